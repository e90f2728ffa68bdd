// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "path/block_labels.h"
#include "path/legs.h"
#include "path/mesh.h"
#include "path/sight.h"

/// Shortest ways between corners, by look-up.
namespace throng {

/// Two-hop labels: for every two corners that hold together, some hub on a shortest way between
/// them is in both their lists. Source: [AIY13].
struct HubLabels {
  struct Label {
    uint32_t hub = 0;  // rank: 0 is the hub of most ways
    float length = 0;  // to the hub [cells]
  };
  std::vector<uint32_t> first;  // per corner, one more at the end
  std::vector<Label> labels;    // of a corner, by rising hub
  // The corner after this one on the way, and its label of the same hub; at the hub itself.
  struct Next {
    uint32_t corner = 0, label = 0;
  };
  std::vector<Next> next;  // per label
  // Per block the corners that may be seen from some point of it: a way from there that bends bends
  // first at one of them.
  struct Candidate {
    uint32_t corner : 31;
    uint32_t from_all : 1;  // it is seen from all of the block
  };
  std::vector<uint32_t> first_candidate;  // one more at the end
  std::vector<Candidate> candidates;
  BlockLabels by_block;        // of small worlds
  MiddleLabels by_middle;      // of others
  std::vector<uint32_t> hubs;  // by rank: the corner
  uint64_t edges = 0;          // pairs of corners that see each other and may bend at both

  [[nodiscard]] std::span<const Label> of(uint32_t corner) const {
    return {labels.data() + first[corner], labels.data() + first[corner + 1]};
  }
  [[nodiscard]] uint64_t bytes() const {
    return (first.size() + hubs.size() + first_candidate.size() + candidates.size()) *
               sizeof(uint32_t) +
           labels.size() * (sizeof(Label) + sizeof(Next)) + by_block.bytes() + by_middle.bytes();
  }
};

/// Looks from every corner, then labels them all. Fails with kCancelled. The same for any number of
/// workers.
Result<HubLabels> build_labels(const PathMesh& mesh, int32_t workers, Context& context);

}  // namespace throng
