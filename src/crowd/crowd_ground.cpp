// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "crowd/crowd_ground.h"

namespace throng {
namespace {

constexpr uint64_t kAllLegal = ~uint64_t{0};
constexpr uint64_t kNoneLegal = 0;

}  // namespace

Result<CrowdGround> CrowdGround::make(const WorldData& world, int32_t avatar_class) {
  CrowdGround ground;
  ground.tiles_x_ = world.summary.tiles_x;
  ground.tiles_z_ = world.summary.tiles_z;
  ground.tiles_.resize(static_cast<size_t>(ground.tiles_x_) * static_cast<size_t>(ground.tiles_z_));
  ground.records_.resize(world.level_count);
  const auto per_zone = static_cast<int32_t>(world.tiles_per_zone);
  for (size_t s = 0; s < world.slots.size(); ++s) {
    const Zone* zone = world.zone(s);
    if (zone == nullptr) return Error{Errc::kBadFile, world.slots[s]->error};
    const uint32_t base = world.slots[s]->first_level;
    for (uint32_t i = 0; i < zone->level_count(); ++i) {
      const GroundLevel level = ground_level(*zone, i, base + i, avatar_class);
      Record& record = ground.records_[base + i];
      record.view = level.view;
      record.step_safe = level.step_safe;
      record.legal_cells = zone->clearance(i, static_cast<uint32_t>(avatar_class)).legal_cells();
      record.legal = level.legal;
      if (level.kind != format::BitsKind::Planes) {
        record.legal = level.kind == format::BitsKind::All ? &kAllLegal : &kNoneLegal;
        record.row_mask = 0;
      }
      const int32_t tile = level.view.record->tile();
      record.tile_x = zone->root().x() * per_zone + tile % per_zone;
      record.tile_z = zone->root().z() * per_zone + tile / per_zone;
      if (record.tile_x >= ground.tiles_x_ || record.tile_z >= ground.tiles_z_) {
        return Error{Errc::kBadFile, zone_file_name(zone->root().x(), zone->root().z()) +
                                         ": has levels outside the world; bake the world again"};
      }
      Range& range =
          ground.tiles_[static_cast<size_t>(record.tile_z) * static_cast<size_t>(ground.tiles_x_) +
                        static_cast<size_t>(record.tile_x)];
      if (range.last == 0) range.first = base + i;
      range.last = base + i + 1;
    }
  }
  return ground;
}

}  // namespace throng
