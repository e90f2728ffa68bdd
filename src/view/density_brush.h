// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "throng/base.h"
#include "throng/scenario.h"

/// Density maps that a brush changes, and random points drawn from them.
namespace throng::view {

/// Sets the weight of all pixels whose middles are within `radius` of a point, if the map covers
/// its height. Returns whether any changed.
bool paint(DensityMap& map, Vec3d where, double radius, uint8_t weight);

/// The map that covers a height, among maps of one storey each; adds an empty one if there is none.
/// `bounds` are those of the world. [m]
DensityMap& map_at(std::vector<DensityMap>& maps, const Box3d& bounds, double height);

/// Random points of several maps, with probabilities proportional to the weights.
class WeightedPlaces {
 public:
  WeightedPlaces() = default;
  explicit WeightedPlaces(std::vector<DensityMap> maps);

  [[nodiscard]] bool empty() const { return up_to_.empty() || up_to_.back() == 0; }
  /// A point at the middle of its map's heights, and half of these: the vertical tolerance.
  struct Point {
    Vec3d at;
    double vertical_tolerance = 0;  ///< [m]
  };
  /// The point of three random numbers of [0, 1). Not while empty.
  [[nodiscard]] Point draw(double which, double along_x, double along_z) const;
  /// The largest weight of all maps that cover a point.
  [[nodiscard]] uint8_t weight_at(Vec3d point) const;

 private:
  std::vector<DensityMap> maps_;
  std::vector<uint64_t> up_to_;  // Running sums of the weights, pixel after pixel, map after map.
};

}  // namespace throng::view
