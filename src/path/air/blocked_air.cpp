// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "path/air/blocked_air.h"

#include <algorithm>
#include <cmath>

#include "path/edits/blocked_cells.h"
#include "path/edits/plan_shapes.h"
#include "world/walk.h"

// Which voxels an obstacle blocks: those in which a body, grown by rounding, could touch its prism
// or triangles. Linear in voxels times triangles.
namespace throng::path {
namespace {

// Layers in which the feet may be of a body that could touch what lies between two heights.
std::pair<int32_t, int32_t> layers_near(const AirGrid& grid, double low, double high) {
  const auto layer = [&](double height) {
    return static_cast<int32_t>(std::clamp(std::floor((height - grid.y) / grid.cell), -1e9, 1e9));
  };
  return {layer(low - grid.height - grid.spare), layer(high + grid.spare)};
}

}  // namespace

AirGrid::AirGrid(const world::WorldData& world, const world::AirShape& shape,
                 const AvatarClass& avatar)
    : x(world.summary.origin.x),
      y(shape.origin_y * 1e-3),
      z(world.summary.origin.z),
      cell(shape.cell * 1e-3),
      radius(avatar.radius),
      height(avatar.height),
      // Whatever follows paths rounds feet to units of the ground and to millimetres.
      spare(std::max(kHeightRounding, 4 * world.summary.cell / world::kUnitsPerCell)) {}

AirRange air_near(const AirGrid& grid, const FlightSpace& space, const Prism& prism) {
  const double radius = grid.radius + grid.spare;
  double x0 = HUGE_VAL, z0 = HUGE_VAL, x1 = -HUGE_VAL, z1 = -HUGE_VAL;
  for (const PlanPoint& p : prism.corners) {
    x0 = std::min(x0, p[0]);
    x1 = std::max(x1, p[0]);
    z0 = std::min(z0, p[1]);
    z1 = std::max(z1, p[1]);
  }
  const auto cell = [&](double at, double origin, int32_t cells) {
    const double index = std::floor((at - origin) / grid.cell);
    return static_cast<int32_t>(std::clamp(index, -1.0, static_cast<double>(cells)));
  };
  const auto [low, high] = layers_near(grid, prism.low, prism.high);
  return {{std::max(cell(x0 - radius, grid.x, space.width), 0), std::max(low, space.shape.floor),
           std::max(cell(z0 - radius, grid.z, space.depth), 0)},
          {std::min(cell(x1 + radius, grid.x, space.width), space.width - 1),
           std::min(high, space.shape.ceiling - 1),
           std::min(cell(z1 + radius, grid.z, space.depth), space.depth - 1)}};
}

bool block_air(const AirGrid& grid, const world::AirCube& cube, const AirRange& near,
               const Prism& prism, std::span<const std::array<Vec3d, 3>> triangles,
               CubeCells& blocked) {
  const double radius = grid.radius + grid.spare;
  bool any = false;
  const auto take = [&](int32_t x, int32_t z, double low, double high) {
    auto [first, last] = layers_near(grid, low, high);
    first = std::max({first, near.first[1], cube.y});
    last = std::min({last, near.last[1], cube.y + cube.side - 1});
    for (int32_t y = first; y <= last; ++y) {
      blocked.row(y - cube.y, z - cube.z) |= uint32_t{1} << (x - cube.x);
      any = true;
    }
  };
  const int32_t x0 = std::max(near.first[0], cube.x), z0 = std::max(near.first[2], cube.z);
  const int32_t x1 = std::min(near.last[0], cube.x + cube.side - 1);
  const int32_t z1 = std::min(near.last[2], cube.z + cube.side - 1);
  for (int32_t z = z0; z <= z1; ++z) {
    for (int32_t x = x0; x <= x1; ++x) {
      PlanSquare square{grid.x + x * grid.cell, grid.z + z * grid.cell, 0, 0};
      square.x1 = square.x0 + grid.cell;
      square.z1 = square.z0 + grid.cell;
      if (!is_nearer(square, prism.corners, radius)) continue;
      if (triangles.empty()) {
        take(x, z, prism.low, prism.high);
        continue;
      }
      const PlanSquare around{square.x0 - radius, square.z0 - radius, square.x1 + radius,
                              square.z1 + radius};
      for (const std::array<Vec3d, 3>& t : triangles) {
        const std::array<PlanPoint, 3> plan{PlanPoint{t[0].x, t[0].z}, PlanPoint{t[1].x, t[1].z},
                                            PlanPoint{t[2].x, t[2].z}};
        if (!is_nearer(square, plan, radius)) continue;
        if (const auto heights = heights_over(around, t))
          take(x, z, heights->first, heights->second);
      }
    }
  }
  return any;
}

}  // namespace throng::path
