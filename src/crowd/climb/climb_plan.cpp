// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <utility>

#include "core/random.h"
#include "crowd/climb/climb_mode.h"
#include "crowd/climb/climb_path.h"

// How climbers find and follow their paths. A path costs a search over nodes; a step without one is
// constant time.
namespace throng::crowd {
namespace {

constexpr double kNoSpacing = 1e9;         // [m] points of a path only at its corners
constexpr float kMin = 1;                  // [s] of a path that does not lead to the goal
constexpr float kExternal = 0.5f;          // [s] for which one that is externally controlled plans
                                           // ahead
constexpr uint64_t kDetours = 0x6465746f;  // random stream
constexpr double kMinRoomySide = 2;        // [m] of a node in which a body can step aside
constexpr double kSearchMargin = 1;        // [m] more than a square of a node
constexpr uint64_t kDetourBudget = 8000;   // crossings that a search for a detour may expand

}  // namespace

NodePlace ClimbMode::place_of(const Body& body, const Climb& climb) const {
  return shared_.config.nodes.place(body.avatar_class, climb.at.node1 - 1, climb.at.s, climb.at.t);
}

// The nearest place of its target, in a straight line.
void ClimbMode::head_to_target_place(const Body& body, Climb& climb) const {
  const auto& places = shared_.classes[body.avatar_class]->landings[body.target - 1u];
  double min_distance = HUGE_VAL;
  const Place* nearest = nullptr;
  for (const Place& place : places) {
    const double far = length(place.position - climb.feet);
    if (far >= min_distance) continue;
    min_distance = far;
    nearest = &place;
  }
  const NodePlace goal = nearest == nullptr ? NodePlace{} : place_near(body.avatar_class, *nearest);
  climb.goal_node1 = goal.node1;
  climb.goal_s = goal.s;
  climb.goal_t = goal.t;
}

// To another place for a while: a new path alone often meets the others again.
void ClimbMode::turn_aside(Body& body, Climb& climb, int32_t worker) {
  OfClass& parts = of(body);
  const auto w = static_cast<size_t>(worker);
  const uint64_t stream = uint64_t{body.slot} << 2, seed = shared_.config.seed ^ kDetours;
  climb.turns_aside = 0;
  climb.detour = kMin + static_cast<float>(random_below(seed, stream, shared_.sub_step, 40)) * 0.1f;
  body.clear(Body::kNeedsPath);
  const NodePlace from = place_of(body, climb);
  Path& path = parts.paths[w];
  path.points.clear();
  // Either to a random place of the graph, or to one of the same node.
  const NodeInfo info = shared_.config.nodes.node(climb.at.node1 - 1);
  const bool is_roomy = info.cells == 0 && info.area > kMinRoomySide * kMinRoomySide;
  if (!is_roomy || random_below(seed, stream | 1, shared_.sub_step, 2) == 0) {
    const NodePlace to = shared_.config.nodes.random_place(
        body.avatar_class, seed, random_u64(seed, stream | 2, shared_.sub_step));
    parts.finders[w].find(from, to, path, kNoSpacing, shared_.search_budget(kDetourBudget));
  }
  if (path.points.size() < 2) {
    const double side = 1.0 / (1 << info.block_level);
    path::NodeSquare square{info.s * side, info.t * side, (info.s + 1) * side, (info.t + 1) * side};
    if (info.cells != 0) {
      square = parts.finders[w]
                   .square(climb.at.node1 - 1, climb.at.s, climb.at.t, climb.at.s, climb.at.t)
                   .value_or(path::NodeSquare{climb.at.s, climb.at.t, climb.at.s, climb.at.t});
    }
    const auto within = [&](double low, double high, uint64_t draw) {
      return low + random_unit(seed, stream | 2, draw) * (high - low);
    };
    const NodePlace to = shared_.config.nodes.place(
        body.avatar_class, climb.at.node1 - 1, within(square.s0, square.s1, 2 * shared_.sub_step),
        within(square.t0, square.t1, 2 * shared_.sub_step + 1));
    set_segment(path, from, to);
  }
  take_path(climb, path);
  climb.whole = 0;
}

// An obstacle that came up beside it, or an area that was closed, blocks a whole square of its node
// for its finder: on to the nearest place of it that is left.
bool ClimbMode::step_aside(Body& body, Climb& climb, int32_t worker, double beside) {
  OfClass& parts = of(body);
  const auto w = static_cast<size_t>(worker);
  const NodePlace from = place_of(body, climb);
  const bool is_as_baked =
      shared_.obstacles.all().empty() && !shared_.edits().has_costs(path::EditList::kNoKinds);
  if (is_as_baked || !from) return false;
  const NodePlace to = parts.finders[w].find_place(climb.feet, beside);
  if (to.node1 != from.node1 || to.feet == from.feet) return false;
  Path& path = parts.paths[w];
  set_segment(path, from, to);
  take_path(climb, path);
  climb.whole = 0;
  body.clear(Body::kNeedsPath);
  return true;
}

// An externally controlled climber heads to where it would be soon, by a path as any other.
void ClimbMode::follow_velocity(const Body& body, Climb& climb, int32_t worker) {
  climb.detour -= shared_.sub_dt();
  if (!climb.is_on_ground() || (climb.detour > 0 && climb.at.next < climb.count)) return;
  OfClass& parts = of(body);
  const auto w = static_cast<size_t>(worker);
  const Vec3d displacement{climb.external[0], climb.external[1], climb.external[2]};
  climb.detour = kExternal;
  const double far = length(displacement) * 2 * kExternal;
  if (!(far > 0)) return clear_path(climb);
  const NodePlace to =
      parts.finders[w].find_place(climb.feet + displacement * (2 * kExternal), far);
  const NodePlace from = place_of(body, climb);
  if (!to || !from) return clear_path(climb);
  Path& path = parts.paths[w];
  parts.finders[w].find(from, to, path, kNoSpacing, shared_.search_budget(kDetourBudget));
  // A long detour does not lead in the direction that it is given.
  if (path.end != PathEnd::kReached || path.length > 3 * far) return clear_path(climb);
  take_path(climb, path);
  climb.whole = 0;
}

void ClimbMode::plan(Body& body, Climb& climb, int32_t worker) {
  if (body.has(Body::kExternal)) return follow_velocity(body, climb, worker);
  if (body.leaves && plan_exit(body, climb, worker)) return;
  if (!body.has(Body::kHasGoal)) return;
  if (climb.detour > 0) {
    climb.detour -= shared_.sub_dt();
    if (climb.detour <= 0) body.flags |= Body::kNeedsPath;
  }
  const bool used_up = climb.whole == 0 && of(body).ground.is_at_end(climb);
  if (used_up) {
    body.flags |= Body::kNeedsPath;
    climb.station += climb.to_station;
    climb.to_station = 0;
  }
  if (!climb.is_on_ground()) return;
  if (climb.turns_aside != 0) return turn_aside(body, climb, worker);
  if (body.has(Body::kNeedsPath)) search(body, climb, worker);
}

// A path to its next station or to its goal.
void ClimbMode::search(Body& body, Climb& climb, int32_t worker) {
  shared_.note_planned();
  climb.detour = 0;
  if (body.target != 0) head_to_target_place(body, climb);
  OfClass& parts = of(body);
  const auto w = static_cast<size_t>(worker);
  Path& path = parts.paths[w];
  path.end = PathEnd::kNoPlace;
  const Nodes& nodes = shared_.config.nodes;
  const NodePlace from = place_of(body, climb);
  const auto is_found = [&] { return path.end == PathEnd::kReached && path.points.size() >= 2; };
  if (climb.station < climb.station_count) {
    const ClimbPoint& station = climb.stations[climb.station];
    const NodePlace to = nodes.place(body.avatar_class, station.node1 - 1, station.s, station.t);
    parts.finders[w].find(from, to, path, kNoSpacing, shared_.search_budget());
    shared_.note_spent(path.spent);
    if (is_found()) {
      take_path(climb, path);
      climb.to_station = std::exchange(climb.whole, uint8_t{0});
      return body.clear(Body::kNeedsPath);
    }
  }
  if (climb.goal_node1 != 0) {
    const NodePlace to =
        nodes.place(body.avatar_class, climb.goal_node1 - 1, climb.goal_s, climb.goal_t);
    parts.finders[w].find(from, to, path, kNoSpacing, shared_.search_budget());
    shared_.note_spent(path.spent);
  }
  if (!is_found()) {
    if (path.end == PathEnd::kNoPlace && step_aside(body, climb, worker, kSearchMargin)) return;
    clear_path(climb);
    return shared_.drop_goal(body);
  }
  take_path(climb, path);
  set_stations(climb, path);
  body.clear(Body::kNeedsPath);
}

}  // namespace throng::crowd
