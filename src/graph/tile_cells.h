// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "graph/node_links.h"
#include "graph/quadtree.h"
#include "throng/surface.h"
#include "world/zone_data.h"

/// Level tiles as patches: their 64 x 64 cells are the finest sub-patches, s along x, t along z.
namespace throng::graph {

inline constexpr int32_t kTileDepth = 6;

/// What the cells of a level promise: to each of some classes what its legal bits say, and the
/// steps that it cannot take between neighbours. [level < world.level_tile_count()]
[[nodiscard]] PatchCells tile_cells(const World& world, uint32_t level, uint16_t classes,
                                    const NodeBins& bins);

/// Cells of different levels between which a class steps there and back, by the rule of moves: over
/// the east and south borders of a tile, and over the seams of its level tiles. Levels count as
/// patches: level l is patch l.
[[nodiscard]] std::vector<CellPair> tile_pairs(const world::WorldData& world, int32_t tile_x,
                                               int32_t tile_z);

}  // namespace throng::graph
