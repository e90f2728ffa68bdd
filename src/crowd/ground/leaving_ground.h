// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>

#include "crowd/ground/crowd_ground.h"
#include "crowd/ground/left_cells.h"
#include "world/tile_grid.h"

/// The ground for a body that stands on blocked cells which it may leave.
namespace throng::crowd {

/// A Ground of walk.h.
class LeavingGround {
 public:
  using Level = CrowdGround::Level;
  LeavingGround(const CrowdGround& ground, Level level, int32_t x, int32_t z)
      : ground_(&ground), from_{level, world::in_tile(x), world::in_tile(z)} {
    if (ground.left().is_zero(from_)) most_steps_ = ground.left().steps_out(from_);
  }

  [[nodiscard]] bool is_legal(Level level, int32_t x, int32_t z) const {
    if (ground_->is_legal(level, x, z)) return true;
    const world::CellRows* baked = ground_->baked_legal(level);
    return baked != nullptr && ((*baked)[static_cast<size_t>(z)] >> x & 1) != 0 &&
           ground_->left().may_cross(from_, {level, x, z}) && leads_out(level, x, z);
  }
  [[nodiscard]] int32_t sample(Level level, int32_t x, int32_t z) const {
    return ground_->sample(level, x, z);
  }
  [[nodiscard]] bool step_safe(Level level) const { return ground_->step_safe(level); }
  template <class Visit>
  void for_tile(int32_t tile_x, int32_t tile_z, int32_t low, int32_t high, Visit visit) const {
    ground_->for_tile(tile_x, tile_z, low, high, visit);
  }

 private:
  // From weight 0 it only goes outwards, or along its border.
  [[nodiscard]] bool leads_out(Level level, int32_t x, int32_t z) const {
    const LeftCells& left = ground_->left();
    return most_steps_ == LeftCells::kNone || !left.is_zero({level, x, z}) ||
           left.steps_out({level, x, z}) <= most_steps_;
  }

  const CrowdGround* ground_;
  LeftCells::Cell from_;
  uint16_t most_steps_ = LeftCells::kNone;
};

/// Does a body at this place stand on a cell which it may leave?
inline bool is_leaving(const CrowdGround& ground, CrowdGround::Level level, int32_t x, int32_t z) {
  return !ground.left().is_empty() && !ground.is_legal(level, world::in_tile(x), world::in_tile(z));
}

/// For each blocked cell that may be left, counts the steps to an exit, after some levels changed.
/// Returns the number of cells that are counted again: those of the levels' tiles, and those that
/// are joined to these by others. Linear in them.
size_t find_exits(CrowdGround& ground, int32_t step_mm,
                  std::span<const CrowdGround::Level> changed);

/// Where the shortest exit from a cell leads to, or its first `max_steps` steps; false: there is
/// none. [cells]
bool find_exit(const CrowdGround& ground, int32_t step_mm, uint32_t max_steps,
               CrowdGround::Level& level, int32_t& x, int32_t& z);

}  // namespace throng::crowd
