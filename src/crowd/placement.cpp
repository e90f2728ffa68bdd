// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "crowd/placement.h"

#include <algorithm>
#include <bit>

#include "core/random.h"
#include "world/tile_grid.h"

// Random points of the ground, uniform by cell: a binary search among the levels, then the row of
// the cell. Logarithmic in the levels.
namespace throng::crowd {
namespace {

// The cell of a level that has `rank` legal cells before it.
std::pair<int32_t, int32_t> nth_legal(const uint64_t* legal, uint32_t rank) {
  for (int32_t z = 0;; ++z) {
    uint64_t row = legal[z];
    const auto count = static_cast<uint32_t>(std::popcount(row));
    if (rank >= count) {
      rank -= count;
      continue;
    }
    for (; rank > 0; --rank) row &= row - 1;
    return {std::countr_zero(row), z};
  }
}

}  // namespace

StandingDraw::StandingDraw(const CrowdGround& ground, uint64_t seed)
    : ground_(&ground), seed_(seed), before_{0} {
  for (const auto& record : ground.records()) {
    before_.push_back(before_.back() + record.legal_cells);
  }
}

StandingDraw::Stand StandingDraw::draw(uint64_t n) const {
  const uint64_t pick = random_below(seed_, 0x706c6163, n, before_.back());
  const uint64_t within = random_u64(seed_, 0x77697468, n);
  const auto level = static_cast<uint32_t>(std::upper_bound(before_.begin(), before_.end(), pick) -
                                           before_.begin() - 1);
  const auto [x, z] =
      nth_legal(ground_->legal(level), static_cast<uint32_t>(pick - before_[level]));
  const auto& record = ground_->records()[level];
  const auto unit = [](uint64_t bits) {
    return static_cast<int64_t>(bits & (world::kUnitsPerCell - 1));
  };
  return {
      level,
      {(int64_t{world::first_cell(record.tile_x) + x} << world::kUnitBits) + unit(within),
       (int64_t{world::first_cell(record.tile_z) + z} << world::kUnitBits) + unit(within >> 32)}};
}

std::vector<Avatar> place_avatars(const CrowdGround& ground, uint32_t count, uint64_t seed,
                                  CollisionMap& map) {
  const auto& records = ground.records();
  const StandingDraw standing(ground, seed);
  std::vector<Avatar> avatars;
  if (standing.is_empty()) return avatars;
  avatars.reserve(count);
  const auto try_place = [&](uint32_t level, world::GroundPoint p) {
    const int32_t y = ground.feet(level, p);
    const CollisionMap::Mark mark = map.mark(p, y);
    if (!map.is_free(mark)) return false;
    map.set(mark);
    avatars.push_back({.x = static_cast<int32_t>(p.x),
                       .z = static_cast<int32_t>(p.z),
                       .y = y,
                       .level = level,
                       .id = static_cast<uint32_t>(avatars.size())});
    return true;
  };
  // At random, until nine draws of ten fail for a while.
  uint64_t draw = 0;
  uint32_t failed = 0, drawn = 0;
  while (avatars.size() < count) {
    const StandingDraw::Stand stand = standing.draw(draw++);
    failed += !try_place(stand.level, stand.point);
    if (++drawn < 4096) continue;
    if (failed > drawn * 9 / 10) break;
    failed = drawn = 0;
  }
  // Cell by cell: what is still missing after this does not fit.
  for (uint32_t level = 0; level < records.size() && avatars.size() < count; ++level) {
    for (int32_t z = 0; z < 64 && avatars.size() < count; ++z) {
      uint64_t row = ground.legal(level)[z];
      for (; row != 0 && avatars.size() < count; row &= row - 1) {
        const int64_t x = world::first_cell(records[level].tile_x) + std::countr_zero(row);
        const int64_t cell_z = world::first_cell(records[level].tile_z) + z;
        try_place(level, {(x << world::kUnitBits) + world::kUnitsPerCell / 2,
                          (cell_z << world::kUnitBits) + world::kUnitsPerCell / 2});
      }
    }
  }
  return avatars;
}

}  // namespace throng::crowd
