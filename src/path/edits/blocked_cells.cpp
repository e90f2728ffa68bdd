// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "path/edits/blocked_cells.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>

#include "path/edits/plan_shapes.h"

// Which cells of a tile an obstacle blocks: those on which a body could touch its prism or
// triangles. Linear in cells times triangles.
namespace throng::path {
namespace {

PlanSquare box_of(std::span<const PlanPoint> corners) {
  PlanSquare box{1e300, 1e300, -1e300, -1e300};
  for (const PlanPoint& p : corners) {
    box = {std::min(box.x0, p[0]), std::min(box.z0, p[1]), std::max(box.x1, p[0]),
           std::max(box.z1, p[1])};
  }
  return box;
}

PlanPoint corner_of(const TileFloor& floor) {
  const double side = kTileCells * floor.summary.cell;
  return {floor.summary.origin.x + floor.tile_x * side,
          floor.summary.origin.z + floor.tile_z * side};
}

// The height of a body on a cell, from its lowest feet to its highest head. [m]
std::pair<double, double> body_heights(const world::LevelView& view, const AvatarClass& avatar,
                                       int32_t x, int32_t z) {
  const auto [gx, gz] = rise_at(view, x, z);
  const double feet = view.sample(x, z) * 1e-3;
  const double tilt = (std::abs(gx) + std::abs(gz)) * 0.5e-3 + kHeightRounding;
  return {feet - tilt + body_bottom(avatar), feet + tilt + avatar.height};
}

}  // namespace

SquareRange tiles_near(const world::WorldData& world, std::span<const PlanPoint> polygon,
                       double radius) {
  const PlanSquare box = box_of(polygon);
  const double side = world.summary.cell * kTileCells;
  const auto tile = [&](double at, double origin, int32_t cells) {
    const double index = std::floor((at - origin) / side);
    return static_cast<int32_t>(std::clamp(index, -1.0, cells / kTileCells + 1.0));
  };
  const Vec3d& origin = world.summary.origin;
  return {
      tile(box.x0 - radius, origin.x, world.width), tile(box.x1 + radius, origin.x, world.width),
      tile(box.z0 - radius, origin.z, world.depth), tile(box.z1 + radius, origin.z, world.depth)};
}

SquareRange cells_near(const TileFloor& floor, std::span<const PlanPoint> polygon, double radius) {
  const PlanSquare box = box_of(polygon);
  const auto [origin_x, origin_z] = corner_of(floor);
  const auto cell = [&](double at, double origin) {
    return static_cast<int32_t>(
        std::clamp(std::floor((at - origin) / floor.summary.cell), -1.0, kTileCells + 0.0));
  };
  return {
      std::max(cell(box.x0 - radius, origin_x), 0),
      std::min(cell(box.x1 + radius, origin_x), kTileCells - 1),
      std::max(cell(box.z0 - radius, origin_z), 0),
      std::min(cell(box.z1 + radius, origin_z), kTileCells - 1),
  };
}

world::CellRows cells_in(const TileFloor& floor, const Prism& prism) {
  world::CellRows rows{};
  const SquareRange cells = cells_near(floor, prism.corners, kHeightRounding);
  for (int32_t z = cells.first_z; z <= cells.last_z; ++z) {
    for (int32_t x = cells.first_x; x <= cells.last_x; ++x) {
      const double feet = floor.view.sample(x, z) * 1e-3;
      if (feet < prism.low || feet > prism.high) continue;
      const WorldSummary& world = floor.summary;
      const double mx = world.origin.x + (floor.tile_x * kTileCells + x + 0.5) * world.cell;
      const double mz = world.origin.z + (floor.tile_z * kTileCells + z + 0.5) * world.cell;
      if (is_nearer({mx, mz, mx, mz}, prism.corners, 1e-9))
        rows[static_cast<size_t>(z)] |= uint64_t{1} << x;
    }
  }
  return rows;
}

std::pair<int32_t, int32_t> rise_at(const world::LevelView& view, int32_t x, int32_t z) {
  if (view.is_constant()) return {0, 0};
  return {world::sheet_slope(
              x, [&](int32_t i) { return view.sample(i, z); },
              [&](int32_t i) { return view.has(i, z); }),
          world::sheet_slope(
              z, [&](int32_t k) { return view.sample(x, k); },
              [&](int32_t k) { return view.has(x, k); })};
}

world::CellRows blocked_cells(const TileFloor& floor, const AvatarClass& avatar, const Prism& prism,
                              std::span<const std::array<Vec3d, 3>> triangles,
                              const uint64_t* legal) {
  world::CellRows blocked{};
  const double radius = taking_reach(avatar);
  const auto [first_x, last_x, first_z, last_z] = cells_near(floor, prism.corners, radius);
  if (first_x > last_x) return blocked;
  const auto [origin_x, origin_z] = corner_of(floor);
  const double side = floor.summary.cell;
  // Triangles are grown by kHeightRounding in height, so the box around them is, too.
  const double spare = triangles.empty() ? 0 : kHeightRounding;
  const uint64_t columns = (~uint64_t{0} >> (63 - (last_x - first_x))) << first_x;
  for (int32_t z = first_z; z <= last_z; ++z) {
    for (uint64_t left = legal[z] & columns; left != 0; left &= left - 1) {
      const int32_t x = std::countr_zero(left);
      const auto [low, high] = body_heights(floor.view, avatar, x, z);
      const auto meets = [low = low, high = high](double from, double to) {
        return to > low && from < high;
      };
      if (!meets(prism.low - spare, prism.high + spare)) continue;
      PlanSquare cell{origin_x + x * side, origin_z + z * side, 0, 0};
      cell.x1 = cell.x0 + side;
      cell.z1 = cell.z0 + side;
      if (!is_nearer(cell, prism.corners, radius)) continue;
      bool hit = triangles.empty();
      const PlanSquare around{cell.x0 - radius, cell.z0 - radius, cell.x1 + radius,
                              cell.z1 + radius};
      for (const std::array<Vec3d, 3>& t : triangles) {
        if (hit) break;
        const std::array<PlanPoint, 3> plan{PlanPoint{t[0].x, t[0].z}, PlanPoint{t[1].x, t[1].z},
                                            PlanPoint{t[2].x, t[2].z}};
        if (!is_nearer(cell, plan, radius)) continue;
        const auto heights = heights_over(around, t);
        hit = heights && meets(heights->first - kHeightRounding, heights->second + kHeightRounding);
      }
      if (hit) blocked[static_cast<size_t>(z)] |= uint64_t{1} << x;
    }
  }
  return blocked;
}

}  // namespace throng::path
