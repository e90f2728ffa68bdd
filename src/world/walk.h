// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <cstdlib>
#include <optional>

#include "world/tile_grid.h"

/// Walking on level tiles: the conservative form of [ML06] algorithm 1, for any storage of levels.
///
/// A Ground has a type Level (a handle), and
///   bool is_legal(Level, int32_t x, int32_t z)      may the body stand on cell (x, z) of the tile?
///   int32_t sample(Level, int32_t x, int32_t z)     floor under the middle of that cell [mm]
///   bool step_safe(Level)                           legal neighbours never differ by more than the
///   step void for_tile(int32_t tile_x, int32_t tile_z, int32_t low, int32_t high, Visit)   visits
///   the levels of a tile of the world; those without a floor from low to high may be left out
namespace throng::world {

/// Positions on the ground: 1/2048 cell from the corner of the world's grid.
inline constexpr int32_t kUnitBits = 11;
inline constexpr int32_t kUnitsPerCell = 1 << kUnitBits;

struct GroundPoint {
  int64_t x = 0, z = 0;  // units
  [[nodiscard]] int32_t cell_x() const { return static_cast<int32_t>(x >> kUnitBits); }
  [[nodiscard]] int32_t cell_z() const { return static_cast<int32_t>(z >> kUnitBits); }
};

/// The level on which a body that stands on `from` at cell (x, z) stands after the step into the
/// neighbouring cell (nx, nz), or none: not legal there, or more than the step up or down. The
/// printed algorithm 1 checks the ceiling over A only; here a cell is legal only if a body on it
/// clears the ceilings of all cells that it reaches from there, so A and B are both checked.
template <class Ground>
std::optional<typename Ground::Level> step_to(const Ground& ground,
                                              const typename Ground::Level& from, int32_t x,
                                              int32_t z, int32_t nx, int32_t nz, int32_t step_mm) {
  using Level = typename Ground::Level;
  const int32_t lx = in_tile(nx), lz = in_tile(nz);
  const bool same_tile = tile_along(x) == tile_along(nx) && tile_along(z) == tile_along(nz);
  if (same_tile && ground.step_safe(from) && ground.is_legal(from, lx, lz)) return from;
  const int32_t feet = ground.sample(from, in_tile(x), in_tile(z));
  const auto rise_to = [&](const Level& level) {
    return ground.is_legal(level, lx, lz) ? std::abs(ground.sample(level, lx, lz) - feet)
                                          : INT32_MAX;
  };
  if (same_tile && rise_to(from) <= step_mm) return from;
  std::optional<Level> best;
  int32_t best_rise = INT32_MAX;
  ground.for_tile(tile_along(nx), tile_along(nz), feet - step_mm, feet + step_mm,
                  [&](const Level& level) {
                    const int32_t rise = rise_to(level);
                    if (rise > step_mm || rise >= best_rise) return;
                    best_rise = rise;
                    best = level;
                  });
  return best;
}

/// Where a straight walk ended: in a cell, and over which of its borders it could not go: x, z, or
/// both at a corner. [-1, 0, 1]
struct WalkStop {
  bool arrived = false;
  int32_t x = 0, z = 0;
  int32_t toward_x = 0, toward_z = 0;
};

/// Walks from `from` to `to` in a straight line, cell by cell, as far as it goes; through a corner
/// only if both cells beside it let the body pass. `level` is then the one of the last cell. Calls
/// enter(level, x, z, from_x, from_z) for every cell after the first, with the one before it.
template <class Ground, class Enter>
WalkStop walk_far(const Ground& ground, typename Ground::Level& level, GroundPoint from,
                  GroundPoint to, int32_t step_mm, Enter enter) {
  int32_t x = from.cell_x(), z = from.cell_z();
  const int32_t end_x = to.cell_x(), end_z = to.cell_z();
  const int64_t dx = std::llabs(to.x - from.x), dz = std::llabs(to.z - from.z);
  const int32_t sx = to.x > from.x ? 1 : -1, sz = to.z > from.z ? 1 : -1;
  while (x != end_x || z != end_z) {
    // Distance along each axis to the next line of the grid; the sooner of the two is crossed.
    const int64_t line_x = int64_t{sx > 0 ? x + 1 : x} << kUnitBits;
    const int64_t line_z = int64_t{sz > 0 ? z + 1 : z} << kUnitBits;
    const int64_t ax = std::llabs(line_x - from.x) * dz, az = std::llabs(line_z - from.z) * dx;
    const bool cross_x = x != end_x && (z == end_z || ax <= az);
    const bool cross_z = z != end_z && (x == end_x || az <= ax);
    const int32_t nx = cross_x ? x + sx : x, nz = cross_z ? z + sz : z;
    std::optional<typename Ground::Level> next;
    if (cross_x && cross_z) {
      const auto beside_x = step_to(ground, level, x, z, nx, z, step_mm);
      const auto beside_z = step_to(ground, level, x, z, x, nz, step_mm);
      if (beside_x && beside_z && step_to(ground, *beside_z, x, nz, nx, nz, step_mm)) {
        next = step_to(ground, *beside_x, nx, z, nx, nz, step_mm);
      }
    } else {
      next = step_to(ground, level, x, z, nx, nz, step_mm);
    }
    if (!next) return {false, x, z, nx - x, nz - z};
    level = *next;
    enter(level, nx, nz, x, z);
    x = nx;
    z = nz;
  }
  return {true, x, z, 0, 0};
}
template <class Ground>
WalkStop walk_far(const Ground& ground, typename Ground::Level& level, GroundPoint from,
                  GroundPoint to, int32_t step_mm) {
  return walk_far(ground, level, from, to, step_mm,
                  [](const typename Ground::Level&, int32_t, int32_t, int32_t, int32_t) {});
}

/// As walk_far, to the end or not at all: false leaves `level` as it was.
template <class Ground>
bool walk(const Ground& ground, typename Ground::Level& level, GroundPoint from, GroundPoint to,
          int32_t step_mm) {
  typename Ground::Level current = level;
  if (!walk_far(ground, current, from, to, step_mm).arrived) return false;
  level = current;
  return true;
}

}  // namespace throng::world
