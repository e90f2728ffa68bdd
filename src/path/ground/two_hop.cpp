// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "path/ground/two_hop.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "core/parallel.h"
#include "core/random.h"
#include "path/ground/open_list.h"

// Pruned landmark labelling [AIY13]: a Dijkstra search from each hub, pruned where earlier hubs
// give as short a path. Time: for each hub, n log n in the nodes that its search reaches, and the
// labels that these have; the order of the hubs takes a whole search for each sample.
namespace throng::path {
namespace {

constexpr double kUnreached = 1e300;
constexpr double kSameLength = 1e-9;

// Dijkstra's search with its memory.
class DijkstraSearch {
 public:
  explicit DijkstraSearch(size_t count) : best_(count, kUnreached), before_(count, 0) {}

  // Calls visit(node, length, before) in order of length; expands a node if it returns true.
  template <class Visit>
  void run(const PathGraph& graph, uint32_t from, Visit visit) {
    open_.clear();
    touched_.clear();
    relax(from, 0, from);
    while (!open_.empty()) {
      const auto [length, node] = open_.pop();
      if (length > best_[node]) continue;
      if (!visit(node, length, before_[node])) continue;
      for (const PathGraph::Edge& edge : graph.of(node)) relax(edge.to, length + edge.length, node);
    }
    for (const uint32_t node : touched_) best_[node] = kUnreached;
  }

 private:
  using Entry = std::pair<double, uint32_t>;

  void relax(uint32_t node, double length, uint32_t before) {
    if (length >= best_[node]) return;
    if (best_[node] == kUnreached) touched_.push_back(node);
    best_[node] = length;
    before_[node] = before;
    open_.push({length, node});
  }

  std::vector<double> best_;
  std::vector<uint32_t> before_;
  OpenList<Entry, std::greater<>> open_;
  std::vector<uint32_t> touched_;
};

// Nodes by how many shortest paths from a sample of nodes lead over them: the more, the better a
// hub.
std::vector<uint32_t> order_hubs(const PathGraph& graph, uint64_t samples, int32_t workers) {
  const size_t count = graph.count();
  samples = std::min<uint64_t>(samples, count);
  const auto threads = static_cast<size_t>(worker_count(workers));
  std::vector<std::vector<uint64_t>> paths(threads);  // per worker: sums do not depend on the order
  parallel_for_worker(threads, workers, [&](size_t share, int32_t) {
    std::vector<uint64_t>& sums = paths[share];
    sums.assign(count, 0);
    std::vector<uint64_t> below(count, 0);
    DijkstraSearch search(count);
    std::vector<std::pair<uint32_t, uint32_t>> tree;  // node, before it
    for (uint64_t n = share; n < samples; n += threads) {
      tree.clear();
      const auto from = static_cast<uint32_t>(random_below(1, n, 0, count));
      search.run(graph, from, [&](uint32_t node, double, uint32_t before) {
        tree.push_back({node, before});
        return true;
      });
      for (size_t i = tree.size(); i-- > 1;) {
        below[tree[i].second] += below[tree[i].first] + 1;
        sums[tree[i].first] += below[tree[i].first];
        below[tree[i].first] = 0;
      }
      if (!tree.empty()) below[tree[0].first] = 0;
    }
  });
  for (size_t t = 1; t < threads; ++t) {
    for (size_t i = 0; i < count; ++i) paths[0][i] += paths[t][i];
  }
  std::vector<uint32_t> order(count);
  std::iota(order.begin(), order.end(), 0u);
  const auto weight = [&](uint32_t c) {
    return std::pair{paths[0][c], uint64_t{graph.first[c + 1] - graph.first[c]}};
  };
  std::stable_sort(order.begin(), order.end(),
                   [&](uint32_t a, uint32_t b) { return weight(a) > weight(b); });
  return order;
}

// The nodes that have a hub, and how paths lead from them to it.
class HubTree {
 public:
  explicit HubTree(size_t count) : at_(count, 0) {}

  void clear() { nodes_.clear(); }
  // Nodes come after the one that they lead to; the hub leads to itself.
  void add(uint32_t node, uint32_t before) {
    const auto n = static_cast<uint32_t>(nodes_.size());
    at_[node] = n;
    nodes_.push_back({node, at_[before], 1, n, 0});
  }
  // Adds the tree to the trees; calls place(node, its place).
  template <class Place>
  void write(std::vector<uint32_t>& trees, Place place) {
    // From the ends on: the branch with most nodes continues to the node that it leads to.
    for (size_t i = nodes_.size(); i-- > 1;) {
      Node& to = nodes_[nodes_[i].before];
      to.below += nodes_[i].below;
      if (to.heavy == nodes_[i].before || nodes_[to.heavy].below <= nodes_[i].below)
        to.heavy = static_cast<uint32_t>(i);
    }
    for (uint32_t i = 0; i < nodes_.size(); ++i) {
      const uint32_t before = nodes_[i].before;
      if (i > 0 && nodes_[before].heavy == i) continue;
      run_.assign(1, i);
      while (nodes_[run_.back()].heavy != run_.back()) run_.push_back(nodes_[run_.back()].heavy);
      for (size_t k = run_.size(); k-- > 0;) {
        Node& node = nodes_[run_[k]];
        node.place = static_cast<uint32_t>(trees.size());
        place(node.node, node.place);
        trees.push_back(node.node);
      }
      trees.push_back(i == 0 ? TwoHopLabels::kEnd : TwoHopLabels::kGoesOn | nodes_[before].place);
    }
  }

 private:
  struct Node {
    uint32_t node, before;
    uint32_t below;  // how many lead over it, with itself
    uint32_t heavy;  // the one with most of them; itself: none
    uint32_t place;
  };
  std::vector<Node> nodes_;
  std::vector<uint32_t> at_;  // per node of the graph
  std::vector<uint32_t> run_;
};

}  // namespace

uint32_t TwoHopLabels::place_of(uint32_t node, uint32_t hub) const {
  const auto list = of(node);
  const auto at = std::lower_bound(list.begin(), list.end(), hub,
                                   [](const Label& l, uint32_t wanted) { return l.hub < wanted; });
  return tree_place[static_cast<size_t>(&*at - labels.data())];
}

void TwoHopLabels::walk(uint32_t from, uint32_t to, std::vector<uint32_t>& nodes) const {
  const auto to_hub = [&](uint32_t place) {
    for (uint32_t word = trees[place]; word != kEnd; word = trees[place]) {
      if ((word & kGoesOn) != 0) {
        place = word & ~kGoesOn;
      } else {
        nodes.push_back(word);
        ++place;
      }
    }
  };
  to_hub(from);
  const auto after_hub = static_cast<ptrdiff_t>(nodes.size());
  to_hub(to);
  nodes.pop_back();  // the hub, which is there already
  std::reverse(nodes.begin() + after_hub, nodes.end());
}

Meeting meet(std::span<const TwoHopLabels::Label> from, std::span<const TwoHopLabels::Label> to) {
  Meeting best;
  uint32_t i = 0, j = 0;
  while (i < from.size() && j < to.size()) {
    const uint32_t hub_i = from[i].hub, hub_j = to[j].hub;
    if (hub_i == hub_j) {
      const float here = from[i].length + to[j].length;
      if (here < best.length) best = {here, hub_i, i, j};
    }
    i += hub_i <= hub_j;
    j += hub_j <= hub_i;
  }
  return best;
}

Result<TwoHopLabels> label_graph(const PathGraph& graph, uint64_t samples, int32_t workers,
                                 Context& context) {
  const size_t count = graph.count();
  TwoHopLabels out;
  out.hubs = order_hubs(graph, samples, workers);
  struct Made {
    uint32_t hub, tree_place;
    double length;
  };
  std::vector<std::vector<Made>> labels(count);
  std::vector<double> to_root(count, kUnreached);  // per hub that the root has
  DijkstraSearch search(count);
  HubTree tree(count);
  for (uint32_t rank = 0; rank < count; ++rank) {
    if (context.cancel) return Error{Errc::kCancelled, "path: cancelled"};
    // A tree of all nodes still has to fit: each is at most a run of its own.
    if (out.trees.size() + 2 * count >= TwoHopLabels::kGoesOn) {
      return Error{Errc::kLimit, "path: more than 2^30 labels; use a larger cell, or zones"};
    }
    const uint32_t root = out.hubs[rank];
    for (const auto& label : labels[root]) to_root[label.hub] = label.length;
    tree.clear();
    search.run(graph, root, [&](uint32_t node, double length, uint32_t before) {
      for (const auto& label : labels[node]) {
        // An earlier hub lies on a path that is as short.
        if (to_root[label.hub] + label.length <= length + kSameLength) return false;
      }
      labels[node].push_back({rank, 0, length});
      tree.add(node, before);
      return true;
    });
    for (const auto& label : labels[root]) to_root[label.hub] = kUnreached;
    tree.write(out.trees,
               [&](uint32_t node, uint32_t place) { labels[node].back().tree_place = place; });
  }
  out.first.push_back(0);
  for (auto& of_node : labels) {
    for (const Made& label : of_node) {
      out.labels.push_back({label.hub, static_cast<float>(label.length)});
      out.tree_place.push_back(label.tree_place);
    }
    out.first.push_back(static_cast<uint32_t>(out.labels.size()));
    of_node = {};
  }
  return out;
}

}  // namespace throng::path
