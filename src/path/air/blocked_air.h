// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "path/air/flight_space.h"
#include "throng/avatar.h"
#include "throng/base.h"
#include "world/zone_data.h"

/// What an obstacle blocks in the air of a class: the voxels from which a body could touch it.
namespace throng::path {

/// The grid of the voxels, and the body that is in them. [m]
struct AirGrid {
  double x = 0, y = 0, z = 0;  ///< Corner of voxel (0, 0, 0).
  double cell = 0;
  double radius = 0, height = 0;
  double spare = 0;  ///< Obstacles count as so much wider, higher and lower.

  AirGrid(const world::WorldData& world, const world::AirShape& shape, const AvatarClass& avatar);
};

/// Voxels of a cube: bit x of row y * kSide + z, from its corner.
struct CubeCells {
  static constexpr int32_t kSide = 32;
  std::array<uint32_t, static_cast<size_t>(kSide) * kSide> rows{};

  [[nodiscard]] uint32_t& row(int32_t y, int32_t z) {
    return rows[static_cast<size_t>(y * kSide + z)];
  }
  [[nodiscard]] uint32_t row(int32_t y, int32_t z) const {
    return rows[static_cast<size_t>(y * kSide + z)];
  }
};

/// The voxels of the space that a prism may block any of; a few more may be among them.
AirRange air_near(const AirGrid& grid, const FlightSpace& space, const Prism& prism);

/// Adds those voxels of a cube of at most 32 a side in which a body, wherever in the voxel its feet
/// are, could touch the prism (its polygon convex, of any number of corners); with triangles, one
/// of those that the prism encloses. False if there are none.
bool block_air(const AirGrid& grid, const world::AirCube& cube, const AirRange& near,
               const Prism& prism, std::span<const std::array<Vec3d, 3>> triangles,
               CubeCells& blocked);

}  // namespace throng::path
