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
constexpr float kFarthest = 3e38f;

uint32_t block_of(const PathMesh& mesh, const Stop& end) {
  return mesh.block_at(end.rect, end.at.cell_x(), end.at.cell_z());
}

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
      out.next.push_back(label.next);
    }
    out.first.push_back(static_cast<uint32_t>(out.labels.size()));
    of_corner = {};
  }
  constexpr uint64_t kMostEntries = uint64_t{1} << 25;  // 320 MiB
  out.by_block = build_block_labels(mesh, out, workers, kMostEntries);
  return out;
}

// The corners that a way may bend at first from an end; false if the cells would have to tell
// which.
bool LabelSearch::gather(const PathMesh& mesh, const HubLabels& labels, const Stop& end,
                         std::vector<SeenCorner>& seen) {
  seen.clear();
  const CellPoint from = in_cells(end.at);
  const uint32_t block = block_of(mesh, end), last = labels.first_candidate[block + 1];
  for (uint32_t i = labels.first_candidate[block]; i < last; ++i) {
    const uint32_t c = labels.candidates[i].corner;
    const MeshCorner& corner = mesh.corners[c];
    const double dx = corner.x - from.x, dz = corner.z - from.z;
    if (!is_taut(corner, dx, dz)) continue;
    if (labels.candidates[i].from_all != 0) {
      seen.push_back({c, std::sqrt(dx * dx + dz * dz)});
      continue;
    }
    const RayEnd ray = ray_to_corner(mesh, end, c);
    if (ray == RayEnd::kTouches) return false;
    if (ray == RayEnd::kArrived) seen.push_back({c, std::sqrt(dx * dx + dz * dz)});
  }
  return true;
}

// The shortest way over the gathered corners; false if there is none.
bool LabelSearch::join(const PathMesh& mesh, const HubLabels& labels, Best& best) {
  if (reach_.size() != mesh.corner_count()) reach_.assign(mesh.corner_count(), {});
  if (++search_ == 0) {
    reach_.assign(mesh.corner_count(), {});
    search_ = 1;
  }
  for (const SeenCorner& s : start_) {
    for (const HubLabels::Label& label : labels.of(s.corner)) {
      Reach& reach = reach_[label.hub];
      const float here = static_cast<float>(s.distance) + label.length;
      if (reach.search != search_ || here < reach.length) reach = {search_, s.corner, here};
    }
  }
  best.length = kFarthest;
  for (const SeenCorner& s : goal_) {
    for (const HubLabels::Label& label : labels.of(s.corner)) {
      const Reach& reach = reach_[label.hub];
      const float here = reach.length + label.length + static_cast<float>(s.distance);
      if (reach.search != search_ || here >= best.length) continue;
      best = {here, label.hub, reach.corner, s.corner};
    }
  }
  return best.length < kFarthest;
}

// The corners from each end to the hub.
void LabelSearch::trace(const HubLabels& labels, const Best& best,
                        std::vector<uint32_t>& corners) const {
  const auto walk = [&](uint32_t corner) {
    for (;;) {
      corners.push_back(corner);
      const auto list = labels.of(corner);
      const auto at = std::lower_bound(
          list.begin(), list.end(), best.hub,
          [](const HubLabels::Label& label, uint32_t wanted) { return label.hub < wanted; });
      const uint32_t next = labels.next[static_cast<size_t>(&*at - labels.labels.data())];
      if (next == corner) return;
      corner = next;
    }
  };
  walk(best.first);
  const size_t middle = corners.size() - 1;
  walk(best.last);
  corners.pop_back();  // the hub, which is there already
  std::reverse(corners.begin() + static_cast<ptrdiff_t>(middle) + 1, corners.end());
}

namespace {

void distances(const PathMesh& mesh, const HubLabels& labels, const Stop& end,
               std::vector<float>& out) {
  const CellPoint from = in_cells(end.at);
  out.clear();
  const uint32_t block = block_of(mesh, end), last = labels.first_candidate[block + 1];
  for (uint32_t i = labels.first_candidate[block]; i < last; ++i) {
    const MeshCorner& corner = mesh.corners[labels.candidates[i].corner];
    const double dx = corner.x - from.x, dz = corner.z - from.z;
    out.push_back(static_cast<float>(std::sqrt(dx * dx + dz * dz)));
  }
}

// The next run of entries of one hub, and its shortest by the distances.
struct HubRun {
  float length = kFarthest;
  uint32_t candidate = 0;

  HubRun(const BlockLabels& labels, uint32_t& at, uint32_t end, const std::vector<float>& to) {
    const uint32_t hub = labels.hub[at];
    for (; at < end && labels.hub[at] == hub; ++at) {
      const float here = to[labels.candidate[at]] + labels.length[at];
      if (here >= length) continue;
      length = here;
      candidate = labels.candidate[at];
    }
  }
};

}  // namespace

// Joins the lists of the ends' blocks. Where a ray does not reach the best way's first or last
// corner, the best without it.
LabelSearch::Merge LabelSearch::merge(const PathMesh& mesh, const HubLabels& labels,
                                      const Stop& from, const Stop& to, Best& best) {
  const BlockLabels& by_block = labels.by_block;
  const uint32_t from_block = block_of(mesh, from), to_block = block_of(mesh, to);
  distances(mesh, labels, from, from_);
  distances(mesh, labels, to, to_);
  const auto is_seen = [&](const Stop& end, uint32_t candidate, float& length, bool& unsure) {
    const HubLabels::Candidate& c =
        labels.candidates[labels.first_candidate[block_of(mesh, end)] + candidate];
    if (c.from_all != 0) return true;
    const RayEnd ray = ray_to_corner(mesh, end, c.corner);
    unsure = unsure || ray == RayEnd::kTouches;
    if (ray == RayEnd::kArrived) return true;
    length = kFarthest;
    return false;
  };
  for (;;) {
    best.length = kFarthest;
    uint32_t first = 0, last = 0;  // candidates
    uint32_t i = by_block.first[from_block], j = by_block.first[to_block];
    const uint32_t i_end = by_block.first[from_block + 1], j_end = by_block.first[to_block + 1];
    while (i < i_end && j < j_end) {
      if (by_block.hub[i] < by_block.hub[j]) {
        ++i;
      } else if (by_block.hub[j] < by_block.hub[i]) {
        ++j;
      } else {
        const uint32_t hub = by_block.hub[i];
        const HubRun a(by_block, i, i_end, from_), b(by_block, j, j_end, to_);
        if (a.length + b.length >= best.length) continue;
        best.length = a.length + b.length;
        best.hub = hub;
        first = a.candidate;
        last = b.candidate;
      }
    }
    if (!(best.length < kFarthest)) return Merge::kNone;
    bool unsure = false;
    const bool seen = is_seen(from, first, from_[first], unsure);
    const bool both = is_seen(to, last, to_[last], unsure) && seen;
    if (unsure) return Merge::kUnsure;
    if (!both) continue;
    best.first = labels.candidates[labels.first_candidate[from_block] + first].corner;
    best.last = labels.candidates[labels.first_candidate[to_block] + last].corner;
    return Merge::kFound;
  }
}

bool LabelSearch::find(const PathMesh& mesh, const HubLabels& labels, const Stop& from,
                       const Stop& to, std::vector<uint32_t>& corners, double& length) {
  corners.clear();
  const CellPoint start = in_cells(from.at), goal = in_cells(to.at);
  length = distance(start, goal);
  if (mesh_ray(mesh, from.rect, from.at, to.at) == to.rect) return true;
  Best best;
  Merge merged = Merge::kUnsure;
  if (!labels.by_block.first.empty()) merged = merge(mesh, labels, from, to, best);
  if (merged != Merge::kFound) {
    if (!(gather(mesh, labels, from, start_) && gather(mesh, labels, to, goal_))) {
      sight_.look(mesh, from.rect, start, to.rect, goal);
      if (sight_.sees_goal()) return true;
      start_ = sight_.corners();
      sight_.look(mesh, to.rect, goal, kNoRect, {});
      goal_ = sight_.corners();
    }
    if (!join(mesh, labels, best)) return false;
  }
  trace(labels, best, corners);
  length = 0;
  CellPoint at = start;
  for (const uint32_t c : corners) {
    const CellPoint next{double(mesh.corners[c].x), double(mesh.corners[c].z)};
    length += distance(at, next);
    at = next;
  }
  length += distance(at, goal);
  return true;
}

}  // namespace throng
