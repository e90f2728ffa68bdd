// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "crowd/placement.h"

#include <algorithm>
#include <bit>

#include "crowd/ground/standing_draw.h"
#include "world/tile_grid.h"

// Where wanderers begin: random points of the ground as long as these fit, then what is left of it,
// cell by cell. Time: about ten draws for each avatar at most, then linear in the cells.
namespace throng::crowd {

std::vector<Avatar> place_avatars(const CrowdGround& ground, int32_t body_height, uint32_t count,
                                  uint64_t seed, CollisionMap& map) {
  const auto& records = ground.records();
  const StandingDraw standing(ground, seed);
  std::vector<Avatar> avatars;
  if (standing.is_empty()) return avatars;
  avatars.reserve(std::min<uint64_t>(count, standing.cells()));  // A count can be any.
  const auto try_place = [&](uint32_t level, world::GroundPoint p) {
    const int32_t y = ground.feet(level, p);
    const CollisionMap::Mark mark = map.mark(p, y, body_height);
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
