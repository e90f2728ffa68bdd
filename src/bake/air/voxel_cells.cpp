// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "core/access.h"
#include "core/hash.h"
#include "throng/bake.h"
#include "world/air_data.h"
#include "world/air_rows.h"
#include "world/zone_data.h"

// Voxels are air cells that are not free: one zone, a tree, and no ground.
namespace throng {
namespace {

constexpr int32_t kMaxSide = 4096;
constexpr double kMaxCells = 4e9;

}  // namespace

Result<World> bake_voxel_cells(const VoxelCells& cells, double cell) {
  const auto sound = [](int32_t side) { return side >= 1 && side <= kMaxSide; };
  if (!sound(cells.width) || !sound(cells.height) || !sound(cells.depth) ||
      static_cast<double>(cells.width) * cells.height * cells.depth > kMaxCells) {
    return Error{Errc::kBadInput,
                 "cells: voxels go up to 4096 along a side, and to 4000 million in all"};
  }
  for (const VoxelCells::Cube& c : cells.filled) {
    if (c.x < 0 || c.y < 0 || c.z < 0 || c.x >= cells.width || c.y >= cells.height ||
        c.z >= cells.depth) {
      return Error{Errc::kBadInput, "cells: a voxel lies outside the map"};
    }
  }
  const double mm = cell * 1000;
  if (!(cell >= 0.02 && cell <= 5) || std::fabs(mm - std::round(mm)) > 1e-6) {
    return Error{Errc::kBadConfig, "cells: the cell must be 0.02 to 5 m, in whole millimetres"};
  }
  auto world = std::make_shared<world::WorldData>();
  WorldSummary& summary = world->summary;
  summary.cell = summary.resolution = cell;
  summary.bounds = {{0, 0, 0}, {cells.width * cell, cells.height * cell, cells.depth * cell}};
  summary.tiles_x = (cells.width + kTileCells - 1) / kTileCells;
  summary.tiles_z = (cells.depth + kTileCells - 1) / kTileCells;
  summary.classes = {
      AvatarClass{.name = "point", .height = 0.1, .radius = 0.01, .step_height = 0, .flies = true}};
  summary.walkable_area = {0};
  world->width = cells.width;
  world->depth = cells.depth;
  world->class_index.push_back(std::make_unique<world::ClassIndex>());
  world->tiles_per_zone = static_cast<uint32_t>(std::max(summary.tiles_x, summary.tiles_z));
  world->zones_x = world->zones_z = 1;
  world->slot_of_zone = {-1};

  auto air = std::make_shared<world::AirData>();
  air->shape = {.multiple = 1,
                .cell = static_cast<int32_t>(std::lround(mm)),
                .origin_y = 0,
                .floor = 0,
                .ceiling = cells.height,
                .flies = 1,
                .points = true};
  air->fit(*world);
  // Whole blocks and words of the map, not of the zone around it: that is square.
  world::AirRows rows((cells.width + 63) & -64, (cells.height + 3) & -4, (cells.depth + 3) & -4,
                      true);
  for (const VoxelCells::Cube& c : cells.filled) rows.fill(c.x, c.x + 1, c.y, c.z, false);
  const world::AirTreeSource source{.rows = &rows,
                                    .x = 0,
                                    .z = 0,
                                    .side = air->zone_side,
                                    .width = cells.width,
                                    .depth = cells.depth,
                                    .base = 0,
                                    .largest = world::AirTree::kMaxSide,
                                    .free_beyond = true};
  world::AirTreeData tree = world::build_air_tree(source);
  auto zone =
      world::AirZone::from_bytes(world::air_zone_bytes(0, 0, 0, tree), world::air_file_name(0, 0));
  if (!zone) return zone.error();
  auto slot = std::make_unique<world::AirData::Slot>();
  const auto bytes = (*zone)->bytes();
  slot->entry = format::AirEntry(0, 0, bytes.size(), hash_bytes(bytes.data(), bytes.size()));
  slot->zone = std::move(*zone);
  air->bytes = bytes.size();
  air->slot_of_zone = {0};
  air->slots.push_back(std::move(slot));
  world->air = std::move(air);
  return Access::create<World>(std::move(world));
}

}  // namespace throng
