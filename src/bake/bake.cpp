// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "throng/bake.h"

#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "bake/folder/finish_bake.h"
#include "bake/folder/graph_bake.h"
#include "bake/folder/world_bake.h"
#include "bake/folder/world_folder.h"
#include "bake/folder/zone_bake.h"
#include "core/access.h"
#include "core/parallel.h"
#include "core/side_by_side.h"
#include "core/stopwatch.h"
#include "world/zone_data.h"

// bake_world and bake_world_to: bake the zones of a scene, several side by side, then the graph, in
// memory or into a world's folder.
namespace throng {
namespace {

// Bakes zones, several at a time where there are many workers: within one of them more than a few
// wait for each other. They go into the folder, which may have some of them already, or, if it is
// null, into memory.
class ZoneBaker {
 public:
  ZoneBaker(const bake::WorldBake& bake, const BakeConfig& config, Context& context,
            bake::WorldFolder* folder)
      : bake_(bake),
        context_(context),
        folder_(folder),
        groups_(assign_workers(bake.zones().size(), config.workers)),
        scratch_(static_cast<size_t>(groups_.groups)),
        facts_(bake.zones().size()),
        zones_(folder == nullptr ? facts_.size() : 0) {}

  Result<void> run() {
    const auto baked = side_by_side(
        facts_.size(), groups_, context_,
        [&](size_t i) {
          if (context_.on_progress) {
            context_.on_progress({"bake", bake_.place(i), bake_.place_count()});
          }
        },
        [&](size_t i, int32_t group) {
          auto& scratch = scratch_[static_cast<size_t>(group)];
          if (!scratch) scratch = std::make_unique<bake::ZoneScratch>(groups_.workers);
          return bake(i, *scratch);
        });
    if (!baked) return baked.error();
    if (context_.cancel) return cancelled();
    return {};
  }

  [[nodiscard]] const std::vector<bake::ZoneFacts>& facts() const { return facts_; }
  // In memory: in order of z, then x.
  [[nodiscard]] std::vector<std::unique_ptr<world::Zone>> take_zones() {
    std::erase(zones_, nullptr);
    return std::move(zones_);
  }

 private:
  static Error cancelled() { return {Errc::kCancelled, "bake: cancelled; nothing was written"}; }

  Result<void> bake(size_t i, bake::ZoneScratch& scratch) {
    const format::ZoneInput& input = bake_.zones()[i];
    if (folder_ != nullptr) {
      if (const auto reused = folder_->reuse(input.x(), input.z(), input.hash())) {
        facts_[i] = bake_.facts_of(*reused);
        return {};
      }
    }
    flatbuffers::DetachedBuffer bytes;
    if (!bake_.bake(i, scratch, context_, facts_[i], bytes)) return cancelled();
    const auto start = Clock::now();
    if (auto ok = put(i, std::move(bytes)); !ok) return ok;
    facts_[i].seconds_write = seconds_since(start);
    return {};
  }

  Result<void> put(size_t i, flatbuffers::DetachedBuffer bytes) {
    const format::ZoneEntry& entry = facts_[i].entry;
    if (folder_ != nullptr) {
      if (auto ok =
              bake::WorldFolder::write_zone(folder_->path(), entry, {bytes.data(), bytes.size()});
          !ok) {
        return ok;
      }
      const std::lock_guard lock(mutex_);
      return folder_->add(entry, bake_.zones()[i].hash());
    }
    if (entry.levels() == 0) return {};
    auto zone =
        world::Zone::from_bytes(std::move(bytes), world::zone_file_name(entry.x(), entry.z()));
    if (!zone) return zone.error();
    zones_[i] = std::move(*zone);
    return {};
  }

  const bake::WorldBake& bake_;
  Context& context_;
  bake::WorldFolder* folder_;
  WorkerGroups groups_;
  std::vector<std::unique_ptr<bake::ZoneScratch>> scratch_;  // by group
  std::vector<bake::ZoneFacts> facts_;
  std::vector<std::unique_ptr<world::Zone>> zones_;
  std::mutex mutex_;  // of the folder's journal
};

Result<std::shared_ptr<world::WorldData>> bake_zones(
    const Scene& scene, const BakeConfig& config, Context& context, BakeReport& report,
    bake::WorldFolder* folder, std::vector<std::unique_ptr<world::Zone>>& in_memory) {
  const auto start = Clock::now();
  const world::WorldData* old_world = folder != nullptr ? folder->old_world() : nullptr;
  const auto begun = bake::WorldBake::begin(scene, config, old_world, folder != nullptr);
  if (!begun) return begun.error();
  const bake::WorldBake& bake = *begun;
  ZoneBaker zones(bake, config, context, folder);
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
