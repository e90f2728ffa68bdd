// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "path/hub_labels.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "core/parallel.h"
#include "core/random.h"
#include "path/border.h"
#include "path/mesh_ray.h"

namespace throng {
namespace {

constexpr double kFar = 1e300;

struct Edge {
  uint32_t to = 0;
  double length = 0;
};

// Which corners see each other, both ways.
struct CornerGraph {
  std::vector<uint32_t> first;
  std::vector<Edge> edges;

  [[nodiscard]] std::span<const Edge> of(uint32_t corner) const {
    return {edges.data() + first[corner], edges.data() + first[corner + 1]};
  }
};

// Turns "what each corner sees" into "by which corners each block is seen".
void list_candidates(const PathMesh& mesh, const std::vector<std::vector<SeenBlock>>& blocks,
                     HubLabels& out) {
  out.first_candidate.assign(mesh.block_count() + 1, 0);
  for (const auto& of_corner : blocks) {
    for (const SeenBlock& b : of_corner) ++out.first_candidate[b.block + 1];
  }
  for (size_t r = 1; r < out.first_candidate.size(); ++r)
    out.first_candidate[r] += out.first_candidate[r - 1];
  out.candidates.resize(out.first_candidate.back());
  std::vector<uint32_t> at(out.first_candidate.begin(), out.first_candidate.end() - 1);
  for (uint32_t c = 0; c < blocks.size(); ++c) {
    for (const SeenBlock& b : blocks[c]) out.candidates[at[b.block]++] = {c & 0x7fffffff, b.whole};
  }
}

CornerGraph look_around(const PathMesh& mesh, int32_t workers, const Context& context,
                        HubLabels& out) {
  const size_t count = mesh.corner_count();
  std::vector<std::vector<SeenBlock>> blocks(count);  // of each corner
  std::vector<std::vector<SeenCorner>> seen(count);
  constexpr size_t kGrain = 64;
  parallel_ranges(count, kGrain, workers, [&](size_t begin, size_t end) {
    Sight sight;
    for (size_t c = begin; c < end && !context.cancel; ++c) {
      sight.look_from_corner(mesh, static_cast<uint32_t>(c));
      seen[c] = sight.corners();
      blocks[c] = sight.blocks();
    }
  });
  list_candidates(mesh, blocks, out);
  // What one sees the other does, even where rounding hid it from one of them.
  struct Pair {
    uint32_t from, to;
    double length;
  };
  std::vector<Pair> pairs;
  for (uint32_t c = 0; c < count; ++c) {
    for (const SeenCorner& s : seen[c]) {
      pairs.push_back({c, s.corner, s.distance});
      pairs.push_back({s.corner, c, s.distance});
    }
    seen[c] = {};
  }
  std::sort(pairs.begin(), pairs.end(), [](const Pair& a, const Pair& b) {
    return a.from != b.from ? a.from < b.from : a.to < b.to;
  });
  CornerGraph graph;
  graph.first.assign(count + 1, 0);
  for (size_t i = 0; i < pairs.size(); ++i) {
    if (i > 0 && pairs[i].from == pairs[i - 1].from && pairs[i].to == pairs[i - 1].to) continue;
    graph.edges.push_back({pairs[i].to, pairs[i].length});
    ++graph.first[pairs[i].from + 1];
  }
  for (size_t c = 0; c < count; ++c) graph.first[c + 1] += graph.first[c];
  return graph;
}

// Dijkstra's search with its memory.
class Spread {
 public:
  explicit Spread(size_t count) : best_(count, kFar), before_(count, 0) {}

  // Calls visit(corner, length, before) in order of length; goes on from a corner if it says so.
  template <class Visit>
  void run(const CornerGraph& graph, uint32_t from, Visit visit) {
    heap_.clear();
    touched_.clear();
    relax(from, 0, from);
    while (!heap_.empty()) {
      std::pop_heap(heap_.begin(), heap_.end(), later);
      const auto [length, corner] = heap_.back();
      heap_.pop_back();
      if (length > best_[corner]) continue;
      if (!visit(corner, length, before_[corner])) continue;
      for (const Edge& edge : graph.of(corner)) relax(edge.to, length + edge.length, corner);
    }
    for (const uint32_t corner : touched_) best_[corner] = kFar;
  }

 private:
  using Entry = std::pair<double, uint32_t>;
  static bool later(const Entry& a, const Entry& b) { return a > b; }

  void relax(uint32_t corner, double length, uint32_t before) {
    if (length >= best_[corner]) return;
    if (best_[corner] == kFar) touched_.push_back(corner);
    best_[corner] = length;
    before_[corner] = before;
    heap_.push_back({length, corner});
    std::push_heap(heap_.begin(), heap_.end(), later);
  }

  std::vector<double> best_;
  std::vector<uint32_t> before_;
  std::vector<Entry> heap_;
  std::vector<uint32_t> touched_;
};

// Corners by how many shortest ways from a sample of corners lead over them: the more, the better a
// hub.
std::vector<uint32_t> order_hubs(const CornerGraph& graph, size_t count) {
  constexpr uint64_t kSamples = 256;
  std::vector<uint64_t> ways(count, 0), below(count, 0);
  Spread spread(count);
  std::vector<std::pair<uint32_t, uint32_t>> tree;  // corner, before it
  for (uint64_t n = 0; n < std::min<uint64_t>(kSamples, count); ++n) {
    tree.clear();
    const auto from = static_cast<uint32_t>(random_below(1, n, 0, count));
    spread.run(graph, from, [&](uint32_t corner, double, uint32_t before) {
      tree.push_back({corner, before});
      return true;
    });
    for (size_t i = tree.size(); i-- > 1;) {
      below[tree[i].second] += below[tree[i].first] + 1;
      ways[tree[i].first] += below[tree[i].first];
      below[tree[i].first] = 0;
    }
    if (!tree.empty()) below[tree[0].first] = 0;
  }
  std::vector<uint32_t> order(count);
  std::iota(order.begin(), order.end(), 0u);
  const auto weight = [&](uint32_t c) {
    return std::pair{ways[c], uint64_t{graph.first[c + 1] - graph.first[c]}};
  };
  std::stable_sort(order.begin(), order.end(),
                   [&](uint32_t a, uint32_t b) { return weight(a) > weight(b); });
  return order;
}

}  // namespace

Result<HubLabels> build_labels(const PathMesh& mesh, int32_t workers, Context& context) {
  const size_t count = mesh.corner_count();
  HubLabels out;
  const CornerGraph graph = look_around(mesh, workers, context, out);
  if (context.cancel) return Error{Errc::kCancelled, "path: cancelled"};
  const std::vector<uint32_t> order = order_hubs(graph, count);
  struct Made {
    uint32_t hub, next;
    double length;
  };
  std::vector<std::vector<Made>> labels(count);
  std::vector<double> to_root(count, kFar);  // per hub that the root has
  Spread spread(count);
  for (uint32_t rank = 0; rank < count; ++rank) {
    if (context.cancel) return Error{Errc::kCancelled, "path: cancelled"};
    const uint32_t root = order[rank];
    for (const auto& label : labels[root]) to_root[label.hub] = label.length;
    spread.run(graph, root, [&](uint32_t corner, double length, uint32_t before) {
      for (const auto& label : labels[corner]) {
        // An earlier hub lies on a way as short.
        if (to_root[label.hub] + label.length <= length + kSame) return false;
      }
      labels[corner].push_back({rank, before, length});
      return true;
    });
    for (const auto& label : labels[root]) to_root[label.hub] = kFar;
  }
  out.hubs = order;
  out.edges = graph.edges.size() / 2;
  out.first.push_back(0);
  for (auto& of_corner : labels) {
    for (const Made& label : of_corner) {
      out.labels.push_back({label.hub, static_cast<float>(label.length)});
      out.next.push_back({label.next, 0});
    }
    out.first.push_back(static_cast<uint32_t>(out.labels.size()));
    of_corner = {};
  }
  parallel_ranges(count, 64, workers, [&](size_t begin, size_t end) {
    for (uint32_t i = out.first[begin]; i < out.first[end]; ++i) {
      const auto list = out.of(out.next[i].corner);
      const auto at = std::lower_bound(
          list.begin(), list.end(), out.labels[i].hub,
          [](const HubLabels::Label& label, uint32_t hub) { return label.hub < hub; });
      out.next[i].label = static_cast<uint32_t>(&*at - out.labels.data());
    }
  });
  constexpr uint64_t kMostEntries = uint64_t{1} << 25;  // 320 MiB
  if (mesh.block_side == kSmallBlock)
    out.by_block = build_block_labels(mesh, out, workers, kMostEntries);
  if (out.by_block.first.empty()) out.by_middle = build_middle_labels(mesh, out, workers);
  return out;
}

}  // namespace throng
