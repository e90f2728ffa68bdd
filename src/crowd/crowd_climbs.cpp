// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <utility>

#include "core/access.h"
#include "core/parallel.h"
#include "core/random.h"
#include "crowd/crowd_state.h"
#include "throng/crowd.h"

// Climbers of a crowd: where they are placed, and how they find and follow their paths.
// docs/design/013-climbers.md. A path costs a search over nodes; a step without one is constant
// time.
namespace throng {
namespace {

constexpr double kNodeRadius = 0.5;        // [m] from a place to the place on nodes that it stands
                                           // for
constexpr float kMin = 1;                  // [s] of a path that does not lead to the goal
constexpr float kExternal = 0.5f;          // [s] for which one that is externally controlled plans
                                           // ahead
constexpr uint64_t kDetours = 0x6465746f;  // random stream
constexpr uint64_t kPlaces = 0x706c6163;   // random stream
constexpr double kRoomy = 2;               // [m] of a node in which a body can step aside
constexpr double kSearchMargin = 1;        // [m] more than a square of a node
constexpr uint64_t kFew = 8000;            // crossings that a search for a detour may expand

crowd::ClimbPoint point_of(const Path& path, size_t i, bool drops) {
  const NodePlace& place = path.node_places[i];
  const bool on_surface = i == 0 || path.segments[i - 1] == SegmentKind::kWalk;
  crowd::ClimbPoint made;
  made.node1 = place.node1;
  made.s = made.node1 != 0 ? place.s : place.feet.y;
  made.t = made.node1 != 0 ? place.t : 0;
  made.on_surface = on_surface && made.node1 != 0 ? 1 : 0;
  made.drops = drops ? 1 : 0;
  return made;
}

// One segment over one node, or only its start if there is no end.
void set_segment(Path& path, const NodePlace& from, const NodePlace& to) {
  path.points.assign(1, {from.feet});
  path.node_places.assign(1, from);
  path.segments.clear();
  if (!to) return;
  path.points.push_back({to.feet});
  path.node_places.push_back(to);
  path.segments.push_back(SegmentKind::kWalk);
}

// Where the rest of a path leads that does not fit: without its end, which is the goal.
void set_stations(crowd::Climb& climb, const Path& path) {
  climb.station = climb.station_count = 0;
  const size_t first = climb.count, all = path.points.size();
  size_t next = first;
  for (size_t k = 0; k < crowd::Climb::kStations; ++k) {
    size_t i =
        std::max(next, first + (all - 1 - std::min(first, all - 1)) * k / crowd::Climb::kStations);
    while (i < all && !path.node_places[i]) ++i;
    if (i + 1 >= all) return;
    climb.stations[climb.station_count++] = point_of(path, i, false);
    next = i + 1;
  }
}

// The body stays where it is.
void clear_path(crowd::Climb& climb) {
  const crowd::ClimbStance at = climb.at;
  climb.count = 0;
  climb.whole = 0;
  climb.to_station = 0;
  climb.at = {};
  climb.at.s = at.s;
  climb.at.t = at.t;
  climb.at.node1 = at.node1;
}

}  // namespace

// As much of a path as fits: it ends on the ground.
void Crowd::State::take_path(crowd::Climb& climb, const Path& path) {
  const size_t all = path.points.size();
  size_t count = std::min(all, crowd::Climb::kPoints);
  while (count > 0 && !path.node_places[count - 1]) --count;
  for (size_t i = 0; i < count; ++i) {
    const bool falls = !path.node_places[i] || (i > 0 && !path.node_places[i - 1]);
    climb.points[i] = point_of(path, i, falls);
  }
  climb.count = static_cast<uint8_t>(count);
  climb.whole = count == all ? 1 : 0;
  climb.to_station = 0;
  climb.at.s = climb.points[0].s;
  climb.at.t = climb.points[0].t;
  climb.at.node1 = climb.points[0].node1;
  climb.at.part = 0;
  climb.at.next = 1;
  climb.at.in_air = count > 1 && climb.points[1].on_surface == 0 ? 1 : 0;
}

bool Crowd::State::is_climber_class(int32_t number) const {
  const AvatarClass& avatar = body_class(number);
  return data_of(config.nodes) != nullptr && !avatar.flies && throng::goes_over_nodes(avatar);
}

Result<void> Crowd::State::open_nodes(int32_t number, ClassParts& parts, Context& context) const {
  auto finder = path::NodeFinder::create(
      config.nodes,
      {.avatar_class = number, .slope_cost = config.slope_cost, .workers = config.workers},
      context);
  if (!finder) return finder.error();
  parts.node_finders.assign(static_cast<size_t>(worker_count(config.workers)), *finder);
  parts.node_paths.resize(parts.node_finders.size());
  parts.nodes.emplace(world, config.nodes, parts.node_finders[0], number);
  return {};
}

bool Crowd::State::put_on_nodes(crowd::Body& body, crowd::Climb& climb, const NodePlace& place,
                                double radius) const {
  const crowd::ClimberGround& ground = *classes[body.avatar_class]->nodes;
  const auto pose = ground.pose(place.node1, place.s, place.t);
  const auto cylinder = pose ? ground.cylinder_of(*pose, radius) : std::nullopt;
  if (!cylinder || climbers.is_blocked(ground, *cylinder, *pose, radius)) return false;
  climb = {};
  climb.at.node1 = place.node1;
  climb.at.s = place.s;
  climb.at.t = place.t;
  climb.feet = pose->feet;
  climb.axis = pose->axis;
  climb.radius = radius;
  body.x = cylinder->low.x;
  body.z = cylinder->low.z;
  body.y = cylinder->low.y;
  body.radius = cylinder->radius;
  body.height = static_cast<uint16_t>(cylinder->height);
  body.level = 0;
  body.flags = crowd::Body::kFlying;
  body.climbs = true;
  return true;
}

// Climbers whose paths cross what became active need another path.
void Crowd::State::cut_climbs(std::span<const uint32_t> slots) {
  for (crowd::Body& body : engine.bodies()) {
    if (!body.climbs || !body.has(crowd::Body::kHasGoal) || body.has(crowd::Body::kNeedsPath) ||
        body.leaves)
      continue;
    const crowd::Climb& climb = climbs[body.slot];
    const crowd::ClimberGround& ground = *classes[body.avatar_class]->nodes;
    path::BodyRoom around;  // all that it occupies, whichever direction it faces
    around.turns_far = true;
    around.top = body_class(body.avatar_class).height;
    around.radius = climb.radius;
    bool is_cut = false;
    Vec3d last = climb.feet;
    for (size_t i = climb.at.next; i < climb.count && !is_cut; ++i) {
      const crowd::ClimbPoint& point = climb.points[i];
      const auto pose = ground.pose(point.node1, point.s, point.t);
      if (!pose) continue;  // in the air: between two that are not
      around.feet = (last + pose->feet) * 0.5;
      around.spread = length(pose->feet - last) / 2;
      last = pose->feet;
      is_cut = std::any_of(slots.begin(), slots.end(), [&](uint32_t slot) {
        const crowd::CrowdObstacle& obstacle = obstacles.all()[slot];
        return obstacle.kind == ObstacleKind::kStatic && may_touch(around, {obstacle.place, {}});
      });
    }
    if (is_cut) body.flags |= crowd::Body::kNeedsPath;
  }
}

NodePlace Crowd::State::place_on_nodes(int32_t number, const Place& place) const {
  if (!place || place.level1 == kAirLevel1) return {};
  return classes[static_cast<size_t>(number)]->node_finders[0].find_place(place.position,
                                                                          kNodeRadius);
}

NodePlace Crowd::State::draw_on_nodes(int32_t number, uint64_t n) const {
  return config.nodes.random_place(number, config.seed ^ kPlaces, n);
}

void Crowd::State::set_goal_of_climber(crowd::Body& body, const NodePlace& goal) {
  crowd::Climb& climb = climbs[body.slot];
  const bool exists =
      classes[body.avatar_class]->nodes->pose(goal.node1, goal.s, goal.t).has_value();
  climb.goal_node1 = exists ? goal.node1 : 0;
  climb.goal_s = goal.s;
  climb.goal_t = goal.t;
  climb.detour = 0;
  climb.waited = 0;
  climb.turns_aside = 0;
  climb.station = climb.station_count = 0;
  body.flags = crowd::Body::kFlying | crowd::Body::kHasGoal | crowd::Body::kNeedsPath;
}

void Crowd::State::stop_climber(crowd::Body& body) {
  body.flags &= crowd::Body::kFlying;
  crowd::Climb& climb = climbs[body.slot];
  if (climb.is_on_ground()) clear_path(climb);
}

// The nearest place of its target, in a straight line.
void Crowd::State::head_to_target_place(const crowd::Body& body, crowd::Climb& climb) const {
  const auto& places = classes[body.avatar_class]->landings[body.target - 1u];
  double min_distance = HUGE_VAL;
  const Place* nearest = nullptr;
  for (const Place& place : places) {
    const double far = length(place.position - climb.feet);
    if (far >= min_distance) continue;
    min_distance = far;
    nearest = &place;
  }
  const NodePlace goal =
      nearest == nullptr ? NodePlace{} : place_on_nodes(body.avatar_class, *nearest);
  climb.goal_node1 = goal.node1;
  climb.goal_s = goal.s;
  climb.goal_t = goal.t;
}

// To another place for a while: a new path alone often meets the others again.
void Crowd::State::turn_aside(crowd::Body& body, crowd::Climb& climb, int32_t worker) {
  ClassParts& parts = *classes[body.avatar_class];
  const auto w = static_cast<size_t>(worker);
  const uint64_t stream = uint64_t{body.slot} << 2, seed = config.seed ^ kDetours;
  climb.turns_aside = 0;
  climb.detour = kMin + static_cast<float>(random_below(seed, stream, sub_step, 40)) * 0.1f;
  body.clear(crowd::Body::kNeedsPath);
  const NodePlace from =
      config.nodes.place(body.avatar_class, climb.at.node1 - 1, climb.at.s, climb.at.t);
  Path& path = parts.node_paths[w];
  path.points.clear();
  // Either to a random place of the graph, or to one of the same node.
  const NodeInfo info = config.nodes.node(climb.at.node1 - 1);
  const bool is_roomy = info.cells == 0 && info.area > kRoomy * kRoomy;
  if (!is_roomy || random_below(seed, stream | 1, sub_step, 2) == 0) {
    const NodePlace to =
        config.nodes.random_place(body.avatar_class, seed, random_u64(seed, stream | 2, sub_step));
    parts.node_finders[w].find(from, to, path, kNoSpacing, search_budget(kFew));
  }
  if (path.points.size() < 2) {
    const double side = 1.0 / (1 << info.level);
    path::NodeSquare square{info.s * side, info.t * side, (info.s + 1) * side, (info.t + 1) * side};
    if (info.cells != 0) {
      square = parts.node_finders[w]
                   .square(climb.at.node1 - 1, climb.at.s, climb.at.t, climb.at.s, climb.at.t)
                   .value_or(path::NodeSquare{climb.at.s, climb.at.t, climb.at.s, climb.at.t});
    }
    const auto within = [&](double low, double high, uint64_t draw) {
      return low + random_unit(seed, stream | 2, draw) * (high - low);
    };
    const NodePlace to = config.nodes.place(body.avatar_class, climb.at.node1 - 1,
                                            within(square.s0, square.s1, 2 * sub_step),
                                            within(square.t0, square.t1, 2 * sub_step + 1));
    set_segment(path, from, to);
  }
  take_path(climb, path);
  climb.whole = 0;
}

// An obstacle that came up beside it blocks a whole square of its node for its finder: on to the
// nearest place of it that is left.
bool Crowd::State::step_aside(crowd::Body& body, crowd::Climb& climb, int32_t worker,
                              double beside) {
  ClassParts& parts = *classes[body.avatar_class];
  const auto w = static_cast<size_t>(worker);
  const NodePlace from =
      config.nodes.place(body.avatar_class, climb.at.node1 - 1, climb.at.s, climb.at.t);
  if (obstacles.all().empty() || !from) return false;
  const NodePlace to = parts.node_finders[w].find_place(climb.feet, beside);
  if (to.node1 != from.node1 || to.feet == from.feet) return false;
  Path& path = parts.node_paths[w];
  set_segment(path, from, to);
  take_path(climb, path);
  climb.whole = 0;
  body.clear(crowd::Body::kNeedsPath);
  return true;
}

// An externally controlled climber heads to where it would be soon, by a path as any other.
void Crowd::State::control_climber(const crowd::Body& body, crowd::Climb& climb, int32_t worker) {
  climb.detour -= static_cast<float>(config.dt / sub_steps);
  if (!climb.is_on_ground() || (climb.detour > 0 && climb.at.next < climb.count)) return;
  ClassParts& parts = *classes[body.avatar_class];
  const auto w = static_cast<size_t>(worker);
  const Vec3d displacement{climb.external[0], climb.external[1], climb.external[2]};
  climb.detour = kExternal;
  const double far = length(displacement) * 2 * kExternal;
  if (!(far > 0)) return clear_path(climb);
  const NodePlace to =
      parts.node_finders[w].find_place(climb.feet + displacement * (2 * kExternal), far);
  const NodePlace from =
      config.nodes.place(body.avatar_class, climb.at.node1 - 1, climb.at.s, climb.at.t);
  if (!to || !from) return clear_path(climb);
  Path& path = parts.node_paths[w];
  parts.node_finders[w].find(from, to, path, kNoSpacing, search_budget(kFew));
  // A long detour does not lead in the direction that it is given.
  if (path.end != PathEnd::kReached || path.length > 3 * far) return clear_path(climb);
  take_path(climb, path);
  climb.whole = 0;
}

void Crowd::State::plan_climb(crowd::Body& body, crowd::Climb& climb, int32_t worker,
                              std::atomic<uint64_t>& planned) {
  if (body.has(crowd::Body::kExternal)) return control_climber(body, climb, worker);
  if (body.leaves && plan_exit_on_nodes(body, climb, worker)) return;
  if (!body.has(crowd::Body::kHasGoal)) return;
  if (climb.detour > 0) {
    climb.detour -= static_cast<float>(config.dt / sub_steps);
    if (climb.detour <= 0) body.flags |= crowd::Body::kNeedsPath;
  }
  const bool used_up = climb.at.next >= climb.count && climb.whole == 0;
  if (used_up) {
    body.flags |= crowd::Body::kNeedsPath;
    climb.station += climb.to_station;
    climb.to_station = 0;
  }
  if (!climb.is_on_ground()) return;
  if (climb.turns_aside != 0) return turn_aside(body, climb, worker);
  if (!body.has(crowd::Body::kNeedsPath)) return;
  planned.fetch_add(1, std::memory_order_relaxed);
  climb.detour = 0;
  if (body.target != 0) head_to_target_place(body, climb);
  ClassParts& parts = *classes[body.avatar_class];
  const auto w = static_cast<size_t>(worker);
  Path& path = parts.node_paths[w];
  path.end = PathEnd::kNoPlace;
  const Nodes& nodes = config.nodes;
  const NodePlace from = nodes.place(body.avatar_class, climb.at.node1 - 1, climb.at.s, climb.at.t);
  const auto is_found = [&] { return path.end == PathEnd::kReached && path.points.size() >= 2; };
  if (climb.station < climb.station_count) {
    const crowd::ClimbPoint& station = climb.stations[climb.station];
    const NodePlace to = nodes.place(body.avatar_class, station.node1 - 1, station.s, station.t);
    parts.node_finders[w].find(from, to, path, kNoSpacing, search_budget());
    note_spent(path.spent);
    if (is_found()) {
      take_path(climb, path);
      climb.to_station = std::exchange(climb.whole, uint8_t{0});
      return body.clear(crowd::Body::kNeedsPath);
    }
  }
  if (climb.goal_node1 != 0) {
    const NodePlace to =
        nodes.place(body.avatar_class, climb.goal_node1 - 1, climb.goal_s, climb.goal_t);
    parts.node_finders[w].find(from, to, path, kNoSpacing, search_budget());
    note_spent(path.spent);
  }
  if (!is_found()) {
    if (path.end == PathEnd::kNoPlace && step_aside(body, climb, worker, kSearchMargin)) return;
    clear_path(climb);
    return drop_goal(body);
  }
  take_path(climb, path);
  set_stations(climb, path);
  body.clear(crowd::Body::kNeedsPath);
}

// The step of climbers, after those of walkers and flyers.
void Crowd::State::move_climbers(crowd::EngineCounts& counts, crowd::EngineTimes& times,
                                 std::atomic<uint64_t>& planned) {
  const crowd::ClimberEngine::Before before = [&](crowd::Body& body, crowd::Climb& climb,
                                                  int32_t worker) {
    plan_climb(body, climb, worker, planned);
  };
  climbers.step(sub_step, engine.bodies(), climbs, flights, before, counts, times);
  for (const uint32_t slot : climbers.arrived()) arrived.push_back(id_of(slot));
}

// A body at its feet, to test whether it is in a region.
crowd::Body Crowd::State::at_feet(const crowd::Body& body) const {
  if (!body.climbs) return body;
  crowd::Body there = body;
  const Vec3d& origin = data_of(world)->summary.origin;
  const Vec3d& feet = climbs[body.slot].feet;
  there.x = static_cast<int32_t>(std::floor((feet.x - origin.x) / unit));
  there.z = static_cast<int32_t>(std::floor((feet.z - origin.z) / unit));
  there.y = static_cast<int32_t>(std::lrint(feet.y * 1000));
  return there;
}

bool Crowd::State::is_sound_climb(const crowd::Body& body) const {
  const auto& parts = classes[body.avatar_class];
  if (!parts || !parts->nodes || body.slot >= climbs.size()) return false;
  const crowd::Climb& climb = climbs[body.slot];
  const crowd::ClimbStance& at = climb.at;
  const bool finite =
      std::isfinite(climb.rise + climb.preferred_up + climb.waited + climb.detour) &&
      std::isfinite(climb.external[0] + climb.external[1] + climb.external[2]) && climb.radius > 0;
  if (!finite || climb.count > crowd::Climb::kPoints || at.next > climb.count || at.in_air > 1)
    return false;
  if (at.in_air != 0 && (at.next == 0 || at.next == climb.count)) return false;
  if (climb.count > 0 && (climb.points[climb.count - 1u].node1 == 0 || at.next == 0)) return false;
  for (size_t i = 0; i < climb.count; ++i) {
    const crowd::ClimbPoint& p = climb.points[i];
    if (p.node1 != 0 && !parts->nodes->pose(p.node1, p.s, p.t)) return false;
    if (p.node1 == 0 && !std::isfinite(p.s)) return false;
    // A segment on the surface stays within the node of the point before.
    const bool joined = i == 0 || p.on_surface == 0 ||
                        parts->nodes->pose(climb.points[i - 1].node1, p.s, p.t).has_value();
    if (!joined) return false;
  }
  if (climb.station_count > crowd::Climb::kStations || climb.to_station > 1) return false;
  for (size_t i = 0; i < climb.station_count; ++i) {
    const crowd::ClimbPoint& p = climb.stations[i];
    if (!parts->nodes->pose(p.node1, p.s, p.t)) return false;
  }
  const bool has_goal =
      climb.goal_node1 == 0 || parts->nodes->pose(climb.goal_node1, climb.goal_s, climb.goal_t);
  if (!has_goal) return false;
  const bool surfaced =
      at.in_air != 0 || at.next >= climb.count ||
      (climb.points[at.next].on_surface != 0 &&
       parts->nodes->pose(at.node1, climb.points[at.next].s, climb.points[at.next].t));
  const auto pose = parts->nodes->pose_of(climb, at);
  if (!surfaced || !pose || !(pose->feet == climb.feet) || !(pose->axis == climb.axis))
    return false;
  const auto cylinder = parts->nodes->cylinder_of(*pose, climb.radius);
  return cylinder && cylinder->low == crowd::AirPosition{body.x, body.z, body.y} &&
         cylinder->radius == body.radius && cylinder->height == body.height && at.node1 != 0 &&
         parts->nodes->pose(at.node1, at.s, at.t).has_value();
}

// Counts the climbers that are in an obstacle.
uint64_t Crowd::State::count_climbers_inside() const {
  uint64_t found = 0;
  for (const crowd::Body& body : engine.bodies()) {
    if (!body.climbs) continue;
    const crowd::Climb& climb = climbs[body.slot];
    const crowd::ClimberGround& ground = *classes[body.avatar_class]->nodes;
    const crowd::ClimbCylinder cylinder{{body.x, body.z, body.y}, body.radius, body.height};
    found += climbers.is_inside(ground, cylinder, {climb.feet, climb.axis}, climb.radius) ? 1 : 0;
  }
  return found;
}

// Counts the climbers that stand where their class may not, or whose cylinder does not enclose
// them.
uint64_t Crowd::State::count_off_nodes() const {
  constexpr double kTouch = 1e-9;  // [m]
  uint64_t found = 0;
  for (const crowd::Body& body : engine.bodies()) {
    if (!body.climbs) continue;
    const crowd::Climb& climb = climbs[body.slot];
    const crowd::ClimberGround& ground = *classes[body.avatar_class]->nodes;
    const auto pose = ground.pose_of(climb, climb.at);
    bool sound =
        pose && length(pose->feet - climb.feet) < 1e-6 && length(pose->axis - climb.axis) < 1e-6;
    // All around its rims.
    const double height = body_class(body.avatar_class).height;
    const Vec3d other = std::fabs(climb.axis.y) < 0.9 ? Vec3d{0, 1, 0} : Vec3d{1, 0, 0};
    Vec3d side = cross(other, climb.axis);
    side = side * (1 / length(side));
    const Vec3d front = cross(side, climb.axis);
    const Vec3d& origin = data_of(world)->summary.origin;
    for (int turn = 0; turn < 16; ++turn) {
      const double angle = turn * (2 * 3.14159265358979 / 16);
      const Vec3d rim =
          side * (climb.radius * std::cos(angle)) + front * (climb.radius * std::sin(angle));
      for (const double up : {0.0, height}) {
        const Vec3d p = climb.feet + climb.axis * up + rim;
        const double dx = p.x - origin.x - (body.x + 0.5) * unit;
        const double dz = p.z - origin.z - (body.z + 0.5) * unit;
        const double range = body.radius * unit + kTouch;
        sound = sound && dx * dx + dz * dz <= range * range && p.y >= body.y * 1e-3 - kTouch &&
                p.y <= (body.y + body.height) * 1e-3 + kTouch;
      }
    }
    found += sound ? 0 : 1;
  }
  return found;
}

}  // namespace throng
