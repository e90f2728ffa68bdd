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

/// Bakes by several processes, on one machine or on several that share a file system. `mpirun -n K`
/// starts them; each calls the same functions in the same order.
namespace throng {

/// The rank of this process among those that were started together.
struct RankInfo {
  int32_t rank = 0;  ///< [0, size)
  int32_t size = 1;
};

/// Reads the rank from the environment that mpirun (Open MPI, MPICH) sets. Does not initialise MPI,
/// and works without it.
[[nodiscard]] THRONG_API RankInfo rank_info();

/// Exchanges success or failure between all ranks. Succeeds if `mine` is a success on every rank.
/// Otherwise it fails on rank 0 with the error and the number of the first rank that failed, and
/// with kCancelled on the others. Fails with kBadConfig if there are several ranks and the library
/// was built without MPI.
[[nodiscard]] THRONG_API Result<void> agree_over_ranks(const Result<void>& mine);

/// The same for ranks that arrive at very different times: they wait without using a core, and only
/// until their context is cancelled.
[[nodiscard]] THRONG_API Result<void> meet_over_ranks(const Result<void>& mine, Context& context);

/// bake_world_to by all ranks: each idle rank gets the next zone. The world's bytes do not depend
/// on the number of ranks. Every rank has read the same scene; `path` is on a file system that all
/// ranks see. config.workers is per rank; 0 shares the cores of a machine among its ranks. The
/// report is complete on rank 0 and empty elsewhere.
///
/// Fails on rank 0 as bake_world_to does, and with the error and name of another rank that failed;
/// on the others with kCancelled. If a rank dies, mpirun ends the others: their contexts are
/// cancelled if a signal handler does so, and the baked zones stay in PATH.part, which the next
/// bake reuses.
[[nodiscard]] THRONG_API Result<BakeReport> bake_over_ranks(const std::string& path,
                                                            const Scene& scene,
                                                            const BakeConfig& config,
                                                            Context& context);

/// Nodes::make_in_folder by all ranks, of a world that each has opened from the same folder. Each
/// idle rank gets the next batch of zones; a batch takes config.working_bytes at most, and is small
/// enough that each rank gets some. The bytes do not depend on the number of ranks. The summary is
/// complete on rank 0 and empty elsewhere. Fails as bake_over_ranks does; what was made stays in
/// the folder's nodes.part, which the next call reuses.
[[nodiscard]] THRONG_API Result<NodeSummary> nodes_over_ranks(const World& world,
                                                              const Scene& scene,
                                                              const NodeConfig& config,
                                                              Context& context);

}  // namespace throng
