// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>

#include "throng/scene.h"

/// How finely a patch must be cut.
namespace throng::importer {

/// Equal steps along s and t.
struct Steps {
  uint8_t s = 1;
  uint8_t t = 1;
  [[nodiscard]] int32_t count() const { return s * t; }
  friend bool operator==(Steps, Steps) = default;
};

/// A patch is cut as a whole, or in 4 x 4 pieces that each have their own steps: piece 4 * j + i,
/// i along s and j along t.
struct PatchCut {
  static constexpr int32_t kMaxPieces = 4;  // along a side

  int32_t pieces = 1;  ///< along a side
  std::array<Steps, size_t{kMaxPieces} * kMaxPieces> steps;

  [[nodiscard]] Steps at(uint32_t i, uint32_t j) const {
    return steps[j * static_cast<uint32_t>(pieces) + i];
  }
};

inline constexpr int32_t kMaxSteps = 128;  ///< Along a side of a whole patch.

/// The cut with the smallest number of triangles that is proven to stay within `tolerance` of the
/// surface, or the finest allowed.
[[nodiscard]] PatchCut cut_within(const BezierPatch& patch, double tolerance);

}  // namespace throng::importer
