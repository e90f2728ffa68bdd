// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "core/access.h"
#include "graph/node_mesh.h"
#include "path/edits/blocked_cells.h"
#include "world/ground.h"

/// The level tiles of a mesh of nodes near a polygon.
namespace throng::path {

/// Calls act(patch, floor) for each level tile that is a patch of the mesh, on tiles that come
/// within `around` of a polygon. [m] Time: the tiles.
template <class Act>
void for_floors_near(const graph::NodeMesh& mesh, std::span<const std::array<double, 2>> polygon,
                     double around, Act act) {
  const world::WorldData& world = *data_of(data_of(mesh.nodes())->world);
  const SquareRange tiles = tiles_near(world, polygon, around);
  for (int32_t z = tiles.first_z; z <= tiles.last_z; ++z) {
    for (int32_t x = tiles.first_x; x <= tiles.last_x; ++x) {
      const auto levels = world.tile_levels(x, z);
      for (uint32_t level = levels.first; level < levels.last; ++level) {
        const uint32_t patch = mesh.patch_of_level(level);
        if (patch == graph::kNoNode) continue;
        const world::GroundLevel ground = world::ground_level(world, level, mesh.avatar_class());
        if (ground.zone != nullptr) act(patch, TileFloor{world.summary, ground.view, x, z});
      }
    }
  }
}

}  // namespace throng::path
