// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "throng/context.h"
#include "throng/result.h"

/// Two-hop labels of any graph: shortest ways by look-up.
namespace throng {

/// A graph whose edges can be gone both ways.
struct WayGraph {
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

/// For every two nodes that hold together, some hub on a shortest way between them is in both their
/// lists. Source: [AIY13].
struct TwoHopLabels {
  struct Label {
    uint32_t hub = 0;  // rank: 0 is the hub of most ways
    float length = 0;  // to the hub
  };
  // The node after this one on the way, and its label of the same hub; at the hub itself.
  struct Next {
    uint32_t node = 0, label = 0;
  };
  std::vector<uint32_t> first;  // per node, one more at the end
  std::vector<Label> labels;    // of a node, by rising hub
  std::vector<Next> next;       // per label
  std::vector<uint32_t> hubs;   // by rank: the node

  [[nodiscard]] std::span<const Label> of(uint32_t node) const {
    return {labels.data() + first[node], labels.data() + first[node + 1]};
  }
  /// Adds the nodes from one to a hub that it has, both of them included.
  void walk(uint32_t node, uint32_t hub, std::vector<uint32_t>& nodes) const;
  [[nodiscard]] uint64_t bytes() const {
    return (first.size() + hubs.size()) * sizeof(uint32_t) +
           labels.size() * (sizeof(Label) + sizeof(Next));
  }
};

/// Hubs are taken in the order of how many shortest ways from `samples` nodes lead over them. Fails
/// with kCancelled. The same for any number of workers.
Result<TwoHopLabels> label_graph(const WayGraph& graph, uint64_t samples, int32_t workers,
                                 Context& context);

}  // namespace throng
