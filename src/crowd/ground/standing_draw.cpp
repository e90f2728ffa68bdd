// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "crowd/ground/standing_draw.h"

#include <algorithm>
#include <bit>
#include <utility>

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

}  // namespace throng::crowd
