// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bake/folder/finish_bake.h"
#include "bake/folder/graph_bake.h"
#include "bake/folder/world_bake.h"
#include "bake/folder/world_folder.h"
#include "cluster/job_assignment.h"
#include "core/stopwatch.h"
#include "graph/graph_passes.h"
#include "throng/bake.h"

// Rank 0 owns the folder. Ground, air, regions and links are made one after the other, each zone as
// a job: a rank writes the zone's file and sends what the world needs of it, which rank 0 collects
// and, where the next stage reads it, gives to all. Every file carries what it was made of, so the
// next bake can continue from those that are there.
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

// What the stages after the ground have in common: one job for each zone, by its number, whatever
// is reused, and files that no journal names.
class ZoneStage {
 public:
  ZoneStage(const char* stage, size_t zones, const std::string& path, const char* finished)
      : stage_(stage), zones_(zones), path_(path), finished_(finished) {}
  virtual ~ZoneStage() = default;

  [[nodiscard]] cluster::RankJobs jobs() {
    return {.stage = "bake",
            .work = [this](std::span<const uint8_t> job,
                           Context& context) -> Result<cluster::RankBytes> {
              return work(static_cast<size_t>(cluster::value_of<uint64_t>(job)), context);
            },
            .finished =
                [this](bool knows) {
                  return cluster::to_be_continued(knows ? finished_ : "finished zones are",
                                                  path_ + ".part", path_);
                }};
  }
  [[nodiscard]] cluster::JobsToAssign to_assign(bake::WorldFolder& folder, Context& context) {
    cluster::JobsToAssign to_assign;
    for (uint64_t zone = 0; zone < zones_; ++zone) {
      to_assign.jobs.push_back(cluster::bytes_of(zone));
    }
    to_assign.enter = [this](size_t job, std::span<const uint8_t> result) -> Result<void> {
      ++done_;
      enter(job, result);
      return {};
    };
    to_assign.on_progress = [this, &context] {
      if (context.on_progress) context.on_progress({stage_, done_, zones_});
    };
    to_assign.on_cancel = [&folder] { folder.leave(); };
    return to_assign;
  }

 private:
  virtual Result<cluster::RankBytes> work(size_t zone, Context& context) = 0;
  virtual void enter(size_t zone, std::span<const uint8_t> result) = 0;

  const char* stage_;
  size_t zones_;
  const std::string& path_;
  const char* finished_;
  size_t done_ = 0;
};

class AirJobs : public ZoneStage {
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
    bool is_there = false;  // not: nothing but air
    bool is_reused = false;
    format::AirEntry entry;
  };

  Result<cluster::RankBytes> work(size_t zone, Context& context) override {
    const uint64_t before = baker_.reused();
    const auto slot = bake_.bake_air(zone, baker_, context);
    if (!slot) return slot.error();
    Air air{.is_there = *slot != nullptr, .is_reused = baker_.reused() > before, .entry = {}};
    if (air.is_there) air.entry = (*slot)->entry;
    return cluster::bytes_of(air);
  }
  void enter(size_t zone, std::span<const uint8_t> result) override {
    const auto air = cluster::value_of<Air>(result);
    reused_ += air.is_reused ? 1 : 0;
    if (!air.is_there) return;
    slots_[zone] = std::make_unique<world::AirData::Slot>();
    slots_[zone]->entry = air.entry;
  }

  const bake::WorldBake& bake_;
  bake::AirBaker baker_;
  bake::AirSlots slots_;
  uint64_t reused_ = 0;
};

constexpr const char* kSomeOfGraph = "all zones and some of their regions and links are finished";

class RegionJobs : public ZoneStage {
 public:
  RegionJobs(graph::GraphPasses& passes, size_t zones, const std::string& path, int32_t workers)
      : ZoneStage("regions", zones, path, kSomeOfGraph),
        passes_(passes),
        workers_(workers),
        found_(zones) {}

  // Of all zones: rank 0's are given to the others.
  [[nodiscard]] const std::vector<graph::RegionsOfZone>& found() const { return found_; }

 private:
  Result<cluster::RankBytes> work(size_t zone, Context& context) override {
    const auto found = passes_.find_regions(zone, workers_, context);
    if (!found) return found.error();
    return cluster::bytes_of(*found);
  }
  void enter(size_t zone, std::span<const uint8_t> result) override {
    found_[zone] = cluster::value_of<graph::RegionsOfZone>(result);
  }

  graph::GraphPasses& passes_;
  int32_t workers_;
  std::vector<graph::RegionsOfZone> found_;
};

class LinkJobs : public ZoneStage {
 public:
  LinkJobs(graph::GraphPasses& passes, size_t zones, const std::string& path, int32_t workers)
      : ZoneStage("links", zones, path, kSomeOfGraph), passes_(passes), workers_(workers) {}

 private:
  using Pair = std::array<uint32_t, 2>;  // (std::pair is not trivial)

  Result<cluster::RankBytes> work(size_t zone, Context& context) override {
    const auto found = passes_.find_links(zone, workers_, context);
    if (!found) return found.error();
    std::vector<Pair> pairs;
    for (const auto& [a, b] : found->joined) pairs.push_back({a, b});
    const cluster::RankBytes own = cluster::bytes_of(found->links);
    const cluster::RankBytes more = cluster::bytes_of(pairs);
    cluster::RankBytes bytes(own.size() + more.size());
    std::copy(more.begin(), more.end(), std::copy(own.begin(), own.end(), bytes.begin()));
    return bytes;
  }
  void enter(size_t /*zone*/, std::span<const uint8_t> result) override {
    graph::GraphPasses::Joined joined;
    for (const Pair& pair : cluster::values_of<Pair>(result.subspan(sizeof(graph::LinksOfZone)))) {
      joined.emplace_back(pair[0], pair[1]);
    }
    passes_.enter(cluster::value_of<graph::LinksOfZone>(result), joined);
  }

  graph::GraphPasses& passes_;
  int32_t workers_;
};

// Every rank does jobs until there are none; all fail if one does. `shared`: see cluster::meet.
template <class Jobs>
Result<void> do_stage(cluster::Ranks& ranks, Jobs& jobs, bake::WorldFolder& folder,
                      Context& context) {
  const Result<void> mine =
      ranks.rank() == 0
          ? cluster::assign_jobs(ranks, jobs.jobs(), jobs.to_assign(folder, context), context)
          : cluster::do_assigned_jobs(ranks, jobs.jobs(), context);
  if (!mine && context.cancel) return mine;  // No other rank may be left to be met.
  return cluster::meet(ranks, mine, context);
}

// What rank 0 has, for all.
template <class T>
Result<std::vector<T>> share(cluster::Ranks& ranks, const std::vector<T>& values,
                             Context& context) {
  cluster::RankBytes bytes;
  if (ranks.rank() == 0) bytes = cluster::bytes_of(values);
  if (auto ok = cluster::meet(ranks, {}, context, &bytes); !ok) return ok.error();
  return cluster::values_of<T>(bytes);
}

// The stages of a bake, in their order.
class RankBake {
 public:
  RankBake(cluster::Ranks& ranks, const bake::WorldBake& bake, bake::WorldFolder& folder,
           const BakeConfig& config, Context& context)
      : ranks_(ranks), bake_(bake), folder_(folder), config_(config), context_(context) {}

  // The report is rank 0's.
  Result<BakeReport> run(const Scene& scene) {
    auto report = run_stages(scene);
    if (!report && context_.cancel) folder_.leave();
    return report;
  }

 private:
  Result<BakeReport> run_stages(const Scene& scene) {
    if (auto ok = bake_ground(); !ok) return ok.error();
    if (auto ok = bake_air(); !ok) return ok.error();
    const auto graph = make_graph();
    if (!graph) return graph.error();
    if (!is_first()) return BakeReport{};
    auto ok = bake::finish_bake(folder_, *world_, **graph, scene, config_, context_, report_);
    if (ok) return report_;
    if (ok.error().code != Errc::kCancelled) return ok.error();
    ranks_.abandon();
    return cluster::stopped_error(ranks_, {.stage = "bake", .work = {}, .finished = [&](bool) {
                                             return cluster::to_be_continued(
                                                 "all zones and their graph are finished",
                                                 folder_.path() + ".part", folder_.path());
                                           }});
  }

  [[nodiscard]] bool is_first() const { return ranks_.rank() == 0; }

  Result<void> bake_ground() {
    GroundJobs ground(bake_, folder_.path(), config_.workers);
    if (auto ok = do_stage(ranks_, ground, folder_, context_); !ok) return ok;
    ground.let_go();
    const auto facts = share(ranks_, ground.facts(), context_);
    if (!facts) return facts.error();
    auto world = bake_.world(*facts, report_);
    if (!world) return world.error();  // On all ranks alike.
    world_ = *std::move(world);
    return {};
  }

  Result<void> bake_air() {
    if (!bake_.has_air()) return {};
    const auto start = Clock::now();
    AirJobs air(bake_, folder_, config_.workers);
    if (auto ok = do_stage(ranks_, air, folder_, context_); !ok) return ok;
    if (!is_first()) return {};
    bake_.set_air(air.take_slots(), *world_, report_);
    report_.air_zones_reused += air.reused();
    report_.seconds_air += seconds_since(start);
    return {};
  }

  // Of rank 0; null for others.
  Result<std::shared_ptr<world::GraphData>> make_graph() {
    const auto start = Clock::now();
    bake::read_zones_in(folder_, *world_);
    bake::GraphFilesInFolder files(folder_);
    graph::GraphPasses passes(*world_, &files);
    const size_t zones = world_->slots.size();
    RegionJobs regions(passes, zones, folder_.path(), config_.workers);
    if (auto ok = do_stage(ranks_, regions, folder_, context_); !ok) return ok.error();
    const auto found = share(ranks_, regions.found(), context_);
    if (!found) return found.error();
    for (const graph::RegionsOfZone& of_zone : *found) passes.enter(of_zone);
    if (auto ok = passes.end_regions(); !ok) return ok.error();  // On all ranks alike.
    LinkJobs links(passes, zones, folder_.path(), config_.workers);
    if (auto ok = do_stage(ranks_, links, folder_, context_); !ok) return ok.error();
    if (!is_first()) return std::shared_ptr<world::GraphData>();
    auto made = passes.finish();
    bake::report_graph(made, report_);
    report_.seconds_graph = seconds_since(start);
    return std::move(made.graph);
  }

  cluster::Ranks& ranks_;
  const bake::WorldBake& bake_;
  bake::WorldFolder& folder_;
  const BakeConfig& config_;
  Context& context_;
  BakeReport report_;
  std::shared_ptr<world::WorldData> world_;
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
  if (!folder) folder.emplace(bake::WorldFolder::join(path, config.old_zones));
  const auto bake = bake::WorldBake::begin(scene, own, folder->old_world(), true);
  Result<void> planned;
  if (!bake) planned = bake.error();
  if (auto ok = agree_over_ranks(planned); !ok) return ok.error();
  if (auto ok = cluster::same_over_ranks(ranks, bake->input_hash(), "bake", "read another scene");
      !ok) {
    return ok.error();
  }
  auto report = RankBake(ranks, *bake, *folder, own, context).run(scene);
  if (report && ranks.rank() == 0) report->seconds_total = seconds_since(start);
  return report;
}

}  // namespace throng
