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
  std::vector<uint32_t> next;  // per label: the corner after this one on the way; at the hub itself
  // Per block the corners that may be seen from some point of it: a way from there that bends bends
  // first at one of them.
  struct Candidate {
    uint32_t corner : 31;
    uint32_t from_all : 1;  // it is seen from all of the block
  };
  std::vector<uint32_t> first_candidate;  // one more at the end
  std::vector<Candidate> candidates;
  BlockLabels by_block;
  std::vector<uint32_t> hubs;  // by rank: the corner
  uint64_t edges = 0;          // pairs of corners that see each other and may bend at both

  [[nodiscard]] std::span<const Label> of(uint32_t corner) const {
    return {labels.data() + first[corner], labels.data() + first[corner + 1]};
  }
  [[nodiscard]] uint64_t bytes() const {
    return (first.size() + hubs.size() + first_candidate.size() + candidates.size()) *
               sizeof(uint32_t) +
           labels.size() * (sizeof(Label) + sizeof(uint32_t)) + by_block.bytes();
  }
};

/// Looks from every corner, then labels them all. Fails with kCancelled. The same for any number of
/// workers.
Result<HubLabels> build_labels(const PathMesh& mesh, int32_t workers, Context& context);

/// The way between two ends by their seen corners. Owns its memory: one per thread.
class LabelSearch {
 public:
  /// As PathSearch::find, without a budget: the length of what it finds is the same but for
  /// rounding.
  bool find(const PathMesh& mesh, const HubLabels& labels, const Stop& from, const Stop& to,
            std::vector<uint32_t>& corners, double& length);

 private:
  struct Reach {
    uint32_t search = 0;  // that set it
    uint32_t corner = 0;  // by which the hub is reached
    float length = 0;
  };
  struct Best {
    float length = 0;
    uint32_t hub = 0, first = 0, last = 0;
  };

  static bool gather(const PathMesh& mesh, const HubLabels& labels, const Stop& end,
                     std::vector<SeenCorner>& seen);
  bool join(const PathMesh& mesh, const HubLabels& labels, Best& best);
  enum class Merge { kFound, kNone, kUnsure };
  Merge merge(const PathMesh& mesh, const HubLabels& labels, const Stop& from, const Stop& to,
              Best& best);
  void trace(const HubLabels& labels, const Best& best, std::vector<uint32_t>& corners) const;

  Sight sight_;
  std::vector<SeenCorner> start_, goal_;
  std::vector<Reach> reach_;      // per hub
  std::vector<float> from_, to_;  // to each candidate of the ends' blocks
  uint32_t search_ = 0;
};

}  // namespace throng
