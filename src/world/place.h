// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>

#include "world/walk.h"
#include "world/zone_data.h"

/// Metres to points of the grid.
namespace throng {

/// Far off the grid is off the grid, whether or not it fits an integer. [m, finite]
inline GroundPoint to_ground(const WorldData& world, double x, double z) {
  const double scale = kUnitsPerCell / world.summary.cell;
  const auto to_unit = [&](double distance) {
    return static_cast<int64_t>(std::floor(std::clamp(distance * scale, -1e15, 1e15)));
  };
  return {to_unit(x - world.summary.origin.x), to_unit(z - world.summary.origin.z)};
}

inline bool in_grid(const WorldData& world, GroundPoint p) {
  return p.x >= 0 && p.z >= 0 && p.x < (int64_t{world.width} << kUnitBits) &&
         p.z < (int64_t{world.depth} << kUnitBits);
}

}  // namespace throng
