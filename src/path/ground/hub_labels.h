// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "path/ground/block_labels.h"
#include "path/ground/mesh.h"
#include "path/ground/sight.h"
#include "path/ground/two_hop.h"

/// Shortest paths between corners, by look-up.
namespace throng::path {

/// Labels of corners, and the corners that the blocks of a mesh see.
struct HubLabels : TwoHopLabels {
  // Per block the corners that may be seen from some point of it: a path from there that turns does
  // so first at one of them.
  struct Candidate {
    uint32_t corner : 31;
    uint32_t from_all : 1;  // it is seen from all of the block
  };
  std::vector<uint32_t> first_candidate;  // one more at the end
  std::vector<Candidate> candidates;
  BlockLabels by_block;    // of small worlds
  MiddleLabels by_middle;  // of others

  [[nodiscard]] uint64_t bytes() const {
    return TwoHopLabels::bytes() + (first_candidate.size() + candidates.size()) * sizeof(uint32_t) +
           by_block.bytes() + by_middle.bytes();
  }
};

/// Casts from every corner, then labels them all. Fails with kCancelled. The same for any number of
/// workers.
Result<HubLabels> build_labels(const PathMesh& mesh, int32_t workers, Context& context);

}  // namespace throng::path
