// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "path/edits/flow_points.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "core/access.h"
#include "path/edits/ground_finder_state.h"
#include "path/ground/open_list.h"
#include "path/ground/reset_path.h"
#include "world/place.h"

// Dijkstra's search outwards from all goals over the points of portals of a GroundView, and against
// the direction of its off-mesh links. Time: n log n in the points that it reaches and the portals
// of their rectangles.
namespace throng::path {
namespace {

bool lies_before(const ViewStop& a, const ViewStop& b) {
  return a.level != b.level ? a.level < b.level : a.rect < b.rect;
}

// The search outwards from all goals.
class Outwards {
 public:
  Outwards(GroundView& mesh, double max_distance) : mesh_(mesh), max_distance_(max_distance) {
    nodes_.clear();
    for (const GroundView::LevelLinkEnd& link : mesh.active_links()) {
      ViewStop from{link.level, 0, link.end.from},
          to{link.end.to_level, 0, link.end.to, link.end.cost};
      const bool stands =
          mesh.stand(from.level, from.at, from.rect) && mesh.stand(to.level, to.at, to.rect);
      if (stands) links_.push_back({from, to});
    }
    std::stable_sort(links_.begin(), links_.end(), ends_before);
  }

  /// `link`: the off-mesh link by which the path leaves the stop, or null.
  void push(const ViewStop& stop, uint32_t parent, double cost, const ViewStop* link = nullptr) {
    if (cost > max_distance_) return;
    const auto [index, is_new] = nodes_.node_of(stop);
    ReachedPoint& node = nodes_.nodes[index];
    if (!is_new && (node.done || node.cost <= cost)) return;
    node.cost = cost;
    node.parent = parent;
    node.stop.off_mesh_link = link != nullptr ? link->off_mesh_link : 0;
    if (link != nullptr) node.link_from = link->at;
    open_.push({cost, index});
  }

  bool run(Context& context) {
    for (uint64_t n = 0; !open_.empty(); ++n) {
      if (n % 1024 == 0 && context.cancel) return false;
      const uint32_t index = open_.pop().second;
      if (nodes_.nodes[index].done) continue;
      nodes_.nodes[index].done = true;
      const ReachedPoint node = nodes_.nodes[index];
      const ViewLevel& level = *mesh_.level(node.stop.level);
      const double factor = mesh_.factor(level, node.stop.rect);
      for_portal_points(mesh_, node.stop, [&](world::GroundPoint side, const ViewStop& beyond) {
        const double there = mesh_.factor(*mesh_.level(beyond.level), beyond.rect);
        if (!std::isfinite(there)) return;
        push(beyond, index,
             node.cost + distance_of(node.stop.at, side) * factor + there / world::kUnitsPerCell);
      });
      const auto [first, last] =
          std::equal_range(links_.begin(), links_.end(), Link{{}, node.stop}, ends_before);
      for (auto link = first; link != last; ++link) {
        if (!std::isfinite(mesh_.factor(*mesh_.level(link->from.level), link->from.rect))) continue;
        push(link->from, index,
             node.cost + distance_of(node.stop.at, link->to.at) * factor + link->to.off_mesh_link,
             &link->to);
      }
    }
    return true;
  }

  /// Of a node whose stop has the cost of an off-mesh link, `link_from` is the link's far end.
  [[nodiscard]] const ChunkedArray<ReachedPoint>& nodes() const { return nodes_.nodes; }

 private:
  struct Link {
    ViewStop from, to;  // `to` has its cost
  };
  static bool ends_before(const Link& a, const Link& b) { return lies_before(a.to, b.to); }

  std::vector<Link> links_;  // by where they end
  GroundView& mesh_;
  double max_distance_;
  ReachedPoints nodes_;
  OpenList<std::pair<double, uint32_t>, std::greater<>> open_;
};

}  // namespace

bool FlowPoints::before(const Point& a, const Point& b) { return lies_before(a.stop, b.stop); }

std::optional<FlowPoints> FlowPoints::create(GroundFinder& of, std::span<const Place> goals,
                                             double max_distance, Context& context) {
  auto& ground = of.state();
  max_distance /= ground.mesh.world().summary.cell;
  Outwards search(ground.mesh, max_distance);
  for (const Place& goal : goals) {
    ViewStop stop;
    if (ground.locate(goal, stop)) search.push(stop, UINT32_MAX, 0);
  }
  if (!search.run(context)) return {};
  const ChunkedArray<ReachedPoint>& nodes = search.nodes();
  std::vector<uint32_t> order(nodes.size());
  for (uint32_t n = 0; n < order.size(); ++n) order[n] = n;
  std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) {
    const ViewStop &p = nodes[a].stop, &q = nodes[b].stop;
    return lies_before(p, q) || (!lies_before(q, p) && a < b);
  });
  std::vector<uint32_t> number(order.size());
  for (uint32_t n = 0; n < order.size(); ++n) number[order[n]] = n;
  FlowPoints made;
  made.max_distance_ = max_distance;
  made.points_.reserve(order.size());
  for (const uint32_t n : order) {
    const ReachedPoint& node = nodes[n];
    Point& point = made.points_.emplace_back();
    point.stop = node.stop;
    point.stop.off_mesh_link = 0;
    point.next = node.parent == UINT32_MAX ? kNoPoint : number[node.parent];
    point.cost = node.cost;
    if (node.stop.off_mesh_link == 0) continue;
    point.link = static_cast<uint32_t>(made.link_ends_.size());
    made.link_ends_.push_back({node.link_from, node.stop.off_mesh_link});
  }
  return made;
}

// The point of a stop's rectangle by which it is nearest to a goal, none if that costs too much.
std::pair<uint32_t, double> FlowPoints::leave_by(GroundView& mesh, const ViewStop& stop) const {
  const double factor = mesh.factor(*mesh.level(stop.level), stop.rect);
  const auto [first, last] =
      std::equal_range(points_.begin(), points_.end(), Point{.stop = stop}, before);
  std::pair<uint32_t, double> best{kNoPoint, kNever};
  for (auto p = first; p != last; ++p) {
    const double cost = p->cost + distance_of(p->stop.at, stop.at) * factor;
    if (cost >= best.second || cost > max_distance_) continue;
    best = {static_cast<uint32_t>(p - points_.begin()), cost};
  }
  return best;
}

// The other side of the border that a point lies at, or the far end of its link: its path continues
// there. [it has a next]
ViewStop FlowPoints::stop_beyond(GroundView& mesh, const Point& point) const {
  const ViewStop& on = points_[point.next].stop;
  ViewStop other = on;
  if (point.link != kNoLink) {
    other.at = link_ends_[point.link].at;
    other.off_mesh_link = link_ends_[point.link].cost;
    return other;
  }
  for_portal_points(mesh, on, [&](world::GroundPoint side, const ViewStop& beyond) {
    if (beyond.level == point.stop.level && beyond.at.x == point.stop.at.x &&
        beyond.at.z == point.stop.at.z) {
      other.at = side;
    }
  });
  return other;
}

double FlowPoints::distance(GroundFinder& of, const Place& place) const {
  auto& ground = of.state();
  ViewStop stop;
  if (!ground.locate(place, stop)) return kNever;
  return leave_by(ground.mesh, stop).second * ground.mesh.world().summary.cell;
}

Place FlowPoints::next(GroundFinder& of, const Place& place) const {
  auto& ground = of.state();
  ViewStop from;
  if (!ground.locate(place, from)) return {};
  const auto [first, total] = leave_by(ground.mesh, from);
  if (first == kNoPoint) return {};
  const Point* best = &points_[first];
  // On as long as a straight line costs no more than the path so far; stop after some that cost
  // more.
  constexpr int kMaxMissed = 3;
  int missed = 0;
  for (const Point* p = best; p->next != kNoPoint && missed < kMaxMissed;) {
    p = &points_[p->next];
    if (segment_cost(ground.mesh, from, p->stop) <= (total - p->cost) * (1 + 1e-9)) {
      best = p;
      missed = 0;
    } else {
      ++missed;
    }
  }
  ViewStop to = best->stop;
  // Bodies stop short of a point by some millimetres, and would never stand on a link's start.
  constexpr double kAtLink = 1;  // [cells]
  const double far = distance_of(to.at, from.at);
  const bool is_there =
      to.level == from.level && (best->link != kNoLink ? far <= kAtLink : far == 0);
  if (is_there && best->next != kNoPoint) to = stop_beyond(ground.mesh, *best);
  return world::place_at(ground.mesh.world(), ground.mesh.level(to.level)->ground, to.at);
}

void FlowPoints::find_path(GroundFinder& of, const Place& place, Path& path) const {
  auto& ground = of.state();
  reset(path);
  ViewStop stop;
  if (!ground.locate(place, stop)) return;
  const uint32_t first = leave_by(ground.mesh, stop).first;
  path.end = PathEnd::kUnreachable;
  if (first == kNoPoint) return;
  ground.stops.assign(1, stop);
  for (uint32_t p = first; p != kNoPoint; p = points_[p].next) {
    ground.stops.push_back(points_[p].stop);
    if (points_[p].next != kNoPoint) ground.stops.push_back(stop_beyond(ground.mesh, points_[p]));
  }
  ground.string.pull(ground.mesh, ground.stops);
  ground.give(path);
  path.end = PathEnd::kReached;
}

}  // namespace throng::path
