// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "throng/graph.h"

#include <chrono>

#include "graph/components.h"
#include "graph/regions.h"
#include "world/ground.h"
#include "world/place.h"

namespace throng {

struct GraphData {
  World world;
  RegionGraph regions;
  std::vector<uint32_t> component_of_part;
  std::vector<std::vector<Component>> components;  // per class
  GraphSummary summary;
};

namespace {

// The middle of the region's key cell.
Place place_in(const WorldData& world, const Region& region) {
  const GroundLevel level = ground_level(world, region.level, 0);
  const auto [tile_x, tile_z] = tile_of(world, *level.zone, *level.view.record);
  const auto middle = [](int32_t tile, uint32_t cell) {
    return ((int64_t{tile} * 64 + cell) << kUnitBits) + kUnitsPerCell / 2;
  };
  return place_at(world, level, {middle(tile_x, region.key % 64), middle(tile_z, region.key / 64)});
}

}  // namespace

Result<Graph> Graph::make(const World& world, const GraphConfig& config, Context& context) {
  if (world.data() == nullptr) return Error{Errc::kBadInput, "graph: the world is empty"};
  if (config.workers < 0) return Error{Errc::kBadConfig, "graph: workers must be 0 or more"};
  const auto start = std::chrono::steady_clock::now();
  const WorldData& data = *world.data();
  if (auto ok = world.check_ground(); !ok) return ok.error();
  auto regions = build_regions(data, config.workers, context);
  if (!regions) return regions.error();
  auto graph = std::make_shared<GraphData>();
  graph->world = world;
  graph->regions = std::move(*regions);
  const size_t classes = data.summary.classes.size();
  const auto found = find_components(graph->regions, classes, graph->component_of_part);
  const double cell_area = data.summary.cell * data.summary.cell;
  for (const ClassComponents& of_class : found) {
    auto& components = graph->components.emplace_back();
    for (size_t i = 0; i < of_class.cells.size(); ++i) {
      components.push_back({static_cast<double>(of_class.cells[i]) * cell_area, of_class.regions[i],
                            place_in(data, graph->regions.regions[of_class.first_region[i]])});
    }
  }
  graph->summary = {
      graph->regions.regions.size(), graph->regions.links.size(), graph->regions.bytes(),
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count()};
  return Graph(std::move(graph));
}

GraphSummary Graph::summary() const {
  THRONG_ASSERT(data_);
  return data_->summary;
}

std::span<const Component> Graph::components(int32_t avatar_class) const {
  THRONG_ASSERT(data_);
  if (avatar_class < 0 || static_cast<size_t>(avatar_class) >= data_->components.size()) return {};
  return data_->components[static_cast<size_t>(avatar_class)];
}

int32_t Graph::component_at(int32_t avatar_class, const Place& place) const {
  THRONG_ASSERT(data_);
  const WorldData& world = *data_->world.data();
  if (components(avatar_class).empty() || !place || place.level1 > world.level_count) return -1;
  const GroundPoint at = to_ground(world, place.position.x, place.position.z);
  if (!in_grid(world, at)) return -1;
  const uint32_t region = region_at(world, data_->regions, place.level1 - 1, avatar_class,
                                    at.cell_x() & 63, at.cell_z() & 63);
  if (region == kNoRegion) return -1;
  return static_cast<int32_t>(data_->component_of_part[data_->regions.part(region, avatar_class)]);
}

}  // namespace throng
