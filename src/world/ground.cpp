// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "world/ground.h"

#include <algorithm>
#include <bit>
#include <utility>

// Ground of one class on a level, the range of a floor's heights, and floors unpacked row by row.
namespace throng::world {
namespace {

// By how much a cell of the block differs from the slopes at most.
int32_t highest_rest(const LevelView& view, const ValueBlock& block) {
  if (block.width < 16) return (1 << block.width) - 1;
  // Of 16 bits nothing follows.
  const uint64_t* words = view.floor + kValueHead + block.first;
  int32_t highest = 0;
  for (uint32_t i = 0; i < 64; ++i) {
    const auto rest = static_cast<int32_t>(rest_at(block, words, i % 8, i / 8));
    if (!block.holes || rest != kNoValue) highest = std::max(highest, rest);
  }
  return highest;
}

}  // namespace

GroundLevel ground_level(const Zone& zone, uint32_t zone_level, uint32_t world_level,
                         int32_t avatar_class) {
  GroundLevel level;
  level.zone = &zone;
  level.world_level = world_level;
  level.view = zone.view(zone_level);
  set_class(level, zone_level, avatar_class);
  return level;
}

void set_class(GroundLevel& level, uint32_t zone_level, int32_t avatar_class) {
  const format::Clearance& clearance =
      level.zone->clearance(zone_level, static_cast<uint32_t>(avatar_class));
  level.kind = clearance.kind();
  level.step_safe = clearance.step_safe() != 0;
  level.legal = nullptr;
  if (level.kind == format::CellsKind::Blocks) level.legal = level.zone->words(clearance.offset());
}

GroundLevel ground_level(const WorldData& world, uint32_t level, int32_t avatar_class) {
  const size_t slot = world.slot_of_level(level);
  const Zone* zone = world.zone(slot);
  if (zone == nullptr) return {};
  return ground_level(*zone, level - world.slots[slot]->first_level, level, avatar_class);
}

FloorRange floor_range(const LevelView& view) {
  FloorRange range{INT32_MAX, INT32_MIN};
  const auto add = [&](int32_t low, int32_t high) {
    range = {std::min(range.low, low), std::max(range.high, high)};
  };
  if (view.floor == nullptr) {  // Planes are highest and lowest at corners.
    for (const auto& [x, z] : {std::pair{0, 0}, {63, 0}, {0, 63}, {63, 63}}) {
      add(view.sample(x, z), view.sample(x, z));
    }
    return range;
  }
  uint64_t used = view.present != nullptr ? view.present[0] | view.present[1] : ~uint64_t{0};
  for (; used != 0; used &= used - 1) {
    const auto b = static_cast<uint32_t>(std::countr_zero(used));
    const ValueBlock block = unpack_head(view.floor[b]);
    const int32_t x = slope_part(block, 7, 0), z = slope_part(block, 0, 7);
    int32_t low = block.base + std::min(x, 0) + std::min(z, 0);
    int32_t high = block.base + std::max(x, 0) + std::max(z, 0) + highest_rest(view, block);
    if (high > UINT16_MAX) {
      // The base may be one below 0, modulo 2^16: any cell shows it, as it is no lower than its
      // base.
      const uint64_t cells = view.present != nullptr ? block_cells(view.present, b) : 1;
      if (cells == 0) continue;  // in forged files
      const auto i = static_cast<uint32_t>(std::countr_zero(cells));
      const uint32_t cx = i % 8, cz = i / 8;
      const int32_t value = value_at(view.floor, static_cast<int32_t>(b % 8 * 8 + cx),
                                     static_cast<int32_t>(b / 8 * 8 + cz));
      if (value < block.base + slope_part(block, cx, cz)) {
        low -= 1 << 16;
        high -= 1 << 16;
      }
    }
    add(view.floor_base + std::max(low, 0), view.floor_base + std::min<int32_t>(high, UINT16_MAX));
  }
  return range;
}

void unpack_floor(const LevelView& view, uint16_t* samples) {
  unpack_values(view.floor, samples);
  if (view.present == nullptr) return;
  CellRows has;
  unpack_bits(view.present, has);
  for (size_t z = 0; z < has.size(); ++z) {
    for (uint64_t none = ~has[z]; none != 0; none &= none - 1) {
      samples[z * 64 + static_cast<size_t>(std::countr_zero(none))] = kNoValue;
    }
  }
}

}  // namespace throng::world
