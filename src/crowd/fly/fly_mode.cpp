// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "crowd/fly/fly_mode.h"

#include <array>
#include <cmath>

#include "core/parallel.h"
#include "core/stopwatch.h"
#include "crowd/fly/air_blockers.h"
#include "crowd/mode/finder_changes.h"
#include "crowd/mode/leaving.h"
#include "crowd/mode/saved_rows.h"
#include "world/place.h"

// Flyers of a crowd: the contract of modes but for paths (fly_plan.cpp, flight_search.cpp). What is
// said of an avatar on foot, WalkMode answers.
namespace throng::crowd {
namespace {

constexpr uint64_t kAirDraws = 0x616972;  // random stream

bool is_in_air(const AvatarSpawn& spawn) { return spawn.place.level1 == kAirLevel1; }

}  // namespace

FlyMode::FlyMode(SharedState& shared, const MoveConfig& config, WalkMode& walk)
    : Mode(shared),
      walk_(walk),
      engine_(config, shared.classes.size()),
      classes_(shared.classes.size()) {
  engine_.set_obstacles(&shared.obstacle_grid);
  walk_.set_takes_off(*this);
}

const path::FlightFinder* FlyMode::finder(int32_t avatar_class) const {
  if (avatar_class < 0 || static_cast<size_t>(avatar_class) >= classes_.size()) return nullptr;
  const auto& parts = classes_[static_cast<size_t>(avatar_class)];
  return parts ? &parts->finders[0] : nullptr;
}

Result<void> FlyMode::open_class(size_t number, Context& context) {
  if (!shared_.flies(number)) return {};
  const auto of = static_cast<int32_t>(number);
  const int32_t workers = shared_.config.workers;
  auto finder =
      path::FlightFinder::create(shared_.world, {.avatar_class = of, .workers = workers}, context);
  if (!finder) return finder.error();
  classes_[number] =
      std::make_unique<OfClass>(shared_.world, *finder, static_cast<size_t>(worker_count(workers)),
                                shared_.classes[number]->ground, of);
  engine_.set_air(number, &classes_[number]->air, shared_.body_class(number).radius);
  flights_.resize(shared_.names.slots());
  return {};
}

void FlyMode::close_class(size_t number) { classes_[number].reset(); }

bool FlyMode::put(NewAvatar& avatar, const AvatarSpawn& spawn) const {
  if (!is_in_air(spawn)) return walk_.put(avatar, spawn);
  return classes_[avatar.body.avatar_class] && put_in_air(avatar.body, spawn.place.position);
}

bool FlyMode::put_in_air(Body& body, const Vec3d& feet) const {
  const FlyerAir& air = air_of(body);
  if (!air.in_grid(feet)) return false;
  const AirPosition position = air.position(feet);
  if (!air.is_legal(position) || engine_.is_obstructed(body, position)) return false;
  body.x = position.x;
  body.z = position.z;
  body.y = position.y;
  body.level = 0;
  body.flags = Body::kMovedElsewhere;
  return true;
}

Result<bool> FlyMode::begin_draws(const AvatarSpawn& like) {
  if (!is_in_air(like)) return walk_.begin_draws(like);
  const auto number = static_cast<size_t>(like.avatar_class);
  if (classes_[number]) return true;
  return Error{Errc::kBadConfig,
               "crowd: class " + shared_.body_class(number).name +
                   " does not fly here: say `flies = true` in the classes' file, and bake the "
                   "world with it"};
}

bool FlyMode::draw(NewAvatar& avatar, const AvatarSpawn& like, uint64_t n) const {
  if (!is_in_air(like)) return walk_.draw(avatar, like, n);
  const path::FlightFinder& finder = classes_[avatar.body.avatar_class]->finders[0];
  const auto point = finder.random_point(shared_.config.seed ^ kAirDraws, n);
  return point && put_in_air(avatar.body, *point);
}

void FlyMode::add(const NewAvatar& avatar) {
  if (flights_.empty() && !classes_[avatar.body.avatar_class]) return;
  flights_.resize(shared_.names.slots());
  flights_[avatar.body.slot] = {};
}

void FlyMode::fit(const BodyExtent& all, float fastest) {
  engine_.fit(all.widest, fastest, all.tallest, shared_.sub_dt());
}

void FlyMode::set_goal(Body& body, const Place& goal) {
  const bool flies = body.has(Body::kMovedElsewhere);
  body.flags &= Body::kMovedElsewhere;
  Flight& flight = flights_[body.slot];
  flight.waited = 0;
  flight.descends = 0;
  flight.to_link = 0;
  flight.lands = 0;
  flight.search = kNoSearch;
  flight.count = flight.next = 0;
  const FlyerAir& air = air_of(body);
  if (goal.level1 == kAirLevel1) {
    if (!air.in_grid(goal.position)) return;
    flight.goal = air.position(goal.position);
    flight.goal_level = Flight::kInAir;
  } else {
    const auto point = world::ground_point(*data_of(shared_.world), goal);
    if (!point) return;
    flight.goal = {static_cast<int32_t>(point->x), static_cast<int32_t>(point->z), 0};
    flight.goal_level = goal.level1 - 1;
    flight.goal.y = shared_.ground_of(body).feet(flight.goal_level, *point);
    Route& route = walk_.route(body.slot);
    route = {};
    route.goal = {flight.goal.x, flight.goal.z, flight.goal_level};
  }
  body.local_target_x = flight.goal.x;
  body.local_target_z = flight.goal.z;
  flight.local_target_y = flight.goal.y;
  const bool walks = !flies && flight.goal_level != Flight::kInAir;
  body.flags |= Body::kHasGoal;
  body.flags |=
      shared_.config.routing == Routing::kStraight && walks ? Body::kLast : Body::kNeedsPath;
}

void FlyMode::set_target(Body& body) {
  if (classes_[body.avatar_class]) set_goal(body, {});
}

void FlyMode::set_velocity(Body& body, const Vec3d& velocity) {
  Flight& flight = flights_[body.slot];
  if (!body.has(Body::kExternal)) flight.local_target_y = 0;  // CarriedMove::rest
  flight.preferred_up = static_cast<float>(control(body, velocity).y);
}

void FlyMode::step(std::span<Body> bodies, EngineCounts& counts, EngineTimes& times) {
  if (flights_.empty()) return;
  const auto before = [this](Body& body, Flight& flight, int32_t worker) {
    plan(body, flight, worker);
  };
  engine_.set_orientations(shared_.orientations);
  engine_.step(shared_.sub_step, bodies, flights_, before, counts, times);
  for (const uint32_t slot : engine_.arrived()) shared_.arrived.push_back(shared_.id_of(slot));
  for (const uint32_t i : engine_.landed()) land(bodies[i]);
  const auto start = Clock::now();
  advance_searches(bodies);
  times.plan += seconds_since(start);
}

void FlyMode::land(Body& body) {
  Flight& flight = flights_[body.slot];
  body.level = flight.link_level;
  body.velocity = {};
  body.detour_angle = 0;
  flight.in_link = 0;
  flight.descends = 0;
  flight.lands = 0;
  flight.rise = 0;
  flight.search = kNoSearch;
  const bool has_goal = body.has(Body::kHasGoal);
  body.flags &= Body::kExternal | Body::kHasGoal;
  if (!has_goal) return;
  const bool is_straight = shared_.config.routing == Routing::kStraight;
  body.flags |= is_straight ? Body::kLast : Body::kNeedsPath;
  body.local_target_x = flight.goal.x;
  body.local_target_z = flight.goal.z;
}

void FlyMode::sync_obstacle(CrowdObstacle& obstacle, size_t number, bool is_new) {
  if (shared_.config.routing != Routing::kPaths || !classes_[number]) return;
  sync_change(classes_[number]->finders, obstacle, is_new, obstacle.of_class[number].air_change);
  restart_searches();
}

void FlyMode::forget_obstacle(const CrowdObstacle& obstacle) {
  for (size_t c = 0; c < classes_.size(); ++c) {
    if (classes_[c]) remove_change(classes_[c]->finders, obstacle.of_class[c].air_change);
  }
  restart_searches();
}

// A flyer looks itself whether its path is free.
void FlyMode::cut_paths(std::span<const uint32_t> /*slots*/, std::span<Body> /*bodies*/) {}

void FlyMode::add_blockers(std::span<const uint32_t> slots, std::span<const Body> bodies,
                           BlockerPairs& found) const {
  if (flights_.empty()) return;
  AirBlockers blockers(shared_, slots);
  if (blockers.is_empty()) return;
  for (uint32_t i = 0; i < bodies.size(); ++i) {
    const Body& body = bodies[i];
    if (!body.flies()) continue;
    blockers.add(body, i, shared_.body_class(body.avatar_class).radius, found);
  }
}

bool FlyMode::is_inside(const Body& body, const ObstacleGrid::Item& obstacle) const {
  if (!body.flies()) return walk_.is_inside(body, obstacle);
  const double radius = shared_.body_class(body.avatar_class).radius;
  return obstacle.shape.holds(feet_of(body), radius, body.height);
}

bool FlyMode::leads_out(const Body& body, std::span<const uint32_t> slots) const {
  if (!body.flies()) return walk_.leads_out(body, slots);
  const Flight& flight = flights_[body.slot];
  std::vector<std::array<int32_t, 2>> points;
  for (size_t i = flight.next; i < flight.count; ++i) {
    points.push_back({flight.points[i].x, flight.points[i].z});
  }
  return leads_out_along(shared_, body, slots, points, 0);
}

void FlyMode::end_leaving(Body& body) {
  if (body.has(Body::kExternal) || !body.has(Body::kHasGoal)) return;
  Flight& flight = flights_[body.slot];
  if (body.has(Body::kArrived)) {
    if (body.flies()) flight.local_target_y = body.y;
    return stay_arrived(body);
  }
  const bool walks_straight = shared_.config.routing == Routing::kStraight && !body.flies();
  if (!walks_straight || !body.has(Body::kNeedsPath)) return;
  if (flight.goal_level != Flight::kInAir) head_straight(body, flight.goal.x, flight.goal.z);
}

AvatarState FlyMode::state_of(const Body& body) const {
  AvatarState state = walk_.state_of(body);
  if (!body.flies()) return state;
  state.mode = MoveMode::kFly;
  state.velocity.y = flights_[body.slot].rise;
  return state;
}

uint64_t FlyMode::hash(const Body& body, uint64_t hash) const {
  if (flights_.empty()) return hash;
  hash = hash_row(flights_, body.slot, hash);
  if (flights_[body.slot].search != kListed) return hash;
  for (size_t nth = 0; nth < searches_.size(); ++nth) {
    if (searches_[nth].slot != body.slot) continue;
    hash = hash_bytes(&searches_[nth], sizeof searches_[nth], hash + nth);
  }
  return hash;
}

void FlyMode::add_memory(CrowdMemory& memory) const {
  memory.avatars += engine_.bytes();
  memory.paths += flights_.capacity() * kRowBytes + searches_.capacity() * sizeof(LongSearch);
}

void FlyMode::save(std::vector<uint8_t>& out) const {
  put_rows(out, flights_.data(), flights_.size());
}

const uint8_t* FlyMode::restore(const uint8_t* saved, size_t rows) {
  return take_rows(saved, rows, flights_);
}

bool FlyMode::is_sound(const Body& body) const {
  if (flights_.empty()) return !body.flies();
  const Flight& flight = flights_[body.slot];
  const uint32_t levels = data_of(shared_.world)->level_count;
  const bool finite = std::isfinite(flight.rise + flight.preferred_up + flight.waited);
  const bool counts = flight.count <= Flight::kPoints && flight.next <= flight.count &&
                      (flight.count == 0 || flight.next < flight.count);
  const bool has_path =
      !body.flies() || !body.has(Body::kHasGoal) || body.has(Body::kNeedsPath) || flight.count > 0;
  const bool goal = flight.goal_level == Flight::kInAir || flight.goal_level < levels;
  return finite && counts && has_path && flight.search <= kTakesOff && goal &&
         flight.link_low <= flight.link_high && (flight.in_link == 0 || flight.link_level < levels);
}

bool FlyMode::is_in_place(const Body& body) const {
  if (!body.flies()) return true;
  return classes_[body.avatar_class] &&
         (air_of(body).is_legal(feet_of(body)) || flights_[body.slot].in_link != 0);
}

}  // namespace throng::crowd
