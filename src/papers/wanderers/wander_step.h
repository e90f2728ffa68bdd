// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>

#include "crowd/ground/avatars.h"
#include "crowd/ground/crowd_ground.h"
#include "crowd/walk/collision_map.h"
#include "crowd/walk/crowd_blocks.h"

/// One sub-step of all wanderers: moves are accepted in a fixed order.
namespace throng::papers {

struct StepCounts {
  uint64_t moved = 0, blocked_by_wall = 0, blocked_by_avatar = 0, waited = 0;
};

struct StepInput {
  const crowd::CrowdGround* ground = nullptr;
  crowd::CollisionMap* map = nullptr;
  uint64_t seed = 0;
  uint64_t step = 0;  // number of the sub-step: with seed and id, the random stream
  int32_t step_mm = 0;
  int32_t body_mm = 0;               // height of the bodies
  bool is_short = false;             // no sub-step is longer than a block of LevelLine
  int32_t units_x = 0, units_z = 0;  // extent of the world
};

/// Moves the avatars of some runs of one colour, run by run. Straight on; if that is blocked, one
/// random turn to the left or right is tried; if that is blocked too, the avatar waits, turned.
/// Source: [ML06] section 4.
void move_runs(const StepInput& input, crowd::Avatar* avatars,
               std::span<const crowd::CrowdBlocks::Run> runs, StepCounts& counts);

}  // namespace throng::papers
