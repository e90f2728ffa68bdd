// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include "bake/folder/block_bake.h"
#include "cluster/bake_stages.h"
#include "core/stopwatch.h"
#include "throng/bake.h"

// A bake of a scene that no rank holds as a whole: ground and air of a block of zones are a job.
namespace throng {
namespace {

// As the bytes of a message.
struct Counts {
  uint64_t zones = 0, air = 0, air_reused = 0;
  double seconds_air = 0;
};

template <class T>
void add_bytes(const std::vector<T>& values, cluster::RankBytes& to) {
  const size_t before = to.size(), size = values.size() * sizeof(T);
  to.resize(before + size);
  if (size > 0) std::memcpy(to.data() + before, values.data(), size);
}

// The values at the beginning of `bytes`, which begin behind them then.
template <class T>
std::vector<T> take_values(size_t count, std::span<const uint8_t>& bytes) {
  auto values = cluster::values_of<T>(bytes.first(count * sizeof(T)));
  bytes = bytes.subspan(count * sizeof(T));
  return values;
}

cluster::RankBytes packed(const bake::BlockMade& made) {
  std::vector<cluster::AirOfZone> air;
  for (const auto& slot : made.air) air.push_back(cluster::AirOfZone::of(slot.get()));
  cluster::RankBytes bytes = cluster::bytes_of(Counts{.zones = made.inputs.size(),
                                                      .air = air.size(),
                                                      .air_reused = made.air_reused,
                                                      .seconds_air = made.seconds_air});
  add_bytes(made.inputs, bytes);
  add_bytes(made.facts, bytes);
  add_bytes(air, bytes);
  return bytes;
}

bake::BlockMade unpacked(std::span<const uint8_t> bytes) {
  const auto counts = cluster::value_of<Counts>(bytes);
  bytes = bytes.subspan(sizeof counts);
  bake::BlockMade made;
  made.inputs = take_values<format::ZoneInput>(counts.zones, bytes);
  made.facts = take_values<bake::ZoneFacts>(counts.zones, bytes);
  for (const auto& of_zone : take_values<cluster::AirOfZone>(counts.air, bytes)) {
    made.air.push_back(of_zone.slot());
  }
  made.air_reused = counts.air_reused;
  made.seconds_air = counts.seconds_air;
  return made;
}

class BlockJobs : public cluster::ZoneStage {
 public:
  // `own` is joined: what is baked counts once rank 0 has entered it into `folder`.
  BlockJobs(bake::BlockBake& bake, bake::WorldFolder& own, bake::WorldFolder& folder)
      : ZoneStage("bake", bake.blocks().size(), folder.path(),
                  "the zones of some blocks are finished"),
        bake_(bake),
        own_(own),
        folder_(folder) {}

 private:
  Result<cluster::RankBytes> work(size_t block, Context& context) override {
    const auto made = bake_.bake(bake_.blocks()[block], own_, context);
    if (!made) return made.error();
    return packed(*made);
  }
  Result<void> enter(size_t /*block*/, std::span<const uint8_t> result) override {
    bake::BlockMade made = unpacked(result);
    for (size_t i = 0; i < made.facts.size(); ++i) {
      if (made.facts[i].reused) continue;
      if (auto ok = folder_.add(made.facts[i].entry, made.inputs[i].hash()); !ok) return ok;
    }
    bake_.enter(std::move(made));
    return {};
  }

  bake::BlockBake& bake_;
  bake::WorldFolder& own_;
  bake::WorldFolder& folder_;
};

}  // namespace

Result<BakeReport> bake_over_ranks(const std::string& path, const SceneRegions& scene,
                                   const BakeConfig& config, Context& context) {
  if (rank_info().size == 1) return bake_world_to(path, scene, config, context);
  const auto start = Clock::now();
  auto joined = cluster::Ranks::join();
  if (!joined) return joined.error();
  cluster::Ranks& ranks = **joined;
  BakeConfig own = config;
  own.workers = cluster::workers_of_rank(config.workers, ranks);
  if (auto ok = agree_over_ranks(bake::BlockBake::check(scene, own)); !ok) return ok.error();
  auto folder = cluster::open_folder(ranks, path, own);
  if (!folder) return folder.error();
  bake::WorldFolder files = bake::WorldFolder::join(path, own.old_zones);
  auto blocks = bake::BlockBake::begin(scene, own, files.old_world());
  if (auto ok = cluster::agree_on_plan(ranks, blocks); !ok) return ok.error();
  const auto make_world = [&](BakeReport& out) -> Result<std::shared_ptr<world::WorldData>> {
    BlockJobs jobs(*blocks, files, *folder);
    if (auto ok = cluster::do_stage(ranks, jobs, *folder, context); !ok) return ok.error();
    bake::BlockBake::Whole whole;
    Result<void> finished;
    if (ranks.rank() == 0) {
      auto found = blocks->finish();
      if (found) {
        whole = *std::move(found);
      } else {
        finished = found.error();
      }
    }
    auto inputs = cluster::share(ranks, whole.inputs, context, finished);
    if (!inputs) return inputs.error();
    auto facts = cluster::share(ranks, whole.facts, context);
    if (!facts) return facts.error();
    auto world = blocks->world({*std::move(inputs), *std::move(facts)}, out);
    if (world && ranks.rank() == 0) blocks->set_air(**world, out);
    return world;
  };
  auto report = cluster::bake_in_stages(ranks, *folder, scene, own, context, make_world);
  if (report && ranks.rank() == 0) report->seconds_total = seconds_since(start);
  return report;
}

}  // namespace throng
