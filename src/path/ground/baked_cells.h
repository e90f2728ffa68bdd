// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "path/ground/cells.h"
#include "world/ground.h"

/// The baked ground behind a mesh.
namespace throng::path {

/// The baked ground of a class, whose levels have numbers.
struct BakedGround : world::WorldGround {
  [[nodiscard]] world::GroundLevel level(uint32_t number) const {
    return world::ground_level(world, number, avatar_class);
  }
  [[nodiscard]] static uint32_t number(const world::GroundLevel& level) {
    return level.world_level;
  }
};

/// Of a mesh that build_mesh() made.
class BakedCells final : public CellsOf<BakedGround> {
 public:
  BakedCells(const world::WorldData& world, const PathMesh& mesh)
      : CellsOf({{world, mesh.avatar_class}}, mesh.step), mesh_(mesh) {}
  [[nodiscard]] uint32_t rect_at(uint32_t level, int32_t x, int32_t z) const override {
    return mesh_.rect_at(level, x, z);
  }

 private:
  const PathMesh& mesh_;
};

}  // namespace throng::path
