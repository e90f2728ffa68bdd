// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "path/mesh.h"
#include "path/sight.h"

/// Shortest ways between corners, by look-up.
namespace throng {

/// Two-hop labels: for every two corners that hold together, some hub on a shortest way between
/// them is in both their lists. Source: [AIY13].
struct HubLabels {
  struct Label {
    uint32_t hub = 0;   // rank: 0 is the hub of most ways
    uint32_t next = 0;  // corner after this one on the way to the hub; the corner itself at the hub
    double length = 0;  // to the hub [cells]
  };
  std::vector<uint32_t> first;  // per corner, one more at the end
  std::vector<Label> labels;    // of a corner, by rising hub
  uint64_t edges = 0;           // pairs of corners that see each other and may bend at both

  [[nodiscard]] std::span<const Label> of(uint32_t corner) const {
    return {labels.data() + first[corner], labels.data() + first[corner + 1]};
  }
  [[nodiscard]] uint64_t bytes() const {
    return first.size() * sizeof(uint32_t) + labels.size() * sizeof(Label);
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
  bool find(const PathMesh& mesh, const HubLabels& labels, uint32_t from_rect, CellPoint from,
            uint32_t to_rect, CellPoint to, std::vector<uint32_t>& corners, double& length);

 private:
  struct Reach {
    uint32_t search = 0;  // that set it
    uint32_t corner = 0;  // by which the hub is reached
    double length = 0;
  };
  Sight sight_;
  std::vector<SeenCorner> start_;
  std::vector<Reach> reach_;  // per hub
  uint32_t search_ = 0;
};

}  // namespace throng
