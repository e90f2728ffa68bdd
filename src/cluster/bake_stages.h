// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "bake/folder/world_folder.h"
#include "bake/surface/node_scene.h"
#include "cluster/job_assignment.h"
#include "throng/bake.h"
#include "world/air_data.h"
#include "world/region_data.h"

/// What all bakes over ranks have in common: the folder, stages of jobs, and the graph.
namespace throng::cluster {

/// Every rank does jobs until there are none; all fail if one does.
template <class Jobs>
Result<void> do_stage(Ranks& ranks, Jobs& jobs, bake::WorldFolder& folder, Context& context) {
  const Result<void> mine =
      ranks.rank() == 0 ? assign_jobs(ranks, jobs.jobs(), jobs.to_assign(folder, context), context)
                        : do_assigned_jobs(ranks, jobs.jobs(), context);
  if (!mine && context.cancel) return mine;  // No other rank may be left to be met.
  return meet(ranks, mine, context);
}

/// What rank 0 has, for all, if it has it: `mine` is its success.
template <class T>
Result<std::vector<T>> share(Ranks& ranks, const std::vector<T>& values, Context& context,
                             const Result<void>& mine = {}) {
  RankBytes bytes;
  if (ranks.rank() == 0) bytes = bytes_of(values);
  if (auto ok = meet(ranks, mine, context, &bytes); !ok) return ok.error();
  return values_of<T>(bytes);
}

/// One job for each zone, or block of zones, by its number, whatever is reused.
class ZoneStage {
 public:
  ZoneStage(const char* stage, size_t zones, const std::string& path, const char* finished)
      : stage_(stage), zones_(zones), path_(path), finished_(finished) {}
  virtual ~ZoneStage() = default;

  [[nodiscard]] RankJobs jobs() {
    return {.stage = "bake",
            .work = [this](std::span<const uint8_t> job, Context& context) -> Result<RankBytes> {
              return work(static_cast<size_t>(value_of<uint64_t>(job)), context);
            },
            .finished =
                [this](bool knows) {
                  return to_be_continued(knows ? finished_ : "finished zones are", path_ + ".part",
                                         path_);
                }};
  }
  [[nodiscard]] JobsToAssign to_assign(bake::WorldFolder& folder, Context& context) {
    JobsToAssign to_assign;
    for (uint64_t zone = 0; zone < zones_; ++zone) {
      to_assign.jobs.push_back(bytes_of(zone));
    }
    to_assign.enter = [this](size_t job, std::span<const uint8_t> result) -> Result<void> {
      ++done_;
      return enter(job, result);
    };
    to_assign.on_progress = [this, &context] {
      if (context.on_progress) context.on_progress({stage_, done_, zones_});
    };
    to_assign.on_cancel = [&folder] { folder.leave(); };
    return to_assign;
  }

 private:
  virtual Result<RankBytes> work(size_t zone, Context& context) = 0;
  virtual Result<void> enter(size_t zone, std::span<const uint8_t> result) = 0;

  const char* stage_;
  size_t zones_;
  const std::string& path_;
  const char* finished_;
  size_t done_ = 0;
};

/// Fails on all ranks if the plan of a bake failed on one, or is another than rank 0's.
template <class Bake>
Result<void> agree_on_plan(Ranks& ranks, const Result<Bake>& bake) {
  if (auto ok = agree(ranks, bake ? Result<void>() : bake.error()); !ok) return ok;
  return same_over_ranks(ranks, bake->input_hash(), "bake", "read another scene");
}

/// The air of a zone as a message has it.
struct AirOfZone {
  bool is_there = false;  ///< Not: nothing but air.
  format::AirEntry entry;

  static AirOfZone of(const world::AirData::Slot* slot) {
    return slot == nullptr ? AirOfZone() : AirOfZone{true, slot->entry};
  }
  [[nodiscard]] std::unique_ptr<world::AirData::Slot> slot() const {
    if (!is_there) return nullptr;
    auto slot = std::make_unique<world::AirData::Slot>();
    slot->entry = entry;
    return slot;
  }
};

/// Of rank 0 the folder that it begins, of others the same, joined. Fails on all if it fails.
Result<bake::WorldFolder> open_folder(Ranks& ranks, const std::string& path,
                                      const BakeConfig& config);

/// Has the world made by `make_world` by all ranks, which adds to the report, then its graph, and
/// puts all into place. The report is rank 0's. Fails as bake_over_ranks.
Result<BakeReport> bake_in_stages(
    Ranks& ranks, bake::WorldFolder& folder, const bake::NodeScene& scene, const BakeConfig& config,
    Context& context,
    const std::function<Result<std::shared_ptr<world::WorldData>>(BakeReport&)>& make_world);

}  // namespace throng::cluster
