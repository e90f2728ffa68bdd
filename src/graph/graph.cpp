// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <chrono>
#include <cmath>

#include "core/access.h"
#include "core/files/file_map.h"
#include "graph/graph_passes.h"
#include "graph/zone_regions.h"
#include "throng/world.h"
#include "world/place.h"
#include "world/region_data.h"
#include "world/sealed_file.h"
#include "world/tile_grid.h"

// The public queries of a graph: components, and the component of a place.
namespace throng {
namespace {

// Null where the bake has left none, or of a world in part.
Result<std::shared_ptr<world::GraphData>> read_index(const world::WorldData& world) {
  if (world.path.empty() || world.part) return std::shared_ptr<world::GraphData>();
  const std::string name = world.path + "/" + world::kGraphIndexName;
  const auto map = FileMap::open(name);
  if (!map) return std::shared_ptr<world::GraphData>();
  auto graph = world::read_graph_index(map->bytes(), name, world, world.manifest_hash);
  if (!graph) return graph.error();
  if (const auto whole = world::unsealed(map->bytes(), name); !whole) return whole.error();
  (*graph)->path = world.path;
  (*graph)->summary.on_disk = true;
  return graph;
}

Result<std::shared_ptr<world::GraphData>> read_or_make(const World& world, int32_t workers,
                                                       Context& context) {
  auto graph = read_index(*data_of(world));
  if (!graph || *graph != nullptr) return graph;
  if (auto ok = world.check_ground(); !ok) return ok.error();
  auto made = graph::make_graph(*data_of(world), nullptr, workers, context);
  if (!made) return made.error();
  return std::move(made->graph);
}

}  // namespace

Result<Graph> Graph::create(const World& world, const GraphConfig& config, Context& context) {
  if (data_of(world) == nullptr) return Error{Errc::kBadInput, "graph: the world is empty"};
  if (config.workers < 0) return Error{Errc::kBadConfig, "graph: workers must be 0 or more"};
  if (context.cancel) return Error{Errc::kCancelled, "graph: cancelled"};
  const auto start = std::chrono::steady_clock::now();
  auto graph = read_or_make(world, config.workers, context);
  if (!graph) return graph.error();
  (*graph)->world = world;
  (*graph)->summary.seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return Graph(std::move(*graph));
}

GraphSummary Graph::summary() const {
  THRONG_ASSERT(data_);
  return data_->summary;
}

std::span<const Component> Graph::components(int32_t avatar_class) const {
  THRONG_ASSERT(data_);
  if (avatar_class < 0 || static_cast<size_t>(avatar_class) >= data_->by_class.size()) return {};
  return data_->by_class[static_cast<size_t>(avatar_class)];
}

int32_t Graph::component_at(int32_t avatar_class, const Place& place) const {
  THRONG_ASSERT(data_);
  const world::WorldData& world = *data_of(data_->world);
  if (components(avatar_class).empty()) return -1;
  const auto at = world::ground_point(world, place);
  if (!at) return -1;
  const uint32_t level = place.level1 - 1;
  const size_t slot = world.slot_of_level(level);
  const world::RegionZone* zone = data_->zone(world, slot);
  if (zone == nullptr) return -1;
  const uint32_t region =
      graph::region_at(world, *zone, level, avatar_class, world::in_tile(at->cell_x()),
                       world::in_tile(at->cell_z()));
  if (region == graph::kNoRegion) return -1;
  const uint32_t component = zone->component(region, static_cast<uint32_t>(avatar_class));
  return static_cast<int32_t>(
      data_->component_of[data_->slots[slot]->entry.first_component() + component]);
}

Result<void> Graph::check_at(Vec3d position) const {
  THRONG_ASSERT(data_);
  const world::WorldData& world = *data_of(data_->world);
  if (!std::isfinite(position.x + position.z)) return {};
  const world::GroundPoint at = world::to_ground(world, position.x, position.z);
  if (!world::in_grid(world, at)) return {};
  const auto cells = static_cast<int32_t>(world.tiles_per_zone) * kTileCells;
  const int32_t found = world::slot_at(world, at.cell_x() / cells, at.cell_z() / cells);
  if (found < 0) return {};
  const auto slot = static_cast<size_t>(found);
  if (world.zone(slot) == nullptr) return Error{Errc::kBadFile, world.slots[slot]->error};
  if (data_->zone(world, slot) == nullptr) {
    return Error{Errc::kBadFile, data_->slots[slot]->error};
  }
  return {};
}

Result<void> Graph::check_files(const World& world) {
  if (data_of(world) == nullptr) return Error{Errc::kBadInput, "graph: the world is empty"};
  const auto graph = read_index(*data_of(world));
  if (!graph) return graph.error();
  for (size_t slot = 0; *graph != nullptr && slot < (*graph)->slots.size(); ++slot) {
    if (auto ok = (*graph)->check_links(*data_of(world), slot); !ok) return ok.error();
  }
  return {};
}

}  // namespace throng
