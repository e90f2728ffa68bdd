// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bake/surface/leaf_link_bake.h"
#include "bake/surface/node_bake.h"
#include "cluster/job_assignment.h"
#include "core/access.h"
#include "core/stopwatch.h"
#include "throng/bake.h"

// Rank 0 reuses what need not be made and assigns batches of zones to the ranks. A rank that has
// made one writes its files and returns what the index needs of them. The bytes of a zone do not
// depend on what it is made together with, so they do not depend on the ranks either.
namespace throng {
namespace {

// Small batches keep all ranks busy to the end, but what lies near each is made for it too: of a
// few sizes the one that is done first, if all ranks are as fast.
std::vector<std::vector<uint32_t>> choose_batches(const bake::NodeBaker& baker,
                                                  const NodeConfig& config, int32_t ranks) {
  std::vector<std::vector<uint32_t>> best;
  uint64_t min_time = UINT64_MAX;
  for (const uint64_t a_rank : {4, 2, 1, 0}) {
    const uint64_t parts = std::max<uint64_t>(a_rank * static_cast<uint64_t>(ranks), 1);
    auto batches = baker.batches(std::min(config.working_bytes, baker.working_bytes() / parts + 1));
    uint64_t sum = 0, most = 0;
    for (const auto& batch : batches) {
      const uint64_t bytes = baker.working_bytes(batch);
      sum += bytes;
      most = std::max(most, bytes);
    }
    const uint64_t at_once = std::min<uint64_t>(static_cast<uint64_t>(ranks), batches.size());
    const uint64_t time = std::max(most, sum / std::max<uint64_t>(at_once, 1));
    if (time >= min_time) continue;
    min_time = time;
    best = std::move(batches);
  }
  return best;
}

std::string part_of(const std::string& path) { return path + "/" + graph::kPartNodeFolder; }

cluster::RankJobs jobs_of(bake::NodeBaker& baker, const std::string& path) {
  return {
      .stage = "nodes",
      .work = [&](std::span<const uint8_t> job, Context& context) -> Result<cluster::RankBytes> {
        const auto zones = cluster::values_of<uint32_t>(job);
        auto slots = baker.make_nodes(zones, false, context);
        if (!slots) return slots.error();
        const auto made = baker.write(zones, *slots);
        if (!made) return made.error();
        return cluster::bytes_of(*made);
      },
      .finished =
          [&](bool knows) {
            return cluster::to_be_continued(knows ? std::to_string(baker.zones_done()) + " of " +
                                                        std::to_string(baker.zones()) +
                                                        " zones are finished"
                                                  : std::string("finished zones are"),
                                            part_of(path), path);
          }};
}

// Of rank 0: all nodes, in the folder.
Result<std::shared_ptr<graph::NodeData>> assign_nodes(cluster::Ranks& ranks, bake::NodeBaker& baker,
                                                      const NodeConfig& config,
                                                      const std::string& path,
                                                      bake::NodeFolder& folder, Context& context) {
  const auto batches = choose_batches(baker, config, ranks.size());
  cluster::JobsToAssign to_assign;
  for (const auto& zones : batches) to_assign.jobs.push_back(cluster::bytes_of(zones));
  to_assign.enter = [&](size_t, std::span<const uint8_t> result) {
    baker.enter(cluster::values_of<bake::NodeBaker::Made>(result));
    return baker.list();
  };
  to_assign.on_progress = [&] {
    if (context.on_progress) context.on_progress({"nodes", baker.zones_done(), baker.zones()});
  };
  to_assign.on_cancel = [&] { folder.leave(); };
  if (auto ok = baker.list(); !ok) return ok.error();
  if (auto ok = cluster::assign_jobs(ranks, jobs_of(baker, path), std::move(to_assign), context);
      !ok) {
    return ok.error();
  }
  auto nodes = baker.finish();
  if (!nodes) return nodes.error();
  if (auto ok = folder.list(**nodes); !ok) return ok.error();
  return nodes;
}

// Rows of zones as jobs, a few for each rank: what lies beside them is elected again.
Result<void> link_to_air(cluster::Ranks& ranks, const World& world, const NodeConfig& config,
                         bake::NodeFolder& folder, Context& context) {
  const std::string& path = data_of(world)->path;
  auto bake = bake::LeafLinkBake::begin(world, config, folder, context);
  Result<void> begun;
  if (!bake) begun = bake.error();
  if (auto ok = cluster::meet(ranks, begun, context); !ok) return ok;
  const cluster::RankJobs jobs{
      .stage = "nodes",
      .work = [&](std::span<const uint8_t> job, Context& own) -> Result<cluster::RankBytes> {
        const auto made = bake->make(cluster::value_of<bake::LeafLinkBake::Rows>(job), own);
        if (!made) return made.error();
        return cluster::bytes_of(*made);
      },
      .finished =
          [&](bool knows) {
            return cluster::to_be_continued(
                knows ? "all nodes and some of their links to the air are finished"
                      : "finished zones are",
                part_of(path), path);
          }};
  if (ranks.rank() != 0) return cluster::do_assigned_jobs(ranks, jobs, context);
  const auto parts = bake->parts(4 * static_cast<size_t>(ranks.size()));
  std::vector<std::vector<format::LeafLinkEntry>> made(parts.size());
  size_t done = 0;
  cluster::JobsToAssign to_assign;
  for (const auto& rows : parts) to_assign.jobs.push_back(cluster::bytes_of(rows));
  to_assign.enter = [&](size_t job, std::span<const uint8_t> result) -> Result<void> {
    made[job] = cluster::values_of<format::LeafLinkEntry>(result);
    ++done;
    return {};
  };
  to_assign.on_progress = [&] {
    if (context.on_progress) context.on_progress({"links to the air", done, parts.size()});
  };
  to_assign.on_cancel = [&] { folder.leave(); };
  if (auto ok = cluster::assign_jobs(ranks, jobs, std::move(to_assign), context); !ok) return ok;
  std::vector<format::LeafLinkEntry> all;
  for (const auto& of_part : made) all.insert(all.end(), of_part.begin(), of_part.end());
  folder.set_links(bake->index(std::move(all)));
  return {};
}

Result<NodeSummary> make_nodes(const World& world, const bake::NodeScene& scene,
                               const NodeConfig& config, Context& context) {
  const auto start = Clock::now();
  auto joined = cluster::Ranks::join();
  if (!joined) return joined.error();
  cluster::Ranks& ranks = **joined;
  if (auto ok = agree_over_ranks(bake::NodeBaker::check(world, scene, config)); !ok)
    return ok.error();
  const std::string& path = data_of(world)->path;
  NodeConfig own = config;
  own.workers = cluster::workers_of_rank(config.workers, ranks);
  Result<void> begun;
  auto folder = ranks.rank() == 0 ? bake::NodeFolder::begin(path)
                                  : Result<bake::NodeFolder>(bake::NodeFolder::join(path));
  if (!folder) begun = folder.error();
  if (auto ok = agree_over_ranks(begun); !ok) return ok.error();
  bake::NodeBaker baker(world, scene, own, &*folder);
  if (auto ok = cluster::agree(ranks, baker.plan(context)); !ok) return ok.error();
  if (auto ok = cluster::same_over_ranks(ranks, baker.input(), "nodes", "opened another world");
      !ok) {
    return ok.error();
  }
  // Rank 0 looks through what is there.
  const Result<void> reused = ranks.rank() == 0 ? baker.reuse_zones() : Result<void>();
  if (auto ok = cluster::meet(ranks, reused, context); !ok) return ok.error();
  const bool is_first = ranks.rank() == 0;
  Result<void> mine;
  std::shared_ptr<graph::NodeData> nodes;  // rank 0's
  if (is_first) {
    auto all = assign_nodes(ranks, baker, own, path, *folder, context);
    if (!all) {
      mine = all.error();
    } else {
      nodes = *std::move(all);
    }
  } else {
    mine = cluster::do_assigned_jobs(ranks, jobs_of(baker, path), context);
  }
  const auto left = [&](const Error& error) {
    if (is_first && context.cancel) folder->leave();
    return error;
  };
  if (!mine && context.cancel) return left(mine.error());
  if (auto ok = cluster::meet(ranks, mine, context); !ok) return left(ok.error());
  if (data_of(world)->air != nullptr) {
    mine = link_to_air(ranks, world, own, *folder, context);
    if (!mine && context.cancel) return left(mine.error());
    if (auto ok = cluster::meet(ranks, mine, context); !ok) return left(ok.error());
  }
  if (!is_first) return NodeSummary{};
  if (auto ok = folder->finish(*nodes); !ok) return ok.error();
  nodes->path = path + "/" + graph::kNodeFolder;
  NodeSummary summary = Access::create<Nodes>(nodes).summary();
  summary.seconds = seconds_since(start);
  return summary;
}

// With one rank: what one process does.
template <class AnyScene>
Result<NodeSummary> nodes_of(const World& world, const AnyScene& scene, const NodeConfig& config,
                             Context& context) {
  if (rank_info().size > 1) return make_nodes(world, scene, config, context);
  const auto nodes = Nodes::create_in_folder(world, scene, config, context);
  if (!nodes) return nodes.error();
  return nodes->summary();
}

}  // namespace

Result<NodeSummary> nodes_over_ranks(const World& world, const Scene& scene,
                                     const NodeConfig& config, Context& context) {
  return nodes_of(world, scene, config, context);
}

Result<NodeSummary> nodes_over_ranks(const World& world, const SceneRegions& scene,
                                     const NodeConfig& config, Context& context) {
  return nodes_of(world, scene, config, context);
}

}  // namespace throng
