// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "world/ground.h"

#include <algorithm>

namespace throng {

GroundLevel ground_level(const Zone& zone, uint32_t zone_level, uint32_t world_level,
                         int32_t avatar_class) {
  GroundLevel level;
  level.zone = &zone;
  level.world_level = world_level;
  level.view = zone.view(zone_level);
  const format::Clearance& clearance = zone.clearance(zone_level, static_cast<uint32_t>(avatar_class));
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

std::optional<GroundLevel> step_to(const WorldData& world, const GroundLevel& from, int32_t x, int32_t z,
                                   int32_t nx, int32_t nz, int32_t avatar_class, int32_t step_mm) {
  const int32_t lx = nx & 63, lz = nz & 63;
  const bool same_tile = (x >> 6) == (nx >> 6) && (z >> 6) == (nz >> 6);
  if (same_tile && from.step_safe && from.is_legal(lx, lz)) return from;
  const int32_t feet = from.view.sample(x & 63, z & 63);
  const auto rise_to = [&](const GroundLevel& level) {
    return level.is_legal(lx, lz) ? std::abs(level.view.sample(lx, lz) - feet) : INT32_MAX;
  };
  if (same_tile && rise_to(from) <= step_mm) return from;
  std::optional<GroundLevel> best;
  int32_t best_rise = step_mm;
  const auto tile = world.tile_levels(nx >> 6, nz >> 6);
  for (uint32_t i = tile.first; i < tile.last; ++i) {
    const GroundLevel level =
        ground_level(*tile.zone, tile.zone_first + i - tile.first, i, avatar_class);
    const int32_t rise = rise_to(level);
    if (rise > best_rise || (best && rise == best_rise)) continue;
    best_rise = rise;
    best = level;
  }
  return best;
}

bool walk(const WorldData& world, GroundLevel& level, GroundPoint from, GroundPoint to,
          int32_t avatar_class, int32_t step_mm) {
  int32_t x = from.cell_x(), z = from.cell_z();
  const int32_t end_x = to.cell_x(), end_z = to.cell_z();
  const int64_t dx = std::llabs(to.x - from.x), dz = std::llabs(to.z - from.z);
  const int32_t sx = to.x > from.x ? 1 : -1, sz = to.z > from.z ? 1 : -1;
  GroundLevel current = level;
  while (x != end_x || z != end_z) {
    // Distance along each axis to the next line of the grid; the sooner of the two is crossed.
    const int64_t line_x = int64_t{sx > 0 ? x + 1 : x} << kUnitBits;
    const int64_t line_z = int64_t{sz > 0 ? z + 1 : z} << kUnitBits;
    const int64_t ax = std::llabs(line_x - from.x) * dz, az = std::llabs(line_z - from.z) * dx;
    const bool cross_x = x != end_x && (z == end_z || ax <= az);
    const bool cross_z = z != end_z && (x == end_x || az <= ax);
    const int32_t nx = cross_x ? x + sx : x, nz = cross_z ? z + sz : z;
    if (cross_x && cross_z) {
      const auto beside_x = step_to(world, current, x, z, nx, z, avatar_class, step_mm);
      const auto beside_z = step_to(world, current, x, z, x, nz, avatar_class, step_mm);
      if (!beside_x || !beside_z) return false;
      if (!step_to(world, *beside_z, x, nz, nx, nz, avatar_class, step_mm)) return false;
      const auto corner = step_to(world, *beside_x, nx, z, nx, nz, avatar_class, step_mm);
      if (!corner) return false;
      current = *corner;
    } else {
      const auto next = step_to(world, current, x, z, nx, nz, avatar_class, step_mm);
      if (!next) return false;
      current = *next;
    }
    x = nx;
    z = nz;
  }
  level = current;
  return true;
}

}  // namespace throng
