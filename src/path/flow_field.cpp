// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "throng/flow_field.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "path/live_search.h"
#include "path/live_state.h"
#include "path/reset_path.h"
#include "world/place.h"

namespace throng {
namespace {

constexpr uint32_t kNoPoint = UINT32_MAX;
constexpr double kNever = std::numeric_limits<double>::infinity();

// A goal, or a point just inside a rectangle by which the way to a goal leaves it.
struct FlowPoint {
  LiveStop stop;
  uint32_t next = kNoPoint;  // on the way; none at a goal
  double cost = 0;           // [cells]
};

bool before(const LiveStop& a, const LiveStop& b) {
  return a.level != b.level ? a.level < b.level : a.rect < b.rect;
}

// The search outwards from all goals.
class Outwards {
 public:
  Outwards(LiveMesh& mesh, double most) : mesh_(mesh), most_(most) { nodes_.clear(); }

  void push(const LiveStop& stop, uint32_t parent, double cost) {
    if (cost > most_) return;
    const auto [index, is_new] = nodes_.node_of(stop);
    LiveNode& node = nodes_.nodes[index];
    if (!is_new && (node.done || node.cost <= cost)) return;
    node.cost = cost;
    node.parent = parent;
    open_.emplace_back(cost, index);
    std::push_heap(open_.begin(), open_.end(), std::greater<>());
  }

  bool run(Context& context) {
    for (uint64_t n = 0; !open_.empty(); ++n) {
      if (n % 1024 == 0 && context.cancel) return false;
      std::pop_heap(open_.begin(), open_.end(), std::greater<>());
      const uint32_t index = open_.back().second;
      open_.pop_back();
      if (nodes_.nodes[index].done) continue;
      nodes_.nodes[index].done = true;
      const LiveNode node = nodes_.nodes[index];
      const LiveLevel& level = *mesh_.level_with_portals(node.stop.level);
      const double factor = mesh_.factor(level.rects[node.stop.rect]);
      for_portal_points(mesh_, node.stop, [&](GroundPoint side, const LiveStop& beyond) {
        const double there = mesh_.factor(mesh_.level(beyond.level)->rects[beyond.rect]);
        if (!std::isfinite(there)) return;
        push(beyond, index,
             node.cost + distance_of(node.stop.at, side) * factor + there / kUnitsPerCell);
      });
    }
    return true;
  }

  // All points by level and rectangle, so that those of one lie together.
  [[nodiscard]] std::vector<FlowPoint> points() const {
    std::vector<uint32_t> order(nodes_.nodes.size());
    for (uint32_t n = 0; n < order.size(); ++n) order[n] = n;
    std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) {
      const LiveStop &p = nodes_.nodes[a].stop, &q = nodes_.nodes[b].stop;
      return before(p, q) || (!before(q, p) && a < b);
    });
    std::vector<uint32_t> number(order.size());
    for (uint32_t n = 0; n < order.size(); ++n) number[order[n]] = n;
    std::vector<FlowPoint> points;
    points.reserve(order.size());
    for (const uint32_t n : order) {
      const LiveNode& node = nodes_.nodes[n];
      points.push_back(
          {node.stop, node.parent == UINT32_MAX ? kNoPoint : number[node.parent], node.cost});
    }
    return points;
  }

 private:
  LiveMesh& mesh_;
  double most_;
  LiveNodes nodes_;
  std::vector<std::pair<double, uint32_t>> open_;
};

}  // namespace

struct FlowField::State {
  LiveGround ground;
  double most = kNever;  // [cells]
  std::shared_ptr<const std::vector<FlowPoint>> points;
  double seconds = 0;
  std::vector<LiveStop> way;

  // The point of a stop's rectangle by which it is nearest to a goal, none if that costs too much.
  [[nodiscard]] std::pair<uint32_t, double> leave_by(const LiveStop& stop) {
    LiveMesh& mesh = ground.state_->mesh;
    const double factor = mesh.factor(mesh.level(stop.level)->rects[stop.rect]);
    const auto [first, last] = std::equal_range(
        points->begin(), points->end(), FlowPoint{stop, kNoPoint, 0},
        [](const FlowPoint& a, const FlowPoint& b) { return before(a.stop, b.stop); });
    std::pair<uint32_t, double> best{kNoPoint, kNever};
    for (auto p = first; p != last; ++p) {
      const double cost = p->cost + distance_of(p->stop.at, stop.at) * factor;
      if (cost >= best.second || cost > most) continue;
      best = {static_cast<uint32_t>(p - points->begin()), cost};
    }
    return best;
  }

  // The other side of the border that a point lies at: its way goes on there. [it has a next]
  [[nodiscard]] LiveStop across(const FlowPoint& point) {
    const LiveStop& on = (*points)[point.next].stop;
    LiveStop other = on;
    for_portal_points(ground.state_->mesh, on, [&](GroundPoint side, const LiveStop& beyond) {
      if (beyond.level == point.stop.level && beyond.at.x == point.stop.at.x &&
          beyond.at.z == point.stop.at.z) {
        other.at = side;
      }
    });
    return other;
  }
};

FlowField::FlowField(std::unique_ptr<State> state) : state_(std::move(state)) {}
FlowField::FlowField(const FlowField& other) : state_(std::make_unique<State>(*other.state_)) {}
FlowField& FlowField::operator=(const FlowField& other) {
  if (this != &other) state_ = std::make_unique<State>(*other.state_);
  return *this;
}
FlowField::FlowField(FlowField&&) noexcept = default;
FlowField& FlowField::operator=(FlowField&&) noexcept = default;
FlowField::~FlowField() = default;

Result<FlowField> FlowField::make(const LiveGround& ground, std::span<const Place> goals,
                                  const FlowConfig& config, Context& context) {
  if (!(config.most > 0)) return Error{Errc::kBadConfig, "flow field: most must be above 0"};
  const auto start = std::chrono::steady_clock::now();
  auto state = std::make_unique<State>(State{ground, kNever, nullptr, 0, {}});
  LiveMesh& mesh = state->ground.state_->mesh;
  state->most = config.most / mesh.world().summary.cell;
  Outwards search(mesh, state->most);
  bool any = false;
  for (const Place& goal : goals) {
    LiveStop stop;
    if (!state->ground.state_->locate(goal, stop)) continue;
    search.push(stop, UINT32_MAX, 0);
    any = true;
  }
  if (!any) {
    return Error{Errc::kBadInput, "flow field: none of " + std::to_string(goals.size()) +
                                      " goals is a place where the class can stand"};
  }
  if (!search.run(context)) return Error{Errc::kCancelled, "flow field: cancelled"};
  state->points = std::make_shared<const std::vector<FlowPoint>>(search.points());
  state->seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return FlowField(std::move(state));
}

double FlowField::distance(const Place& place) {
  LiveStop stop;
  if (!state_->ground.state_->locate(place, stop)) return kNever;
  return state_->leave_by(stop).second * state_->ground.state_->mesh.world().summary.cell;
}

Place FlowField::next(const Place& place) {
  LiveGround::State& ground = *state_->ground.state_;
  LiveStop from;
  if (!ground.locate(place, from)) return {};
  const auto [first, total] = state_->leave_by(from);
  if (first == kNoPoint) return {};
  const std::vector<FlowPoint>& points = *state_->points;
  const FlowPoint* best = &points[first];
  // On as long as a straight line is no dearer than the way so far; give up after some that are.
  constexpr int kPatience = 3;
  int missed = 0;
  for (const FlowPoint* p = best; p->next != kNoPoint && missed < kPatience;) {
    p = &points[p->next];
    if (leg_cost(ground.mesh, from, p->stop) <= (total - p->cost) * (1 + 1e-9)) {
      best = p;
      missed = 0;
    } else {
      ++missed;
    }
  }
  LiveStop to = best->stop;
  const bool is_there = to.level == from.level && to.at.x == from.at.x && to.at.z == from.at.z;
  if (is_there && best->next != kNoPoint) to = state_->across(*best);
  return place_at(ground.mesh.world(), ground.mesh.level(to.level)->ground, to.at);
}

void FlowField::way(const Place& place, Path& path) {
  LiveGround::State& ground = *state_->ground.state_;
  reset(path);
  LiveStop stop;
  if (!ground.locate(place, stop)) return;
  const auto [first, total] = state_->leave_by(stop);
  path.end = PathEnd::kUnreachable;
  if (first == kNoPoint) return;
  const std::vector<FlowPoint>& points = *state_->points;
  ground.way.assign(1, stop);
  for (uint32_t p = first; p != kNoPoint; p = points[p].next) {
    ground.way.push_back(points[p].stop);
    if (points[p].next != kNoPoint) ground.way.push_back(state_->across(points[p]));
  }
  ground.straight.draw(ground.mesh, ground.way);
  ground.give(path);
  path.end = PathEnd::kReached;
}

FlowSummary FlowField::summary() const {
  const size_t count = state_->points->size();
  return {count, count * sizeof(FlowPoint), state_->seconds};
}

}  // namespace throng
