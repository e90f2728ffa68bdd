// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <vector>

#include "throng/base.h"
#include "world/region_data.h"

/// What the two passes make of zones: regions and links within one, then links into the next ones.
namespace throng::graph {

/// Pass 1: the regions of a zone, their links and the connected components of these. The zone must
/// be usable; no other is read. None if the context was cancelled. The same for any number of
/// workers.
std::optional<world::RegionTables> find_zone_regions(const world::WorldData& world, size_t slot,
                                                     int32_t workers, const Context& context);

/// Pass 2: links over the border between a zone and its neighbour to the east or south, from
/// regions of the first to regions of the second, by a, then b. Both zones must be usable, and
/// `from` and `to` be their regions.
struct ZoneBorder {
  size_t slot = 0;  // of the world
  const world::RegionZone* regions = nullptr;
};
std::vector<format::RegionLink> find_zone_links(const world::WorldData& world,
                                                const ZoneBorder& from, const ZoneBorder& to,
                                                int32_t workers);

/// Region of the zone for a legal cell of a level and a class; kNoRegion if the cell is not legal.
/// Floods the level's part where the class has several regions there.
inline constexpr uint32_t kNoRegion = UINT32_MAX;
uint32_t region_at(const world::WorldData& world, const world::RegionZone& regions, uint32_t level,
                   int32_t avatar_class, int32_t x, int32_t z);

}  // namespace throng::graph
