// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "throng/bake.h"

#include <memory>
#include <vector>

#include "bake/graph_bake.h"
#include "bake/world_bake.h"
#include "bake/world_folder.h"
#include "bake/zone_bake.h"
#include "core/parallel.h"
#include "core/stopwatch.h"
#include "world/zone_data.h"

namespace throng {
namespace {

// Zones go into the folder, which may have some of them already, or, if it is null, in order of z,
// then x, into `in_memory`.
Result<std::shared_ptr<WorldData>> bake_zones(const Scene& scene, const BakeConfig& config,
                                              Context& context, BakeReport& report,
                                              WorldFolder* folder,
                                              std::vector<std::unique_ptr<Zone>>& in_memory) {
  const auto start = Clock::now();
  const WorldData* old_world = folder != nullptr ? folder->old_world() : nullptr;
  const auto begun = WorldBake::begin(scene, config, old_world, folder != nullptr);
  if (!begun) return begun.error();
  const WorldBake& bake = *begun;
  ZoneScratch scratch(worker_count(config.workers));
  std::vector<ZoneFacts> facts(bake.zones().size());
  const Error cancelled{Errc::kCancelled, "bake: cancelled; nothing was written"};
  for (size_t i = 0; i < facts.size(); ++i) {
    const format::ZoneInput& input = bake.zones()[i];
    if (context.on_progress) {
      context.on_progress({"bake", bake.place(i), bake.place_count()});
    }
    if (context.cancel) return cancelled;
    if (folder != nullptr) {
      if (const auto kept = folder->keep(input.x(), input.z(), input.hash())) {
        facts[i] = bake.facts_of(*kept);
        continue;
      }
    }
    flatbuffers::DetachedBuffer bytes;
    if (!bake.bake(i, scratch, context, facts[i], bytes)) return cancelled;
    const auto write_start = Clock::now();
    const format::ZoneEntry& entry = facts[i].entry;
    if (folder != nullptr) {
      if (auto ok = folder->write(entry, input.hash(), {bytes.data(), bytes.size()}); !ok)
        return ok.error();
    } else if (entry.levels() > 0) {
      auto zone = Zone::from_bytes(std::move(bytes), zone_file_name(entry.x(), entry.z()));
      if (!zone) return zone.error();
      in_memory.push_back(std::move(*zone));
    }
    facts[i].seconds_write = seconds_since(write_start);
  }
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
  if (auto ok = check_bake(scene, config); !ok) return ok.error();
  BakeReport local;
  std::vector<std::unique_ptr<Zone>> zones;
  auto world = bake_zones(scene, config, context, local, nullptr, zones);
  if (!world) return world.error();
  for (size_t i = 0; i < zones.size(); ++i) (*world)->slots[i]->zone = std::move(zones[i]);
  if (report != nullptr) *report = local;
  return World(std::move(*world));
}

Result<BakeReport> bake_world_to(const std::string& path, const Scene& scene,
                                 const BakeConfig& config, Context& context) {
  if (auto ok = check_bake(scene, config); !ok) return ok.error();
  auto folder = WorldFolder::begin(path, config.old_zones);
  if (!folder) return folder.error();
  std::vector<std::unique_ptr<Zone>> none;
  BakeReport report;
  const auto start = Clock::now();
  auto world = bake_zones(scene, config, context, report, &*folder, none);
  if (!world) return world.error();
  const auto graph = bake_graph(*folder, **world, config.workers, context, report);
  if (!graph) return graph.error();
  if (auto ok = folder->finish(**world, **graph, config.carry_nodes); !ok) return ok.error();
  report.seconds_total = seconds_since(start);
  return report;
}

}  // namespace throng
