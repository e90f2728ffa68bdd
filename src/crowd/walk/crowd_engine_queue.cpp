// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>

#include "crowd/mode/saved_rows.h"
#include "crowd/walk/crowd_engine.h"

// Queues before doors: docs/design/008-engine.md, "Queues". The idea that a body which has
// precedence makes others give room, and that these pass the request on, is priority inheritance of
// multi-agent path finding [Okumura19]. Constant time for each body and its neighbours.
namespace throng::crowd {
namespace {

using steer::Plane;

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
  const Plane target =
      config_.units.metres(body.local_target_x - body.x, body.local_target_z - body.z);
  return {size_of(target) + after_[body.slot], body.slot};
}

// What a body keeps to another that is ahead in the order, so that the other can move. [m]
float CrowdEngine::margin_to(const Body& body, const Body& other, float gap) const {
  if (gap >= config_.queue.ahead_range || !queues(body) || !queues(other)) return 0;
  return order_of(other) < order_of(body) ? config_.queue.ahead_margin : 0;
}

// The room that a body keeps to a neighbour. Notes whether that comes towards it. [m]
float CrowdEngine::room_in_queue(const Body& body, const Body& other, Plane apart, float room,
                                 Worker& worker) const {
  worker.has_oncoming = worker.has_oncoming || comes_towards(body, other, apart);
  return room + margin_to(body, other, size_of(apart) - room);
}

// A body follows the request that is first in the order, unless it is ahead of that itself. If none
// asks it, it may be the head of a queue, and ask.
void CrowdEngine::query_queue(const Body& body, std::span<const uint32_t> nearest,
                              Worker& worker) const {
  if (body.has(Body::kExternal)) return;
  const std::vector<RoomRequest>& requests = requests_[(step_ + 1) % 2];
  const QueueOrder own = queues(body) ? order_of(body) : QueueOrder{};
  QueueOrder first = own;
  const bool is_at_rest = rests(body);
  uint32_t asker = UINT32_MAX;
  Plane asked, from;
  uint32_t by = 0;
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
    const bool is_first = request.order < first ||
                          (asker != UINT32_MAX && !(first < request.order) && other.slot < asker);
    if (!is_first) continue;
    first = request.order;
    asker = other.slot;
    from = apart;
    needs = room;
    asked = request.ahead;
    by = j;
  }
  if (asker != UINT32_MAX) {
    const Plane away = unit({-from.x, -from.z});
    worker.yields = queues(body) && dot(unit(path_ahead(bodies_[by])), unit(path_ahead(body))) <
                                        -config_.queue.oncoming;
    const bool steps_aside = worker.yields || !queues(body);
    worker.makes_room = steps_aside ? aside_of(body, away, from, asked, needs) : away;
    worker.asks = RoomRequest{first, *worker.makes_room};
  } else if (queues(body) && is_head(body, nearest)) {
    worker.asks = RoomRequest{own, unit(path_ahead(body))};
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

// Has it stood, with none before it that is ahead in the order?
bool CrowdEngine::is_head(const Body& body, std::span<const uint32_t> nearest) const {
  // One that follows a body which makes room for it asks on.
  const bool asks_on = body.asks && size_of(body.velocity) < config_.queue.asks_on * body.speed &&
                       requests_[(step_ + 1) % 2][body.slot].order.slot == body.slot;
  const bool has_stood = stands(body) && progress_[body.slot].stood >= config_.queue.head_stands;
  if (!has_stood && !asks_on) return false;
  const Plane ahead = path_ahead(body);
  const QueueOrder own = order_of(body);
  return std::none_of(nearest.begin(), nearest.end(), [&](uint32_t j) {
    const Body& other = bodies_[j];
    if (!queues(other)) return false;
    const Plane apart = config_.units.metres(other.x - body.x, other.z - body.z);
    const float room = static_cast<float>(body.radius + other.radius) * config_.units.unit;
    return size_of(apart) - room < config_.queue.head_range && dot(ahead, apart) > 0 &&
           order_of(other) < own;
  });
}

// A velocity away from its local target becomes 0, unless another comes towards it: people that
// queue stand rather than walk back.
Plane CrowdEngine::unless_back(const Body& body, const Worker& worker, Plane velocity) const {
  const bool may = !config_.queues || !queues(body) || worker.waits || worker.has_oncoming ||
                   body.detour_angle != 0;
  return may || dot(velocity, path_ahead(body)) >= 0 ? velocity : Plane{};
}

// Candidates of a body that makes room, or of the head of a queue whose best velocity is next to
// nothing: the nearest directions in which the ground permits a step. False: it does neither.
bool CrowdEngine::find_room(const Body& body, Plane best, Worker& worker,
                            Displacements& candidates) const {
  if (!worker.asks) return false;
  const QueueSettings& queue = config_.queue;
  const float wanted = size_of(body.preferred);
  if (!worker.makes_room && size_of(best) >= queue.creep_share * wanted) return false;
  constexpr size_t kNear = 11, kMaxFound = 4;  // directions within 75 degrees; candidates
  const size_t directions = worker.makes_room ? kRoomDirections : kRoomDirections / 2;
  float speed = queue.room_share * body.speed;
  if (!worker.makes_room) speed = std::min(speed, wanted);  // It must not pass its local target.
  const auto all = room_directions(worker.makes_room ? *worker.makes_room : worker.asks->ahead);
  size_t n = 0;
  for (size_t d = 0; d < directions && n < kMaxFound && (d < kNear || n == 0); ++d) {
    for (const float part : {1.0f, 0.25f}) {
      const Displacement displacement =
          displacement_of(body, {all[d].x * speed * part, all[d].z * speed * part});
      Stand place;
      if (!try_displacement(body, displacement, place)) continue;
      candidates[n++] = displacement;
      break;
    }
  }
  // To stand is always clear, so shorter moves must come before that.
  for (const float part : kShorterParts) {
    if (n > 0 && n < candidates.size()) candidates[n++] = shorter(candidates[0], part);
  }
  std::fill(candidates.begin() + static_cast<ptrdiff_t>(n), candidates.end(), Displacement{});
  return true;
}

// The velocity that comes nearest to another within the body's acceleration.
Plane CrowdEngine::reachable(const Body& body, Plane velocity) const {
  if (!(config_.acceleration > 0)) return velocity;
  const Plane change{velocity.x - body.velocity.x, velocity.z - body.velocity.z};
  const float size = size_of(change), most = config_.acceleration * units_of(body).dt;
  if (size <= most) return velocity;
  const float part = most / size;
  return {body.velocity.x + change.x * part, body.velocity.z + change.z * part};
}

bool CrowdEngine::stands(const Body& body) const {
  const float slow = config_.queue.still_share * body.speed;
  return dot(body.velocity, body.velocity) < slow * slow;
}

// `stood`: at the beginning of the step.
void CrowdEngine::settle_standing(const Body& body, bool stood, bool yields, float dt) {
  constexpr float kLongest = 60;  // [s]
  const bool still = stands(body);
  if (still || stood || yields) {
    QueueProgress& progress = progress_[body.slot];
    progress.stood = still ? std::min(progress.stood + dt, kLongest) : 0;
    progress.yields = yields ? config_.queue.yield_time : std::max(progress.yields - dt, 0.0f);
  }
}

// Does it stand, instead of heading to its goal, until it has rested or another has passed?
bool CrowdEngine::is_paused(const Body& body) const {
  return rests(body) || (stands(body) && progress_[body.slot].yields > 0);
}

// The detour angle is the last resort of heads of queues: others wait.
bool CrowdEngine::may_turn_aside(const Body& body) const {
  return body.asks && requests_[step_ % 2][body.slot].order.slot == body.slot &&
         progress_[body.slot].stood >= config_.queue.detour_stands;
}

// Requests count for one step: those of the last one are read in the next.
void CrowdEngine::save_rows(size_t rows, std::vector<uint8_t>& out) const {
  put_rows(out, after_.data(), rows);
  if (!config_.queues) return;
  put_rows(out, progress_.data(), rows);
  put_rows(out, requests_[step_ % 2].data(), rows);
}

bool CrowdEngine::has_sound_rows(uint32_t slot) const {
  if (!(after_[slot] >= 0)) return false;
  if (!config_.queues) return true;
  const QueueProgress& progress = progress_[slot];
  const RoomRequest& request = requests_[0][slot];
  return progress.stood >= 0 && progress.rest <= Rest::kMadeRoom && request.order.left >= 0 &&
         std::abs(request.ahead.x) <= 1.001f && std::abs(request.ahead.z) <= 1.001f;
}

const uint8_t* CrowdEngine::restore_rows(const uint8_t* saved, size_t rows) {
  saved = take_rows(saved, rows, after_);
  if (!config_.queues) return saved;
  saved = take_rows(saved, rows, progress_);
  saved = take_rows(saved, rows, requests_[0]);
  requests_[1] = requests_[0];
  return saved;
}

}  // namespace throng::crowd
