// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <cstdlib>
#include <optional>

#include "world/zone_data.h"

/// Walking on level tiles: the conservative form of [ML06] algorithm 1.
namespace throng {

/// Positions on the ground: 1/2048 cell from the corner of the world's grid.
inline constexpr int32_t kUnitBits = 11;
inline constexpr int32_t kUnitsPerCell = 1 << kUnitBits;

struct GroundPoint {
  int64_t x = 0, z = 0;  // units
  [[nodiscard]] int32_t cell_x() const { return static_cast<int32_t>(x >> kUnitBits); }
  [[nodiscard]] int32_t cell_z() const { return static_cast<int32_t>(z >> kUnitBits); }
};

/// One level of the world with what a class needs to walk on it.
struct GroundLevel {
  const Zone* zone = nullptr;
  uint32_t world_level = 0;
  LevelView view;
  const uint64_t* legal = nullptr;  // 64 rows, or null: see `kind`
  format::BitsKind kind = format::BitsKind::None;
  bool step_safe = false;

  [[nodiscard]] bool is_legal(int32_t x, int32_t z) const {
    if (kind == format::BitsKind::All) return true;
    return legal != nullptr && ((legal[z] >> x) & 1) != 0;
  }
};

GroundLevel ground_level(const Zone& zone, uint32_t zone_level, uint32_t world_level, int32_t avatar_class);
/// By the world's number; null zone if its zone cannot be used.
GroundLevel ground_level(const WorldData& world, uint32_t level, int32_t avatar_class);

/// The level on which a body that stands on `from` at cell (x, z) stands after the step into the
/// neighbouring cell (nx, nz), or none: not legal there, or more than the step up or down. The
/// printed algorithm 1 checks the ceiling over A only; a cell is legal here only if a body clears the
/// ceilings of all cells that it can reach from it, so A and B are checked both.
std::optional<GroundLevel> step_to(const WorldData& world, const GroundLevel& from, int32_t x, int32_t z,
                                   int32_t nx, int32_t nz, int32_t avatar_class, int32_t step_mm);

/// Walks from `from` to `to` in a straight line, cell by cell; through a corner only if both cells
/// beside it let the body pass. False leaves `level` as it was.
bool walk(const WorldData& world, GroundLevel& level, GroundPoint from, GroundPoint to,
          int32_t avatar_class, int32_t step_mm);

}  // namespace throng
