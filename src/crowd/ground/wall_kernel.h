// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>

#include "steer/sampled.h"

/// Distances to walls, in all directions of a fan at a time.
namespace throng::crowd {

/// Where a body could stand around its place: 32 x 32 squares of 2^shift units, bit x of row z.
struct WallWindow {
  static constexpr int32_t kSize = 32;
  static constexpr int32_t kMiddle = 15;  ///< The body's own square, along both axes.
  alignas(64) std::array<uint32_t, kSize> rows{};
  int32_t shift = 0;
  int32_t x = 0, z = 0;  ///< The body, from the window's corner. [units]

  /// Half a square: the distance between samples. [units]
  [[nodiscard]] int32_t spacing() const { return 1 << (shift - 1); }
  /// The longest range of a query: a square less than the window, for lines that end on its border.
  /// [units]
  [[nodiscard]] float range() const { return static_cast<float>((kMiddle - 1) << shift); }
};

using FreeDistances = std::array<float, steer::kDirections>;

/// How far each direction leads over free squares, in half squares, up to `query_range` [units, <=
/// range()], in units. The first sample lies half a square off.
void find_free_distances(const WallWindow& window, const steer::Fan& fan, float query_range,
                         FreeDistances& distances);

}  // namespace throng::crowd
