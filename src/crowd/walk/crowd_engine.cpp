// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "crowd/walk/crowd_engine.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <mutex>
#include <utility>

#include "core/arrays/prefetch.h"
#include "core/parallel.h"
#include "core/random.h"
#include "core/stopwatch.h"
#include "crowd/walk/reaction.h"
#include "crowd/walk/sense_kernel.h"
#include "steer/sampled_kernel.h"

// The step of a crowd: docs/design/008-engine.md. A body that can touch no other within the step
// takes its first move at once; only the others go through conflict resolution rounds. Linear in
// the bodies and their neighbours.
namespace throng::crowd {
namespace {

using steer::Plane;

constexpr size_t kGrain = 256;            // bodies that are worth another thread
constexpr float kArrivalRadius = 0.3f;    // [m] from its goal a body has arrived
constexpr uint64_t kSides = 0x51de5;      // random stream
constexpr float kCornerRadius = 0.1f;     // [m] to its corner a body turns to neither side
constexpr float kStraightHorizon = 0.1f;  // [s] within which a body that walks straight
                                          // must meet no other
constexpr size_t kLevelPrefetch = 6, kCellPrefetch = 3;  // bodies, whose ground is prefetched
constexpr size_t kOrientationPrefetch = 8;               // bodies
constexpr size_t kBits = 64;                             // of a word

// Do two bodies at these places overlap?
bool overlaps_with(const Body& a, const Stand& at_a, const Body& b, const Stand& at_b) {
  return nearer_than(at_a.x - at_b.x, at_a.z - at_b.z, int64_t{a.radius} + b.radius) &&
         at_a.y < at_b.y + b.height && at_b.y < at_a.y + a.height;
}

// Is it turned aside by deadlock avoidance, blocked by more than other bodies?
bool is_blocked_by_walls(const Body& body) {
  return body.detour_angle != 0 && (!body.has(Body::kLast) || body.near_wall);
}

// Speed towards its local target, which is `displacement` away. [m/s]
float speed_towards(const Body& body, Plane displacement) {
  const float left = size_of(displacement);
  return left > 1e-6f ? (body.velocity.x * displacement.x + body.velocity.z * displacement.z) / left
                      : 0;
}

// Relative to its desired speed. [millionths]
int64_t progress_of(const Body& body, Plane displacement) {
  return std::lrint(speed_towards(body, displacement) / body.speed * 1e6f);
}

}  // namespace

CrowdEngine::CrowdEngine(const MoveConfig& config, int32_t width, int32_t depth, size_t classes)
    : config_(config), grounds_(classes), width_(width), depth_(depth) {
  if (config.model != SteeringModel::kSampled) {
    config_.reaction = 0;
    config_.deadlock_avoidance = false;
    config_.steering.neighbours = steer::kMaxNear;
    config_.queues = false;
    config_.acceleration = 0;
  }
  if (config_.queues) config_.steering = queueing(config_.steering);
  workers_.resize(static_cast<size_t>(worker_count(config.workers)));
}

void CrowdEngine::set_ground(size_t avatar_class, const StrideGround& ground) {
  grounds_[avatar_class] = ground;
}

void CrowdEngine::set_turning_radius(size_t avatar_class, float radius) {
  if (turning_radii_.empty() && radius > 0) turning_radii_.resize(grounds_.size());
  if (!turning_radii_.empty()) turning_radii_[avatar_class] = radius;
}

void CrowdEngine::copy_slope_factors(size_t to, size_t from) {
  if (!config_.slope_factors.empty()) config_.slope_factors[to] = config_.slope_factors[from];
}

void CrowdEngine::fit(int32_t widest, float fastest, float dt) {
  config_.units.dt = dt;
  widest_ = widest;
  fastest_ = fastest;
  every_ = throng::crowd::steps_of_reaction(config_.reaction, dt);
  // A gain of a few units would be lost if moves were rounded to the nearest one.
  constexpr float kMinGain = 4;  // [units]
  gains_little_ =
      config_.acceleration > 0 && config_.acceleration * dt * (dt / config_.units.unit) < kMinGain;
  sight_ = 0;
  fit_grid();
}

void CrowdEngine::set_detail(const EngineDetail& detail) {
  detail_ = detail;
  detail_.narrowest = std::min(detail.narrowest, kLongestStep);
  if (size_ > 0 || names_ != nullptr) fit_grid();  // Ranks that share a crowd see equally far.
}

void CrowdEngine::fit_grid() {
  longest_ = config_.units.stride(fastest_);
  if (!detail_.views.empty() && detail_.steps > 1) {
    StepUnits units = config_.units;
    units.dt *= static_cast<float>(detail_.steps);
    longest_ = std::max(longest_, std::min(detail_.narrowest, units.stride(fastest_)));
  }
  THRONG_ASSERT(longest_ <= kLongestStep);
  // All that could be touched within a step must be sensed, however short the sight.
  const auto sight = static_cast<int32_t>(std::lround(config_.sight / double{config_.units.unit}));
  const int32_t wanted = std::max(sight, 2 * widest_ + 2 * longest_);
  if (wanted == sight_) return;
  sight_ = wanted;
  if (bodies_.size() > 0) grid_.emplace(width_, depth_, sight_, bodies_.size());
}

void CrowdEngine::reserve(size_t bodies) {
  if (bodies <= bodies_.size()) return;
  bodies = grown(bodies_.size(), std::max<size_t>(1024, bodies));
  HugeArray<Body> larger(bodies);
  std::copy_n(bodies_.data(), size_, larger.data());
  bodies_ = std::move(larger);
  spare_ = HugeArray<Body>(bodies);
  contests_.resize((bodies + kBits - 1) / kBits);
  grid_.emplace(width_, depth_, sight_, bodies);
}

void CrowdEngine::add(const Body& body) {
  highest_ = std::max<int32_t>(highest_, body.height);
  reserve(size_ + 1);
  bodies_[size_++] = body;
  fit_rows(body.slot + size_t{1});
}

void CrowdEngine::step(uint64_t step, Before before, EngineCounts& counts, EngineTimes& times,
                       StepExchange* exchange) {
  if (size_ == 0 && exchange == nullptr) return;
  step_ = step;
  exchange_ = exchange;
  auto start = Clock::now();
  const auto lap = [&](double& seconds) {
    seconds += seconds_since(start);
    start = Clock::now();
  };
  prefer_all(step, before);
  lap(times.plan);
  if (exchange != nullptr) add_ghosts(exchange->exchange_bodies(*this));
  grid_->sort({bodies_.data(), size_}, {spare_.data(), size_}, config_.workers);
  std::swap(bodies_, spare_);
  if (exchange != nullptr) list_shared();
  lap(times.sort);
  decide_all(counts);
  lap(times.steer);
  resolve_conflicts(step);
  lap(times.resolve);
  settle_all(counts);
  if (exchange != nullptr) drop_ghosts();
  lap(times.settle);
}

// Does it repeat its last move?
bool CrowdEngine::continues(const Body& body, uint64_t step) const {
  if (!body.has(Body::kContinues) || body.has(Body::kExternal) || body.has(Body::kNeedsPath) ||
      body.has(Body::kMovedElsewhere) || has_short_moves(body)) {
    return false;
  }
  const uint64_t every = steps_of_reaction(body);
  if (decides(every, step, name_of(body))) return false;
  const int32_t x = body.local_target_x - body.x, z = body.local_target_z - body.z;
  return !is_before({x, z}, stride_of(body)) &&
         !(body.has(Body::kLast) && must_brake(config_.units.metres(x, z), body.speed,
                                               config_.acceleration, every, config_.units.dt));
}

// Its velocity if nothing blocked it. `detour_angle`: to the right.
Plane CrowdEngine::preferred_of(const Body& body, float detour_angle) const {
  if (!(body.has(Body::kHasGoal) || body.leaves) || (config_.queues && is_paused(body))) return {};
  const Plane left =
      config_.units.metres(body.local_target_x - body.x, body.local_target_z - body.z);
  const float dt = units_of(body).dt;
  float speed = body.speed;
  if (body.has(Body::kLast)) {
    speed = steer::braking_speed(size_of(left), config_.acceleration, dt, speed);
  }
  return steer::preferred_towards(left, speed, dt, detour_angle);
}

// To the right, if only other bodies block it. At a wall or a corner that would press a crowd
// against it: there, to a random side.
float CrowdEngine::turned_aside(const Body& b) const {
  constexpr float kSide = 2;  // [s] for which a body keeps to a side
  if (b.in_counterflow || !is_blocked_by_walls(b)) return b.detour_angle;
  const Plane left = config_.units.metres(b.local_target_x - b.x, b.local_target_z - b.z);
  if (size_of(left) < kCornerRadius) return 0;
  const auto window = step_ / static_cast<uint64_t>(std::lround(kSide / config_.units.dt));
  const bool is_left = (random_u64(config_.seed ^ kSides, name_of(b), window) & 1) != 0;
  return is_left ? -b.detour_angle : b.detour_angle;
}

void CrowdEngine::prefer_all(uint64_t step, Before before) {
  const size_t pieces = (size_ + kGrain - 1) / kGrain;
  const auto run = [&](size_t piece, int32_t worker) {
    const size_t begin = piece * kGrain;
    const std::span<Body> bodies{bodies_.data() + begin, std::min(kGrain, size_ - begin)};
    for (Body& b : bodies) {
      choose_detail(b, step);
      if (b.steps > 0 && !continues(b, step)) b.clear(Body::kContinues);
    }
    before(bodies, worker);
    for (Body& b : bodies) {
      if (!config_.slope_factors.empty()) slow_on_slope(b);
      if (finds_preferred(b)) b.preferred = preferred_of(b, turned_aside(b));
    }
  };
  parallel_for_worker(pieces, config_.workers, run);
}

void CrowdEngine::decide_all(EngineCounts& counts) {
  for (Worker& worker : workers_) {
    worker.others.clear();
    worker.counts = {};
  }
  const size_t pieces = (size_ + kGrain - 1) / kGrain;
  const auto run = [&](size_t piece, int32_t worker) {
    const auto w = static_cast<uint16_t>(worker);
    NeighbourGrid::Around around;
    uint32_t square = UINT32_MAX;
    const size_t end = std::min(size_, (piece + 1) * kGrain);
    for (size_t i = piece * kGrain; i < end; ++i) {
      Contests& contests = contests_[i / kBits];
      if (i % kBits == 0) contests = {};
      prefetch_ground(i);
      if (bodies_[i].steps == 0 || bodies_[i].is_ghost) {
        proposals()[i] = {};
        bodies_[i].state = Body::kEnclosed;
        continue;
      }
      const uint32_t here = grid_->square(bodies_[i]);
      std::optional<bool> contested;
      if (bodies_[i].has(Body::kContinues))
        contested = try_to_continue(static_cast<uint32_t>(i), w, here);
      if (!contested) {
        if (here != square) {
          square = here;
          around = grid_->around(square);
        }
        contested = decide(static_cast<uint32_t>(i), w, around);
      }
      if (!*contested) continue;
      const uint64_t bit = uint64_t{1} << (i % kBits);
      contests.open |= bit;
      if (proposals()[i].round == 0) contests.unproposed |= bit;
      ++workers_[w].counts.contested;
    }
  };
  parallel_for_worker(pieces, config_.workers, run);
  for (const Worker& worker : workers_) counts.add(worker.counts);
}

// Prefetches the ground that the bodies which decide next will reach if they repeat their moves.
void CrowdEngine::prefetch_ground(size_t i) const {
  if (i + kLevelPrefetch < size_) {
    const Body& body = bodies_[i + kLevelPrefetch];
    grounds_[body.avatar_class].prefetch_level(body.level);
  }
  if (i + kCellPrefetch < size_) {
    const Body& body = bodies_[i + kCellPrefetch];
    const Displacement displacement = displacement_again(body, body.velocity);
    throng::prefetch(&choices_[body.slot]);
    grounds_[body.avatar_class].prefetch_cell(
        body.level, {int64_t{body.x} + displacement.x, int64_t{body.z} + displacement.z});
    if (config_.queues) __builtin_prefetch(&progress_[body.slot]);
  }
}

// Is its preferred velocity open, or is that of a lane? Then that is its preferred velocity.
bool CrowdEngine::find_open_preferred(uint32_t i, Worker& worker,
                                      const NeighbourGrid::Around& around) {
  const Body& body = bodies_[i];
  if (!is_sampled(body)) return true;
  if (!worker.waits && go_straight(body, worker.situation)) return true;
  const auto is_open = [&] {
    query_wall_ahead(body, worker.situation);
    return steer::preferred_is_open_fast(config_.steering, worker.situation);
  };
  return is_open() || (!worker.waits && choose_lane(i, worker, around) && is_open());
}

// A body that a jam at a door turned aside passes as soon as it can.
bool CrowdEngine::go_straight(const Body& body, steer::Situation& situation) const {
  if (!is_blocked_by_walls(body)) return false;
  const Plane turned = situation.preferred;
  const Plane left =
      config_.units.metres(body.local_target_x - body.x, body.local_target_z - body.z);
  situation.preferred = steer::preferred_towards(left, body.speed, units_of(body).dt, 0);
  // A body one step from its corner stops there: whether it would touch others beyond does not
  // matter.
  if (!body.has(Body::kLast) && size_of(left) <= body.speed * units_of(body).dt) {
    query_wall_ahead(body, situation);
    return true;
  }
  situation.preferred = steer::following_fast(config_.steering, situation);
  query_wall_ahead(body, situation);
  steer::SampledSettings at_once = config_.steering;
  at_once.horizon = kStraightHorizon;
  if (steer::preferred_is_open_fast(at_once, situation)) return true;
  situation.preferred = turned;
  return false;
}

// A body that can only stand between walls keeps its spacing to others.
Plane CrowdEngine::if_blocked(Plane displacement, const steer::Situation& situation) const {
  const bool stands = displacement.x == 0 && displacement.z == 0;
  return stands && situation.has_walls ? steer::keep_spacing(config_.spacing, situation)
                                       : displacement;
}

// As it counts for a body. A distance that is free over the whole query range counts as endless.
float CrowdEngine::wall_distance(const Body& body, float displacement, float query_range) const {
  return displacement < query_range ? displacement * config_.units.unit * wall_scale(body)
                                    : std::numeric_limits<float>::infinity();
}

// Is a wall near, and how far is it along the preferred velocity?
void CrowdEngine::query_wall_ahead(const Body& body, steer::Situation& situation) const {
  const StrideGround& ground = grounds_[body.avatar_class];
  const float query_range = wall_range(body);
  situation.has_walls = !ground.is_open_around(body.level, body.point(), cells_of(query_range));
  if (!situation.has_walls) return;
  const Plane ahead = steer::ahead_of(situation.preferred);
  situation.free_distance[0] = wall_distance(
      body, ground.free_distance(body.level, body.point(), ahead, query_range), query_range);
}

// The distances to walls in all directions. Only for bodies whose preferred velocity is not open.
void CrowdEngine::query_walls(const Body& body, steer::Situation& situation) const {
  if (!situation.has_walls) return;
  const StrideGround& ground = grounds_[body.avatar_class];
  const float query_range = wall_range(body);
  const auto rise = static_cast<int32_t>(query_range * config_.units.unit * 1000);  // 45 degrees
  const steer::Fan fan = steer::fan_around(situation.preferred);
  WallWindow window;
  switch (
      ground.query_walls(body.level, body.y, body.point(), cells_of(query_range), rise, window)) {
    case StrideGround::Around::kOpen:
      situation.has_walls = false;
      break;
    case StrideGround::Around::kWalls:
      find_free_distances(window, fan, query_range, situation.free_distance);
      for (float& displacement : situation.free_distance)
        displacement = wall_distance(body, displacement, query_range);
      break;
    case StrideGround::Around::kSteps:
      for (size_t k = 1; k < steer::kDirections; ++k) {
        situation.free_distance[k] = wall_distance(
            body, ground.free_distance(body.level, body.point(), fan[k], query_range), query_range);
      }
  }
}

void CrowdEngine::find_candidates(const Body& body, Worker& worker, bool open,
                                  Displacements& candidates) {
  const steer::Situation& situation = worker.situation;
  if (!is_sampled(body)) {
    const steer::Choices choices = steer::candidates_about(situation.preferred);
    std::transform(choices.begin(), choices.end(), candidates.begin(),
                   [&](Plane displacement) { return displacement_of(body, displacement); });
    return;
  }
  steer::Trials trials;
  steer::Costs costs;
  steer::costs_of_fast(config_.steering, situation, trials, costs);
  size_t n = 0;
  if (open) {
    candidates[n++] =
        displacement_of(body, reachable(body, if_blocked(situation.preferred, situation)));
  }
  // Squares of walls are coarse, so beside a wall the cheapest trials may all lead into it: bodies
  // that queue, and do not walk back, would have no other.
  Stand place;
  for (size_t tries = 0; tries < steer::kTrials && n < candidates.size(); ++tries) {
    const Plane velocity = if_blocked(steer::take_best_fast(trials, costs), situation);
    const Displacement displacement =
        displacement_of(body, reachable(body, unless_back(body, worker, velocity)));
    if (!config_.queues || try_displacement(body, displacement, place)) {
      candidates[n++] = displacement;
    }
  }
  std::fill(candidates.begin() + static_cast<ptrdiff_t>(n), candidates.end(), Displacement{});
}

std::span<const uint32_t> CrowdEngine::others_of(const Proposal& proposal) const {
  const uint32_t* const end = proposal.words.data() + kWords;
  if (!proposal.is_in_list) return {end - proposal.others, end};
  const Worker& worker = workers_[proposal.words[kWords - 2]];
  return {worker.others.data() + proposal.words[kWords - 1], proposal.others};
}

// Appends the bodies that a worker listed last to the proposed move, if they fit.
void CrowdEngine::store_others(Proposal& proposal, uint16_t worker, size_t first) {
  std::vector<uint32_t>& others = workers_[worker].others;
  proposal.others = static_cast<uint32_t>(others.size() - first);
  proposal.is_in_list = proposal.candidate_count + size_t{proposal.others} > kWords;
  if (proposal.is_in_list) {
    proposal.words[kWords - 2] = worker;
    proposal.words[kWords - 1] = static_cast<uint32_t>(first);
    return;
  }
  std::copy(others.begin() + static_cast<std::ptrdiff_t>(first), others.end(),
            proposal.words.end() - proposal.others);
  others.resize(first);
}

// The move of a body that keeps to the velocity that it chose when it last decided, which it may
// still accelerate to.
CrowdEngine::Displacement CrowdEngine::chosen_displacement(const Body& body) const {
  return displacement_again(body, reachable(body, choices_[body.slot]));
}

// Proposes the place that a body reaches if it keeps to its choice; returns whether it could touch
// another. None if that is not free.
std::optional<bool> CrowdEngine::try_to_continue(uint32_t i, uint16_t w, uint32_t square) {
  Worker& worker = workers_[w];
  Body& body = bodies_[i];
  Proposal& proposal = proposals()[i];
  proposal = {};
  proposal.flags = Body::kContinues;
  proposal.in_counterflow = body.in_counterflow;
  const Displacement displacement = chosen_displacement(body);
  if (!try_displacement(body, displacement, proposal.place)) return std::nullopt;
  const float touch = touch_of(body);
  const NeighbourGrid::Around around = grid_->around(square, touch <= grid_->width() ? 1 : 2);
  fit_lists(around, worker);
  const Eye eye{.x = body.x,
                .z = body.z,
                .y = body.y,
                .self = i,
                .max_square = 0,
                .tall = 0,
                .touch = touch * touch,
                .touch_tall = std::max<int32_t>(body.height, highest_) + 2 * kMaxRise};
  SeenLists lists{worker.squares.data(), worker.entries.data(), worker.touched.data()};
  find_seen({grid_->x(), grid_->z(), grid_->y()}, around.pieces(), eye, lists);
  const size_t first = worker.others.size();
  list_touched(body, lists, worker);
  if (worker.others.size() == first) {
    body.state = Body::kFree;
    return false;
  }
  const std::span<const uint32_t> others(worker.others.data() + first,
                                         worker.others.size() - first);
  if (!is_clear(body, proposal.place, others, /*any_moved=*/false)) {
    worker.others.resize(first);
    return std::nullopt;
  }
  body.state = Body::kUndecided;
  proposal.round = 1;
  proposal.add_displacement(displacement);
  store_others(proposal, w, first);
  return true;
}

// Senses, steers, and proposes a place if no other could touch it. Returns whether it could touch
// one.
bool CrowdEngine::decide(uint32_t i, uint16_t w, const NeighbourGrid::Around& around) {
  Worker& worker = workers_[w];
  Body& body = bodies_[i];
  Proposal& proposal = proposals()[i];
  proposal = {};
  if (body.has(Body::kMovedElsewhere)) {
    body.state = Body::kEnclosed;
    return false;
  }
  const size_t first = worker.others.size();
  sense(i, worker, around, true);
  const std::span<const uint32_t> others(worker.others.data() + first,
                                         worker.others.size() - first);
  // Not when candidates are found again: a body that yielded then heads to its target, or lanes jam
  // more often.
  if (is_sampled(body)) keep_right(body, worker);
  const bool open = find_open_preferred(i, worker, around);
  proposal.in_counterflow = worker.in_counterflow;
  body.follows = worker.follows;
  // The best candidate is enough as long as no other contests it.
  if (!open) query_walls(body, worker.situation);
  const Plane best =
      open ? worker.situation.preferred
           : unless_back(body, worker,
                         if_blocked(steer::best_fast(config_.steering, worker.situation),
                                    worker.situation));
  const Plane reached = reachable(body, best);
  Displacements candidates{displacement_of(body, reached)};
  proposal.has_all = find_room(body, best, worker, others, candidates);
  proposal.asks = worker.asks.has_value();
  proposal.yields = worker.yields;
  proposal.in_stream = worker.in_stream;
  proposal.may_rest = config_.queues && may_rest(body);
  if (proposal.may_rest) proposal.rest = next_rest(i, around);
  if (worker.asks) requests_[step_ % 2][body.slot] = *worker.asks;
  bool proposed = !proposal.has_all && try_displacement(body, candidates[0], proposal.place) &&
                  is_clear(body, proposal.place, others, /*any_moved=*/false);
  if (proposed) {
    // A body that asks looks in each step whether there is room.
    const bool keeps =
        !worker.asks && (!gains_little_ || (reached.x == best.x && reached.z == best.z));
    proposal.flags = keeps ? Body::kContinues : 0;
    choices_[body.slot] = best;
    proposal.round = others.empty() ? 0 : 1;
  } else if (!proposal.has_all) {
    if (open) query_walls(body, worker.situation);
    find_candidates(body, worker, open, candidates);
    proposal.has_all = true;
  }
  // Known only if walls were queried.
  body.near_wall = (!open || !proposed) && worker.situation.has_walls;
  if (others.empty()) {
    if (!proposed) proposed = try_displacements(body, candidates, others, proposal.place);
    body.state = proposed ? Body::kFree : Body::kEnclosed;
    return false;
  }
  body.state = Body::kUndecided;
  for (size_t n = 0; n < (proposed ? 1 : candidates.size()); ++n)
    proposal.add_displacement(candidates[n]);
  store_others(proposal, w, first);
  return true;
}

// Where a body would stand after a move, if the ground permits it.
bool CrowdEngine::try_displacement(const Body& body, Displacement displacement,
                                   Stand& place) const {
  const world::GroundPoint to{int64_t{body.x} + displacement.x, int64_t{body.z} + displacement.z};
  StrideGround::Landing landing;
  if (!grounds_[body.avatar_class].move(body.level, body.y, body.point(), to, landing)) {
    return false;
  }
  if (std::abs(landing.y - body.y) > kMaxRise) return false;
  place = {static_cast<int32_t>(to.x), static_cast<int32_t>(to.z), landing.y, landing.level};
  return true;
}

// The first candidate that is open and clear, then a shorter one.
bool CrowdEngine::try_displacements(const Body& body, const Displacements& candidates,
                                    std::span<const uint32_t> others, Stand& place) const {
  const auto is_free = [&](Displacement displacement) {
    Stand to;
    if (!try_displacement(body, displacement, to) ||
        !is_clear(body, to, others, /*any_moved=*/true)) {
      return false;
    }
    place = to;
    return true;
  };
  return std::any_of(candidates.begin(), candidates.end(), is_free) ||
         std::any_of(kShorterParts.begin(), kShorterParts.end(),
                     [&](float part) { return is_free(shorter(candidates[0], part)); });
}

// Contests for which `act` returns true are left out from then on.
template <class Do>
void CrowdEngine::for_contests(uint64_t Contests::*which, Do act) {
  static_assert(kGrain % kBits == 0);
  const size_t words = (size_ + kBits - 1) / kBits;
  constexpr size_t kPiece = kGrain / kBits;
  const auto run = [&](size_t piece, int32_t worker) {
    const size_t last = std::min(words, (piece + 1) * kPiece);
    for (size_t word = piece * kPiece; word < last; ++word) {
      uint64_t& bits = contests_[word].*which;
      for (uint64_t left = bits; left != 0; left &= left - 1) {
        const auto bit = static_cast<size_t>(std::countr_zero(left));
        const auto i = static_cast<uint32_t>(word * kBits + bit);
        if (act(i, workers_[static_cast<size_t>(worker)])) bits ^= uint64_t{1} << bit;
      }
    }
  };
  parallel_for_worker((words + kPiece - 1) / kPiece, config_.workers, run);
}

// By induction no body ever touches another: a proposed place is clear of where all bodies stand
// that could touch it, and it is accepted only if it is clear of what those before it in the order
// proposed, accepted or not.
void CrowdEngine::resolve_conflicts(uint64_t step) {
  for (int32_t r = 1; r <= config_.rounds; ++r) {
    const auto round = static_cast<uint8_t>(r);
    // Nearly all proposed a place for the first round when they decided: none had moved yet.
    for_contests(r == 1 ? &Contests::unproposed : &Contests::open,
                 [&](uint32_t i, Worker& scratch) {
                   propose(i, scratch, round);
                   return false;
                 });
    if (exchange_ != nullptr) exchange_moves(round);
    for_contests(&Contests::open, [&](uint32_t i, Worker&) {
      const bool decided = proposals()[i].round == round && is_accepted(i, step);
      if (decided) bodies_[i].state = Body::kDecided;
      return decided;
    });
    if (exchange_ != nullptr && r < config_.rounds) exchange_accepted(round);
  }
}

// Is a place clear of where the others stand now?
bool CrowdEngine::is_clear(const Body& body, const Stand& place, std::span<const uint32_t> others,
                           bool any_moved) const {
  return std::none_of(others.begin(), others.end(), [&](uint32_t j) {
    const Body& other = bodies_[j];
    const bool moved = any_moved && other.state == Body::kDecided;
    return overlaps_with(body, place, other, moved ? proposals()[j].place : other.stand());
  });
}

// Proposes the first candidate that is open and clear, if there is one.
void CrowdEngine::propose(uint32_t i, Worker& scratch, uint8_t round) {
  const Body& body = bodies_[i];
  Proposal& proposal = proposals()[i];
  const std::span<const uint32_t> others = others_of(proposal);
  Stand place;
  const auto take = [&](bool found) {
    if (!found) return;
    proposal.place = place;
    proposal.round = round;
  };
  if (!proposal.has_all && !proposal.forgets) {
    const bool found = try_displacement(body, proposal.displacement(0), place) &&
                       is_clear(body, place, others, /*any_moved=*/true);
    if (found) return take(true);
  }
  proposal.flags = 0;  // It makes a move that was not its first choice.
  Displacements candidates;
  if (proposal.has_all) {
    for (size_t n = 0; n < candidates.size(); ++n)
      candidates[n] = proposal.displacement(static_cast<uint32_t>(n));
    return take(try_displacements(body, candidates, others, place));
  }
  // What it steers by is as when the step began. Others read `scratch.others` meanwhile.
  const NeighbourGrid::Around around = grid_->around(grid_->square(body));
  sense(i, scratch, around, /*lists_others=*/false);
  const bool open = find_open_preferred(i, scratch, around);
  query_walls(body, scratch.situation);
  find_candidates(body, scratch, open, candidates);
  proposal.forgets = !proposal.has_room(candidates.size());
  if (!proposal.forgets) {
    proposal.candidate_count = 0;
    for (const Displacement displacement : candidates) proposal.add_displacement(displacement);
    proposal.has_all = true;
  }
  take(try_displacements(body, candidates, others, place));
}

bool CrowdEngine::is_accepted(uint32_t i, uint64_t step) const {
  const Body& body = bodies_[i];
  const Proposal& proposal = proposals()[i];
  const auto order = [&](const Body& b) {
    const uint32_t name = name_of(b);
    return std::pair(random_u64(config_.seed, name, step), name);
  };
  const auto mine = order(body);
  const std::span<const uint32_t> others = others_of(proposal);
  return std::none_of(others.begin(), others.end(), [&](uint32_t j) {
    const Proposal& other = proposals()[j];
    return other.round == proposal.round &&
           overlaps_with(body, proposal.place, bodies_[j], other.place) && order(bodies_[j]) > mine;
  });
}

void CrowdEngine::settle_all(EngineCounts& counts) {
  arrived_.clear();
  std::mutex adding;
  const Turning turning(orientations_, config_.units.dt);
  const auto run = [&](size_t begin, size_t end) {
    EngineCounts here;
    for (size_t i = begin; i < end; ++i) {
      Body& b = bodies_[i];
      if (i + kOrientationPrefetch < end) {
        const uint32_t slot = bodies_[i + kOrientationPrefetch].slot;
        turning.prefetch(slot);
        if (config_.queues) __builtin_prefetch(&progress_[slot]);
      }
      if (b.has(Body::kMovedElsewhere) || b.is_ghost) continue;
      here.low_detail += b.has(Body::kLowDetail) ? 1 : 0;
      const Plane displacement =
          b.has(Body::kExternal)
              ? Plane{}
              : config_.units.metres(b.local_target_x - b.x, b.local_target_z - b.z);
      b.asks = b.steps > 0 && proposals()[i].asks;
      if (b.steps == 0) {  // For all others it looks as if it had moved evenly.
        ++here.skipped;
        if (b.has(Body::kHasGoal)) here.progress += progress_of(b, displacement);
        continue;
      }
      const StepUnits units = units_of(b);
      const Proposal& proposal = proposals()[i];
      const Stand& place = proposal.place;
      const bool is_alone = b.state == Body::kFree || b.state == Body::kEnclosed;
      const bool may_move = b.state == Body::kFree || b.state == Body::kDecided;
      const bool stood = config_.queues && stands(b);
      const bool moves = may_move && (place.x != b.x || place.z != b.z);
      if (may_move) keep_rest(b, place.x, place.z, units.units_by_speed());
      if (moves) {
        b.velocity = {units.velocity(place.x - b.x), units.velocity(place.z - b.z)};
        b.x = place.x;
        b.z = place.z;
        b.y = place.y;
        b.level = place.level;
      } else {
        b.velocity = {};
        ++here.stood;
      }
      turning.turn(b, units.dt);
      b.clear(Body::kContinues);
      b.in_counterflow = proposal.in_counterflow;
      if (proposal.may_rest) {
        progress_[b.slot].set_rest(proposal.rest, size_of(displacement), units.dt);
        b.at_rest = proposal.rest != Rest::kNo;
      }
      if (config_.queues) settle_queue(b, stood, proposal, units.dt);
      if (may_move) b.flags = static_cast<uint8_t>(b.flags | proposal.flags);
      if (!b.has(Body::kHasGoal) || b.has(Body::kExternal)) continue;
      const float left = size_of(displacement);
      const float towards = speed_towards(b, displacement);
      here.progress += progress_of(b, displacement);
      const bool near_goal = left <= 1 && b.has(Body::kLast);
      // A body without others near has none to turn away from.
      if (config_.deadlock_avoidance) {
        const float content =
            near_goal || is_alone || !may_turn_aside(b)
                ? 1
                : steer::progress_felt(config_.deadlock_settings, towards / b.speed, b.follows);
        const float along =
            (b.velocity.x * b.preferred.x + b.velocity.z * b.preferred.z) / (b.speed * b.speed);
        b.detour_angle = steer::next_detour_angle(config_.deadlock_settings, b.detour_angle,
                                                  content, along, units.dt);
      }
      const Plane rest = config_.units.metres(b.local_target_x - b.x, b.local_target_z - b.z);
      if (b.has(Body::kLast) && !b.has(Body::kArrived) && size_of(rest) < kArrivalRadius) {
        b.flags |= Body::kArrived;
        const std::lock_guard lock(adding);
        arrived_.push_back(b.slot);
      }
    }
    const std::lock_guard lock(adding);
    counts.add(here);
  };
  parallel_ranges(size_, 4 * kGrain, config_.workers, run);
}

uint64_t CrowdEngine::bytes() const {
  uint64_t bytes = 2 * bodies_.size() * sizeof(Body) + contests_.size() * sizeof(Contests) +
                   (grid_ ? grid_->bytes() : 0);
  bytes += progress_.capacity() * sizeof(QueueProgress) + choices_.capacity() * sizeof(Plane) +
           2 * requests_[0].capacity() * sizeof(RoomRequest);
  for (const Worker& worker : workers_) {
    bytes += 4 * (worker.squares.capacity() + worker.entries.capacity() +
                  worker.touched.capacity() + worker.others.capacity());
  }
  return bytes;
}

}  // namespace throng::crowd
