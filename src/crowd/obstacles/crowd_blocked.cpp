// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <bit>

#include "crowd/ground/crowd_ground.h"

// Cells that obstacles block, and free again. While some cells of a level are blocked, what was
// baked is kept aside, so that it comes back to the bit. Linear in the level's cells.
namespace throng::crowd {
namespace {

constexpr size_t kRows = 64;

}  // namespace

void CrowdGround::keep_baked(Level level, Baked& baked) {
  LevelLine& line = lines_[level];
  const uint32_t set = line.legal_set & kSetBits;
  baked.legal_word = line.legal_set;
  baked.flat_set = line.flat_set;
  std::copy_n(legal(level), kRows, baked.legal.begin());
  std::copy_n(flat(level), kRows, baked.flat.begin());
  if (set != kAllLegal) return;
  // Many levels share the rows of all cells: this one needs its own.
  uint32_t own = row_sets_;
  if (spare_sets_.empty()) {
    ++row_sets_;
  } else {
    own = spare_sets_.back();
    spare_sets_.pop_back();
  }
  if (line.flat_set == set) line.flat_set = own;
  line.legal_set = own | (line.legal_set & ~kSetBits);
}

void CrowdGround::set_blocked(Level level, const world::CellRows& blocked) {
  const bool any =
      std::any_of(blocked.begin(), blocked.end(), [](uint64_t row) { return row != 0; });
  auto kept = baked_.find(level);
  if (kept == baked_.end()) {
    if (!any || (lines_[level].legal_set & kSetBits) == kNoneLegal) return;
    kept = baked_.try_emplace(level).first;
    keep_baked(level, kept->second);
  }
  const Baked& baked = kept->second;
  LevelLine& line = lines_[level];
  const auto write = [&](uint32_t set, const world::CellRows& rows) {
    uint64_t* to = rows_.data() + size_t{set & kSetBits} * kRows;
    for (size_t z = 0; z < kRows; ++z) to[z] = rows[z] & ~blocked[z];
  };
  // A cell is flat if it is legal and as high as those beside it, legal or not.
  write(line.legal_set, baked.legal);
  if (line.flat_set != kNoneLegal) write(line.flat_set, baked.flat);
  uint32_t cells = 0;
  for (size_t z = 0; z < kRows; ++z) {
    cells += static_cast<uint32_t>(std::popcount(legal(level)[z]));
  }
  records_[level].legal_cells = cells;
  line.flat = full_blocks(flat(level));
  find_open(level);
  if (any) return;
  if (line.legal_set != baked.legal_word) spare_sets_.push_back(line.legal_set & kSetBits);
  line.legal_set = baked.legal_word;
  line.flat_set = baked.flat_set;
  baked_.erase(kept);
}

const world::CellRows* CrowdGround::baked_legal(Level level) const {
  const auto kept = baked_.find(level);
  return kept == baked_.end() ? nullptr : &kept->second.legal;
}

void CrowdGround::join_tile(int32_t x, int32_t z) {
  // The tile's own sides, and from beyond each the side towards the tile.
  const auto for_sides = [&](auto act) {
    const auto for_levels = [&](int32_t tile_x, int32_t tile_z, LevelLine::Side side) {
      const Range* range = tile(tile_x, tile_z);
      for (Level i = range ? range->first : 0; range && i < range->last; ++i) act(i, side);
    };
    for (const LevelLine::Side side : LevelLine::kSides) for_levels(x, z, side);
    for_levels(x - 1, z, LevelLine::kRight);
    for_levels(x + 1, z, LevelLine::kLeft);
    for_levels(x, z - 1, LevelLine::kBelow);
    for_levels(x, z + 1, LevelLine::kAbove);
  };
  for_sides([&](Level level, LevelLine::Side side) {
    join_side(level, side);
    find_beyond(level, side);
  });
  for_sides([&](Level level, LevelLine::Side side) { join_open_side(level, side); });
}

}  // namespace throng::crowd
