// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "throng/bake.h"

#include <chrono>
#include <functional>
#include <optional>

#include "bake/world_bake.h"
#include "bake/world_folder.h"
#include "bake/zone_bake.h"
#include "core/parallel.h"
#include "world/zone_data.h"

namespace throng {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

// Where zones go, in order of z, then x, and where some of them come from.
struct ZoneStore {
  // Receives each baked zone; `bytes` are empty where nobody can stand.
  std::function<Result<void>(const format::ZoneEntry&, uint64_t input, flatbuffers::DetachedBuffer)>
      write;
  // A zone that need not be baked, or null: then none is kept.
  std::function<std::optional<WorldFolder::Kept>(int32_t x, int32_t z, uint64_t input)> keep;
  const WorldData* old_world = nullptr;
  WorldFolder* folder = nullptr;  // where air files go; null: they stay in memory
};

Result<std::shared_ptr<WorldData>> bake_zones(const Scene& scene, const BakeConfig& config,
                                              Context& context, BakeReport& report,
                                              const ZoneStore& store) {
  const auto start = Clock::now();
  const auto begun =
      WorldBake::begin(scene, config, store.old_world, static_cast<bool>(store.keep));
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
    if (store.keep) {
      if (const auto kept = store.keep(input.x(), input.z(), input.hash())) {
        facts[i] = bake.facts_of(*kept);
        continue;
      }
    }
    flatbuffers::DetachedBuffer bytes;
    if (!bake.bake(i, scratch, context, facts[i], bytes)) return cancelled;
    const auto write_start = Clock::now();
    if (auto ok = store.write(facts[i].entry, input.hash(), std::move(bytes)); !ok) {
      return ok.error();
    }
    facts[i].seconds_write = seconds_since(write_start);
  }
  auto world = bake.world(facts, report);
  if (!world) return world.error();
  if (auto ok = bake.add_air(store.folder, **world, context, report); !ok) return ok.error();
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
  ZoneStore store;
  store.write = [&](const format::ZoneEntry& entry, uint64_t /*input*/,
                    flatbuffers::DetachedBuffer bytes) -> Result<void> {
    if (entry.levels() == 0) return {};
    auto zone = Zone::from_bytes(std::move(bytes), zone_file_name(entry.x(), entry.z()));
    if (!zone) return zone.error();
    zones.push_back(std::move(*zone));
    return {};
  };
  auto world = bake_zones(scene, config, context, local, store);
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
  ZoneStore store;
  store.old_world = folder->old_world();
  store.folder = &*folder;
  store.keep = [&](int32_t x, int32_t z, uint64_t input) { return folder->keep(x, z, input); };
  store.write = [&](const format::ZoneEntry& entry, uint64_t input,
                    const flatbuffers::DetachedBuffer& bytes) {
    return folder->write(entry, input, {bytes.data(), bytes.size()});
  };
  BakeReport report;
  auto world = bake_zones(scene, config, context, report, store);
  if (!world) return world.error();
  if (auto ok = folder->finish(**world); !ok) return ok.error();
  return report;
}

}  // namespace throng
