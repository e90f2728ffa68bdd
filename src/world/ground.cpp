// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "world/ground.h"

#include <bit>

namespace throng {

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

}  // namespace throng
