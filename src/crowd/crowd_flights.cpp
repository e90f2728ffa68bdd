// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <mutex>
#include <utility>

#include "core/access.h"
#include "core/parallel.h"
#include "core/random.h"
#include "crowd/crowd_state.h"
#include "path/air/flight_space.h"
#include "steer/air.h"
#include "throng/crowd.h"
#include "world/place.h"

// Flyers of a crowd: when they take off, how they find and follow their paths, and when they are on
// the ground again. docs/design/012-flyers.md. A path costs a search in the air's octree; a step
// without one is constant time.
namespace throng {
namespace {

constexpr double kCheckRange = 3;        // [m] to a waypoint, to test whether the next one is
                                         // visible
constexpr double kAtLink = 0.3;          // [m] from the place of its take-off
constexpr float kTries = 10;             // [s] there, before it gives up
constexpr double kGroundRadius = 0.5;    // [m] from feet to the ground below them
constexpr uint64_t kSightInterval = 16;  // steps
constexpr float kWaits = 2;              // [s] over its landing place, before it takes another
constexpr uint64_t kRooms = 0x726f6f6d;  // random stream
constexpr uint64_t kMaxBoxes = 1 << 16;  // that a search may expand; then it passes over all
                                         // obstacles
constexpr int32_t kPointTolerance = 20;  // [units, mm] so near to a waypoint that the rest does not
                                         // matter

void turn_to(crowd::Body& body, crowd::Flight& flight) {
  const crowd::AirPosition& point = flight.points[flight.next];
  body.local_target_x = point.x;
  body.local_target_z = point.z;
  flight.local_target_y = point.y;
  body.flags = static_cast<uint8_t>(flight.is_last() ? body.flags | crowd::Body::kLast
                                                     : body.flags & ~crowd::Body::kLast);
}

void set_path(crowd::Flight& flight, std::span<const crowd::AirPosition> points, bool lands) {
  flight.count = static_cast<uint8_t>(std::min(points.size(), crowd::Flight::kPoints));
  flight.next = 0;
  flight.whole = points.size() <= crowd::Flight::kPoints ? 1 : 0;
  flight.lands = lands ? 1 : 0;
  std::copy_n(points.begin(), flight.count, flight.points.begin());
}

}  // namespace

Result<void> Crowd::State::open_air(int32_t number, ClassParts& parts, Context& context) const {
  if (!body_class(number).flies || data_of(world)->air == nullptr) return {};
  auto finder = path::FlightFinder::create(
      world, {.avatar_class = number, .workers = config.workers}, context);
  if (!finder) return finder.error();
  parts.flight_finders.assign(static_cast<size_t>(worker_count(config.workers)), *finder);
  parts.flights.resize(parts.flight_finders.size());
  parts.air.emplace(world, parts.flight_finders[0].space(), parts.ground, number);
  return {};
}

bool Crowd::State::put_in_air(crowd::Body& body, const Vec3d& feet) const {
  const crowd::FlyerAir* air = air_of(body);
  if (air == nullptr || !air->in_grid(feet)) return false;
  const crowd::AirPosition position = air->position(feet);
  if (!air->is_legal(position) || flyers.is_obstructed(body, position)) return false;
  body.x = position.x;
  body.z = position.z;
  body.y = position.y;
  body.level = 0;
  body.flags = crowd::Body::kFlying;
  return true;
}

bool Crowd::State::set_goal_of_flyer(crowd::Body& body, const Place& goal) {
  const bool flies = body.has(crowd::Body::kFlying);
  body.flags &= crowd::Body::kFlying;
  crowd::Flight& flight = flights[body.slot];
  flight.waited = 0;
  flight.descends = 0;
  flight.to_link = 0;
  flight.lands = 0;
  flight.count = flight.next = 0;
  const crowd::FlyerAir& air = *air_of(body);
  if (goal.level1 == kAirLevel1) {
    if (!air.in_grid(goal.position)) return false;
    flight.goal = air.position(goal.position);
    flight.goal_level = crowd::Flight::kInAir;
  } else {
    const auto point = world::ground_point(*data_of(world), goal);
    if (!point) return false;
    const crowd::CrowdGround& ground = classes[body.avatar_class]->ground;
    flight.goal = {static_cast<int32_t>(point->x), static_cast<int32_t>(point->z), 0};
    flight.goal_level = goal.level1 - 1;
    flight.goal.y = ground.feet(flight.goal_level, *point);
    routes[body.slot] = {};
    routes[body.slot].goal = {flight.goal.x, flight.goal.z, flight.goal_level};
  }
  body.local_target_x = flight.goal.x;
  body.local_target_z = flight.goal.z;
  flight.local_target_y = flight.goal.y;
  const bool walks = !flies && flight.goal_level != crowd::Flight::kInAir;
  body.flags |= crowd::Body::kHasGoal;
  body.flags |=
      config.routing == Routing::kStraight && walks ? crowd::Body::kLast : crowd::Body::kNeedsPath;
  return true;
}

void Crowd::State::drop_goal(crowd::Body& body) {
  body.flags &= crowd::Body::kFlying;
  const std::lock_guard lock(goal_mutex);
  goal_unreachable.push_back(id_of(body.slot));
}

bool Crowd::State::take_off(crowd::Body& body, crowd::Flight& flight) const {
  const auto high = air_of(body)->take_off(feet_of(body));
  if (!high) return false;
  flight.in_link = 1;
  flight.descends = 0;
  flight.link_low = body.y;
  flight.link_high = *high;
  flight.link_level = body.level;
  flight.rise = 0;
  flight.to_link = 0;
  flight.lands = 0;
  flight.count = flight.next = 0;
  body.detour_angle = 0;
  const bool has_goal = body.has(crowd::Body::kHasGoal);
  body.flags &= crowd::Body::kExternal | crowd::Body::kHasGoal;
  body.flags |= crowd::Body::kFlying;
  if (has_goal) body.flags |= crowd::Body::kNeedsPath;
  return true;
}

bool Crowd::State::plan_on_foot(crowd::Body& body, crowd::Flight& flight, int32_t worker,
                                std::atomic<uint64_t>& planned) {
  if (body.has(crowd::Body::kExternal)) {
    if (flight.preferred_up > 0) take_off(body, flight);
    return true;
  }
  if (flight.to_link != 0 && body.has(crowd::Body::kLast)) {
    const double dx = static_cast<double>(body.local_target_x) - body.x;
    const double dz = static_cast<double>(body.local_target_z) - body.z;
    const double near = kAtLink / unit;
    if (dx * dx + dz * dz < near * near) {
      if (take_off(body, flight)) return true;
      flight.waited += static_cast<float>(config.dt / sub_steps);
      if (flight.waited > kTries) {
        drop_goal(body);
        return true;
      }
    }
  }
  if (!body.has(crowd::Body::kNeedsPath) || body.target != 0) return false;
  const bool is_straight = config.routing == Routing::kStraight;
  const bool lands = flight.goal_level != crowd::Flight::kInAir;
  if (is_straight && lands) return false;
  if (take_off(body, flight)) {
    // Into the air from where it stands, unless it is shorter on foot.
    if (!lands) return true;
    flight.in_link = 0;
    body.flags = crowd::Body::kHasGoal | crowd::Body::kNeedsPath;
  } else if (is_straight) {
    drop_goal(body);
    return true;
  }
  ClassParts& parts = *classes[body.avatar_class];
  const auto w = static_cast<size_t>(worker);
  Path& path = parts.flights[w];
  parts.flight_finders[w].find({.from = parts.air->metres(feet_of(body)),
                                .to = parts.air->metres(flight.goal),
                                .vertical_tolerance = kGroundRadius,
                                .budget = search_budget(kMaxBoxes),
                                .by_turns = false,
                                .nearest = false},
                               path);
  note_spent(path.spent);
  flight.to_link = 0;
  if (lands) routes[body.slot].goal = {flight.goal.x, flight.goal.z, flight.goal_level};
  if (path.end != PathEnd::kReached) return false;  // as a walker
  const auto walked = static_cast<size_t>(
      std::find_if(path.segments.begin(), path.segments.end(),
                   [](SegmentKind segment) { return segment != SegmentKind::kWalk; }) -
      path.segments.begin());
  if (walked == path.segments.size()) return false;
  if (walked == 0 && take_off(body, flight)) {
    planned.fetch_add(1, std::memory_order_relaxed);
    return true;
  }
  const Place ground_air_link =
      world.find_place(body.avatar_class, path.points[walked].position, kGroundRadius);
  if (!ground_air_link) return false;
  routes[body.slot].goal = crowd::point_of(*data_of(world), ground_air_link);
  flight.to_link = 1;
  return false;
}

// Is a straight line clear of all active obstacles?
bool Crowd::State::is_clear_of_obstacles(const crowd::Body& body, const crowd::AirPosition& from,
                                         const crowd::AirPosition& to) const {
  if (!flyers.has_obstacles()) return true;
  const double dx = static_cast<double>(to.x) - from.x, dz = static_cast<double>(to.z) - from.z;
  const double dy = static_cast<double>(to.y) - from.y;
  const double length = std::sqrt((dx * dx + dz * dz) * unit * unit + dy * dy * 1e-6);
  const auto steps = static_cast<int32_t>(length / (body.radius * unit)) + 1;
  for (int32_t i = 1; i <= steps; ++i) {
    const double t = static_cast<double>(i) / steps;
    const crowd::AirPosition position{from.x + static_cast<int32_t>(t * dx),
                                      from.z + static_cast<int32_t>(t * dz),
                                      from.y + static_cast<int32_t>(t * dy)};
    if (flyers.is_blocked(body, position)) return false;
  }
  return true;
}

// Straight up, across, and straight down: no search, but hardly ever short.
bool Crowd::State::find_path_over(const crowd::Body& body, const crowd::AirPosition& from,
                                  const crowd::AirPosition& to,
                                  std::vector<crowd::AirPosition>& points) const {
  constexpr int32_t kRise = 3000;  // [mm] more at each attempt
  const crowd::FlyerAir& air = *air_of(body);
  const auto is_open = [&](const crowd::AirPosition& a, const crowd::AirPosition& b) {
    return air.sees(a, b) && is_clear_of_obstacles(body, a, b);
  };
  const int32_t ceiling = air.ceiling() - 1;
  for (int32_t y = std::max(from.y, to.y);; y = std::min(y + kRise, ceiling)) {
    const crowd::AirPosition up{from.x, from.z, y}, down{to.x, to.z, y};
    if (is_open(from, up) && is_open(up, down) && is_open(down, to)) {
      points.assign({up, down, to});
      return true;
    }
    if (y >= ceiling) return false;
  }
}

// The nearest position beside obstacles that the path finder takes for open, straight on from `at`;
// `at` itself if it is open.
std::optional<crowd::AirPosition> Crowd::State::open_position(const crowd::Body& body,
                                                              const crowd::AirPosition& at,
                                                              int32_t worker) const {
  constexpr int32_t kCells = 2;  // to each side
  const ClassParts& parts = *classes[body.avatar_class];
  const crowd::FlyerAir& air = *parts.air;
  const path::FlightFinder& finder = parts.flight_finders[static_cast<size_t>(worker)];
  if (finder.is_legal(air.metres(at))) return at;
  const int32_t high = finder.space().shape.cell;
  const auto wide = static_cast<int32_t>(high * 1e-3 / unit);
  std::optional<crowd::AirPosition> nearest;
  int32_t min_square = INT32_MAX;
  for (int32_t dy = -kCells; dy <= kCells; ++dy) {
    for (int32_t dz = -kCells; dz <= kCells; ++dz) {
      for (int32_t dx = -kCells; dx <= kCells; ++dx) {
        const int32_t square = dx * dx + dy * dy + dz * dz;
        const crowd::AirPosition there{at.x + dx * wide, at.z + dz * wide, at.y + dy * high};
        if (square >= min_square || there.x < 0 || there.z < 0) continue;
        if (!finder.is_legal(air.metres(there)) || !air.sees(at, there) ||
            !is_clear_of_obstacles(body, at, there)) {
          continue;
        }
        min_square = square;
        nearest = there;
      }
    }
  }
  return nearest;
}

// A path from where a flyer is to its goal. False: there is none.
bool Crowd::State::find_flight(const crowd::Body& body, crowd::Flight& flight,
                               int32_t worker) const {
  ClassParts& parts = *classes[body.avatar_class];
  const crowd::FlyerAir& air = *parts.air;
  crowd::AirPosition from = feet_of(body), to = flight.goal;
  if (flight.in_link != 0) from.y = std::max(from.y, flight.link_high);
  const bool lands = flight.goal_level != crowd::Flight::kInAir;
  const auto high = lands ? air.take_off(to) : std::nullopt;
  if (high) to.y = *high;
  const bool ends_in_air = !lands || high;
  const bool is_straight = config.routing == Routing::kStraight;
  if (ends_in_air &&
      (is_straight || (air.sees(from, to) && is_clear_of_obstacles(body, from, to)))) {
    set_path(flight, std::span(&to, 1), lands);
    return true;
  }
  if (config.routing == Routing::kStraight) return false;
  const auto w = static_cast<size_t>(worker);
  Path& path = parts.flights[w];
  const auto find = [&](const crowd::AirPosition& begin, const crowd::AirPosition& end) {
    parts.flight_finders[w].find({.from = air.metres(begin),
                                  .to = air.metres(end),
                                  .vertical_tolerance = kGroundRadius,
                                  .budget = search_budget(kMaxBoxes),
                                  .by_turns = false,
                                  .nearest = false},
                                 path);
    note_spent(path.spent);
  };
  find(from, flight.goal);
  std::vector<crowd::AirPosition> points;
  std::optional<crowd::AirPosition> end;
  if (path.end == PathEnd::kNoPlace && flyers.has_obstacles()) {
    // Beside an obstacle the feet may be where the finder's whole cell is blocked.
    const auto out = open_position(body, from, worker);
    end = lands ? flight.goal : open_position(body, to, worker);
    if (out && end) find(*out, *end);
    if (out) points.push_back(*out);
  }
  if (path.end == PathEnd::kReached) {
    // The path on foot after the landing is searched for then.
    bool walks_then = false;
    for (size_t i = 0; i < path.segments.size() && !walks_then; ++i) {
      if (path.segments[i] == SegmentKind::kFly)
        points.push_back(air.position(path.points[i + 1].position));
      walks_then = path.segments[i] == SegmentKind::kLand;
    }
    if (end && !lands) points.push_back(to);
    if (points.empty()) points.push_back(from);
    // The finder does not know obstacles that move. If one blocks the path, a path over it may be
    // free.
    std::vector<crowd::AirPosition> over;
    crowd::AirPosition at = from;
    const bool clear =
        std::all_of(points.begin(), points.end(), [&](const crowd::AirPosition& next) {
          const crowd::AirPosition begin = std::exchange(at, next);
          return is_clear_of_obstacles(body, begin, next);
        });
    const bool goes_over = !clear && ends_in_air && find_path_over(body, from, to, over);
    set_path(flight, goes_over ? over : points, lands);
    return true;
  }
  points.clear();
  if (path.end != PathEnd::kBudgetExhausted || !ends_in_air ||
      !find_path_over(body, from, to, points)) {
    return false;
  }
  set_path(flight, points, lands);
  return true;
}

// Others are where it would land: it picks another place, the farther away the longer it has
// waited.
void Crowd::State::find_landing_place(crowd::Body& body, const crowd::Flight& flight) const {
  const crowd::FlyerAir& air = *air_of(body);
  const crowd::AirPosition& over = flight.points[flight.next];
  const auto window = static_cast<uint64_t>(static_cast<double>(step) * config.dt / kWaits);
  const uint64_t side =
      random_below(config.seed ^ kRooms, body.slot, window, steer::kEighths.size());
  const double far = crowd::FlyerEngine::landing_radius(flight) / unit;
  const crowd::AirPosition there{over.x + static_cast<int32_t>(far * steer::kEighths[side][0]),
                                 over.z + static_cast<int32_t>(far * steer::kEighths[side][1]),
                                 over.y};
  const bool sees = there.x >= 0 && there.z >= 0 && air.sees(feet_of(body), there);
  body.local_target_x = sees ? there.x : over.x;
  body.local_target_z = sees ? there.z : over.z;
}

void Crowd::State::plan_flight(crowd::Body& body, crowd::Flight& flight, int32_t worker,
                               std::atomic<uint64_t>& planned) {
  if (body.leaves && plan_exit_in_air(body, flight)) return;
  if (!body.has(crowd::Body::kHasGoal)) return;
  const crowd::FlyerAir& air = *air_of(body);
  const crowd::AirPosition at = feet_of(body);
  if (!body.has(crowd::Body::kNeedsPath) && flight.in_link == 0) {
    const double dx = (static_cast<double>(body.local_target_x) - body.x) * unit;
    const double dz = (static_cast<double>(body.local_target_z) - body.z) * unit;
    const double dy = (static_cast<double>(flight.local_target_y) - body.y) * 1e-3;
    const bool is_near = dx * dx + dy * dy + dz * dz < kCheckRange * kCheckRange;
    if (is_near && !flight.is_last()) {
      const bool at_end = flight.next + 1 == flight.count;
      const crowd::AirPosition& local_target = flight.points[flight.next];
      const bool there = std::abs(local_target.x - at.x) < kPointTolerance &&
                         std::abs(local_target.z - at.z) < kPointTolerance &&
                         std::abs(local_target.y - at.y) < kPointTolerance;
      if (at_end) {
        if (there || dx * dx + dy * dy + dz * dz < 1) body.flags |= crowd::Body::kNeedsPath;
      } else if (there || (air.sees(at, flight.points[flight.next + 1u]) &&
                           is_clear_of_obstacles(body, at, flight.points[flight.next + 1u]))) {
        ++flight.next;
        turn_to(body, flight);
      }
    }
    const bool checks_path = (sub_step + body.slot) % kSightInterval == 0;
    if (checks_path && config.routing == Routing::kPaths) {
      const crowd::AirPosition& local_target = flight.points[flight.next];
      if (!air.sees(at, local_target) || !is_clear_of_obstacles(body, at, local_target))
        body.flags |= crowd::Body::kNeedsPath;
    }
    if (flight.lands != 0 && flight.is_last() && flight.waited > kWaits)
      find_landing_place(body, flight);
  }
  if (!body.has(crowd::Body::kNeedsPath)) return;
  planned.fetch_add(1, std::memory_order_relaxed);
  if (body.target != 0) {
    // The nearest place of its target, in a straight line.
    const auto& places = classes[body.avatar_class]->landings[body.target - 1u];
    double min_square = HUGE_VAL;
    for (const Place& place : places) {
      const crowd::AirPosition position = air.position(place.position);
      const double dx = static_cast<double>(position.x) - at.x,
                   dz = static_cast<double>(position.z) - at.z;
      const double dy = (static_cast<double>(position.y) - at.y) * 1e-3 / unit;
      const double square = dx * dx + dy * dy + dz * dz;
      if (square >= min_square) continue;
      min_square = square;
      flight.goal = position;
      flight.goal_level = place.level1 - 1;
    }
    if (places.empty()) return drop_goal(body);
  }
  if (!find_flight(body, flight, worker)) return drop_goal(body);
  body.flags &= static_cast<uint8_t>(~crowd::Body::kNeedsPath);
  turn_to(body, flight);
}

// The step of flyers in the air, after that of walkers.
void Crowd::State::fly(crowd::EngineCounts& counts, crowd::EngineTimes& times,
                       std::atomic<uint64_t>& planned) {
  const crowd::FlyerEngine::Before before = [&](crowd::Body& body, crowd::Flight& flight,
                                                int32_t worker) {
    plan_flight(body, flight, worker, planned);
  };
  flyers.step(sub_step, engine.bodies(), flights, before, counts, times);
  for (const uint32_t slot : flyers.arrived()) arrived.push_back(id_of(slot));
  for (const uint32_t i : flyers.landed()) {
    crowd::Body& body = engine.bodies()[i];
    crowd::Flight& flight = flights[body.slot];
    body.level = flight.link_level;
    body.velocity = {};
    body.detour_angle = 0;
    flight.in_link = 0;
    flight.descends = 0;
    flight.lands = 0;
    flight.rise = 0;
    const bool has_goal = body.has(crowd::Body::kHasGoal);
    body.flags &= crowd::Body::kExternal | crowd::Body::kHasGoal;
    if (!has_goal) continue;
    const bool is_straight = config.routing == Routing::kStraight;
    body.flags |= is_straight ? crowd::Body::kLast : crowd::Body::kNeedsPath;
    body.local_target_x = flight.goal.x;
    body.local_target_z = flight.goal.z;
  }
}

void Crowd::State::add_flyer_blockers(std::span<const uint32_t> slots,
                                      std::vector<std::pair<uint32_t, uint32_t>>& found) const {
  const Vec3d& origin = data_of(world)->summary.origin;
  crowd::ObstacleGrid passed(unit);
  for (const uint32_t slot : slots) {
    const crowd::CrowdObstacle& obstacle = obstacles.all()[slot];
    if (!obstacle.waits()) continue;
    const Prism& prism =
        obstacle.is_up ? crowd::hull_of(obstacle.place, obstacle.wanted) : obstacle.wanted;
    passed.set(slot, crowd::AirObstacle(prism, origin, unit), {});
  }
  if (passed.is_empty()) return;
  const std::span<const crowd::Body> bodies = engine.bodies();
  std::vector<const crowd::ObstacleGrid::Item*> near;
  for (uint32_t i = 0; i < bodies.size(); ++i) {
    const crowd::Body& body = bodies[i];
    if (!body.has(crowd::Body::kFlying)) continue;
    const double radius = body.climbs ? body.radius * unit : body_class(body.avatar_class).radius;
    passed.list_near(feet_of(body), radius, near);
    for (const crowd::ObstacleGrid::Item* obstacle : near) {
      if (obstacle->shape.holds(feet_of(body), radius, body.height)) {
        found.emplace_back(obstacle->slot, i);
      }
    }
  }
  std::sort(found.begin(), found.end());
}

void Crowd::State::update_obstacle_grid() {
  const Vec3d& origin = data_of(world)->summary.origin;
  for (const uint32_t slot : obstacles.take_changed()) {
    const crowd::CrowdObstacle& obstacle = obstacles.at(slot);
    if (!obstacle.exists || !obstacle.has_cells) {
      obstacle_grid.erase(slot);
      continue;
    }
    obstacle_grid.set(slot, crowd::AirObstacle(obstacle.place, origin, unit, obstacle.closes()),
                      {obstacle.place, {}});
  }
}

}  // namespace throng
