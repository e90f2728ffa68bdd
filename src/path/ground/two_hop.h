// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "core/arrays/prefetch.h"
#include "throng/base.h"

/// Two-hop labels of any graph: shortest paths by look-up.
namespace throng::path {

/// An undirected graph.
struct PathGraph {
  struct Edge {
    uint32_t to = 0;
    double length = 0;
  };
  std::vector<uint32_t> first;  // per node, one more at the end
  std::vector<Edge> edges;

  [[nodiscard]] size_t count() const { return first.size() - 1; }
  [[nodiscard]] std::span<const Edge> of(uint32_t node) const {
    return {edges.data() + first[node], edges.data() + first[node + 1]};
  }
};

/// For every two nodes that are connected, some hub on a shortest path between them is in both
/// their lists. Source: [AIY13].
struct TwoHopLabels {
  struct Label {
    uint32_t hub = 0;  // rank: 0 is the hub of most paths
    float length = 0;  // to the hub
  };
  // The paths of all nodes to one hub are a tree, and its nodes lie here in runs of a path each,
  // the longest branches first: what is walked lies together. After a node comes the next on its
  // path; where a run ends, a word with the place at which the path continues, and after the hub,
  // kEnd.
  static constexpr uint32_t kGoesOn = uint32_t{1} << 31;  // with a place
  static constexpr uint32_t kEnd = UINT32_MAX;
  std::vector<uint32_t> first;       // per node, one more at the end
  std::vector<Label> labels;         // of a node, by rising hub
  std::vector<uint32_t> tree_place;  // per label: the place of its node in `trees`
  std::vector<uint32_t> trees;       // of all hubs
  std::vector<uint32_t> hubs;        // by rank: the node

  [[nodiscard]] std::span<const Label> of(uint32_t node) const {
    return {labels.data() + first[node], labels.data() + first[node + 1]};
  }
  /// Prefetches what of() will read of several nodes.
  template <class Nodes>
  void ask_for(const Nodes& nodes) const {
    for (const uint32_t node : nodes) prefetch(&first[node]);
    for (const uint32_t node : nodes) {
      const Label* list = labels.data() + first[node];
      constexpr size_t kLine = 64 / sizeof(Label), kLines = 4;  // hardware prefetches the rest
      for (size_t i = 0; i < kLines; ++i) prefetch(list + i * kLine);
    }
  }
  /// Where in `trees` the path from a node to a hub of its list begins.
  [[nodiscard]] uint32_t place_of(uint32_t node, uint32_t hub) const;
  /// Adds the nodes of the path from one place to another of the same hub, over the hub.
  void walk(uint32_t from, uint32_t to, std::vector<uint32_t>& nodes) const;
  [[nodiscard]] uint64_t bytes() const {
    return (first.size() + tree_place.size() + trees.size() + hubs.size()) * sizeof(uint32_t) +
           labels.size() * sizeof(Label);
  }
};

/// The shortest path over a hub of two lists, and where its labels are in these.
struct Meeting {
  float length = std::numeric_limits<float>::infinity();  // no path
  uint32_t hub = 0;
  uint32_t first = 0, last = 0;
};
Meeting meet(std::span<const TwoHopLabels::Label> from, std::span<const TwoHopLabels::Label> to);

/// Hubs are ordered by how many shortest paths from `samples` nodes lead over them. Fails with
/// kCancelled or kLimit (too many labels). The same for any number of workers.
Result<TwoHopLabels> label_graph(const PathGraph& graph, uint64_t samples, int32_t workers,
                                 Context& context);

}  // namespace throng::path
