// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>

#include "crowd/ground/avatars.h"
#include "crowd/ground/level_line.h"
#include "crowd/ground/pixel_grid.h"

/// Steps that a level's line decides, several avatars at a time.
namespace throng::crowd {

/// Which of up to 64 avatars step within flat blocks of their tile, a bit each.
struct PlannedSteps {
  uint64_t stays = 0;   // in their pixel: they have moved
  uint64_t leaves = 0;  // it: they have not
};

/// Can plan_steps be used? Pixels of one cell are too rare to be worth it, and lines are found by
/// 31 bits of bytes.
inline bool can_plan(PixelGrid grid, size_t levels) {
  return grid.cells() > 1 && levels < (uint64_t{1} << 31) / sizeof(LevelLine);
}

/// Moves the avatars that stay in their pixel. No step may be longer than a block.
PlannedSteps plan_steps(const LevelLine* lines, PixelGrid grid, Avatar* avatars, size_t size);

}  // namespace throng::crowd
