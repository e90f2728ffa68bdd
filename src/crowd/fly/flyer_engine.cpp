// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "crowd/fly/flyer_engine.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/parallel.h"
#include "core/random.h"
#include "crowd/fly/long_search.h"
#include "crowd/mode/given_moves.h"

// The step of flyers: docs/design/012-flyers.md. Walkers have moved clear of where all flyers are;
// then flyers move, clear of where all bodies are. Linear in the flyers and their neighbours.
namespace throng::crowd {
namespace {

using steer::Space;

constexpr size_t kGrain = 128;             // flyers that are worth another thread
constexpr float kArrivalRadius = 0.3f;     // [m] from its goal a body has arrived
constexpr uint64_t kRolls = 0x726f6c6c;    // random stream
constexpr float kRoll = 2;                 // [s] for which a flyer keeps to a side
constexpr float kLinkSpeed = 2;            // [m/s] at most, up or down a ground-air link
constexpr float kDescentTimeout = 2;       // [s] that one which lands waits for a body below it
constexpr float kLandingSpread = 0.5f;     // [m/s] by which one that waits lands farther away
constexpr float kMaxLandingDistance = 15;  // [m] from where one would land, at most
constexpr int32_t kLandingHeight = 1500;   // [mm] above the start of the air at which it may begin
                                           // to land
constexpr std::array<float, 3> kShorterParts = {0.5f, 0.25f, 0.1f};

bool overlap(int32_t y, int32_t height, int32_t other_y, int32_t other_height) {
  return y < other_y + other_height && other_y < y + height;
}

bool overlaps_with(const Body& a, const AirPosition& at_a, const Body& b, const AirPosition& at_b) {
  return nearer_than(at_a.x - at_b.x, at_a.z - at_b.z, int64_t{a.radius} + b.radius) &&
         overlap(at_a.y, a.height, at_b.y, b.height);
}

AirPosition position_of(const Body& body) { return {body.x, body.z, body.y}; }

Space given_to(const Body& body, const Flight& flight) {
  return {body.preferred.x, flight.preferred_up, body.preferred.z};
}

// The fastest that it may fly, as speed_limit() of walkers.
float speed_limit(const Body& body, const Flight& flight) {
  constexpr float kMinLimit = 1e-3f;  // [m/s]
  if (!body.has(Body::kExternal)) return body.speed;
  return std::min(body.speed, std::max(steer::size_of(given_to(body, flight)), kMinLimit));
}

}  // namespace

FlyerEngine::FlyerEngine(const MoveConfig& config, size_t classes)
    : config_(config), classes_(classes) {
  rounds_.workers.resize(static_cast<size_t>(worker_count(config.workers)));
}

void FlyerEngine::set_air(size_t avatar_class, const FlyerAir* air, double radius) {
  classes_[avatar_class] = {air, radius};
}

void FlyerEngine::fit(int32_t widest, float fastest, int32_t tallest, float dt) {
  config_.units.dt = dt;
  // Far enough to see in time what comes at full speed, and all that could be touched, in all
  // directions.
  const float unit = config_.units.unit;
  const float stride = fastest * dt;
  sight_metres_ = std::max(config_.sight, config_.air_steering.horizon * fastest);
  const float touched = 2 * static_cast<float>(widest) * unit + 2 * stride;
  const float high = 2 * static_cast<float>(tallest) * 1e-3f + 2 * stride;
  near_metres_ = std::max({sight_metres_ / 2, touched, high + kLandingHeight * 1e-3f}) + 0.01f;
  sight_metres_ = std::min(sight_metres_, 2 * near_metres_);
  fastest_ = fastest;
  grid_.fit(static_cast<int32_t>(near_metres_ / unit) + 4,
            static_cast<int32_t>(near_metres_ * 1000) + 4);
}

bool FlyerEngine::is_blocked(const Body& body, const AirPosition& position) const {
  if (!has_obstacles()) return false;
  const double radius = classes_[body.avatar_class].radius;
  return obstacles_->any_near(position, radius, [&](const ObstacleGrid::Item& obstacle) {
    const AirObstacle& shape = obstacle.shape;
    return shape.holds(position, radius, body.height) &&
           !(shape.closes() && shape.holds(position_of(body), radius, body.height));
  });
}

bool FlyerEngine::is_obstructed(const Body& body, const AirPosition& position) const {
  if (!has_obstacles()) return false;
  const double radius = classes_[body.avatar_class].radius;
  return obstacles_->any_near(position, radius, [&](const ObstacleGrid::Item& obstacle) {
    return obstacle.shape.holds(position, radius, body.height);
  });
}

void FlyerEngine::list_exits(const Body& body, std::vector<const ObstacleGrid::Item*>& near,
                             std::vector<AirPosition>& exits) const {
  const double radius = classes_[body.avatar_class].radius;
  exits.clear();
  if (!has_obstacles()) return;
  obstacles_->list_near(position_of(body), radius, near);
  for (const ObstacleGrid::Item* obstacle : near) {
    const AirObstacle& shape = obstacle->shape;
    if (!shape.closes() || !shape.holds(position_of(body), radius, body.height)) continue;
    shape.list_exits(position_of(body), radius, body.height, exits);
  }
}

void FlyerEngine::step(uint64_t step, std::span<Body> bodies, std::span<Flight> flights,
                       Before before, EngineCounts& counts, EngineTimes& times) {
  step_ = step;
  arrived_.clear();
  landed_.clear();
  bodies_ = bodies;
  flights_ = flights;
  const auto plan_one = [&](uint32_t f, int32_t worker) {
    Body& body = bodies_[rounds_.movers[f]];
    Flight& flight = flights_[body.slot];
    before(body, flight, worker);
    preferred(body, flight, step);
  };
  const auto decide_one = [&](uint32_t f, Worker& worker) { decide(f, worker); };
  const auto propose_one = [&](const Contest& contest, const Worker& owner) {
    return propose(contest, owner);
  };
  const auto overlap = [&](const Contest& contest, uint32_t other) {
    return overlaps_with(bodies_[rounds_.movers[contest.mover]], rounds_.moves[contest.mover].place,
                         bodies_[other], rounds_.moves[rounds_.mover_of[other]].place);
  };
  const auto settle_one = [&](uint32_t f, EngineCounts& here) { settle(f, here); };
  const Rounds::Parts parts{.is_mover = [](const Body& body) { return body.flies(); },
                            .plan = plan_one,
                            .decide = decide_one,
                            .propose = propose_one,
                            .overlaps_with = overlap,
                            .settle = settle_one};
  rounds_.step(bodies, parts, grid_, kGrain, config_.workers, config_.rounds, {config_.seed, step},
               counts, times);
  for (size_t n = 0; n < rounds_.movers.size(); ++n) {
    const uint32_t i = rounds_.movers[n];
    const Body& body = bodies_[i];
    const Flight& flight = flights_[body.slot];
    if (rounds_.moves[n].arrives) arrived_.push_back(body.slot);
    if (flight.in_link != 0 && flight.descends != 0 && body.y == flight.link_low) {
      landed_.push_back(i);
    }
  }
}

// Its preferred velocity, as if no other were there.
void FlyerEngine::preferred(Body& body, Flight& flight, uint64_t step) const {
  if (body.has(Body::kExternal)) {
    flight.descends = flight.preferred_up < 0 ? 1 : 0;
    return;
  }
  const StepUnits& units = config_.units;
  const auto set = [&](Space v) {
    body.preferred = {v.x, v.z};
    flight.preferred_up = v.y;
  };
  if (flight.in_link != 0) {
    const int32_t to = flight.descends != 0 ? flight.link_low : flight.link_high;
    const Space displacement{0, static_cast<float>(to - body.y) * 1e-3f, 0};
    return set(steer::preferred_towards(displacement, std::min(body.speed, kLinkSpeed), units.dt, 0,
                                        0, flight.descends != 0));
  }
  if (!body.has(Body::kHasGoal) && !body.leaves) return set({});
  const steer::Plane level =
      units.metres(body.local_target_x - body.x, body.local_target_z - body.z);
  const Space displacement{level.x, static_cast<float>(flight.local_target_y - body.y) * 1e-3f,
                           level.z};
  const auto window = step / static_cast<uint64_t>(std::max(1L, std::lround(kRoll / units.dt)));
  const auto roll = static_cast<int32_t>(random_below(config_.seed ^ kRolls, body.slot, window, 3));
  set(steer::preferred_towards(displacement, body.speed, units.dt, body.detour_angle, roll,
                               body.has(Body::kLast)));
}

float FlyerEngine::landing_radius(const Flight& flight) {
  return std::min(kLandingSpread * flight.waited, kMaxLandingDistance);
}

// Would it land, if there is ground below?
bool FlyerEngine::wants_down(const Body& body, const Flight& flight) const {
  if (flight.in_link != 0) return false;
  if (body.has(Body::kExternal)) return flight.preferred_up < 0;
  if (!body.has(Body::kHasGoal) || flight.lands == 0 || !flight.is_last()) return false;
  const AirPosition& over = flight.points[flight.next];
  const steer::Plane off = config_.units.metres(over.x - body.x, over.z - body.z);
  const float range = landing_radius(flight) + kArrivalRadius;
  return off.x * off.x + off.z * off.z < range * range;
}

// Appends the bodies that the flyer could touch to `others`, and adds the nearest, by which it
// steers. `column_is_clear`: no body is in the column that it would descend.
void FlyerEngine::sense(uint32_t f, Worker& worker, steer::AirSituation& situation,
                        bool& column_is_clear,
                        const FlyerAir::GroundAirLink* ground_air_link) const {
  const uint32_t i = rounds_.movers[f];
  const Body& body = bodies_[i];
  const StepUnits& units = config_.units;
  const int32_t stride = stride_of(body);
  const auto rise_of = [&](float speed) {
    return static_cast<int32_t>(speed * units.dt * 1000) + 2;
  };
  const int32_t rise = rise_of(body.speed);
  NearestInAir nearest(sight_metres_);
  // Bodies farther away than that and their radius cannot be touched; the exact test follows.
  const float own_range =
      static_cast<float>(body.radius + 2 * units.stride(fastest_) + 3) * units.unit * 1.0001f;
  const auto query = [&](const FlyerGrid::Entry& entry, bool is_near) {
    const float dx = static_cast<float>(entry.x - body.x) * units.unit;
    const float dz = static_cast<float>(entry.z - body.z) * units.unit;
    const int32_t up = entry.y - body.y;
    const int32_t apart = std::max({up - body.height, -up - entry.height, 0});
    const float high = static_cast<float>(apart) * 1e-3f;
    const float level = dx * dx + dz * dz, square = level + high * high;
    const float range = own_range + static_cast<float>(entry.radius) * units.unit;
    const bool may_matter = is_near && level < range * range;
    if ((square > nearest.max_square() && !may_matter) || entry.body == i) return;
    const Body& other = bodies_[entry.body];
    if (may_matter) {
      const bool flies = other.flies();
      const int64_t radii = int64_t{body.radius} + other.radius;
      const int64_t touched = radii + stride + (flies ? stride_of(other) : 0);
      if (apart <= rise + (flies ? rise_of(other.speed) : 0) &&
          nearer_than(entry.x - body.x, entry.z - body.z, touched)) {
        worker.others.push_back(entry.body);
      }
      if (ground_air_link != nullptr && nearer_than(entry.x - body.x, entry.z - body.z, radii) &&
          overlap(ground_air_link->low, body.y + body.height - ground_air_link->low, entry.y,
                  other.height)) {
        column_is_clear = false;
      }
    }
    nearest.add(square, other.slot, entry.body);
  };
  nearest.query_neighbours(grid_, body, near_metres_, units.unit, query);
  const Flight& flight = flights_[body.slot];
  situation.velocity = {body.velocity.x, flight.rise, body.velocity.z};
  situation.preferred = {body.preferred.x, flight.preferred_up, body.preferred.z};
  situation.fastest = speed_limit(body, flight);
  situation.height = static_cast<float>(body.height) * 1e-3f;
  situation.size = nearest.size();
  for (size_t n = 0; n < nearest.size(); ++n) {
    const Body& other = bodies_[nearest.body(n)];
    const bool flies = other.flies();
    const steer::Plane apart = units.metres(other.x - body.x, other.z - body.z);
    const Flight* of_other = flies ? &flights_[other.slot] : nullptr;
    Space velocity{other.velocity.x, flies ? of_other->rise : 0, other.velocity.z};
    // A flyer that has arrived yields to those that would pass if it were not there.
    const bool yields = body.has(Body::kArrived) && flies && other.has(Body::kHasGoal) &&
                        !other.has(Body::kArrived);
    if (yields) {
      const steer::Plane left =
          units.metres(other.local_target_x - other.x, other.local_target_z - other.z);
      const Space displacement{
          left.x, static_cast<float>(of_other->local_target_y - other.y) * 1e-3f, left.z};
      velocity = steer::preferred_towards(displacement, other.speed, units.dt, 0, 0, false);
    }
    situation.near[n] = {{apart.x, static_cast<float>(other.y - body.y) * 1e-3f, apart.z},
                         velocity,
                         static_cast<float>(body.radius + other.radius) * units.unit,
                         static_cast<float>(other.height) * 1e-3f,
                         other.slot};
    if (flies && gives_precedence(body, flight, other, *of_other)) {
      const Space at = situation.near[n].at;
      const float far = steer::size_of(at);
      if (far > 0) situation.preferred = (-0.5f * body.speed / far) * at;
    }
  }
}

// Of two that touch before one waypoint the farther steps back, if the nearer stands.
bool FlyerEngine::gives_precedence(const Body& body, const Flight& flight, const Body& other,
                                   const Flight& of_other) const {
  constexpr float kCornerRadius = 1.5f, kMaxGap = 0.3f,
                  kStandingShare = 0.3f;  // [m], [m], of its speed
  const StepUnits& units = config_.units;
  const auto turns = [](const Body& b) {
    constexpr uint8_t kAll = Body::kHasGoal | Body::kLast | Body::kExternal;
    return (b.flags & kAll) == Body::kHasGoal;
  };
  if (!turns(body) || !turns(other) || flight.in_link != 0 || of_other.in_link != 0) return false;
  const auto left = [&](const Body& b, const Flight& f) {
    const steer::Plane level = units.metres(b.local_target_x - b.x, b.local_target_z - b.z);
    return steer::size_of(
        Space{level.x, static_cast<float>(f.local_target_y - b.y) * 1e-3f, level.z});
  };
  const steer::Plane targets_apart = units.metres(other.local_target_x - body.local_target_x,
                                                  other.local_target_z - body.local_target_z);
  const Space between{targets_apart.x,
                      static_cast<float>(of_other.local_target_y - flight.local_target_y) * 1e-3f,
                      targets_apart.z};
  if (steer::size_of(between) > kCornerRadius) return false;
  const steer::Plane apart = units.metres(other.x - body.x, other.z - body.z);
  const int32_t up = other.y - body.y;
  const float gap = static_cast<float>(std::max({up - body.height, -up - other.height, 0})) * 1e-3f;
  const float radii = static_cast<float>(body.radius + other.radius) * units.unit;
  if (gap > kMaxGap || steer::size_of(apart) > radii + kMaxGap) return false;
  const Space velocity{other.velocity.x, of_other.rise, other.velocity.z};
  if (steer::size_of(velocity) > kStandingShare * other.speed) return false;
  const float mine = left(body, flight), its = left(other, of_other);
  return its != mine ? its < mine : other.slot < body.slot;
}

// Does its preferred velocity lead straight to its local target, which it sees? Then it flies no
// farther than that, so walls beyond do not matter: a flyer comes to a goal beside a wall, and to a
// waypoint in a narrow shaft, at full speed.
bool FlyerEngine::leads_to_target(const Body& body, const steer::AirSituation& situation) const {
  const bool has_target = body.has(Body::kHasGoal) || body.leaves;
  if (!has_target || body.has(Body::kExternal) || body.detour_angle != 0) return false;
  const Flight& flight = flights_[body.slot];
  const Space& v = situation.preferred;
  // It may step back instead.
  if (v.x != body.preferred.x || v.y != flight.preferred_up || v.z != body.preferred.z) {
    return false;
  }
  return classes_[body.avatar_class].air->sees(
      position_of(body), {body.local_target_x, body.local_target_z, flight.local_target_y});
}

// Is its preferred velocity open? If not, how far are walls in all directions?
bool FlyerEngine::query_walls(const Body& body, steer::AirSituation& situation) const {
  const FlyerAir& air = *classes_[body.avatar_class].air;
  const AirPosition here = position_of(body);
  const float query_range = body.speed * config_.air_steering.wall_horizon;
  const auto free_distance = [&](Space direction) {
    const auto sees = [&](float far) {
      const AirPosition there{here.x + static_cast<int32_t>(direction.x * far / config_.units.unit),
                              here.z + static_cast<int32_t>(direction.z * far / config_.units.unit),
                              here.y + static_cast<int32_t>(direction.y * far * 1000)};
      return air.sees(here, there);
    };
    if (sees(query_range)) return std::numeric_limits<float>::infinity();
    for (float far = query_range * 0.5f; far > query_range * 0.1f; far *= 0.5f) {
      if (sees(far)) return far;
    }
    return 0.0f;
  };
  situation.has_walls = !air.is_open_around(here, query_range);
  const steer::AirFan fan = steer::air_fan(situation.preferred);
  if (situation.has_walls) {
    float& ahead = situation.free_distance[0];
    ahead = free_distance(fan[0]);
    const float never = std::numeric_limits<float>::infinity();
    if (ahead < never && leads_to_target(body, situation)) ahead = never;
  }
  if (steer::preferred_is_open(config_.air_steering, situation)) return true;
  if (!situation.has_walls) return false;
  for (size_t d = 1; d < fan.size(); ++d) situation.free_distance[d] = free_distance(fan[d]);
  return false;
}

// No move of it in the plan is longer. [units]
int32_t FlyerEngine::stride_of(const Body& body) const {
  return config_.units.stride(body.speed) + (body.has(Body::kExternal) ? 1 : 0);
}

// How far it rises in a step, in whole millimetres: short rises are rounded up or down in turn.
int32_t FlyerEngine::rise_of(const Body& body, float velocity) const {
  constexpr float kMinRise = 64;  // [mm] Shorter ones are short.
  const StepUnits millimetres{1e-3f, config_.units.dt};
  const uint64_t n = step_ + body.slot;
  if (body.has(Body::kExternal)) return millimetres.displacement_within(velocity, n);
  const float by_speed = millimetres.dt * 1000;
  if (body.speed * by_speed < kMinRise) return millimetres.small_displacement(velocity, n);
  return static_cast<int32_t>(std::lrint(velocity * by_speed));
}

// A velocity as a move of whole units and millimetres.
AirPosition FlyerEngine::displacement_of(const Body& body, Space velocity) const {
  const StepUnits& units = config_.units;
  const uint64_t n = step_ + body.slot;
  if (body.has(Body::kExternal)) {
    const Flight& flight = flights_[body.slot];
    const Space given = given_to(body, flight);
    const StepUnits millimetres{1e-3f, units.dt};
    if (velocity.x == given.x && velocity.y == given.y && velocity.z == given.z) {
      const GivenMove move(body, units.units_by_speed());
      const double rise = double{given.y} * millimetres.units_by_speed();
      return {move.x.units, move.z.units, carry(rise, flight.local_target_y).units};
    }
    const float size = steer::size_of(velocity), max_speed = steer::size_of(given);
    const Space cut = size > max_speed ? (max_speed / size) * velocity : velocity;
    return {units.displacement_within(cut.x, n), units.displacement_within(cut.z, n),
            millimetres.displacement_within(cut.y, n)};
  }
  const int32_t up = rise_of(body, velocity.y);
  if (!units.is_short(body.speed)) {
    return {units.displacement(velocity.x), units.displacement(velocity.z), up};
  }
  return {units.small_displacement(velocity.x, n), units.small_displacement(velocity.z, n), up};
}

void FlyerEngine::find_candidates(const Body& body, const steer::AirSituation& situation, bool open,
                                  Contest& contest) const {
  contest.candidate_count = 0;
  const auto add = [&](Space v) {
    contest.displacement[contest.candidate_count++] = displacement_of(body, v);
  };
  Space best = situation.preferred;
  if (open) {
    add(best);
  } else {
    const steer::AirChoices choices = steer::best_of(config_.air_steering, situation);
    for (const Space& v : choices) add(v);
    best = choices[0];
  }
  for (const float part : kShorterParts) add(part * best);
  if (!open || body.has(Body::kExternal)) return;
  // Rounding may lead off a line that runs along a floor or a ceiling, by a millimetre.
  for (const int32_t up : {-1, 1}) {
    AirPosition& beside = contest.displacement[contest.candidate_count++];
    beside = contest.displacement[0];
    beside.y += up;
  }
}

// The velocity by [CAACD], which replaces the preferred velocity as if that were open.
void FlyerEngine::find_curved_candidates(const Body& body, const steer::AirSituation& situation,
                                         Contest& contest) const {
  const StepUnits& units = config_.units;
  const Flight& flight = flights_[body.slot];
  const steer::Plane level =
      units.metres(body.local_target_x - body.x, body.local_target_z - body.z);
  steer::AirView view{
      .to_target = {level.x, static_cast<float>(flight.local_target_y - body.y) * 1e-3f, level.z},
      .stops = body.has(Body::kLast),
      .radius = static_cast<float>(body.radius) * units.unit,
      .slot = body.slot};
  // A body without a goal of its own keeps the given velocity.
  if (body.has(Body::kExternal) || !body.has(Body::kHasGoal)) {
    view.to_target = given_to(body, flight);
    view.stops = false;
  }
  caacd::Model curves = config_.curves_of(body.slot);
  curves.axes =
      config_.flyer_axes == FlyerAxes::kSide ? caacd::Axes::kSide : caacd::Axes::kSideAndUp;
  const Space v = steer::curvilinear_in_air(situation, view, units.dt, curves);
  contest.candidate_count = 0;
  for (const Space& candidate : steer::candidates_in_air(v)) {
    contest.displacement[contest.candidate_count++] = displacement_of(body, candidate);
  }
  for (const float part : kShorterParts) {
    contest.displacement[contest.candidate_count++] = displacement_of(body, part * v);
  }
}

// Senses, steers, and takes a place at once if no other could touch it.
void FlyerEngine::decide(uint32_t f, Worker& worker) {
  Body& body = bodies_[rounds_.movers[f]];
  Flight& flight = flights_[body.slot];
  Move& move = rounds_.moves[f];
  move = {};
  move.place = position_of(body);
  Contest contest;
  contest.mover = f;
  contest.first = static_cast<uint32_t>(worker.others.size());
  std::optional<FlyerAir::GroundAirLink> ground_air_link;
  if (wants_down(body, flight))
    ground_air_link = classes_[body.avatar_class].air->link_below(position_of(body));
  if (ground_air_link && body.y - ground_air_link->high > kLandingHeight) ground_air_link.reset();
  steer::AirSituation situation;
  bool column_is_clear = true;
  sense(f, worker, situation, column_is_clear, ground_air_link ? &*ground_air_link : nullptr);
  contest.last = static_cast<uint32_t>(worker.others.size());
  if (ground_air_link && column_is_clear) {
    flight.in_link = 1;
    flight.descends = 1;
    flight.link_low = ground_air_link->low;
    flight.link_high = ground_air_link->high;
    flight.link_level = ground_air_link->level;
    body.detour_angle = 0;
    const float down = body.has(Body::kExternal) ? std::max(flight.preferred_up, -kLinkSpeed)
                                                 : -std::min(body.speed, kLinkSpeed);
    situation.preferred = {0,
                           std::max(down, static_cast<float>(ground_air_link->low - body.y) *
                                              1e-3f / config_.units.dt),
                           0};
  }
  if (flight.in_link != 0) {
    // Up and down only: it can choose nothing but its speed.
    contest.candidate_count = 0;
    for (const float part : {1.0f, 0.5f, 0.25f}) {
      const int32_t up = rise_of(body, part * situation.preferred.y);
      contest.displacement[contest.candidate_count++] = {0, 0, up};
    }
  } else if (flies_curves() && !body.leaves) {
    find_curved_candidates(body, situation, contest);
  } else {
    find_candidates(body, situation, query_walls(body, situation), contest);
  }
  if (contest.first != contest.last) {
    ++worker.counts.contested;
    move.state = Move::kUndecided;
    worker.contests.push_back(contest);
    return;
  }
  for (size_t w = 0; w < contest.candidate_count; ++w) {
    if (!try_place(body, contest.displacement[w], move.place)) continue;
    move.state = Move::kDecided;
    return;
  }
}

// Where a body would be after a move, if all between is air.
bool FlyerEngine::try_place(const Body& body, const AirPosition& displacement,
                            AirPosition& place) const {
  const Flight& flight = flights_[body.slot];
  const FlyerAir& air = *classes_[body.avatar_class].air;
  const AirPosition here = position_of(body);
  AirPosition there{here.x + displacement.x, here.z + displacement.z, here.y + displacement.y};
  if (flight.in_link != 0) {
    if (displacement.x != 0 || displacement.z != 0) return false;
    there.y = std::max(there.y, flight.link_low);
    // An obstacle may have appeared where it would stand.
    const bool lands = there.y == flight.link_low && here.y != there.y;
    if (lands && !air.may_stand(flight.link_level, there)) return false;
    // Between the ground and the air it is free; all above is tested.
    const int32_t from = std::max(here.y, flight.link_high);
    const int32_t to = std::max(there.y, flight.link_high);
    if (from != to && !air.sees({here.x, here.z, from}, {here.x, here.z, to})) return false;
  } else if (!air.sees(here, there)) {
    return false;
  }
  if (there != here && is_blocked(body, there)) return false;
  place = there;
  return true;
}

// Is a place clear of where all bodies are now?
bool FlyerEngine::is_clear(const Contest& contest, const Worker& owner,
                           const AirPosition& place) const {
  const Body& body = bodies_[rounds_.movers[contest.mover]];
  for (const uint32_t j : owner.others_of(contest)) {
    const Body& other = bodies_[j];
    AirPosition there = position_of(other);
    if (other.flies()) {
      const Move& move = rounds_.moves[rounds_.mover_of[j]];
      if (move.state == Move::kDecided) there = move.place;
    }
    if (overlaps_with(body, place, other, there)) return false;
  }
  return true;
}

// Proposes the first candidate that is open and clear.
bool FlyerEngine::propose(const Contest& contest, const Worker& owner) {
  const Body& body = bodies_[rounds_.movers[contest.mover]];
  AirPosition place;
  for (size_t w = 0; w < contest.candidate_count; ++w) {
    if (!try_place(body, contest.displacement[w], place) || !is_clear(contest, owner, place))
      continue;
    rounds_.moves[contest.mover].place = place;
    return true;
  }
  return false;
}

// As keep_rest() of walkers, also of the rise.
void FlyerEngine::keep_rest(Body& body, Flight& flight, const AirPosition& to) const {
  if (!body.has(Body::kExternal) || flight.in_link != 0) return;
  const StepUnits& units = config_.units;
  const double rise = double{flight.preferred_up} * StepUnits{1e-3f, units.dt}.units_by_speed();
  const CarriedMove up = carry(rise, flight.local_target_y);
  const GivenMove given(body, units.units_by_speed());
  const AirPosition move{to.x - body.x, to.z - body.z, to.y - body.y};
  if (move != AirPosition{given.x.units, given.z.units, up.units}) return;
  body.local_target_x = given.x.rest;
  body.local_target_z = given.z.rest;
  flight.local_target_y = up.rest;
}

void FlyerEngine::settle(uint32_t f, EngineCounts& counts) {
  const StepUnits& units = config_.units;
  Body& body = bodies_[rounds_.movers[f]];
  Flight& flight = flights_[body.slot];
  Move& move = rounds_.moves[f];
  const steer::Plane level =
      units.metres(body.local_target_x - body.x, body.local_target_z - body.z);
  const Space displacement{level.x, static_cast<float>(flight.local_target_y - body.y) * 1e-3f,
                           level.z};
  if (move.state == Move::kDecided) keep_rest(body, flight, move.place);
  const bool moves = move.state == Move::kDecided && move.place != position_of(body);
  if (moves) {
    body.velocity = {units.velocity(move.place.x - body.x), units.velocity(move.place.z - body.z)};
    flight.rise = static_cast<float>(move.place.y - body.y) * (1e-3f / units.dt);
    body.x = move.place.x;
    body.z = move.place.z;
    body.y = move.place.y;
  } else {
    body.velocity = {};
    flight.rise = 0;
    ++counts.stood;
  }
  Turning(orientations_, units.dt).turn(body, units.dt);
  if (flight.in_link != 0) {
    if (flight.descends != 0) {
      body.detour_angle = moves ? 0 : body.detour_angle + units.dt;
      flight.waited += moves ? 0 : units.dt;
      if (body.detour_angle > kDescentTimeout && !body.has(Body::kExternal)) flight.descends = 0;
    }
    if (flight.descends == 0 && body.y >= flight.link_high) {
      flight.in_link = 0;
      body.detour_angle = 0;
    }
    return;
  }
  if (!body.has(Body::kHasGoal) || body.has(Body::kExternal)) return;
  const Space velocity{body.velocity.x, flight.rise, body.velocity.z};
  const Space preferred{body.preferred.x, flight.preferred_up, body.preferred.z};
  const float left = steer::size_of(displacement);
  const float towards = left > 1e-6f ? steer::dot(velocity, displacement) / left : 0;
  counts.progress += std::lrint(towards / body.speed * 1e6f);
  // So near that it brakes to less than what counts as progress.
  const float braking = steer::kAirStop * config_.deadlock_settings.min_progress * body.speed;
  const bool near_goal = body.has(Body::kLast) && left <= std::max(1.0f, braking);
  if (config_.deadlock_avoidance) {
    // A step that ends at a waypoint is short, and one that waits for its path makes none.
    constexpr float kWaitingRadius = 0.1f;  // [m]
    const bool waits = left <= (flight.search != kNoSearch ? kWaitingRadius : 1e-6f);
    const float possible = std::min(body.speed, left / units.dt);
    const float content = near_goal || waits ? 1 : towards / possible;
    const float along = steer::dot(velocity, preferred) / (body.speed * body.speed);
    body.detour_angle = steer::next_detour_angle(config_.deadlock_settings, body.detour_angle,
                                                 content, along, units.dt);
  }
  if (flight.lands != 0 && flight.is_last() && left < kMaxLandingDistance &&
      towards < 0.3f * body.speed) {
    flight.waited += units.dt;
  }
  const steer::Plane rest =
      units.metres(body.local_target_x - body.x, body.local_target_z - body.z);
  const Space off{rest.x, static_cast<float>(flight.local_target_y - body.y) * 1e-3f, rest.z};
  if (body.has(Body::kLast) && flight.lands == 0 && !body.has(Body::kArrived) &&
      steer::size_of(off) < kArrivalRadius) {
    body.flags |= Body::kArrived;
    move.arrives = true;
  }
}

uint64_t FlyerEngine::bytes() const { return grid_.bytes() + rounds_.bytes(); }

}  // namespace throng::crowd
