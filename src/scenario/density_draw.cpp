// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "scenario/density_draw.h"

#include <algorithm>

// Draws points by the weights of a density map: prefix sums of the pixels, and a binary search for
// each point.
namespace throng::scenario {

DensityDraw::DensityDraw(const DensityMap& map) : map_(&map) {
  before_.reserve(map.weights.size() + 1);
  uint64_t sum = 0;
  for (const uint8_t weight : map.weights) {
    before_.push_back(sum);
    sum += weight;
  }
  before_.push_back(sum);
}

std::array<double, 2> DensityDraw::point(double which, double along_x, double along_z) const {
  const auto n = static_cast<uint64_t>(which * static_cast<double>(before_.back()));
  const auto pixel = static_cast<size_t>(std::upper_bound(before_.begin(), before_.end() - 1, n) -
                                         before_.begin() - 1);
  const auto width = static_cast<size_t>(map_->width);
  const auto column = static_cast<double>(pixel % width), row = static_cast<double>(pixel / width);
  return {map_->x0 + (column + along_x) * (map_->x1 - map_->x0) / map_->width,
          map_->z0 + (row + along_z) * (map_->z1 - map_->z0) / map_->height};
}

}  // namespace throng::scenario
