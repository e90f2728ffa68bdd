// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "throng/math.h"
#include "throng/scenario.h"

/// Painting where people go: maps of weights that a brush changes, and places drawn from them.
namespace throng {

/// Gives all pixels whose middles are within `radius` of a point the weight, if the map is for its
/// height. Returns whether any changed.
bool paint(DensityMap& map, Vec3d where, double radius, uint8_t weight);

/// The map for a height among maps of one storey each; made, empty, if there is none. `bounds` are
/// those of the world. [m]
DensityMap& map_at(std::vector<DensityMap>& maps, const Box3d& bounds, double height);

/// Points of several maps, each as likely as its weight says.
class WeightedPlaces {
 public:
  WeightedPlaces() = default;
  explicit WeightedPlaces(std::vector<DensityMap> maps);

  [[nodiscard]] bool empty() const { return up_to_.empty() || up_to_.back() == 0; }
  /// What three numbers of [0, 1) give: a point at the middle of its map's heights, and how far up
  /// or down its floor may be. Not of an empty one.
  struct Point {
    Vec3d at;
    double reach = 0;  ///< [m]
  };
  [[nodiscard]] Point draw(double which, double along_x, double along_z) const;
  /// The largest weight that a map has at a point of its heights.
  [[nodiscard]] uint8_t weight_at(Vec3d point) const;

 private:
  std::vector<DensityMap> maps_;
  std::vector<uint64_t> up_to_;  // Running sums of the weights, pixel after pixel, map after map.
};

}  // namespace throng
