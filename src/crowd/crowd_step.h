// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "crowd/avatars.h"
#include "crowd/collision_map.h"
#include "crowd/crowd_ground.h"

/// One sub-step of all wanderers: claims commit in parallel and in a fixed order.
namespace throng {

/// The world in square blocks of pixels. Blocks of one colour (of four) lie a whole block apart, so
/// nobody who moves in one of them reads or writes what a mover of another touches, as long as
/// avatars have not drifted far since they were last sorted. Within a block avatars move one after
/// the other. So every move sees the true places of all others, and the order, hence the result,
/// is the same for any number of threads.
class CrowdBlocks {
 public:
  CrowdBlocks(int32_t width, int32_t depth, int32_t pixel_cells, int32_t block_pixels);

  [[nodiscard]] uint32_t block(const Avatar& avatar) const {
    return static_cast<uint32_t>(avatar.z / block_units_) * blocks_x_ +
           static_cast<uint32_t>(avatar.x / block_units_);
  }
  /// Sorts avatars by block, keeping their order within a block. Time: linear.
  void sort(std::vector<Avatar>& avatars, std::vector<Avatar>& scratch);

  /// Blocks that hold avatars, by colour; avatars of block i are [first[b], first[b + 1]).
  struct Run {
    uint32_t first, last;
  };
  [[nodiscard]] const std::vector<Run>& runs(uint32_t colour) const { return runs_[colour]; }
  [[nodiscard]] uint64_t bytes() const { return first_.capacity() * 4; }

 private:
  int32_t block_units_;
  uint32_t blocks_x_, blocks_z_;
  std::vector<uint32_t> first_;
  std::vector<Run> runs_[4];
};

struct StepCounts {
  uint64_t moved = 0, blocked_by_wall = 0, blocked_by_avatar = 0, waited = 0;
};

struct StepInput {
  const CrowdGround* ground = nullptr;
  CollisionMap* map = nullptr;
  uint64_t seed = 0;
  uint64_t step = 0;  // number of the sub-step: with seed and id, the random stream
  int32_t step_mm = 0;
  int32_t units_x = 0, units_z = 0;  // extent of the world
};

/// Moves the avatars of one run, in order. Straight on; if that is blocked, one random turn to the
/// left or right is tried; if that is blocked too, the avatar waits, turned. Source: [ML06]
/// section 4.
void move_run(const StepInput& input, Avatar* first, Avatar* last, StepCounts& counts);

}  // namespace throng
