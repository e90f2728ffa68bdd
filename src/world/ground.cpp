// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "world/ground.h"

namespace throng {

GroundLevel ground_level(const Zone& zone, uint32_t zone_level, uint32_t world_level,
                         int32_t avatar_class) {
  GroundLevel level;
  level.zone = &zone;
  level.world_level = world_level;
  level.view = zone.view(zone_level);
  const format::Clearance& clearance =
      zone.clearance(zone_level, static_cast<uint32_t>(avatar_class));
  level.kind = clearance.kind();
  level.step_safe = clearance.step_safe() != 0;
  if (level.kind == format::BitsKind::Planes) level.legal = zone.planes(clearance.offset());
  return level;
}

GroundLevel ground_level(const WorldData& world, uint32_t level, int32_t avatar_class) {
  const size_t slot = world.slot_of_level(level);
  const Zone* zone = world.zone(slot);
  if (zone == nullptr) return {};
  return ground_level(*zone, level - world.slots[slot]->first_level, level, avatar_class);
}

}  // namespace throng
