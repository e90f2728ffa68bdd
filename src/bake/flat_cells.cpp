// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "bake/folder/zone_builder.h"
#include "bake/layers/layer_kernels.h"
#include "core/access.h"
#include "core/hash.h"
#include "core/parallel.h"
#include "throng/bake.h"
#include "world/zone_data.h"

// Cells that say themselves where a point may be need no columns and no legality: each tile is one
// level layer whose legal cells are the passable ones. From there on it is a world like any other.
namespace throng {
namespace {

constexpr int32_t kFloor = 0;  // [mm]

bake::BitPlane passable_rows(const FlatCells& cells, int32_t tile_x, int32_t tile_z) {
  bake::BitPlane rows{};
  for (int32_t z = 0; z < std::min(bake::kTileSide, cells.depth - tile_z * bake::kTileSide); ++z) {
    const size_t row = static_cast<size_t>(tile_z * bake::kTileSide + z) * cells.width;
    for (int32_t x = 0; x < std::min(bake::kTileSide, cells.width - tile_x * bake::kTileSide);
         ++x) {
      if (cells.passable[row + static_cast<size_t>(tile_x * bake::kTileSide + x)] != 0) {
        rows[static_cast<size_t>(z)] |= uint64_t{1} << x;
      }
    }
  }
  return rows;
}

uint64_t pack_tile(uint32_t tile, const bake::BitPlane& rows, const bake::SurfaceCodes& codes,
                   bake::TilePack& pack) {
  bake::ClearancePlanes planes;
  planes.legal = rows;
  for (const uint64_t row : rows) planes.cells += std::popcount(row);
  if (planes.cells == 0) return 0;
  bake::Layer layer;
  bake::clear_layer(layer);
  layer.base = kFloor - bake::Layer::kBaseDepth;
  for (size_t c = 0; c < bake::kTileArea; ++c) {
    if ((rows[c / bake::kTileSide] >> (c % bake::kTileSide) & 1) == 0) continue;
    layer.top[c] = layer.feet[c] = static_cast<uint16_t>(bake::Layer::kBaseDepth);
    layer.ceiling[c] = bake::kNone16;
    layer.code[c] = 0;
  }
  bake::summarise(layer);
  const uint8_t step_safe = 1;
  bake::pack_level(tile, layer, bake::fit_plane(layer), {&planes, 1}, {&step_safe, 1}, codes, pack);
  return static_cast<uint64_t>(planes.cells);
}

}  // namespace

Result<World> bake_flat_cells(const FlatCells& cells, double cell, int32_t workers) {
  const auto area = static_cast<size_t>(cells.width) * static_cast<size_t>(cells.depth);
  if (cells.width < 1 || cells.depth < 1 || cells.width > 16000 || cells.depth > 16000 ||
      cells.passable.size() != area) {
    return Error{Errc::kBadInput,
                 "cells: a map has 1 to 16000 cells along a side, and a value each"};
  }
  if (!(cell >= 0.02 && cell <= 5)) {
    return Error{Errc::kBadConfig, "cells: the cell must be 0.02 to 5 m"};
  }
  if (workers < 0) return Error{Errc::kBadConfig, "cells: workers must be 0 (all cores) or more"};

  auto world = std::make_shared<world::WorldData>();
  WorldSummary& summary = world->summary;
  summary.cell = summary.resolution = cell;
  summary.bounds = {{0, 0, 0}, {cells.width * cell, 0, cells.depth * cell}};
  summary.tiles_x = (cells.width + bake::kTileSide - 1) / bake::kTileSide;
  summary.tiles_z = (cells.depth + bake::kTileSide - 1) / bake::kTileSide;
  summary.classes = {AvatarClass{.name = "point", .height = 0.1, .radius = 0.01, .step_height = 0}};
  world->width = cells.width;
  world->depth = cells.depth;
  world->class_index.push_back(std::make_unique<world::ClassIndex>());
  const int32_t side = std::clamp(std::max(summary.tiles_x, summary.tiles_z), 1, 255);
  world->tiles_per_zone = static_cast<uint32_t>(side);
  world->zones_x = (summary.tiles_x + side - 1) / side;
  world->zones_z = (summary.tiles_z + side - 1) / side;

  const bake::SurfaceCodes codes{.codes = {{.slope_bin = 0, .area = kAreaWalkable}},
                                 .allowed = {1}};
  uint64_t legal = 0;
  for (int32_t z = 0; z < world->zones_z; ++z) {
    for (int32_t x = 0; x < world->zones_x; ++x) {
      std::vector<bake::TilePack> packs(static_cast<size_t>(side) * static_cast<size_t>(side));
      std::vector<uint64_t> legal_of(packs.size(), 0);
      parallel_for(packs.size(), workers, [&](size_t t) {
        const auto tile = static_cast<int32_t>(t);
        const bake::BitPlane rows =
            passable_rows(cells, x * side + tile % side, z * side + tile / side);
        legal_of[t] = pack_tile(static_cast<uint32_t>(t), rows, codes, packs[t]);
      });
      uint32_t levels = 0, tiles = 0;
      for (const bake::TilePack& pack : packs) {
        levels += static_cast<uint32_t>(pack.levels.size());
        tiles += pack.levels.empty() ? 0 : 1;
      }
      for (const uint64_t count : legal_of) legal += count;
      world->slot_of_zone.push_back(levels == 0 ? -1 : static_cast<int32_t>(world->slots.size()));
      if (levels == 0) continue;
      auto bytes = bake::zone_bytes(
          {.x = x, .z = z, .tiles_per_side = static_cast<uint32_t>(side), .class_count = 1}, packs,
          workers);
      auto slot = std::make_unique<world::WorldData::Slot>();
      slot->entry = format::ZoneEntry(x, z, levels, tiles, bytes.size(),
                                      hash_bytes(bytes.data(), bytes.size()));
      slot->first_level = world->level_count;
      summary.bytes += bytes.size();
      auto zone = world::Zone::from_bytes(std::move(bytes), world::zone_file_name(x, z));
      if (!zone) return zone.error();
      slot->zone = std::move(*zone);
      world->level_count += levels;
      world->slots.push_back(std::move(slot));
    }
  }
  summary.zones = world->slots.size();
  summary.level_tiles = world->level_count;
  summary.walkable_area = {static_cast<double>(legal) * cell * cell};
  return Access::create<World>(std::move(world));
}

}  // namespace throng
