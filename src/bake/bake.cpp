// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "throng/bake.h"

#include <memory>
#include <utility>
#include <vector>

#include "bake/folder/finish_bake.h"
#include "bake/folder/graph_bake.h"
#include "bake/folder/world_bake.h"
#include "bake/folder/world_folder.h"
#include "bake/folder/zone_baker.h"
#include "core/access.h"
#include "core/parallel.h"
#include "core/side_by_side.h"
#include "core/stopwatch.h"
#include "world/zone_data.h"

// bake_world and bake_world_to: bake the zones of a scene, several side by side, then the graph, in
// memory or into a world's folder.
namespace throng {
namespace {

Result<std::shared_ptr<world::WorldData>> bake_zones(
    const Scene& scene, const BakeConfig& config, Context& context, BakeReport& report,
    bake::WorldFolder* folder, std::vector<std::unique_ptr<world::Zone>>& in_memory) {
  const auto start = Clock::now();
  const world::WorldData* old_world = folder != nullptr ? folder->old_world() : nullptr;
  const auto begun = bake::WorldBake::begin(scene, config, old_world, folder != nullptr);
  if (!begun) return begun.error();
  const bake::WorldBake& bake = *begun;
  bake::ZoneBaker zones(bake, config, context, folder);
  if (auto ok = zones.run(); !ok) return ok.error();
  in_memory = zones.take_zones();
  const std::vector<bake::ZoneFacts>& facts = zones.facts();
  auto world = bake.world(facts, report);
  if (!world) return world.error();
  if (auto ok = bake.add_air(folder, **world, context, report); !ok) return ok.error();
  report.seconds_total = seconds_since(start);
  if (context.on_progress) context.on_progress({"bake", bake.place_count(), bake.place_count()});
  return world;
}

}  // namespace

Result<World> bake_world(const Scene& scene, const BakeConfig& config, Context& context,
                         BakeReport* report) {
  if (auto ok = bake::check_bake(scene, config); !ok) return ok.error();
  BakeReport local;
  std::vector<std::unique_ptr<world::Zone>> zones;
  auto world = bake_zones(scene, config, context, local, nullptr, zones);
  if (!world) return world.error();
  for (size_t i = 0; i < zones.size(); ++i) (*world)->slots[i]->zone = std::move(zones[i]);
  if (report != nullptr) *report = local;
  return Access::create<World>(std::move(*world));
}

Result<BakeReport> bake_world_to(const std::string& path, const Scene& scene,
                                 const BakeConfig& config, Context& context) {
  if (auto ok = bake::check_bake(scene, config); !ok) return ok.error();
  auto folder = bake::WorldFolder::begin(path, config.old_zones);
  if (!folder) return folder.error();
  if (auto ok = folder->check_part(config); !ok) return ok.error();
  std::vector<std::unique_ptr<world::Zone>> none;
  BakeReport report;
  const auto start = Clock::now();
  auto world = bake_zones(scene, config, context, report, &*folder, none);
  if (!world) return world.error();
  const auto graph = bake::bake_graph(*folder, **world, config.workers, context, report);
  if (!graph) return graph.error();
  if (auto ok = bake::finish_bake(*folder, **world, **graph, scene, config, context, report); !ok) {
    return ok.error();
  }
  report.seconds_total = seconds_since(start);
  return report;
}

}  // namespace throng
