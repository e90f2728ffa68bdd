// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>

#include "crowd/ground/crowd_ground.h"
#include "world/tile_grid.h"
#include "world/walk.h"

// Which flat blocks continue, level, beyond the edge of their tile: found once, so that a step over
// the edge needs no search. A step from a flat cell to an equally high one rises by 0, which no
// other level of the tile can better; world/walk.h takes the first of those that rise least. So a
// join is right if no earlier level of the tile is legal at that height in a cell of the block.
// Linear in the level tiles, but for the levels that lie over one tile.
namespace throng::crowd {
namespace {

constexpr int32_t kLast = 15;  // block of a row or column

// Cell of the tile in the corner of a block of the rim: the i-th along a side.
struct Cell {
  int32_t x, z;
};
Cell rim(LevelLine::Side side, int32_t i) {
  switch (side) {
    case LevelLine::kLeft:
      return {0, i * 4};
    case LevelLine::kRight:
      return {kLast * 4, i * 4};
    case LevelLine::kAbove:
      return {i * 4, 0};
    default:
      return {i * 4, kLast * 4};
  }
}

bool is_flat(const LevelLine& line, Cell c) { return (line.flat[c.z / 4] >> (c.x / 4) & 1) != 0; }

}  // namespace

void CrowdGround::join_blocks() {
  for (Level level = 0; level < records_.size(); ++level) {
    for (const LevelLine::Side side : LevelLine::kSides) {
      join_side(level, side);
      find_beyond(level, side);
    }
  }
  for (Level level = 0; level < records_.size(); ++level) {
    for (const LevelLine::Side side : LevelLine::kSides) join_open_side(level, side);
  }
}

void CrowdGround::join_side(Level level, LevelLine::Side side) {
  const bool along_x = side == LevelLine::kLeft || side == LevelLine::kRight;
  const bool back = side == LevelLine::kLeft || side == LevelLine::kAbove;
  const LevelLine::Side opposite = LevelLine::opposite(side);
  const Record& record = records_[level];
  LevelLine& line = lines_[level];
  line.beyond[side] = LevelLine::kNone;
  line.joined[side] = 0;
  const Range* range = tile(record.tile_x + (along_x ? (back ? -1 : 1) : 0),
                            record.tile_z + (along_x ? 0 : (back ? -1 : 1)));
  if (range == nullptr) return;
  const auto already_joined = [&](Level other, Cell c, int32_t y) {
    for (Level j = range->first; j < other; ++j) {
      if (heights_[j].low > y || heights_[j].high < y) continue;
      for (int32_t cell = 0; cell < 16; ++cell) {
        const int32_t x = c.x + cell % 4, z = c.z + cell / 4;
        if (is_legal(j, x, z) && sample(j, x, z) == y) return true;
      }
    }
    return false;
  };
  for (int32_t i = 0; i <= kLast; ++i) {
    const Cell here = rim(side, i), there = rim(opposite, i);
    if (!is_flat(line, here)) continue;
    const int32_t y = sample(level, here.x, here.z);
    for (Level other = range->first; other < range->last; ++other) {
      if (!is_flat(lines_[other], there) || sample(other, there.x, there.z) != y) continue;
      const bool fits = line.beyond[side] == LevelLine::kNone || line.beyond[side] == other;
      if (!fits || already_joined(other, there, y)) break;
      line.beyond[side] = other;
      line.joined[side] = static_cast<uint16_t>(line.joined[side] | 1u << i);
      break;
    }
  }
}

void CrowdGround::find_open(Level level) {
  open_[level].open = step_safe(level) ? full_blocks(legal(level)) : std::array<uint16_t, 16>{};
}

// Of the levels that steps over a side lead to, the one beyond is that which most of them lead to
// (the first of equals).
void CrowdGround::find_beyond(Level level, LevelLine::Side side) {
  const bool along_x = side == LevelLine::kLeft || side == LevelLine::kRight;
  const int32_t toward = side == LevelLine::kLeft || side == LevelLine::kAbove ? -1 : 1;
  const Record& record = records_[level];
  OpenLine& line = open_[level];
  line.beyond[side] = LevelLine::kNone;
  line.cells[side] = 0;
  if ((lines_[level].legal_set & kSetBits) == kNoneLegal) return;
  std::array<Level, 64> steps;  // where the step from each cell leads
  for (int32_t i = 0; i < 64; ++i) {
    const int32_t rim = toward > 0 ? world::kInTile : 0;
    const int32_t x = world::first_cell(record.tile_x) + (along_x ? rim : i);
    const int32_t z = world::first_cell(record.tile_z) + (along_x ? i : rim);
    const auto next = is_legal(level, world::in_tile(x), world::in_tile(z))
                          ? world::step_to(*this, level, x, z, x + (along_x ? toward : 0),
                                           z + (along_x ? 0 : toward), step_mm_)
                          : std::nullopt;
    steps[i] = next ? *next : LevelLine::kNone;
  }
  int64_t max_count = 0;
  for (const Level to : steps) {
    if (to == LevelLine::kNone || to == line.beyond[side]) continue;
    const int64_t count = std::count(steps.begin(), steps.end(), to);
    if (count <= max_count) continue;
    max_count = count;
    line.beyond[side] = to;
  }
  if (max_count == 0) return;
  for (int32_t i = 0; i < 64; ++i) {
    line.cells[side] |= uint64_t{steps[i] == line.beyond[side]} << i;
  }
}

// After both levels know where their steps lead: blocks join if all steps lead there and back.
void CrowdGround::join_open_side(Level level, LevelLine::Side side) {
  OpenLine& line = open_[level];
  line.joined[side] = 0;
  if (line.beyond[side] == LevelLine::kNone) return;
  const LevelLine::Side back = LevelLine::opposite(side);
  const OpenLine& other = open_[line.beyond[side]];
  if (other.beyond[back] != level) return;
  const uint64_t both_directions = line.cells[side] & other.cells[back];
  for (int32_t i = 0; i <= kLast; ++i) {
    const Cell here = rim(side, i), there = rim(back, i);
    const bool joins = (both_directions >> (4 * i) & 15) == 15 &&
                       line.is_open(here.x / 4, here.z / 4) &&
                       other.is_open(there.x / 4, there.z / 4);
    line.joined[side] = static_cast<uint16_t>(line.joined[side] | int{joins} << i);
  }
}

}  // namespace throng::crowd
