// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "graph/zone_regions.h"

#include <utility>

#include "core/parallel.h"
#include "graph/ground_parts.h"
#include "graph/tile_regions.h"
#include "graph/zone_components.h"
#include "world/place.h"
#include "world/tile_grid.h"

// Runs tile_regions over a zone's tiles and over the borders between zones, in parallel; numbers
// regions in order of tiles.
namespace throng::graph {
namespace {

// The tiles of a zone and their regions, numbered through the zone.
struct ZoneTiles {
  int32_t first_x = 0, first_z = 0, side = 0;
  std::vector<TileParts> tiles;
  std::vector<uint32_t> base;  // per tile: its first region in the zone
};

std::vector<format::RegionLink> to_format(const std::vector<RegionLink>& links) {
  std::vector<format::RegionLink> out;
  out.reserve(links.size());
  for (const RegionLink& link : links) out.emplace_back(link.a, link.b, link.classes);
  return out;
}

// Regions in the zone's numbers, with their parts counted; `cells` gets those of each part.
void number_regions(const world::WorldData& world, ZoneTiles& zone, world::RegionTables& tables,
                    std::vector<uint32_t>& first_part, std::vector<uint32_t>& cells) {
  const size_t classes = world.summary.classes.size();
  tables.classes = static_cast<uint32_t>(classes);
  tables.first.assign(1, 0);
  first_part.assign(1, 0);
  for (const TileParts& tile : zone.tiles) {
    const auto base = static_cast<uint32_t>(tables.regions.size());
    zone.base.push_back(base);
    for (uint32_t l = 0; l < tile.levels; ++l) tables.first.push_back(base + tile.first[l + 1]);
    for (const Region& region : tile.regions) {
      tables.regions.emplace_back(0, static_cast<uint16_t>(region.key),
                                  static_cast<uint16_t>(region.classes));
      first_part.push_back(first_part.back() + world::count_ones(region.classes));
    }
  }
  cells.assign(first_part.back(), 0);
  for (size_t t = 0; t < zone.tiles.size(); ++t) {
    const TileParts& tile = zone.tiles[t];
    for (size_t i = 0; i < tile.classes.size(); ++i) {
      const uint32_t below = (uint32_t{1} << i % classes) - 1;
      for (uint32_t p = tile.classes[i].first; p < tile.classes[i].last; ++p) {
        const uint32_t region = zone.base[t] + tile.parts[p].region;
        const uint32_t before = world::count_ones(tables.regions[region].classes() & below);
        cells[first_part[region] + before] = tile.parts[p].cells;
      }
    }
  }
}

}  // namespace

std::optional<world::RegionTables> find_zone_regions(const world::WorldData& world, size_t slot,
                                                     int32_t workers, const Context& context) {
  const format::ZoneEntry& entry = world.slots[slot]->entry;
  ZoneTiles zone;
  zone.side = static_cast<int32_t>(world.tiles_per_zone);
  zone.first_x = entry.x() * zone.side;
  zone.first_z = entry.z() * zone.side;
  zone.tiles.resize(static_cast<size_t>(zone.side) * static_cast<size_t>(zone.side));
  const TileRegions finder(world);
  const auto at = [&](size_t t) {
    return std::pair{static_cast<int32_t>(t) % zone.side, static_cast<int32_t>(t) / zone.side};
  };
  std::vector<TileScratch> scratch(static_cast<size_t>(worker_count(workers)));
  parallel_for_worker(zone.tiles.size(), workers, [&](size_t t, int32_t worker) {
    if (context.cancel) return;
    const auto [x, z] = at(t);
    zone.tiles[t] = finder.linked_parts(zone.first_x + x, zone.first_z + z,
                                        scratch[static_cast<size_t>(worker)]);
  });
  if (context.cancel) return std::nullopt;
  world::RegionTables tables;
  std::vector<uint32_t> first_part, cells;
  number_regions(world, zone, tables, first_part, cells);

  std::vector<std::vector<RegionLink>> found(zone.tiles.size());
  parallel_for_worker(zone.tiles.size(), workers, [&](size_t t, int32_t worker) {
    if (context.cancel) return;
    const int32_t x = at(t).first, z = at(t).second;
    const auto add = [&](const std::vector<RegionLink>& links, size_t to) {
      for (const RegionLink& link : links) {
        found[t].push_back({link.a + zone.base[t], link.b + zone.base[to], link.classes});
      }
    };
    const auto border = [&](TileSide side, size_t to) {
      add(finder.border(zone.first_x + x, zone.first_z + z, side, zone.tiles[t], zone.tiles[to],
                        scratch[static_cast<size_t>(worker)]),
          to);
    };
    add(zone.tiles[t].links, t);
    if (x + 1 < zone.side) border(kEast, t + 1);
    if (z + 1 < zone.side) border(kSouth, t + static_cast<size_t>(zone.side));
  });
  if (context.cancel) return std::nullopt;
  std::vector<RegionLink> links;
  for (const auto& of_tile : found) links.insert(links.end(), of_tile.begin(), of_tile.end());
  merge_links(links);
  tables.links = to_format(links);
  find_components(world, slot, {first_part, cells}, tables);
  return tables;
}

std::vector<format::RegionLink> find_zone_links(const world::WorldData& world,
                                                const ZoneBorder& from, const ZoneBorder& to,
                                                int32_t workers) {
  const format::ZoneEntry& a = world.slots[from.slot]->entry;
  const format::ZoneEntry& b = world.slots[to.slot]->entry;
  const TileSide side = b.x() > a.x() ? kEast : kSouth;
  const auto tiles = static_cast<int32_t>(world.tiles_per_zone);
  const TileRegions finder(world);
  std::vector<std::vector<RegionLink>> found(world.tiles_per_zone);
  std::vector<TileScratch> of_workers(static_cast<size_t>(worker_count(workers)));
  parallel_for_worker(found.size(), workers, [&](size_t i, int32_t worker) {
    TileScratch& scratch = of_workers[static_cast<size_t>(worker)];
    const auto along = static_cast<int32_t>(i);
    const int32_t x = a.x() * tiles + (side == kEast ? tiles - 1 : along);
    const int32_t z = a.z() * tiles + (side == kEast ? along : tiles - 1);
    const TileParts here = finder.parts(x, z, scratch);
    if (here.levels == 0) return;
    const TileParts there =
        side == kEast ? finder.parts(x + 1, z, scratch) : finder.parts(x, z + 1, scratch);
    if (there.levels == 0) return;
    const auto first_region = [&](const ZoneBorder& zone, const TileParts& tile) {
      return zone.regions->level_regions(tile.first_level - world.slots[zone.slot]->first_level)
          .first;
    };
    const uint32_t base_a = first_region(from, here), base_b = first_region(to, there);
    for (const RegionLink& link : finder.border(x, z, side, here, there, scratch)) {
      found[i].push_back({link.a + base_a, link.b + base_b, link.classes});
    }
  });
  std::vector<RegionLink> links;
  for (const auto& of_tile : found) links.insert(links.end(), of_tile.begin(), of_tile.end());
  merge_links(links);
  return to_format(links);
}

uint32_t region_at(const world::WorldData& world, const world::RegionZone& regions, uint32_t level,
                   int32_t avatar_class, int32_t x, int32_t z) {
  const world::GroundLevel ground = world::ground_level(world, level, avatar_class);
  if (ground.zone == nullptr || !ground.is_legal(x, z)) return kNoRegion;
  const auto has_class = [&](uint32_t r) {
    return (regions.regions()[r].classes() >> avatar_class & 1) != 0;
  };
  const auto [first, last] =
      regions.level_regions(level - world.slots[world.slot_of_level(level)]->first_level);
  uint32_t only = kNoRegion, count = 0;
  for (uint32_t r = first; r < last; ++r) {
    if (!has_class(r)) continue;
    only = r;
    ++count;
  }
  if (count <= 1) return only;
  const world::CellRows legal = legal_rows(ground);
  const auto cuts = step_cuts(
      ground, legal, world::step_mm(world.summary.classes[static_cast<size_t>(avatar_class)]));
  const world::CellRows part = flood(legal, cuts ? &*cuts : nullptr, x, z);
  for (uint32_t r = first; r < last; ++r) {
    const uint32_t key = regions.regions()[r].key();
    if (has_class(r) && (part[world::z_of_cell(key)] >> world::x_of_cell(key) & 1) != 0) return r;
  }
  return kNoRegion;
}

}  // namespace throng::graph
