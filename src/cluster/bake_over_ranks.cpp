// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <optional>

#include "bake/folder/finish_bake.h"
#include "bake/folder/graph_bake.h"
#include "bake/folder/world_bake.h"
#include "bake/folder/world_folder.h"
#include "cluster/job_assignment.h"
#include "core/stopwatch.h"
#include "throng/bake.h"

// Rank 0 owns the folder: it takes over what need not be baked and hands out the rest, the largest
// zones first. The others write their zones' files and send what the manifest needs of them, which
// rank 0 enters into the journal.
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

// Zones as jobs, and what rank 0 knows of them.
class ZoneJobs {
 public:
  ZoneJobs(const bake::WorldBake& bake, const std::string& path, int32_t workers)
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
                [this](bool knows) { return finished(knows ? so_far() : "finished zones are"); }};
  }
  [[nodiscard]] std::string finished(const std::string& what) const {
    return what + " in " + path_ + ".part, and the next bake of " + path_ + " goes on from there";
  }

  // Of rank 0: the facts of all zones, in their order.
  Result<std::vector<bake::ZoneFacts>> assign(cluster::Ranks& ranks, bake::WorldFolder& folder,
                                              Context& context);

 private:
  [[nodiscard]] std::string so_far() const {
    return std::to_string(done_) + " of " + std::to_string(facts_.size()) + " zones are finished";
  }

  const bake::WorldBake& bake_;
  const std::string& path_;
  int32_t workers_;
  std::optional<bake::ZoneScratch> scratch_;  // made for the first zone
  std::vector<bake::ZoneFacts> facts_;
  size_t done_ = 0;
};

Result<std::vector<bake::ZoneFacts>> ZoneJobs::assign(cluster::Ranks& ranks,
                                                      bake::WorldFolder& folder, Context& context) {
  const auto zones = bake_.zones();
  facts_.resize(zones.size());
  std::vector<uint64_t> open;
  for (size_t i = 0; i < zones.size() && !context.cancel; ++i) {
    if (const auto reused = folder.reuse(zones[i].x(), zones[i].z(), zones[i].hash())) {
      facts_[i] = bake_.facts_of(*reused);
      ++done_;
    } else {
      open.push_back(i);
    }
  }
  std::stable_sort(open.begin(), open.end(), [&](uint64_t a, uint64_t b) {
    return bake_.triangle_count(a) > bake_.triangle_count(b);
  });
  cluster::JobsToAssign to_assign;
  for (const uint64_t zone : open) to_assign.jobs.push_back(cluster::bytes_of(zone));
  to_assign.enter = [&](size_t job, std::span<const uint8_t> result) {
    const auto zone = static_cast<size_t>(open[job]);
    facts_[zone] = cluster::value_of<bake::ZoneFacts>(result);
    ++done_;
    return folder.add(facts_[zone].entry, zones[zone].hash());
  };
  to_assign.on_progress = [&] {
    if (context.on_progress) context.on_progress({"bake", done_, facts_.size()});
  };
  to_assign.on_cancel = [&] { folder.leave(); };
  if (auto ok = cluster::assign_jobs(ranks, jobs(), std::move(to_assign), context); !ok)
    return ok.error();
  return std::move(facts_);
}

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
  std::optional<bake::WorldFolder> folder;
  Result<void> begun;
  if (ranks.rank() == 0) {
    auto opened = bake::WorldFolder::begin(path, config.old_zones);
    if (opened) {
      folder.emplace(*std::move(opened));
      begun = folder->check_part(config);
    } else {
      begun = opened.error();
    }
  }
  if (auto ok = agree_over_ranks(begun); !ok) return ok.error();
  std::shared_ptr<world::WorldData> read;
  if (!folder && config.old_zones == OldZones::kKeep) read = bake::WorldFolder::read_world(path);
  const world::WorldData* old = folder ? folder->old_world() : read.get();
  const auto bake = bake::WorldBake::begin(scene, own, old, true);
  Result<void> planned;
  if (!bake) planned = bake.error();
  if (auto ok = agree_over_ranks(planned); !ok) return ok.error();
  if (auto ok = cluster::same_over_ranks(ranks, bake->input_hash(), "bake", "read another scene");
      !ok) {
    return ok.error();
  }

  BakeReport report;
  ZoneJobs zones(*bake, path, own.workers);
  if (ranks.rank() != 0) {
    if (auto ok = cluster::do_assigned_jobs(ranks, zones.jobs(), context); !ok) return ok.error();
  } else {
    const auto facts = zones.assign(ranks, *folder, context);
    if (!facts) return facts.error();
    const auto world = bake->world(*facts, report);
    if (!world) return world.error();
    // By this rank alone, on its own threads: the others have parted.
    const auto failed = [&](const Error& error, const char* finished) {
      if (error.code != Errc::kCancelled) return error;
      ranks.abandon();
      folder->leave();
      cluster::RankJobs rest = zones.jobs();
      rest.finished = [&](bool) { return zones.finished(finished); };
      return cluster::stopped_error(ranks, rest);
    };
    if (auto ok = bake->add_air(&*folder, **world, context, report); !ok) {
      return failed(ok.error(), "all zones' ground and some of their air are finished");
    }
    const auto graph = bake::bake_graph(*folder, **world, own.workers, context, report);
    if (!graph) {
      return failed(graph.error(), "all zones and some of their regions and links are finished");
    }
    if (auto ok = bake::finish_bake(*folder, **world, **graph, scene, own, context, report); !ok) {
      return failed(ok.error(), "all zones and their graph are finished");
    }
    report.seconds_total = seconds_since(start);
  }
  return report;
}

}  // namespace throng
