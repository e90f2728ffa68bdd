// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "world/ground.h"
#include "world/tile_grid.h"

/// Between metres and points of the grid, levels and places.
namespace throng::world {

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

/// Where a place lies on the grid; none if it is of no level of the world, or not over the tile of
/// its level: the cell there would be another tile's.
inline std::optional<GroundPoint> ground_point(const WorldData& world, const Place& place) {
  if (!place || place.level1 > world.level_count ||
      !std::isfinite(place.position.x + place.position.z))
    return std::nullopt;
  const GroundPoint point = to_ground(world, place.position.x, place.position.z);
  if (!in_grid(world, point)) return std::nullopt;
  const auto tile = world.tile_levels(tile_along(point.cell_x()), tile_along(point.cell_z()));
  if (place.level1 <= tile.first || place.level1 > tile.last) return std::nullopt;
  return point;
}

/// Tile of the grid over which a level of a zone lies.
inline std::pair<int32_t, int32_t> tile_of(const WorldData& world, const Zone& zone,
                                           const format::Level& level) {
  const auto per_zone = static_cast<int32_t>(world.tiles_per_zone);
  return {zone.root().x() * per_zone + level.tile() % per_zone,
          zone.root().z() * per_zone + level.tile() / per_zone};
}

/// Height of the feet on a level. [m]
inline double feet_at(const LevelView& view, GroundPoint p) {
  return view.feet(in_tile(p.cell_x()), in_tile(p.cell_z()),
                   static_cast<int32_t>(p.x & (kUnitsPerCell - 1)),
                   static_cast<int32_t>(p.z & (kUnitsPerCell - 1))) *
         1e-3;
}

inline double feet_at(const GroundLevel& level, GroundPoint p) { return feet_at(level.view, p); }

/// The place of a point on a level: the middle of its unit, so that its coordinates lead back to
/// it.
inline Place place_at(const WorldData& world, uint32_t level, const LevelView& view,
                      GroundPoint p) {
  const double unit = world.summary.cell / kUnitsPerCell;
  return {{world.summary.origin.x + (static_cast<double>(p.x) + 0.5) * unit, feet_at(view, p),
           world.summary.origin.z + (static_cast<double>(p.z) + 0.5) * unit},
          level + 1};
}
inline Place place_at(const WorldData& world, const GroundLevel& level, GroundPoint p) {
  return place_at(world, level.world_level, level.view, p);
}

/// A class's step in the whole millimetres of the moves.
inline int32_t step_mm(const AvatarClass& avatar) {
  return static_cast<int32_t>(std::floor(avatar.step_height * 1000 + 1e-6));
}

}  // namespace throng::world
