// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "crowd/placement.h"

#include <algorithm>
#include <bit>

#include "core/random.h"

namespace throng {
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

std::vector<Avatar> place_avatars(const CrowdGround& ground, uint32_t count, uint64_t seed,
                                  CollisionMap& map) {
  const auto& records = ground.records();
  std::vector<uint64_t> before{0};
  for (const auto& record : records) before.push_back(before.back() + record.legal_cells);
  std::vector<Avatar> avatars;
  if (before.back() == 0) return avatars;
  avatars.reserve(count);
  const auto try_place = [&](uint32_t level, int32_t x, int32_t z, int32_t u, int32_t v) {
    const auto& record = records[level];
    const GroundPoint p{(int64_t{record.tile_x * 64 + x} << kUnitBits) + u,
                        (int64_t{record.tile_z * 64 + z} << kUnitBits) + v};
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
  // At random, until nine draws of ten fail over a while.
  uint64_t draw = 0;
  uint32_t failed = 0, drawn = 0;
  while (avatars.size() < count) {
    const uint64_t pick = random_below(seed, 0x706c6163, draw, before.back());
    const uint64_t within = random_u64(seed, 0x77697468, draw);
    ++draw;
    const auto level = static_cast<uint32_t>(std::upper_bound(before.begin(), before.end(), pick) -
                                             before.begin() - 1);
    const auto [x, z] = nth_legal(ground.legal(level), static_cast<uint32_t>(pick - before[level]));
    failed += !try_place(level, x, z, static_cast<int32_t>(within & (kUnitsPerCell - 1)),
                         static_cast<int32_t>((within >> 32) & (kUnitsPerCell - 1)));
    if (++drawn < 4096) continue;
    if (failed > drawn * 9 / 10) break;
    failed = drawn = 0;
  }
  // Cell by cell: what is still missing after this does not fit.
  for (uint32_t level = 0; level < records.size() && avatars.size() < count; ++level) {
    for (int32_t z = 0; z < 64 && avatars.size() < count; ++z) {
      uint64_t row = ground.legal(level)[z];
      for (; row != 0 && avatars.size() < count; row &= row - 1) {
        try_place(level, std::countr_zero(row), z, kUnitsPerCell / 2, kUnitsPerCell / 2);
      }
    }
  }
  return avatars;
}

}  // namespace throng
