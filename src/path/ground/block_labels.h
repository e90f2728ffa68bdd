// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "path/ground/mesh.h"
#include "path/ground/two_hop.h"

/// Labels of blocks: the hub labels that the points of each need, prepared.
namespace throng::path {

struct HubLabels;

/// For each block of a mesh, by rising hub, the corners over which the shortest path from some
/// point of it to the hub may lead. Source: Du, Shen, Cheema. Ultrafast Euclidean Shortest Path
/// Computation using Hub Labeling. AAAI 2023, [DSC23].
struct BlockLabels {
  std::vector<uint32_t> first;      // per block its first hub, one more at the end; empty: none
  std::vector<uint32_t> hub;        // of each block, rising
  std::vector<uint32_t> entries;    // per hub of a block its first entry, one more at the end
  std::vector<float> length;        // per entry: from the corner to the hub [cells]
  std::vector<uint16_t> candidate;  // the corner: its place in HubLabels' list of the block

  [[nodiscard]] uint64_t bytes() const {
    return (first.size() + hub.size() + entries.size()) * 4 + length.size() * (4 + 2);
  }
};

/// For the middle of each block, labels as if it were a corner: the shortest path to each of its
/// hubs.
struct MiddleLabels {
  using Label = TwoHopLabels::Label;
  std::vector<uint32_t> first;  // per block, one more at the end; empty: there are none
  std::vector<Label> labels;    // by rising hub [cells]
  std::vector<uint32_t>
      tree_place;  // per label: the place in HubLabels' trees of its path's corners

  [[nodiscard]] std::span<const Label> of(uint32_t block) const {
    return {labels.data() + first[block], labels.data() + first[block + 1]};
  }
  [[nodiscard]] uint64_t bytes() const {
    return (first.size() + tree_place.size()) * sizeof(uint32_t) + labels.size() * sizeof(Label);
  }
};

/// The middle of a block.
world::GroundPoint middle_of(const MeshRect& block);

/// An entry is left out if its corner cannot be on a shortest path from any point of the block to
/// the hub, judged by the hub's distance from the middle. Empty if there would be more than
/// `max_entries`.
BlockLabels build_block_labels(const PathMesh& mesh, const HubLabels& labels, int32_t workers,
                               uint64_t max_entries);

/// A label is left out if the path over another hub is as short.
MiddleLabels build_middle_labels(const PathMesh& mesh, const HubLabels& labels, int32_t workers);

}  // namespace throng::path
