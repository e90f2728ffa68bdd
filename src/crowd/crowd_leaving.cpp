// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/access.h"
#include "crowd/crowd_state.h"
#include "crowd/ground/leaving_ground.h"
#include "throng/crowd.h"
#include "world/place.h"
#include "world/tile_grid.h"

// Avatars that are in an obstacle when it closes leave it: along their paths if these lead out
// soon, else by the shortest exit. Which moves are allowed, StrideGround::move and the other
// engines' is_blocked decide. docs/design/008-engine.md, "Obstacles".
namespace throng {
namespace {

constexpr double kMaxDetourFactor = 2;    // times the shortest exit, for a path that leads out
constexpr double kMaxPath = 2;            // [m] more than that
constexpr float kMaxDetourAngle = 0.4f;   // [radians] of a detour, before one gives its path up
constexpr uint64_t kMaxExitNodes = 8000;  // crossings that a search for an exit may expand
constexpr uint64_t kExitInterval = 4;     // steps of one that finds no exit
constexpr std::array<double, 4> kSearchRadii = {1, 2, 4, 8};  // [m] to a node's free place

// Of any height.
crowd::AirObstacle column_of(const Prism& prism, const Vec3d& origin, double unit) {
  constexpr double kHigh = 1e5;  // [m]
  return {{prism.corners, -kHigh, kHigh}, origin, unit};
}

}  // namespace

bool Crowd::State::is_occupied(uint32_t slot,
                               std::span<const std::pair<uint32_t, uint32_t>> found) const {
  const Prism& prism = obstacles.all()[slot].wanted;
  const crowd::AirObstacle solid(prism, data_of(world)->summary.origin, unit);
  return std::any_of(found.begin(), found.end(), [&](const auto& pair) {
    const crowd::Body& body = engine.bodies()[pair.second];
    const AvatarClass& avatar = body_class(body.avatar_class);
    if (body.climbs) {
      const crowd::Climb& climb = climbs[body.slot];
      return climbers.meets_obstacle(*classes[body.avatar_class]->nodes,
                                     {feet_of(body), body.radius, body.height},
                                     {climb.feet, climb.axis}, climb.radius, solid, {prism, {}});
    }
    crowd::AirPosition feet = feet_of(body);
    int32_t height = body.height;
    if (!body.has(crowd::Body::kFlying)) {
      const auto bottom = static_cast<int32_t>(std::floor(body_bottom(avatar) * 1000));
      feet.y += bottom;
      height -= bottom;
    }
    return solid.holds(feet, avatar.radius, height);
  });
}

void Crowd::State::mark_leaving(std::span<const std::pair<uint32_t, uint32_t>> found, bool all) {
  std::vector<std::pair<uint32_t, uint32_t>> by_body;  // index, obstacle
  for (const auto& pair : found) {
    const bool is_climber = engine.bodies()[pair.second].climbs;
    if (!is_climber || is_occupied(pair.first, {&pair, 1}))
      by_body.emplace_back(pair.second, pair.first);
  }
  std::sort(by_body.begin(), by_body.end());
  if (all && some_leave) {
    for (uint32_t i = 0; i < engine.bodies().size(); ++i) {
      crowd::Body& body = engine.bodies()[i];
      if (!body.leaves) continue;
      const auto at = std::lower_bound(by_body.begin(), by_body.end(), std::pair(i, uint32_t{0}));
      if (at == by_body.end() || at->first != i) end_leaving(body);
    }
  }
  some_leave = !by_body.empty() || (!all && some_leave);
  std::vector<uint32_t> slots;
  for (size_t n = 0; n < by_body.size();) {
    crowd::Body& body = engine.bodies()[by_body[n].first];
    slots.clear();
    for (const uint32_t i = by_body[n].first; n < by_body.size() && by_body[n].first == i; ++n) {
      slots.push_back(by_body[n].second);
    }
    if (!body.leaves) begin_to_leave(body, slots);
  }
}

void Crowd::State::begin_to_leave(crowd::Body& body, std::span<const uint32_t> slots) {
  body.leaves = true;
  body.clear(crowd::Body::kContinues);
  body.detour_angle = 0;
  constexpr uint8_t kAll = crowd::Body::kHasGoal | crowd::Body::kExternal | crowd::Body::kArrived |
                           crowd::Body::kNeedsPath;
  if ((body.flags & kAll) != crowd::Body::kHasGoal || body.climbs) return;
  if (!leads_out(body, slots)) body.flags |= crowd::Body::kNeedsPath;
}

// Does its path lead out of obstacles soon, and never back?
bool Crowd::State::leads_out(const crowd::Body& body, std::span<const uint32_t> slots) const {
  const Vec3d& origin = data_of(world)->summary.origin;
  std::vector<crowd::AirObstacle> columns;
  for (const uint32_t slot : slots) {
    columns.push_back(column_of(obstacles.all()[slot].wanted, origin, unit));
  }
  const double radius = body_class(body.avatar_class).radius;
  std::vector<std::pair<double, double>> points;  // [units]
  const auto add = [&](int32_t x, int32_t z) { points.emplace_back(x, z); };
  if (body.flies()) {
    const crowd::Flight& flight = flights[body.slot];
    for (size_t i = flight.next; i < flight.count; ++i) add(flight.points[i].x, flight.points[i].z);
  } else if (config.routing == Routing::kStraight) {
    add(body.local_target_x, body.local_target_z);
  } else {
    const crowd::Route& route = routes[body.slot];
    for (size_t i = route.next; i < route.count; ++i) add(route.corners[i].x, route.corners[i].z);
  }
  const crowd::CrowdGround& ground = classes[body.avatar_class]->ground;
  const uint16_t steps =
      body.flies() ? uint16_t{0}
                   : ground.left().steps_out({body.level, world::in_tile(body.point().cell_x()),
                                              world::in_tile(body.point().cell_z())});
  const double least =
      steps == crowd::LeftCells::kNone ? HUGE_VAL : steps * data_of(world)->summary.cell;
  const double limit = (kMaxDetourFactor * least + kMaxPath) / unit;
  const double step_size = radius / 2 / unit;
  double walked = 0, x = body.x, z = body.z;
  bool is_out = false;
  for (const auto& [to_x, to_z] : points) {
    const double dx = to_x - x, dz = to_z - z, size = std::sqrt(dx * dx + dz * dz);
    const auto count = static_cast<int64_t>(size / step_size) + 1;
    for (int64_t i = 1; i <= count; ++i) {
      const double part = static_cast<double>(i) / static_cast<double>(count);
      const crowd::AirPosition position{static_cast<int32_t>(x + part * dx),
                                        static_cast<int32_t>(z + part * dz), 0};
      const bool is_inside = std::any_of(
          columns.begin(), columns.end(),
          [&](const crowd::AirObstacle& column) { return column.holds(position, radius, 1); });
      if (is_out && is_inside) return false;
      is_out = is_out || !is_inside;
      if (!is_out && walked + part * size > limit) return false;
    }
    walked += size;
    x = to_x;
    z = to_z;
  }
  return is_out;
}

void Crowd::State::end_leaving(crowd::Body& body) {
  body.leaves = false;
  if (body.has(crowd::Body::kExternal)) return;
  if (body.climbs) {
    crowd::Climb& climb = climbs[body.slot];
    const bool rests = !body.has(crowd::Body::kHasGoal) || body.has(crowd::Body::kArrived);
    if (!rests || !climb.is_on_ground()) return;
    climb.count = 0;
    climb.at.next = 0;
    climb.whole = body.has(crowd::Body::kArrived) ? 1 : 0;
    return;
  }
  if (!body.has(crowd::Body::kHasGoal)) return;
  if (body.has(crowd::Body::kArrived)) {  // It stays where it is now.
    body.flags |= crowd::Body::kLast;
    body.local_target_x = body.x;
    body.local_target_z = body.z;
    if (body.flies()) flights[body.slot].local_target_y = body.y;
    return;
  }
  const bool walks_straight = config.routing == Routing::kStraight && !body.flies();
  if (!walks_straight || !body.has(crowd::Body::kNeedsPath)) return;  // It needs a path.
  crowd::PathPoint goal = routes[body.slot].goal;
  if (air_of(body) != nullptr) {
    const crowd::Flight& flight = flights[body.slot];
    if (flight.goal_level == crowd::Flight::kInAir) return;
    goal = {flight.goal.x, flight.goal.z, flight.goal_level};
  }
  body.local_target_x = goal.x;
  body.local_target_z = goal.z;
  body.clear(crowd::Body::kNeedsPath);
  body.flags |= crowd::Body::kLast;
}

// Does it take its path again, since it makes no progress towards the nearest exit either?
bool Crowd::State::tries_path_again(crowd::Body& body) const {
  constexpr uint8_t kAll = crowd::Body::kHasGoal | crowd::Body::kArrived | crowd::Body::kNeedsPath;
  if ((body.flags & kAll) != (crowd::Body::kHasGoal | crowd::Body::kNeedsPath)) return false;
  const crowd::Route& route = routes[body.slot];
  if (std::fabs(body.detour_angle) <= kMaxDetourAngle || route.next >= route.count) return false;
  body.detour_angle = 0;
  std::vector<uint32_t> slots;
  const world::GroundPoint at = body.point();
  classes[body.avatar_class]->ground.left().list_obstacles(
      {body.level, world::in_tile(at.cell_x()), world::in_tile(at.cell_z())}, slots);
  if (slots.empty() || !leads_out(body, slots)) return false;
  const crowd::PathPoint& corner = route.corners[route.next];
  body.local_target_x = corner.x;
  body.local_target_z = corner.z;
  body.clear(crowd::Body::kNeedsPath);
  if (route.whole && route.next + 1 == route.count) body.flags |= crowd::Body::kLast;
  return true;
}

void Crowd::State::plan_exit(crowd::Body& body) {
  if (body.has(crowd::Body::kExternal)) return;
  const crowd::CrowdGround& cells = classes[body.avatar_class]->ground;
  const int32_t step_height = world::step_mm(body_class(body.avatar_class));
  const crowd::StrideGround ground(cells, step_height);
  const bool has_path = body.has(crowd::Body::kHasGoal) && !body.has(crowd::Body::kArrived) &&
                        !body.has(crowd::Body::kNeedsPath);
  if (has_path) {
    if (config.routing == Routing::kPaths && !body.has(crowd::Body::kContinues)) {
      const uint64_t nth = (sub_step - 1 + body.slot) / engine.steps_of_reaction(body);
      crowd::follow(body, routes[body.slot], ground, nth, static_cast<float>(1 / unit));
    }
    if (std::fabs(body.detour_angle) > kMaxDetourAngle) {
      body.flags |= crowd::Body::kNeedsPath;
      body.detour_angle = 0;
    }
    if (!body.has(crowd::Body::kNeedsPath)) return;
  } else if (tries_path_again(body)) {
    return;
  }
  body.clear(crowd::Body::kLast);
  body.clear(crowd::Body::kContinues);
  const world::GroundPoint from = body.point();
  if (!crowd::is_leaving(cells, body.level, from.cell_x(), from.cell_z())) return;  // It is out.
  body.local_target_x = body.x;
  body.local_target_z = body.z;
  constexpr int32_t kHalf = world::kUnitsPerCell / 2;
  for (uint32_t max_steps = cells.left().steps_out(
           {body.level, world::in_tile(from.cell_x()), world::in_tile(from.cell_z())});
       max_steps > 0 && max_steps != crowd::LeftCells::kNone; max_steps /= 2) {
    uint32_t level = body.level;
    int32_t x = from.cell_x(), z = from.cell_z();
    if (!crowd::find_exit(cells, step_height, max_steps, level, x, z)) return;
    const world::GroundPoint to{(int64_t{x} << world::kUnitBits) + kHalf,
                                (int64_t{z} << world::kUnitBits) + kHalf};
    if (max_steps > 1 && !ground.sees(body.level, from, to, level, HUGE_VALF)) continue;
    body.local_target_x = static_cast<int32_t>(to.x);
    body.local_target_z = static_cast<int32_t>(to.z);
    return;
  }
}

bool Crowd::State::plan_exit_in_air(crowd::Body& body, crowd::Flight& flight) const {
  if (body.has(crowd::Body::kExternal)) return false;
  if (flight.in_link != 0) {
    flight.descends = 0;  // It may not stand there.
    return true;
  }
  const bool has_path = body.has(crowd::Body::kHasGoal) && !body.has(crowd::Body::kArrived) &&
                        !body.has(crowd::Body::kNeedsPath);
  if (has_path && std::fabs(body.detour_angle) <= kMaxDetourAngle) return false;
  if (has_path) body.flags |= crowd::Body::kNeedsPath;
  const crowd::FlyerAir& air = *air_of(body);
  const crowd::AirPosition at = feet_of(body);
  body.clear(crowd::Body::kLast);
  body.local_target_x = body.x;
  body.local_target_z = body.z;
  flight.local_target_y = body.y;
  std::vector<crowd::AirPosition> exits;
  flyers.list_exits(body, exits);
  double least = HUGE_VAL;
  for (const crowd::AirPosition& exit : exits) {
    const double dx = (static_cast<double>(exit.x) - at.x) * unit;
    const double dz = (static_cast<double>(exit.z) - at.z) * unit;
    const double dy = (static_cast<double>(exit.y) - at.y) * 1e-3;
    const double square = dx * dx + dy * dy + dz * dz;
    if (square >= least || !air.is_legal(exit) || !air.sees(at, exit)) continue;
    if (flyers.is_obstructed(body, exit) || !is_clear_of_obstacles(body, at, exit)) continue;
    least = square;
    body.local_target_x = exit.x;
    body.local_target_z = exit.z;
    flight.local_target_y = exit.y;
  }
  return true;
}

bool Crowd::State::plan_exit_on_nodes(crowd::Body& body, crowd::Climb& climb, int32_t worker) {
  if (!climb.is_on_ground()) return false;
  const bool rests = !body.has(crowd::Body::kHasGoal) || body.has(crowd::Body::kArrived);
  const bool goes = climb.count > 0 && climb.at.next < climb.count;
  if (!rests && goes && !body.has(crowd::Body::kNeedsPath)) return false;  // on along its path
  if (rests && goes && climb.whole == 0) return true;                      // on its exit
  if ((sub_step + body.slot) % kExitInterval != 0) return true;
  for (const double search_radius : kSearchRadii) {
    if (step_aside(body, climb, worker, search_radius)) return true;
  }
  return find_exit_over_nodes(body, climb, worker);
}

// To the nearest place that is left, by a finder that does not mind what closes around it.
bool Crowd::State::find_exit_over_nodes(crowd::Body& body, crowd::Climb& climb, int32_t worker) {
  ClassParts& parts = *classes[body.avatar_class];
  const auto w = static_cast<size_t>(worker);
  path::NodeFinder& finder = parts.node_finders[w];
  NodePlace to;
  for (size_t i = 0; i < kSearchRadii.size() && !to; ++i) {
    to = finder.find_place(climb.feet, kSearchRadii[i]);
  }
  const NodePlace from =
      config.nodes.place(body.avatar_class, climb.at.node1 - 1, climb.at.s, climb.at.t);
  if (!to || !from) return true;
  const Vec3d& origin = data_of(world)->summary.origin;
  const auto let_through = [&](bool lets) {
    for (const uint32_t slot : obstacles.waiting()) {  // One that closes waits.
      const crowd::CrowdObstacle& obstacle = obstacles.all()[slot];
      if (!obstacle.closes()) continue;
      const crowd::AirObstacle solid(obstacle.place, origin, unit);
      const bool is_in = climbers.meets_obstacle(
          *parts.nodes, {feet_of(body), body.radius, body.height}, {climb.feet, climb.axis},
          climb.radius, solid, {obstacle.place, {}});
      if (is_in) finder.set_active(obstacle.of_class[body.avatar_class].node_change, !lets);
    }
  };
  Path& path = parts.node_paths[w];
  let_through(true);
  finder.find(from, to, path, kNoSpacing, kMaxExitNodes);
  let_through(false);
  if (path.end != PathEnd::kReached || path.points.size() < 2) return true;
  take_path(climb, path);
  climb.whole = 0;
  body.clear(crowd::Body::kNeedsPath);
  return true;
}

}  // namespace throng
