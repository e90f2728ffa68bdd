// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <tuple>

#include "core/random.h"
#include "crowd/mode/saved_rows.h"
#include "crowd/walk/crowd_engine.h"

// Queues before doors: docs/design/008-engine.md, "Queues". The idea that a body which has
// precedence makes others give room, and that these pass the request on, is priority inheritance of
// multi-agent path finding [Okumura19]. Constant time for each body and its neighbours.
namespace throng::crowd {
namespace {

using steer::Plane;

constexpr uint64_t kTurns = 0x7ead;  // random stream

float dot(Plane a, Plane b) { return a.x * b.x + a.z * b.z; }

// X of a null vector, as steer::ahead_of.
Plane unit(Plane p) {
  const float size = size_of(p);
  return size > 0 ? Plane{p.x / size, p.z / size} : Plane{1, 0};
}

}  // namespace

// Does it head to a goal of its own, so that it has a place in a queue?
bool CrowdEngine::queues(const Body& body) const {
  constexpr uint8_t kAll =
      Body::kHasGoal | Body::kArrived | Body::kExternal | Body::kMovedElsewhere;
  return (body.flags & kAll) == Body::kHasGoal && !body.leaves && !rests(body);
}

QueueOrder CrowdEngine::order_of(const Body& body) const {
  const Plane ahead = path_ahead(body);
  const float left = size_of(ahead) + progress_[body.slot].after;
  return {name_of(body),
          {body.x, body.z},
          {body.local_target_x, body.local_target_z},
          path_beyond(body),
          left};
}

// Its order, which few need: it is found once.
const QueueOrder& CrowdEngine::own_order(const Body& body, Worker& worker) const {
  if (worker.own.name == UINT32_MAX && queues(body)) worker.own = order_of(body);
  return worker.own;
}

// The room that a body keeps to a close neighbour: more to one that is ahead in the order, so that
// it can move. [m]
float CrowdEngine::room_in_queue(const Body& body, const Body& other, float room,
                                 Worker& worker) const {
  worker.is_close = true;
  if (!queues(body) || !queues(other)) return room;
  return order_of(other) < own_order(body, worker) ? room + config_.queue.ahead_margin : room;
}

// Do enough come towards it? While it walks freely it need not know.
bool CrowdEngine::meets_stream(const Body& body, std::span<const uint32_t> nearest,
                               const Worker& worker) const {
  const float slow = config_.queue.held_up * body.speed;
  if (!worker.is_close && dot(body.velocity, body.velocity) >= slow * slow) return false;
  int32_t oncoming = 0;
  for (size_t n = 0; n < nearest.size() && oncoming < config_.queue.min_oncoming; ++n) {
    const Body& other = bodies_[nearest[n]];
    const Plane apart = config_.units.metres(other.x - body.x, other.z - body.z);
    oncoming += comes_towards(body, other, apart) ? 1 : 0;
  }
  return oncoming >= config_.queue.min_oncoming;
}

// Of the requests of those that are ahead of it a body follows the one with the shortest path left:
// neighbours have no order of their own, so the choice must not depend on which comes first. If
// none asks it, it may be the head of a queue, and ask.
void CrowdEngine::query_queue(uint32_t i, std::span<const uint32_t> nearest,
                              const NeighbourGrid::Around& around, Worker& worker) const {
  const Body& body = bodies_[i];
  if (body.has(Body::kExternal)) return;
  const std::vector<RoomRequest>& requests = requests_[(step_ + 1) % 2];
  QueueOrder first;
  const bool is_at_rest = rests(body);
  const Body* asker = nullptr;
  Plane asked, from;
  float needs = 0;
  for (const uint32_t j : nearest) {
    const Body& other = bodies_[j];
    if (!other.asks || other.has(Body::kMovedElsewhere)) continue;
    const Plane apart = config_.units.metres(other.x - body.x, other.z - body.z);
    const float room = static_cast<float>(body.radius + other.radius) * config_.units.unit;
    const RoomRequest& request = requests[other.slot];
    if (size_of(apart) - room >= config_.queue.touch_gap || dot(request.ahead, apart) >= 0) {
      continue;
    }
    // It stands where the other wants to stand: that one rests beside it.
    const auto reach = int64_t{body.radius} + other.radius;
    const bool is_wanted =
        is_at_rest && other.has(Body::kLast) &&
        nearer_than(other.local_target_x - body.x, other.local_target_z - body.z, reach);
    if (is_wanted) continue;
    const auto key = [&](const QueueOrder& order, const Body& of) {
      return std::tuple(order.left, order.name, name_of(of));
    };
    if (request.order.name == name_of(body) || !(request.order < own_order(body, worker))) continue;
    if (asker != nullptr && key(first, *asker) < key(request.order, other)) continue;
    first = request.order;
    asker = &other;
    from = apart;
    needs = room;
    asked = request.ahead;
  }
  if (takes_turn(body, asker, first)) {
    QueueOrder order = own_order(body, worker);
    order.left = std::min(order.left, QueueOrder::kTurn - 1) - QueueOrder::kTurn;
    worker.asks = RoomRequest{order, unit(path_ahead(body))};
  } else if (asker != nullptr) {
    const Plane away = unit({-from.x, -from.z});
    worker.yields =
        queues(body) &&
        dot(unit(path_ahead(*asker)), unit(path_ahead(body))) < -config_.queue.oncoming &&
        !go_on_alike(body, *asker);
    const bool steps_aside = worker.yields || !queues(body);
    worker.makes_room = steps_aside ? aside_of(body, away, from, asked, needs) : away;
    worker.asks = RoomRequest{first, *worker.makes_room};
  } else if (queues(body) && is_head(body, nearest, worker) &&
             !(may_rest(body) && is_goal_taken(i, around))) {
    worker.asks = RoomRequest{own_order(body, worker), unit(path_ahead(body))};
  }
}

// Where a body goes that another asks to make room, `from` where it is, and that does not go the
// same direction: to the side, if walls leave the room that both need to pass, or else away.
Plane CrowdEngine::aside_of(const Body& body, Plane away, Plane from, Plane asked,
                            float room) const {
  constexpr float kSpare = 0.02f, kFarthest = 1.5f;  // [m]
  const Plane right{-asked.z, asked.x};
  const float off = -dot(from, right);  // to the right of the line that the other walks along
  const StrideGround& ground = grounds_[body.avatar_class];
  const auto has_room = [&](float side) {
    const float wanted = room + kSpare - side * off;
    if (!(wanted > 0 && wanted < kFarthest)) return false;
    const float range = wanted / config_.units.unit;
    return ground.free_distance(body.level, body.point(), {side * right.x, side * right.z},
                                range) >= range;
  };
  const float nearer = off >= 0 ? 1.0f : -1.0f;
  for (const float side : {nearer, -nearer}) {
    if (has_room(side)) return {side * right.x, side * right.z};
  }
  return away;
}

// A body and the head of a queue that asks it for room, both go the same direction and neither gets
// on: they may hold each other, each at a post of a narrow door. For a while in every other one it
// is the first instead, and the head makes room for it.
bool CrowdEngine::takes_turn(const Body& body, const Body* asker, const QueueOrder& first) const {
  // So it is for nearly all.
  if (asker == nullptr && !body.asks) return false;
  const auto steps =
      static_cast<uint64_t>(std::max(std::lround(config_.queue.turn_time / config_.units.dt), 1L));
  if (step_ / steps % 2 == 0 || !queues(body) || first.left < 0) return false;
  const QueueOrder& last = requests_[(step_ + 1) % 2][body.slot].order;
  if (body.asks && last.name == name_of(body) && last.left < 0) return true;
  return asker != nullptr && first.name == name_of(*asker) && stands(body) &&
         dot(first.beyond, path_beyond(body)) > 0 &&
         std::min(progress_[body.slot].stood, progress_[asker->slot].stood) >=
             config_.queue.held_stands;
}

// Bodies that have long stood, and of which none asks, may wait for each other in a cycle: each
// becomes the first of a queue for a while, in turn.
bool CrowdEngine::has_turn(const Body& body, std::span<const uint32_t> nearest) const {
  constexpr uint64_t kSteps = 8, kShare = 8;  // for so many steps; one of so many bodies
  return progress_[body.slot].stood >= config_.queue.turn_stands &&
         random_u64(config_.seed ^ kTurns, name_of(body), step_ / kSteps) % kShare == 0 &&
         std::none_of(nearest.begin(), nearest.end(), [&](uint32_t j) { return bodies_[j].asks; });
}

// Has it stood, with none before it that is ahead in the order?
bool CrowdEngine::is_head(const Body& body, std::span<const uint32_t> nearest,
                          Worker& worker) const {
  // One that follows a body which makes room for it asks on.
  const bool asks_on = body.asks && size_of(body.velocity) < config_.queue.asks_on * body.speed &&
                       requests_[(step_ + 1) % 2][body.slot].order.name == name_of(body);
  const bool has_stood = stands(body) && progress_[body.slot].stood >= config_.queue.head_stands;
  if (!has_stood && !asks_on) return false;
  if (has_turn(body, nearest)) return true;
  const Plane ahead = path_ahead(body);
  return std::none_of(nearest.begin(), nearest.end(), [&](uint32_t j) {
    const Body& other = bodies_[j];
    if (!queues(other)) return false;
    const Plane apart = config_.units.metres(other.x - body.x, other.z - body.z);
    const float room = static_cast<float>(body.radius + other.radius) * config_.units.unit;
    return size_of(apart) - room < config_.queue.head_range && dot(ahead, apart) > 0 &&
           order_of(other) < own_order(body, worker);
  });
}

// Without its part to the left, of a body that must keep to its half.
Plane CrowdEngine::unless_left(const Worker& worker, Plane velocity) {
  const float left = std::max(-dot(velocity, worker.not_left), 0.0f);
  return {velocity.x + left * worker.not_left.x, velocity.z + left * worker.not_left.z};
}

// A velocity away from its local target becomes 0: people that queue stand rather than walk back,
// unless a stream comes towards them.
Plane CrowdEngine::unless_back(const Body& body, const Worker& worker, Plane velocity) const {
  if (!config_.queues) return velocity;
  const Plane kept = unless_left(worker, velocity);
  const bool may = !queues(body) || pushes(body) || worker.waits || body.detour_angle != 0;
  return may || dot(kept, path_ahead(body)) >= 0 ? kept : Plane{};
}

// Does the ground permit a step, and do all others that stand?
bool CrowdEngine::can_move(const Body& body, Displacement displacement,
                           std::span<const uint32_t> others) const {
  Stand place;
  return try_displacement(body, displacement, place) &&
         is_clear(body, place, others, /*any_moved=*/false);
}

// Candidates of a body that makes room, or of the head of a queue whose best velocity is next to
// nothing or not possible: the nearest directions that are clear, or else those in which the ground
// permits a step: others may move away. False: it does neither.
bool CrowdEngine::find_room(const Body& body, Plane best, const Worker& worker,
                            std::span<const uint32_t> others, Displacements& candidates) const {
  if (!worker.asks) return false;
  const QueueSettings& queue = config_.queue;
  const float wanted = size_of(body.preferred);
  if (!worker.makes_room && size_of(best) >= queue.creep_share * wanted &&
      can_move(body, displacement_of(body, reachable(body, best)), others)) {
    return false;
  }
  constexpr size_t kNear = 11, kMaxFound = 4;  // directions within 75 degrees; candidates
  const size_t directions = worker.makes_room ? kRoomDirections : kRoomDirections / 2;
  float speed = (worker.yields ? queue.back_share : queue.room_share) * body.speed;
  // It must not pass its local target.
  if (!worker.makes_room) speed = std::min(queue.creep_speed * body.speed, wanted);
  const auto all = room_directions(worker.makes_room ? *worker.makes_room : worker.asks->ahead);
  size_t n = 0;
  const auto add = [&](size_t d, auto is_possible) {
    for (const float part : {1.0f, 0.5f, 0.25f}) {
      const Displacement displacement =
          displacement_of(body, {all[d].x * speed * part, all[d].z * speed * part});
      if (!is_possible(displacement)) continue;
      candidates[n++] = displacement;
      return;
    }
  };
  for (size_t d = 0; d < directions && n < kMaxFound; ++d) {
    add(d, [&](Displacement displacement) { return can_move(body, displacement, others); });
  }
  const bool is_blocked = n == 0;
  for (size_t d = 0; is_blocked && d < directions && n < kMaxFound && (d < kNear || n == 0); ++d) {
    Stand place;
    add(d, [&](Displacement displacement) { return try_displacement(body, displacement, place); });
  }
  // To stand is always clear, so shorter moves must come before that.
  for (const float part : kShorterParts) {
    if (n > 0 && n < candidates.size()) candidates[n++] = shorter(candidates[0], part);
  }
  std::fill(candidates.begin() + static_cast<ptrdiff_t>(n), candidates.end(), Displacement{});
  return true;
}

// The velocity that comes nearest to another within the body's acceleration. An externally
// controlled one moves as its host wants.
Plane CrowdEngine::reachable(const Body& body, Plane velocity) const {
  if (!(config_.acceleration > 0) || body.has(Body::kExternal)) return velocity;
  const StepUnits units = units_of(body);
  return steer::within_acceleration(body.velocity, velocity, config_.acceleration * units.dt,
                                    units.rounding(), body.speed);
}

bool CrowdEngine::stands(const Body& body) const {
  const float slow = config_.queue.still_share * body.speed;
  return dot(body.velocity, body.velocity) < slow * slow;
}

// `stood`: at the beginning of the step.
void CrowdEngine::settle_queue(Body& body, bool stood, const Proposal& proposal, float dt) {
  constexpr float kLongest = 60;  // [s]
  const bool still = stands(body);
  if (!proposal.in_stream && !body.in_stream && !still && !stood && !proposal.yields) return;
  QueueProgress& progress = progress_[body.slot];
  progress.stream =
      proposal.in_stream ? config_.queue.stream_time : std::max(progress.stream - dt, 0.0f);
  body.in_stream = progress.stream > 0;
  if (!still && !stood && !proposal.yields) return;
  progress.stood = still ? std::min(progress.stood + dt, kLongest) : 0;
  progress.yields =
      proposal.yields ? config_.queue.yield_time : std::max(progress.yields - dt, 0.0f);
}

// Does it stand, instead of heading to its goal, until it has rested or another has passed?
bool CrowdEngine::is_paused(const Body& body) const {
  return rests(body) || (stands(body) && progress_[body.slot].yields > 0);
}

// Where bodies queue, the detour angle is the last resort of those at their heads: others wait.
bool CrowdEngine::may_turn_aside(const Body& body) const {
  return pushes(body) ||
         (body.asks && requests_[step_ % 2][body.slot].order.name == name_of(body) &&
          progress_[body.slot].stood >= config_.queue.detour_stands);
}

// Requests count for one step: those of the last one are read in the next. Rows of bodies that do
// not ask hold old requests, which none reads.
void CrowdEngine::save_rows(size_t rows, std::vector<uint8_t>& out) const {
  put_rows(out, progress_.data(), rows);
  put_rows(out, choices_.data(), rows);
  if (!config_.queues) return;
  std::vector<RoomRequest> requests(rows);
  for (size_t i = 0; i < size_; ++i) {
    const Body& body = bodies_[i];
    if (body.asks) requests[body.slot] = requests_[step_ % 2][body.slot];
  }
  put_rows(out, requests.data(), rows);
}

bool CrowdEngine::has_sound_rows(const Body& body) const {
  const uint32_t slot = body.slot;
  const QueueProgress& progress = progress_[slot];
  if (!(progress.after >= 0)) return false;
  // Faster than its speed it would reach what it does not look at.
  constexpr float kRounding = 1.001f;
  if (body.has(Body::kContinues) && !(size_of(choices_[slot]) <= body.speed * kRounding)) {
    return false;
  }
  if (!config_.queues) return !body.in_stream && !body.at_rest;
  const RoomRequest& request = requests_[0][slot];
  const QueueOrder& order = request.order;
  constexpr float kFarthest = 1e6f;  // [m] as far as a crowd can lie
  const auto is_sound = [&](Plane p) {
    return std::abs(p.x) <= kFarthest && std::abs(p.z) <= kFarthest;
  };
  return progress.stood >= 0 && progress.yields >= 0 && progress.stream >= 0 &&
         progress.rest <= Rest::kMadeRoom && progress.vain >= 0 &&
         body.at_rest == (progress.rest != Rest::kNo) && body.in_stream == (progress.stream > 0) &&
         order.left >= -QueueOrder::kTurn && is_sound(progress.onward) && is_sound(order.beyond) &&
         std::abs(request.ahead.x) <= 1.001f && std::abs(request.ahead.z) <= 1.001f;
}

const uint8_t* CrowdEngine::restore_rows(const uint8_t* saved, size_t rows) {
  saved = take_rows(take_rows(saved, rows, progress_), rows, choices_);
  if (!config_.queues) return saved;
  saved = take_rows(saved, rows, requests_[0]);
  requests_[1] = requests_[0];
  return saved;
}

}  // namespace throng::crowd
