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

CornerGraph look_around(const PathMesh& mesh, int32_t workers, const Context& context) {
  const size_t count = mesh.corner_count();
  std::vector<std::vector<SeenCorner>> seen(count);
  constexpr size_t kGrain = 64;
  parallel_ranges(count, kGrain, workers, [&](size_t begin, size_t end) {
    Sight sight;
    for (size_t c = begin; c < end && !context.cancel; ++c) {
      sight.look_from_corner(mesh, static_cast<uint32_t>(c));
      seen[c] = sight.corners();
    }
  });
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
  constexpr uint64_t kSamples = 96;
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
  const CornerGraph graph = look_around(mesh, workers, context);
  if (context.cancel) return Error{Errc::kCancelled, "path: cancelled"};
  const std::vector<uint32_t> order = order_hubs(graph, count);
  std::vector<std::vector<HubLabels::Label>> labels(count);
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
  HubLabels out;
  out.edges = graph.edges.size() / 2;
  out.first.push_back(0);
  for (auto& of_corner : labels) {
    out.labels.insert(out.labels.end(), of_corner.begin(), of_corner.end());
    out.first.push_back(static_cast<uint32_t>(out.labels.size()));
    of_corner = {};
  }
  return out;
}

bool LabelSearch::find(const PathMesh& mesh, const HubLabels& labels, uint32_t from_rect,
                       CellPoint from, uint32_t to_rect, CellPoint to,
                       std::vector<uint32_t>& corners, double& length) {
  corners.clear();
  sight_.look(mesh, from_rect, from, to_rect, to);
  if (sight_.sees_goal()) {
    length = distance(from, to);
    return true;
  }
  if (reach_.size() != mesh.corner_count()) reach_.assign(mesh.corner_count(), {});
  if (++search_ == 0) {
    reach_.assign(mesh.corner_count(), {});
    search_ = 1;
  }
  start_ = sight_.corners();
  for (const SeenCorner& s : start_) {
    for (const HubLabels::Label& label : labels.of(s.corner)) {
      Reach& reach = reach_[label.hub];
      const double here = s.distance + label.length;
      if (reach.search != search_ || here < reach.length) reach = {search_, s.corner, here};
    }
  }
  sight_.look(mesh, to_rect, to, kNoRect, {});
  length = kFar;
  uint32_t hub = 0, last = 0;
  for (const SeenCorner& s : sight_.corners()) {
    for (const HubLabels::Label& label : labels.of(s.corner)) {
      const Reach& reach = reach_[label.hub];
      if (reach.search != search_) continue;
      const double here = reach.length + label.length + s.distance;
      if (here >= length) continue;
      length = here;
      hub = label.hub;
      last = s.corner;
    }
  }
  if (length == kFar) return false;
  // From each end to the hub.
  const auto walk = [&](uint32_t corner) {
    for (;;) {
      corners.push_back(corner);
      const auto list = labels.of(corner);
      const auto at = std::lower_bound(
          list.begin(), list.end(), hub,
          [](const HubLabels::Label& label, uint32_t wanted) { return label.hub < wanted; });
      if (at->next == corner) return;
      corner = at->next;
    }
  };
  walk(reach_[hub].corner);
  const size_t middle = corners.size() - 1;
  walk(last);
  corners.pop_back();  // the hub, which is there already
  std::reverse(corners.begin() + static_cast<ptrdiff_t>(middle) + 1, corners.end());
  return true;
}

}  // namespace throng
