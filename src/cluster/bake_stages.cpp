// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "cluster/bake_stages.h"

#include <algorithm>
#include <array>
#include <optional>

#include "bake/folder/finish_bake.h"
#include "bake/folder/graph_bake.h"
#include "core/stopwatch.h"
#include "graph/graph_passes.h"

// Rank 0 owns the folder. Each stage makes files of zones; what a stage needs of the one before
// rank 0 collects and gives to all. Every file carries what it was made of, so the next bake can
// continue from those that are there.
namespace throng::cluster {
namespace {

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
  Result<RankBytes> work(size_t zone, Context& context) override {
    const auto found = passes_.find_regions(zone, workers_, context);
    if (!found) return found.error();
    return bytes_of(*found);
  }
  Result<void> enter(size_t zone, std::span<const uint8_t> result) override {
    found_[zone] = value_of<graph::RegionsOfZone>(result);
    return {};
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

  Result<RankBytes> work(size_t zone, Context& context) override {
    const auto found = passes_.find_links(zone, workers_, context);
    if (!found) return found.error();
    std::vector<Pair> pairs;
    for (const auto& [a, b] : found->joined) pairs.push_back({a, b});
    const RankBytes own = bytes_of(found->links);
    const RankBytes more = bytes_of(pairs);
    RankBytes bytes(own.size() + more.size());
    std::copy(more.begin(), more.end(), std::copy(own.begin(), own.end(), bytes.begin()));
    return bytes;
  }
  Result<void> enter(size_t /*zone*/, std::span<const uint8_t> result) override {
    graph::GraphPasses::Joined joined;
    for (const Pair& pair : values_of<Pair>(result.subspan(sizeof(graph::LinksOfZone)))) {
      joined.emplace_back(pair[0], pair[1]);
    }
    passes_.enter(value_of<graph::LinksOfZone>(result), joined);
    return {};
  }

  graph::GraphPasses& passes_;
  int32_t workers_;
};

// Of rank 0; null for others.
Result<std::shared_ptr<world::GraphData>> make_graph(Ranks& ranks, bake::WorldFolder& folder,
                                                     world::WorldData& world,
                                                     const BakeConfig& config, Context& context,
                                                     BakeReport& report) {
  const auto start = Clock::now();
  bake::read_zones_in(folder, world);
  bake::GraphFilesInFolder files(folder);
  graph::GraphPasses passes(world, &files);
  const size_t zones = world.slots.size();
  RegionJobs regions(passes, zones, folder.path(), config.workers);
  if (auto ok = do_stage(ranks, regions, folder, context); !ok) return ok.error();
  const auto found = share(ranks, regions.found(), context);
  if (!found) return found.error();
  for (const graph::RegionsOfZone& of_zone : *found) passes.enter(of_zone);
  if (auto ok = passes.end_regions(); !ok) return ok.error();  // On all ranks alike.
  LinkJobs links(passes, zones, folder.path(), config.workers);
  if (auto ok = do_stage(ranks, links, folder, context); !ok) return ok.error();
  if (ranks.rank() != 0) return std::shared_ptr<world::GraphData>();
  auto made = passes.finish();
  bake::report_graph(made, report);
  report.seconds_graph = seconds_since(start);
  return std::move(made.graph);
}

Result<BakeReport> run_stages(
    Ranks& ranks, bake::WorldFolder& folder, const bake::NodeScene& scene, const BakeConfig& config,
    Context& context,
    const std::function<Result<std::shared_ptr<world::WorldData>>(BakeReport&)>& make_world) {
  BakeReport report;
  const auto world = make_world(report);
  if (!world) return world.error();
  const auto graph = make_graph(ranks, folder, **world, config, context, report);
  if (!graph) return graph.error();
  if (ranks.rank() != 0) return BakeReport{};
  auto ok = bake::finish_bake(folder, **world, **graph, scene, config, context, report);
  if (ok) return report;
  if (ok.error().code != Errc::kCancelled) return ok.error();
  ranks.abandon();
  return stopped_error(ranks, {.stage = "bake", .work = {}, .finished = [&](bool) {
                                 return to_be_continued("all zones and their graph are finished",
                                                        folder.path() + ".part", folder.path());
                               }});
}

}  // namespace

Result<bake::WorldFolder> open_folder(Ranks& ranks, const std::string& path,
                                      const BakeConfig& config) {
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
  if (auto ok = agree(ranks, begun); !ok) return ok.error();
  if (!folder) return bake::WorldFolder::join(path, config.old_zones);
  return *std::move(folder);
}

Result<BakeReport> bake_in_stages(
    Ranks& ranks, bake::WorldFolder& folder, const bake::NodeScene& scene, const BakeConfig& config,
    Context& context,
    const std::function<Result<std::shared_ptr<world::WorldData>>(BakeReport&)>& make_world) {
  auto report = run_stages(ranks, folder, scene, config, context, make_world);
  if (!report && context.cancel) folder.leave();
  return report;
}

}  // namespace throng::cluster
