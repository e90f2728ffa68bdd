// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "world/walk.h"
#include "world/zone_data.h"

/// The ground of a mapped world for one class, as world/walk.h needs it.
namespace throng::world {

/// One level of the world with what a class needs to walk on it.
struct GroundLevel {
  const Zone* zone = nullptr;
  uint32_t world_level = 0;
  LevelView view;
  const uint64_t* legal = nullptr;  // a set in blocks, or null: see `kind`
  format::CellsKind kind = format::CellsKind::None;
  bool step_safe = false;

  [[nodiscard]] bool is_legal(int32_t x, int32_t z) const {
    if (kind == format::CellsKind::All) return true;
    return legal != nullptr && bit_at(legal, x, z);
  }
  /// The legal cells of one of the level's blocks of 8 x 8. [block < kBlocks]
  [[nodiscard]] uint64_t legal_in(uint32_t block) const {
    if (kind == format::CellsKind::All) return ~uint64_t{0};
    return legal != nullptr ? block_cells(legal, block) : 0;
  }
};

GroundLevel ground_level(const Zone& zone, uint32_t zone_level, uint32_t world_level,
                         int32_t avatar_class);
/// Makes it the same level for another class.
void set_class(GroundLevel& level, uint32_t zone_level, int32_t avatar_class);
/// By the world's number; null zone if its zone cannot be used.
GroundLevel ground_level(const WorldData& world, uint32_t level, int32_t avatar_class);

/// Heights between which the floor of a level lies, maybe wider than it does: from the heads of its
/// blocks, as a bake makes them. [mm]
struct FloorRange {
  int32_t low = 0, high = 0;

  /// Is any height of it within `step` of one of the other's? [step >= 0]
  [[nodiscard]] bool is_near(const FloorRange& other, int32_t step) const {
    return low <= int64_t{other.high} + step && other.low <= int64_t{high} + step;
  }
};
FloorRange floor_range(const LevelView& view);

/// The floor of a level row by row, kNoValue where there is none: for LevelView::samples, where
/// many of its cells are read. `samples` holds 4096. [view.floor != nullptr]
void unpack_floor(const LevelView& view, uint16_t* samples);

struct WorldGround {
  using Level = GroundLevel;
  const WorldData& world;
  int32_t avatar_class;

  [[nodiscard]] bool is_legal(const Level& level, int32_t x, int32_t z) const {
    return level.is_legal(x, z);
  }
  [[nodiscard]] int32_t sample(const Level& level, int32_t x, int32_t z) const {
    return level.view.sample(x, z);
  }
  [[nodiscard]] bool step_safe(const Level& level) const { return level.step_safe; }
  template <class Visit>
  void for_tile(int32_t tile_x, int32_t tile_z, int32_t /*low*/, int32_t /*high*/,
                Visit visit) const {
    const auto tile = world.tile_levels(tile_x, tile_z);
    for (uint32_t i = tile.first; i < tile.last; ++i) {
      visit(ground_level(*tile.zone, tile.zone_first + i - tile.first, i, avatar_class));
    }
  }
};

}  // namespace throng::world
