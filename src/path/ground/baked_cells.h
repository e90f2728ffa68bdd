// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "path/ground/cells.h"
#include "world/cell_blocks.h"
#include "world/ground.h"
#include "world/zone_data.h"

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

/// The area kinds that the bake gave to the cells of a level.
inline std::array<uint8_t, 4096> baked_kinds(const world::GroundLevel& level) {
  std::array<uint8_t, 4096> kinds;
  const format::Level& record = *level.view.record;
  kinds.fill(record.area_value());
  if (record.area_kind() != format::CellsKind::Blocks) return kinds;
  std::array<uint16_t, 4096> values;
  world::unpack_values(level.zone->words(record.area_offset()), values.data());
  for (size_t c = 0; c < kinds.size(); ++c) {
    kinds[c] = static_cast<uint8_t>(values[c] & world::kLastAreaKind);
  }
  return kinds;
}

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
