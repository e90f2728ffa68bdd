// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <optional>

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
            return (knows ? std::to_string(baker.zones_done()) + " of " +
                                std::to_string(baker.zones()) + " zones are finished"
                          : std::string("finished zones are")) +
                   " in " + path + "/" + graph::kPartNodeFolder + ", and the next bake of " + path +
                   " goes on from there";
          }};
}

Result<NodeSummary> assign_nodes(cluster::Ranks& ranks, bake::NodeBaker& baker,
                                 const NodeConfig& config, const World& world,
                                 bake::NodeFolder& folder, Context& context) {
  const std::string& path = data_of(world)->path;
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
  const auto nodes = baker.finish();
  if (!nodes) return nodes.error();
  if (auto ok = bake::link_to_air(world, **nodes, config, folder, context); !ok) {
    if (ok.error().code == Errc::kCancelled) folder.leave();
    return ok.error();
  }
  if (auto ok = folder.finish(**nodes); !ok) return ok.error();
  (*nodes)->path = path + "/" + graph::kNodeFolder;
  return Access::create<Nodes>(*nodes).summary();
}

}  // namespace

Result<NodeSummary> nodes_over_ranks(const World& world, const Scene& scene,
                                     const NodeConfig& config, Context& context) {
  if (rank_info().size == 1) {
    const auto nodes = Nodes::create_in_folder(world, scene, config, context);
    if (!nodes) return nodes.error();
    return nodes->summary();
  }
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
  if (ranks.rank() != 0) {
    if (auto ok = cluster::do_assigned_jobs(ranks, jobs_of(baker, path), context); !ok)
      return ok.error();
    return NodeSummary{};
  }
  auto made = assign_nodes(ranks, baker, config, world, *folder, context);
  if (made) made->seconds = seconds_since(start);
  return made;
}

}  // namespace throng
