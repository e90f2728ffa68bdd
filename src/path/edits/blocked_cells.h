// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <utility>

#include "throng/base.h"
#include "world/cell_blocks.h"
#include "world/level_view.h"
#include "world/zone_data.h"

/// What an obstacle blocks on the ground of a class: the cells on which a body could touch it.
namespace throng::path {

/// A level tile of a world.
struct TileFloor {
  const WorldSummary& summary;
  const world::LevelView& view;
  int32_t tile_x = 0, tile_z = 0;
};

/// Tiles or cells, last included. None: first above last.
struct SquareRange {
  int32_t first_x = 0, last_x = -1, first_z = 0, last_z = -1;
};

/// Tiles with cells that lie nearer to a polygon's box than `radius`; clamped to a tile beyond the
/// world's rim. [m]
SquareRange tiles_near(const world::WorldData& world,
                       std::span<const std::array<double, 2>> polygon, double radius);
/// The same for cells of a tile.
SquareRange cells_near(const TileFloor& floor, std::span<const std::array<double, 2>> polygon,
                       double radius);

/// Cells of a tile whose middle lies in a prism: on its border, too. By rows.
world::CellRows cells_in(const TileFloor& floor, const Prism& prism);

/// How a floor rises over a cell that has one, along x and z. [mm per cell]
std::pair<int32_t, int32_t> rise_at(const world::LevelView& view, int32_t x, int32_t z);

/// Rounding of heights to whole millimetres, with a margin. [m]
inline constexpr double kHeightRounding = 0.003;
/// No obstacle blocks a cell farther from it than this. [m]
inline double taking_reach(const AvatarClass& avatar) { return avatar.radius + kHeightRounding; }

/// Those of the `legal` cells on which a body of the class, wherever it stands on them, could touch
/// the prism (its polygon convex, of any number of corners) with its bottom above the step height;
/// with triangles, one of those that the prism encloses.
world::CellRows blocked_cells(const TileFloor& floor, const AvatarClass& avatar, const Prism& prism,
                              std::span<const std::array<Vec3d, 3>> triangles,
                              const uint64_t* legal);

}  // namespace throng::path
