// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "throng/scenario.h"

/// Random points of the plane, distributed by a density map.
namespace throng::scenario {

/// Fails with kBadInput: hours that are not in order, beyond the period, of another size or empty.
[[nodiscard]] Result<void> check_hours(const DensityMap& map);

/// The weights of a map at a time of the run: those of its hours, blended. [s]
[[nodiscard]] std::vector<uint8_t> weights_at(const DensityMap& map, double time);

class DensityDraw {
 public:
  explicit DensityDraw(const DensityMap& map) : DensityDraw(map, map.weights) {}
  /// By other weights of its pixels.
  DensityDraw(const DensityMap& map, std::span<const uint8_t> weights);
  /// From three numbers in [0, 1). [m]
  [[nodiscard]] std::array<double, 2> point(double which, double along_x, double along_z) const;
  /// Of the weights of all pixels.
  [[nodiscard]] uint64_t sum() const { return before_.back(); }

 private:
  const DensityMap* map_;
  std::vector<uint64_t> before_;  // sum of the weights before each pixel, and of all at the end
};

}  // namespace throng::scenario
