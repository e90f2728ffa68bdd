// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "crowd/climb/climber_engine.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/parallel.h"
#include "core/random.h"
#include "steer/surface.h"

// The step of climbers: docs/design/013-climbers.md. Walkers and flyers have moved clear of the
// cylinders that enclose climbers; then climbers move, clear of where all bodies are. Linear in the
// climbers and their neighbours.
namespace throng::crowd {
namespace {

using steer::Space;

constexpr size_t kGrain = 32;                   // climbers that are worth another thread
constexpr float kArrivalRadius = 0.3f;          // [m] from its goal a body has arrived
constexpr float kProgressShare = 0.1f;          // of its speed
constexpr float kDetourDelay = 2;               // [s] at least, before it turns aside
constexpr float kRetreatDelay = 1;              // [s] before one in the air moves back
constexpr float kYieldDelay = 0.5f;             // [s] before others that rest yield to it
constexpr float kYieldDistance = 0.3f;          // [m] from a body that cannot step aside
constexpr uint64_t kDetourDelays = 0x74656d70;  // random stream

bool overlaps_with(const ClimbCylinder& a, const ClimbCylinder& b) {
  return nearer_than(a.low.x - b.low.x, a.low.z - b.low.z, int64_t{a.radius} + b.radius) &&
         a.low.y < b.low.y + b.height && b.low.y < a.low.y + a.height;
}

ClimbCylinder cylinder_of(const Body& body) {
  return {{body.x, body.z, body.y}, body.radius, body.height};
}

Space space_of(Vec3d v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

// The fastest that it may go: if it is externally controlled, no faster than it was given.
float speed_limit(const Body& body, const Climb& climb) {
  if (!body.has(Body::kExternal)) return body.speed;
  return std::min(body.speed,
                  steer::size_of({climb.external[0], climb.external[1], climb.external[2]}));
}

}  // namespace

ClimberEngine::ClimberEngine(const MoveConfig& config, size_t classes)
    : config_(config), grounds_(classes, nullptr) {
  rounds_.workers.resize(static_cast<size_t>(worker_count(config.workers)));
}

void ClimberEngine::fit(int32_t widest, float fastest, int32_t tallest, float dt) {
  config_.units.dt = dt;
  const float unit = config_.units.unit, stride = fastest * dt;
  sight_metres_ = std::max(config_.sight, config_.air_steering.horizon * fastest);
  // The largest distance between the centres of two cylinders whose bodies could touch after a
  // step.
  const float touched = 2 * static_cast<float>(widest) * unit + 2 * stride;
  const float high = 2 * static_cast<float>(tallest) * 1e-3f + 2 * stride;
  near_metres_ = std::max({sight_metres_ / 2, touched, high}) + 0.01f;
  sight_metres_ = std::min(sight_metres_, 2 * near_metres_);
  fastest_ = fastest;
  widest_ = widest;
  tallest_ = tallest;
  grid_.fit(static_cast<int32_t>(near_metres_ / unit) + 4,
            static_cast<int32_t>(near_metres_ * 1000) + 4);
}

bool ClimberEngine::meets_obstacle(const ClimberGround& ground, const ClimbCylinder& cylinder,
                                   const ClimbPose& pose, double radius,
                                   const AirObstacle& obstacle, const path::Solid& solid) const {
  return obstacle.holds(cylinder.low, cylinder.radius * double{config_.units.unit},
                        cylinder.height) &&
         may_touch(ground.body_room_of(pose, radius), solid);
}

// Does a test hold for one of the obstacles that a body meets?
template <class Test>
bool ClimberEngine::any_meets(const ClimberGround& ground, const ClimbCylinder& cylinder,
                              const ClimbPose& pose, double radius, Test test) const {
  if (obstacles_ == nullptr) return false;
  return obstacles_->any_near(cylinder.low, cylinder.radius * double{config_.units.unit},
                              [&](const ObstacleGrid::Item& obstacle) {
                                return meets_obstacle(ground, cylinder, pose, radius,
                                                      obstacle.shape, obstacle.solid) &&
                                       test(obstacle);
                              });
}

bool ClimberEngine::is_blocked(const ClimberGround& ground, const ClimbCylinder& cylinder,
                               const ClimbPose& pose, double radius) const {
  return any_meets(ground, cylinder, pose, radius, [](const auto&) { return true; });
}

bool ClimberEngine::is_inside(const ClimberGround& ground, const ClimbCylinder& cylinder,
                              const ClimbPose& pose, double radius) const {
  return any_meets(ground, cylinder, pose, radius,
                   [](const auto& obstacle) { return !obstacle.shape.closes(); });
}

bool ClimberEngine::is_blocked(const ClimberGround& ground, const Body& body, const Climb& climb,
                               const ClimbCylinder& cylinder, const ClimbPose& pose) const {
  return any_meets(ground, cylinder, pose, climb.radius, [&](const ObstacleGrid::Item& obstacle) {
    const bool continues = obstacle.shape.closes() &&
                           meets_obstacle(ground, cylinder_of(body), {climb.feet, climb.axis},
                                          climb.radius, obstacle.shape, obstacle.solid);
    return !continues;
  });
}

void ClimberEngine::step(uint64_t step, std::span<Body> bodies, std::span<Climb> climbs,
                         std::span<const Flight> flights, Before before, EngineCounts& counts,
                         EngineTimes& times) {
  arrived_.clear();
  bodies_ = bodies;
  climbs_ = climbs;
  flights_ = flights;
  const auto plan_one = [&](uint32_t c, int32_t worker) {
    Body& body = bodies_[rounds_.movers[c]];
    Climb& climb = climbs_[body.slot];
    before(body, climb, worker);
    preferred(body, climb);
  };
  const auto decide_one = [&](uint32_t c, Worker& worker) { decide(c, worker); };
  const auto propose_one = [&](const Contest& contest, const Worker& owner) {
    return propose(contest, owner);
  };
  const auto overlap = [&](const Contest& contest, uint32_t other) {
    return overlaps_with(rounds_.moves[contest.mover].displacement.cylinder,
                         rounds_.moves[rounds_.mover_of[other]].displacement.cylinder);
  };
  const auto settle_one = [&](uint32_t c, EngineCounts& here) { settle(c, step, here); };
  const Rounds::Parts parts{.is_mover = [](const Body& body) { return bool{body.climbs}; },
                            .plan = plan_one,
                            .decide = decide_one,
                            .propose = propose_one,
                            .overlaps_with = overlap,
                            .settle = settle_one};
  rounds_.step(bodies, parts, grid_, kGrain, config_.workers, config_.rounds, {config_.seed, step},
               counts, times);
  for (size_t n = 0; n < rounds_.movers.size(); ++n) {
    if (rounds_.moves[n].arrives) arrived_.push_back(bodies_[rounds_.movers[n]].slot);
  }
}

// Its preferred velocity, as if no other were there.
void ClimberEngine::preferred(Body& body, Climb& climb) const {
  Space desired;
  const bool goes = body.has(Body::kHasGoal) || body.has(Body::kExternal) || body.leaves;
  if (goes && climb.count > 0) {
    const float speed = speed_limit(body, climb);
    const Space displacement = space_of(grounds_[body.avatar_class]->path_ahead(climb));
    if (speed > 0) {
      desired = steer::preferred_towards(displacement, speed, config_.units.dt, 0, 0,
                                         climb.is_last_segment());
    }
  }
  body.preferred = {desired.x, desired.z};
  climb.preferred_up = desired.y;
}

// Is the other blocked where it cannot step aside, on its path over an edge or a hole, or by a body
// that has no goal left?
bool ClimberEngine::needs_space(const Body& body, const Climb& climb, const Body& other) const {
  if (!other.climbs || climb.at.in_air != 0) return false;
  const Climb& of_other = climbs_[other.slot];
  const bool rests = body.has(Body::kArrived) || !body.has(Body::kHasGoal);
  if (rests && of_other.waited > kYieldDelay && !other.has(Body::kArrived)) return true;
  return of_other.at.in_air != 0 && of_other.at.part > 0 && of_other.waited > 0 &&
         (of_other.waited >= climb.waited || other.slot < body.slot);
}

// Appends the bodies that the climber could touch to `others`, and adds the nearest, by which it
// steers.
void ClimberEngine::sense(uint32_t c, Worker& worker, steer::AirSituation& situation,
                          bool& yields) const {
  const uint32_t i = rounds_.movers[c];
  const Body& body = bodies_[i];
  const Climb& climb = climbs_[body.slot];
  const StepUnits& units = config_.units;
  NearestInAir nearest(sight_metres_);
  // Where the centres of both may be after a step, and how far their cylinders may extend then.
  const auto rise = static_cast<int64_t>(fastest_ * units.dt * 1000) + 2;
  const int64_t stride = units.stride(fastest_) + 1;
  const auto query = [&](const FlyerGrid::Entry& entry, bool is_near) {
    if (entry.body == i) return;
    const Body& other = bodies_[entry.body];
    if (is_near) {
      const int64_t range = widest_ + stride + (other.climbs ? widest_ + stride : entry.radius);
      const int64_t high = tallest_ + 2 * rise + (other.climbs ? tallest_ : entry.height);
      const int64_t up = int64_t{2} * (entry.y - body.y) + entry.height - body.height;  // doubled
      if (std::abs(up) <= 2 * high && nearer_than(entry.x - body.x, entry.z - body.z, range)) {
        worker.others.push_back(entry.body);
      }
    }
    const float dx = static_cast<float>(entry.x - body.x) * units.unit;
    const float dz = static_cast<float>(entry.z - body.z) * units.unit;
    const int32_t up = entry.y - body.y;
    const int32_t apart = std::max({up - body.height, -up - entry.height, 0});
    const float high = static_cast<float>(apart) * 1e-3f;
    nearest.add(dx * dx + dz * dz + high * high, other.slot, entry.body);
  };
  nearest.query_neighbours(grid_, body, near_metres_, units.unit, query);
  situation.velocity = {body.velocity.x, climb.rise, body.velocity.z};
  situation.preferred = {body.preferred.x, climb.preferred_up, body.preferred.z};
  constexpr float kMinLimit = 1e-3f;  // [m/s] Costs are divided by it.
  situation.fastest = std::min(body.speed, std::max(speed_limit(body, climb), kMinLimit));
  situation.height = static_cast<float>(body.height) * 1e-3f;
  situation.has_walls = false;
  situation.size = nearest.size();
  yields = false;
  for (size_t n = 0; n < nearest.size(); ++n) {
    const Body& other = bodies_[nearest.body(n)];
    const steer::Plane apart = units.metres(other.x - body.x, other.z - body.z);
    float up = 0, preferred_up = 0;
    if (other.climbs) {
      up = climbs_[other.slot].rise;
      preferred_up = climbs_[other.slot].preferred_up;
    } else if (other.flies()) {
      up = flights_[other.slot].rise;
    }
    // A climber that has arrived yields to those that would pass if it were not there.
    const bool is_passed = body.has(Body::kArrived) && other.climbs && !other.has(Body::kArrived);
    const Space velocity = is_passed ? Space{other.preferred.x, preferred_up, other.preferred.z}
                                     : Space{other.velocity.x, up, other.velocity.z};
    situation.near[n] = {{apart.x, static_cast<float>(other.y - body.y) * 1e-3f, apart.z},
                         velocity,
                         static_cast<float>(body.radius + other.radius) * units.unit,
                         static_cast<float>(other.height) * 1e-3f};
    if (yields || !needs_space(body, climb, other)) continue;
    const Climb& of_other = climbs_[other.slot];
    const Space off = space_of(of_other.feet - climb.feet);
    const float far = steer::size_of(off);
    const float room = static_cast<float>(body.height + other.height) * 1e-3f + kYieldDistance;
    if (far > 0 && far < room) {
      situation.preferred = (-0.5f * body.speed / far) * off;
      yields = true;
    }
  }
}

// The best first.
void ClimberEngine::find_candidates(const Body& body, const Climb& climb,
                                    const steer::AirSituation& situation, bool yields,
                                    Contest& contest) const {
  const ClimberGround& ground = *grounds_[body.avatar_class];
  const float dt = config_.units.dt;
  const double max_travel = double{speed_limit(body, climb)} * dt;
  contest.candidate_count = 0;
  const auto add = [&](const std::optional<ClimberGround::Step>& step, bool on_path) {
    if (!step || contest.candidate_count == kCandidates) return;
    const auto cylinder = ground.cylinder_of(step->pose, climb.radius);
    if (!cylinder) return;
    if (is_blocked(ground, body, climb, *cylinder, step->pose)) return;
    contest.displacement[contest.candidate_count++] = {*step, *cylinder, on_path};
  };
  const bool goes = climb.count > 0 && steer::size_of(situation.preferred) > 0;
  // Where it stops, the preferred velocity is slower; else the rest of a step continues along the
  // path.
  const double desired = climb.is_last_segment() || body.has(Body::kExternal)
                             ? double{steer::size_of(situation.preferred)} * dt
                             : max_travel;
  if (climb.at.in_air != 0) {
    const bool turning = climb.count > 0 && climb.at.next < climb.count;
    // Over an edge or a hole it can only continue.
    const double along =
        body.has(Body::kExternal) ? std::max(desired, double{body.speed} * dt / 4) : max_travel;
    for (const double part : {1.0, 0.5, 0.25}) {
      if (turning) add(ground.advance(climb, part * along), true);
    }
    if (climb.waited > kRetreatDelay) add(ground.retreat(climb, max_travel), false);
    return;
  }
  if (!yields && steer::preferred_is_open(config_.air_steering, situation)) {
    if (!goes) return;
    for (const double part : {1.0, 0.5, 0.25}) add(ground.advance(climb, part * desired), true);
    return;
  }
  const Space up = space_of(ground.normal_at(climb));
  for (const Space& v : steer::best_along(config_.air_steering, situation, up)) {
    const float speed = steer::size_of(v), preferred = steer::size_of(situation.preferred);
    if (!(speed > 1e-3f)) return;  // nothing is better than to stand
    const bool ahead =
        !yields && goes && steer::dot(v, situation.preferred) > 0.999f * speed * preferred;
    if (ahead) {
      add(ground.advance(climb, std::min(max_travel, desired * (speed / preferred))), true);
    } else {
      add(ground.shift(climb, Vec3d{v.x, v.y, v.z} * dt, max_travel), false);
    }
  }
}

// Senses, steers, and takes a place at once if no other could touch it.
void ClimberEngine::decide(uint32_t c, Worker& worker) {
  const Body& body = bodies_[rounds_.movers[c]];
  const Climb& climb = climbs_[body.slot];
  Move& move = rounds_.moves[c];
  move = {};
  Contest& contest = worker.contests.emplace_back();
  contest.mover = c;
  contest.first = static_cast<uint32_t>(worker.others.size());
  steer::AirSituation situation;
  bool yields = false;
  sense(c, worker, situation, yields);
  contest.last = static_cast<uint32_t>(worker.others.size());
  find_candidates(body, climb, situation, yields, contest);
  move.yields = yields;
  if (contest.first != contest.last && contest.candidate_count > 0) {
    ++worker.counts.contested;
    move.state = Move::kUndecided;
    return;
  }
  if (contest.candidate_count > 0) {
    move.displacement = contest.displacement[0];
    move.state = Move::kDecided;
  }
  worker.others.resize(contest.first);
  worker.contests.pop_back();
}

// Is a cylinder clear of where all bodies are now?
bool ClimberEngine::is_clear(const Contest& contest, const Worker& owner,
                             const ClimbCylinder& cylinder) const {
  for (const uint32_t j : owner.others_of(contest)) {
    const Body& other = bodies_[j];
    ClimbCylinder there = cylinder_of(other);
    if (other.climbs) {
      const Move& move = rounds_.moves[rounds_.mover_of[j]];
      if (move.state == Move::kDecided) there = move.displacement.cylinder;
    }
    if (overlaps_with(cylinder, there)) return false;
  }
  return true;
}

// Proposes the first candidate that is clear.
bool ClimberEngine::propose(const Contest& contest, const Worker& owner) {
  for (size_t w = 0; w < contest.candidate_count; ++w) {
    if (!is_clear(contest, owner, contest.displacement[w].cylinder)) continue;
    rounds_.moves[contest.mover].displacement = contest.displacement[w];
    return true;
  }
  return false;
}

// Its orientation, after its axis and then towards its move.
void ClimberEngine::turn(const Body& body, const Climb& climb, const Vec3d& last_axis) const {
  if (orientations_.empty()) return;
  Orientation& orientation = orientations_[body.slot];
  orientation = transported(orientation, last_axis, climb.axis);
  const auto before_lean = [&](const Vec3d& v) {
    const Vec3d own = unleaned(v, climb.axis);
    return steer::Plane{static_cast<float>(own.x), static_cast<float>(own.z)};
  };
  Turning(orientations_, config_.units.dt)
      .turn(body, before_lean({body.velocity.x, climb.rise, body.velocity.z}),
            before_lean({body.preferred.x, climb.preferred_up, body.preferred.z}));
}

void ClimberEngine::settle(uint32_t c, uint64_t step, EngineCounts& counts) {
  const StepUnits& units = config_.units;
  Body& body = bodies_[rounds_.movers[c]];
  Climb& climb = climbs_[body.slot];
  Move& move = rounds_.moves[c];
  const ClimberGround& ground = *grounds_[body.avatar_class];
  const Space desired{body.preferred.x, climb.preferred_up, body.preferred.z};
  const bool moves = move.state == Move::kDecided;
  const Vec3d last_axis = climb.axis;
  float gained = 0;  // of its speed
  if (moves) {
    const auto& [at, pose] = move.displacement.step;
    const Space displacement = space_of(pose.feet - climb.feet);
    const double far = ground.travel({climb.feet, climb.axis}, pose);
    const float per_step = body.speed * units.dt, preferred = steer::size_of(desired);
    gained = move.displacement.on_path ? static_cast<float>(far) / per_step
             : preferred > 0           ? steer::dot(displacement, desired) / (preferred * per_step)
                                       : 0;
    body.velocity = {displacement.x / units.dt, displacement.z / units.dt};
    climb.rise = displacement.y / units.dt;
    climb.at = at;
    climb.feet = pose.feet;
    climb.axis = pose.axis;
    body.x = move.displacement.cylinder.low.x;
    body.z = move.displacement.cylinder.low.z;
    body.y = move.displacement.cylinder.low.y;
    body.radius = move.displacement.cylinder.radius;
    body.height = static_cast<uint16_t>(move.displacement.cylinder.height);
    if (!(far > 0)) ++counts.stood;
  } else {
    body.velocity = {};
    climb.rise = 0;
    ++counts.stood;
  }
  turn(body, climb, last_axis);
  if (!body.has(Body::kHasGoal) || body.has(Body::kExternal)) return;
  counts.progress += std::lrint(gained * 1e6f);
  const bool at_end = climb.is_last_segment() && climb.at.in_air == 0;
  const float left = at_end ? steer::size_of(space_of(ground.path_ahead(climb))) : 1;
  if (at_end && left < kArrivalRadius && climb.detour <= 0 && !body.has(Body::kArrived)) {
    body.flags |= Body::kArrived;
    move.arrives = true;
  }
  const bool is_there = body.has(Body::kArrived) && left < kArrivalRadius && !move.yields;
  if (gained > kProgressShare || is_there) {
    climb.waited = std::max(0.0f, climb.waited - 0.5f * units.dt);
    return;
  }
  climb.waited += units.dt;
  const auto extra =
      static_cast<float>(random_below(config_.seed ^ kDetourDelays, body.slot, step, 3));
  const float delay = kDetourDelay + extra;
  if (config_.deadlock_avoidance && climb.waited > delay && climb.is_on_ground()) {
    climb.waited = 0;
    climb.turns_aside = 1;
  }
}

uint64_t ClimberEngine::bytes() const { return grid_.bytes() + rounds_.bytes(); }

}  // namespace throng::crowd
