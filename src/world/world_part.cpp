// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "world/world_part.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include "world/tile_grid.h"

// Zones know neither their number nor their neighbours', so a world may lack any of them: what is
// beside a missing one ends there.
namespace throng::world {
namespace {

// Zones along one axis that touch [low, high]: [first, last).
std::pair<int32_t, int32_t> zones_between(double low, double high, double origin, double side,
                                          int32_t count) {
  const auto zone = [&](double at) {
    return static_cast<int32_t>(std::clamp(std::floor((at - origin) / side), -1.0, count * 1.0));
  };
  return {std::max(zone(low), 0), std::min(zone(high) + 1, count)};
}

std::string metres(const Box3d& box) {
  std::array<char, 160> text{};
  std::snprintf(text.data(), text.size(), "x %.1f to %.1f, z %.1f to %.1f", box.min.x, box.max.x,
                box.min.z, box.max.z);
  return text.data();
}

// Leaves the slots of zones in the part, and the grid's numbers of these.
template <class Slots>
void keep_slots(const ZoneRect& part, int32_t zones_x, int32_t outside, Slots& slots,
                std::vector<int32_t>& slot_of_zone) {
  std::erase_if(slots,
                [&](const auto& slot) { return !part.contains(slot->entry.x(), slot->entry.z()); });
  for (size_t place = 0; place < slot_of_zone.size(); ++place) {
    const auto at = static_cast<int32_t>(place);
    slot_of_zone[place] = part.contains(at % zones_x, at / zones_x) ? -1 : outside;
  }
  for (size_t s = 0; s < slots.size(); ++s) {
    const auto& entry = slots[s]->entry;
    slot_of_zone[static_cast<size_t>(entry.z() * zones_x + entry.x())] = static_cast<int32_t>(s);
  }
}

}  // namespace

Result<ZoneRect> zones_in(const Box3d& box, const Vec3d& origin, double side, int32_t zones_x,
                          int32_t zones_z) {
  const auto is_ordered = [](double low, double high) {
    return std::isfinite(low) && std::isfinite(high) && low <= high;
  };
  if (!is_ordered(box.min.x, box.max.x) || !is_ordered(box.min.z, box.max.z)) {
    return Error{Errc::kBadConfig,
                 "part: the box must have a lower and an upper corner, in metres"};
  }
  const auto [x0, x1] = zones_between(box.min.x, box.max.x, origin.x, side, zones_x);
  const auto [z0, z1] = zones_between(box.min.z, box.max.z, origin.z, side, zones_z);
  return ZoneRect{.x0 = x0, .z0 = z0, .x1 = x1, .z1 = z1};
}

Result<void> keep_part(WorldData& world, const Box3d& part) {
  WorldSummary& summary = world.summary;
  const double side = summary.cell * kTileCells * world.tiles_per_zone;
  const auto zones = zones_in(part, summary.origin, side, world.zones_x, world.zones_z);
  if (!zones) return zones.error();
  world.part = *zones;
  keep_slots(*world.part, world.zones_x, -1, world.slots, world.slot_of_zone);
  if (world.slots.empty()) {
    return Error{Errc::kBadConfig, "part: there is no ground in " + metres(part) +
                                       "; the world lies in " + metres(summary.bounds)};
  }
  uint32_t levels = 0;
  summary.bytes = 0;
  for (const auto& slot : world.slots) {
    slot->first_level = levels;
    levels += slot->entry.levels();
    summary.bytes += slot->entry.bytes();
  }
  world.level_count = levels;
  summary.zones = world.slots.size();
  summary.level_tiles = levels;
  return {};
}

void keep_part(AirData& air, const ZoneRect& part) {
  keep_slots(part, air.zones_x, AirData::kNotThere, air.slots, air.slot_of_zone);
  air.bytes = 0;
  for (const auto& slot : air.slots) air.bytes += slot->entry.bytes();
}

}  // namespace throng::world
