// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bake/folder/world_bake.h"
#include "bake/folder/world_folder.h"
#include "cluster/bake_stages.h"
#include "cluster/job_assignment.h"
#include "core/stopwatch.h"
#include "throng/bake.h"

// A bake of a scene that every rank holds: ground and air, each zone as a job.
namespace throng {
namespace {

Result<bake::ZoneFacts> bake_and_write(const bake::WorldBake& bake, const std::string& path,
                                       size_t zone, bake::ZoneScratch& scratch, Context& context) {
  bake::ZoneFacts facts;
  flatbuffers::DetachedBuffer bytes;
  if (!bake.bake(zone, scratch, context, facts, bytes)) {
    return Error{Errc::kCancelled, "bake: cancelled"};
  }
  const auto start = Clock::now();
  if (auto ok = bake::WorldFolder::write_zone(path, facts.entry, {bytes.data(), bytes.size()});
      !ok) {
    return ok.error();
  }
  facts.seconds_write = seconds_since(start);
  return facts;
}

// Zones' ground as jobs, and what rank 0 knows of it.
class GroundJobs {
 public:
  GroundJobs(const bake::WorldBake& bake, const std::string& path, int32_t workers)
      : bake_(bake), path_(path), workers_(workers) {}

  // Of all ranks.
  [[nodiscard]] cluster::RankJobs jobs() {
    return {.stage = "bake",
            .work = [this](std::span<const uint8_t> job,
                           Context& context) -> Result<cluster::RankBytes> {
              if (!scratch_) scratch_.emplace(workers_);
              const auto facts = bake_and_write(
                  bake_, path_, static_cast<size_t>(cluster::value_of<uint64_t>(job)), *scratch_,
                  context);
              if (!facts) return facts.error();
              return cluster::bytes_of(*facts);
            },
            .finished =
                [this](bool knows) {
                  return cluster::to_be_continued(knows ? std::to_string(done_) + " of " +
                                                              std::to_string(facts_.size()) +
                                                              " zones are finished"
                                                        : std::string("finished zones are"),
                                                  path_ + ".part", path_);
                }};
  }

  // Of rank 0: the largest zones first.
  [[nodiscard]] cluster::JobsToAssign to_assign(bake::WorldFolder& folder, Context& context);
  // By zone.
  [[nodiscard]] std::vector<bake::ZoneFacts>& facts() { return facts_; }
  void let_go() { scratch_.reset(); }

 private:
  const bake::WorldBake& bake_;
  const std::string& path_;
  int32_t workers_;
  std::optional<bake::ZoneScratch> scratch_;  // made for the first zone
  std::vector<bake::ZoneFacts> facts_;
  std::vector<uint64_t> open_;  // zones that are not reused
  size_t done_ = 0;
};

cluster::JobsToAssign GroundJobs::to_assign(bake::WorldFolder& folder, Context& context) {
  const auto zones = bake_.zones();
  facts_.resize(zones.size());
  for (size_t i = 0; i < zones.size() && !context.cancel; ++i) {
    if (const auto reused = folder.reuse(zones[i].x(), zones[i].z(), zones[i].hash())) {
      facts_[i] = bake_.facts_of(*reused);
      ++done_;
    } else {
      open_.push_back(i);
    }
  }
  std::stable_sort(open_.begin(), open_.end(), [&](uint64_t a, uint64_t b) {
    return bake_.triangle_count(a) > bake_.triangle_count(b);
  });
  cluster::JobsToAssign to_assign;
  for (const uint64_t zone : open_) to_assign.jobs.push_back(cluster::bytes_of(zone));
  to_assign.enter = [this, &folder](size_t job, std::span<const uint8_t> result) {
    const auto zone = static_cast<size_t>(open_[job]);
    facts_[zone] = cluster::value_of<bake::ZoneFacts>(result);
    ++done_;
    return folder.add(facts_[zone].entry, bake_.zones()[zone].hash());
  };
  to_assign.on_progress = [this, &context] {
    if (context.on_progress) context.on_progress({"bake", done_, facts_.size()});
  };
  to_assign.on_cancel = [&folder] { folder.leave(); };
  return to_assign;
}

class AirJobs : public cluster::ZoneStage {
 public:
  AirJobs(const bake::WorldBake& bake, const bake::WorldFolder& folder, int32_t workers)
      : ZoneStage("air", bake.zones().size(), folder.path(),
                  "all zones' ground and some of their air are finished"),
        bake_(bake),
        baker_(bake.air_baker(&folder, workers)),
        slots_(bake.zones().size()) {}

  // Of rank 0.
  [[nodiscard]] bake::AirSlots take_slots() { return std::move(slots_); }
  [[nodiscard]] uint64_t reused() const { return reused_; }

 private:
  struct Air {
    cluster::AirOfZone air;
    bool is_reused = false;
  };

  Result<cluster::RankBytes> work(size_t zone, Context& context) override {
    const uint64_t before = baker_.reused();
    const auto slot = bake_.bake_air(zone, baker_, context);
    if (!slot) return slot.error();
    const Air air{cluster::AirOfZone::of(slot->get()), baker_.reused() > before};
    return cluster::bytes_of(air);
  }
  Result<void> enter(size_t zone, std::span<const uint8_t> result) override {
    const auto air = cluster::value_of<Air>(result);
    reused_ += air.is_reused ? 1 : 0;
    slots_[zone] = air.air.slot();
    return {};
  }

  const bake::WorldBake& bake_;
  bake::AirBaker baker_;
  bake::AirSlots slots_;
  uint64_t reused_ = 0;
};

}  // namespace

Result<BakeReport> bake_over_ranks(const std::string& path, const Scene& scene,
                                   const BakeConfig& config, Context& context) {
  if (rank_info().size == 1) return bake_world_to(path, scene, config, context);
  const auto start = Clock::now();
  auto joined = cluster::Ranks::join();
  if (!joined) return joined.error();
  cluster::Ranks& ranks = **joined;
  if (auto ok = agree_over_ranks(bake::check_bake(scene, config)); !ok) return ok.error();

  BakeConfig own = config;
  own.workers = cluster::workers_of_rank(config.workers, ranks);
  // The folder first: what is there decides on the grid.
  auto folder = cluster::open_folder(ranks, path, own);
  if (!folder) return folder.error();
  const auto bake = bake::WorldBake::begin(scene, own, folder->old_world(), true);
  if (auto ok = cluster::agree_on_plan(ranks, bake); !ok) return ok.error();
  const auto make_world = [&](BakeReport& out) -> Result<std::shared_ptr<world::WorldData>> {
    GroundJobs ground(*bake, folder->path(), own.workers);
    if (auto ok = cluster::do_stage(ranks, ground, *folder, context); !ok) return ok.error();
    ground.let_go();
    const auto facts = cluster::share(ranks, ground.facts(), context);
    if (!facts) return facts.error();
    auto world = bake->world(*facts, out);
    if (!world || !bake->has_air()) return world;  // It fails on all ranks alike.
    const auto air_start = Clock::now();
    AirJobs air(*bake, *folder, own.workers);
    if (auto ok = cluster::do_stage(ranks, air, *folder, context); !ok) return ok.error();
    if (ranks.rank() == 0) bake->set_air(air.take_slots(), **world, out);
    out.air_zones_reused += air.reused();
    out.seconds_air += seconds_since(air_start);
    return world;
  };
  auto report = cluster::bake_in_stages(ranks, *folder, scene, own, context, make_world);
  if (report && ranks.rank() == 0) report->seconds_total = seconds_since(start);
  return report;
}

}  // namespace throng
