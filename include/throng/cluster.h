// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>

#include "throng/bake.h"
#include "throng/base.h"
#include "throng/context.h"
#include "throng/nodes.h"
#include "throng/result.h"
#include "throng/scene.h"

/// Several processes on one bake, on one machine or on many that share a file system: `mpirun -n K`
/// starts them, each calls the same functions in the same order.
namespace throng {

/// This process among those that were started together.
struct RankInfo {
  int32_t rank = 0;  ///< [0, size)
  int32_t size = 1;
};

/// Read from the environment that mpirun (Open MPI, MPICH) sets: nothing is begun, without MPI too.
[[nodiscard]] THRONG_API RankInfo rank_info();

/// Tells all ranks how far each has come. Succeeds if `mine` is a success on every rank. Else it
/// fails with the error of the first rank that failed, and which rank that was, on rank 0; with
/// kCancelled on the others. Fails with kBadConfig if there are several ranks and the library was
/// built without MPI.
[[nodiscard]] THRONG_API Result<void> agree_over_ranks(const Result<void>& mine);

/// The same, for ranks that come to it at very different times: they wait without taking a core
/// from those that work, and no longer than until their context is cancelled.
[[nodiscard]] THRONG_API Result<void> meet_over_ranks(const Result<void>& mine, Context& context);

/// bake_world_to by all ranks: zones are handed out one by one to whoever is free. The world's
/// bytes do not depend on the number of ranks. Every rank has read the same scene; `path` is on a
/// file system that all of them see. config.workers is per rank; 0 shares the cores of a machine
/// among its ranks. The report is whole on rank 0 and empty elsewhere.
///
/// Fails on rank 0 as bake_world_to does, also for what failed on another rank, which it names; on
/// the others with kCancelled. If a rank dies, mpirun ends the others: their contexts are cancelled
/// if a signal handler sees to that, and what was baked stays in PATH.part, which the next bake
/// takes over.
[[nodiscard]] THRONG_API Result<BakeReport> bake_over_ranks(const std::string& path,
                                                            const Scene& scene,
                                                            const BakeConfig& config,
                                                            Context& context);

/// Nodes::make_in_folder by all ranks, of a world that each has opened from the same folder:
/// batches of zones are handed out to whoever is free, so small, of config.working_bytes at most,
/// that each rank gets some. The bytes do not depend on the number of ranks. The summary is whole
/// on rank 0 and empty elsewhere. Fails as bake_over_ranks does; what was made lies in the folder's
/// nodes.part, which the next call takes over.
[[nodiscard]] THRONG_API Result<NodeSummary> nodes_over_ranks(const World& world,
                                                              const Scene& scene,
                                                              const NodeConfig& config,
                                                              Context& context);

}  // namespace throng
