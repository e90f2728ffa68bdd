// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <vector>

#include "core/random.h"
#include "plain_crowd.h"

// Queues and rest of the plain step.
namespace throng::test {

using crowd::QueueOrder;
using crowd::Rest;
using steer::Plane;

Plane PlainCrowd::path_ahead(const PlainBody& body) const {
  return config_.units.metres(body.goal.x - body.at.x, body.goal.z - body.at.z);
}

bool PlainCrowd::may_rest(const PlainBody& body) const {
  return config_.queues &&
         crowd::nearer_than(body.goal.x - body.at.x, body.goal.z - body.at.z, sight());
}

bool PlainCrowd::rests(const PlainBody& body) const {
  return may_rest(body) && body.rest != Rest::kNo;
}

bool PlainCrowd::stands(const PlainBody& body) const {
  const float slow = config_.queue.still_share * body.speed;
  return body.velocity.x * body.velocity.x + body.velocity.z * body.velocity.z < slow * slow;
}

bool PlainCrowd::is_paused(const PlainBody& body) const {
  return rests(body) || (config_.queues && stands(body) && body.yields > 0);
}

bool PlainCrowd::pushes(const PlainBody& body) const { return !config_.queues || body.stream > 0; }

bool PlainCrowd::queues(const PlainBody& body) const {
  return config_.queues && body.arrived < 0 && !rests(body);
}

// Paths are straight.
QueueOrder PlainCrowd::order_of(uint32_t i) const {
  const PlainBody& body = bodies_[i];
  const Plane ahead = path_ahead(body);
  return {i, {body.at.x, body.at.z}, {body.goal.x, body.goal.z}, ahead, size_of(ahead)};
}

// Between the bodies. [m]
float PlainCrowd::gap(uint32_t i, const Near& n) const {
  const auto room = static_cast<float>(bodies_[i].radius + bodies_[n.other].radius);
  return size_of(config_.units.metres(n.at.x, n.at.z)) - room * config_.units.unit;
}

// Within the range in which it keeps off those ahead of it.
bool PlainCrowd::is_near(uint32_t i, const Near& n) const {
  const Plane at = config_.units.metres(n.at.x, n.at.z);
  const float range =
      static_cast<float>(bodies_[i].radius + bodies_[n.other].radius) * config_.units.unit +
      config_.queue.ahead_range;
  return at.x * at.x + at.z * at.z < range * range;
}

// Those that count in steering.
size_t PlainCrowd::nearest(uint32_t i) const {
  return std::min(near_[i].size(), static_cast<size_t>(config_.steering.neighbours));
}

// Two come towards it, or one before it that heads the same direction knows of a stream.
bool PlainCrowd::is_in_stream(uint32_t i) const {
  const PlainBody& body = bodies_[i];
  const Plane preferred = preferred_of(body), ahead = path_ahead(body);
  int32_t oncoming = 0;
  bool is_close = false;
  for (size_t k = 0; k < nearest(i); ++k) {
    const Near& n = near_[i][k];
    const PlainBody& other = bodies_[n.other];
    is_close = is_close || is_near(i, n);
    const Plane at = config_.units.metres(n.at.x, n.at.z), others = preferred_of(other);
    const float same = preferred.x * others.x + preferred.z * others.z;
    const float both = (preferred.x * preferred.x + preferred.z * preferred.z) *
                       (others.x * others.x + others.z * others.z);
    const bool is_before = at.x * preferred.x + at.z * preferred.z > 0;
    if (other.stream > 0 && is_before && same > 0 && 2 * same * same > both) return true;
    const Plane theirs = path_ahead(other);
    const float along = ahead.x * theirs.x + ahead.z * theirs.z;
    const bool goes_alike = along > config_.queue.alike * size_of(ahead) * size_of(theirs);
    if (same < 0 && !goes_alike &&
        steer::comes_towards(at, ahead, theirs, config_.lanes.narrow_opposed)) {
      ++oncoming;
    }
  }
  const Plane v = body.velocity;
  const float slow = config_.queue.held_up * body.speed;
  return oncoming >= config_.queue.min_oncoming &&
         (is_close || v.x * v.x + v.z * v.z < slow * slow);
}

// After long standing each is the first of a queue in turn, if none asks.
bool PlainCrowd::has_turn(uint32_t i) const {
  bool asked = false;
  for (size_t k = 0; k < nearest(i); ++k) asked = asked || bodies_[near_[i][k].other].asks;
  return !asked && bodies_[i].stood >= config_.queue.turn_stands &&
         random_u64(config_.seed ^ 0x7ead, i, steps_ / 8) % 8 == 0;
}

// One that the first of a queue asks, while both stand, is the first itself in odd turns.
bool PlainCrowd::takes_turn(uint32_t i, uint32_t asker, const QueueOrder& first) const {
  const PlainBody& body = bodies_[i];
  const long steps = std::max(std::lround(config_.queue.turn_time / config_.units.dt), 1L);
  const bool is_odd = static_cast<long>(steps_) / steps % 2 == 1;
  if (!is_odd || !queues(body)) return false;
  if (asker != UINT32_MAX && first.left < 0) return false;  // it is another's turn
  const bool had_turn = body.asks && body.request.order.name == i && body.request.order.left < 0;
  if (had_turn) return true;
  if (asker == UINT32_MAX || first.name != asker || !stands(body)) return false;
  const Plane ahead = path_ahead(body);
  if (first.beyond.x * ahead.x + first.beyond.z * ahead.z <= 0) return false;
  return body.stood >= config_.queue.held_stands &&
         bodies_[asker].stood >= config_.queue.held_stands;
}

bool PlainCrowd::is_head(uint32_t i) const {
  const PlainBody& body = bodies_[i];
  const bool asks_on = body.asks && body.request.order.name == i &&
                       size_of(body.velocity) < config_.queue.asks_on * body.speed;
  const bool has_stood = stands(body) && body.stood >= config_.queue.head_stands;
  if (!queues(body) || (!has_stood && !asks_on)) return false;
  if (has_turn(i)) return true;
  const Plane ahead = path_ahead(body);
  for (size_t k = 0; k < nearest(i); ++k) {
    const Near& n = near_[i][k];
    const Plane at = config_.units.metres(n.at.x, n.at.z);
    if (queues(bodies_[n.other]) && gap(i, n) < config_.queue.head_range &&
        at.x * ahead.x + at.z * ahead.z > 0 && order_of(n.other) < order_of(i)) {
      return false;
    }
  }
  return true;
}

bool PlainCrowd::is_goal_taken(uint32_t i) const {
  const PlainBody& body = bodies_[i];
  const Plane ahead = path_ahead(body);
  return std::any_of(near_[i].begin(), near_[i].end(), [&](const Near& n) {
    const PlainBody& other = bodies_[n.other];
    if (!rests(other)) return false;
    const Spot from_goal = between(body.goal, other.at), goals = between(body.goal, other.goal);
    const int64_t room = int64_t{body.radius} + other.radius;
    if (crowd::nearer_than(from_goal.x, from_goal.z, room)) return true;
    const Plane at = config_.units.metres(n.at.x, n.at.z);
    const auto touching = room + static_cast<int64_t>(0.1f / config_.units.unit);
    return at.x * ahead.x + at.z * ahead.z > 0 && crowd::nearer_than(n.at.x, n.at.z, touching) &&
           crowd::nearer_than(goals.x, goals.z, room);
  });
}

bool PlainCrowd::touches_resting(uint32_t i) const {
  const PlainBody& body = bodies_[i];
  return std::any_of(near_[i].begin(), near_[i].end(), [&](const Near& n) {
    const PlainBody& other = bodies_[n.other];
    const int64_t touching =
        int64_t{body.radius} + other.radius + static_cast<int64_t>(0.1f / config_.units.unit);
    const Spot goals = between(body.goal, other.goal);
    return crowd::nearer_than(n.at.x, n.at.z, touching) &&
           crowd::nearer_than(goals.x, goals.z, static_cast<int64_t>(1.0f / config_.units.unit)) &&
           rests(other);
  });
}

void PlainCrowd::settle_rest(PlainBody& body, Rest next, float left, float dt) {
  body.vain = body.rest == Rest::kNo ? body.vain + dt : 0;
  if (body.nearest_cm < 0 || left < 0.01f * static_cast<float>(body.nearest_cm) - 0.2f) {
    body.nearest_cm = static_cast<int>(100 * left + 0.5f);
    body.vain = 0;
  }
  if (body.rest == Rest::kMadeRoom && next == Rest::kNo) body.stood = 0;
  body.rest = next;
}

Rest PlainCrowd::next_rest(uint32_t i) const {
  const PlainBody& body = bodies_[i];
  const float left = size_of(path_ahead(body));
  if (!may_rest(body)) return body.rest;
  if (body.rest == Rest::kMadeRoom) {
    if (!stands(body) || body.stood < 1) return Rest::kMadeRoom;
    return is_goal_taken(i) ? Rest::kRests : Rest::kNo;
  }
  if (body.rest == Rest::kRests && !stands(body) && body.stood == 0) return Rest::kMadeRoom;
  if (body.rest == Rest::kNo) {
    if (left < 0.005f || (left < 0.3f && is_goal_taken(i))) return Rest::kRests;
    if (body.vain >= 1 && touches_resting(i)) return Rest::kRests;
    if (!stands(body) || body.stood < 0.5f) return Rest::kNo;
  }
  return left < 0.3f || is_goal_taken(i) ? Rest::kRests : Rest::kNo;
}

// To the side of the line along which the other walks. There are no walls.
static Plane aside_of(Plane away, Plane from, Plane asked, float room) {
  const Plane right{-asked.z, asked.x};
  const float off = -(from.x * right.x + from.z * right.z);
  const float nearer = off >= 0 ? 1.0f : -1.0f;
  for (const float side : {nearer, -nearer}) {
    const float wanted = room + 0.02f - side * off;
    if (wanted > 0 && wanted < 1.5f) return {side * right.x, side * right.z};
  }
  return away;
}

// The request that it follows, or its own.
void PlainCrowd::queue_up(uint32_t i, Plan& plan) const {
  const PlainBody& body = bodies_[i];
  plan.rest = next_rest(i);
  plan.in_stream = is_in_stream(i);
  const QueueOrder own = queues(body) ? order_of(i) : QueueOrder{};
  QueueOrder first;
  uint32_t asker = UINT32_MAX;
  Plane asked, from;
  float needs = 0;
  for (size_t k = 0; k < nearest(i); ++k) {
    const Near& n = near_[i][k];
    const PlainBody& other = bodies_[n.other];
    const Plane at = config_.units.metres(n.at.x, n.at.z);
    if (!other.asks || gap(i, n) >= config_.queue.touch_gap) continue;
    if (at.x * other.request.ahead.x + at.z * other.request.ahead.z >= 0) continue;
    const Spot goal = between(body.at, other.goal);
    if (rests(body) && crowd::nearer_than(goal.x, goal.z, int64_t{body.radius} + other.radius)) {
      continue;
    }
    const QueueOrder& order = other.request.order;
    if (order.name == i || !(order < own)) continue;
    // The shortest path that is left.
    if (asker != UINT32_MAX) {
      if (first.left < order.left) continue;
      if (first.left == order.left && first.name < order.name) continue;
      if (first.left == order.left && first.name == order.name && asker < n.other) continue;
    }
    first = order;
    asker = n.other;
    asked = other.request.ahead;
    from = at;
    needs = static_cast<float>(body.radius + other.radius) * config_.units.unit;
  }
  const bool turn = takes_turn(i, asker, first);
  plan.makes_room = asker != UINT32_MAX && !turn;
  const Plane ahead = path_ahead(body);
  const float size = size_of(ahead);
  if (plan.makes_room) {
    const Plane to = size > 0 ? Plane{ahead.x / size, ahead.z / size} : Plane{1, 0};
    const Plane others = path_ahead(bodies_[asker]);
    const float whole = size_of(others);
    const Plane theirs = whole > 0 ? Plane{others.x / whole, others.z / whole} : Plane{1, 0};
    const float along = others.x * ahead.x + others.z * ahead.z;
    plan.yields = queues(body) && theirs.x * to.x + theirs.z * to.z < -config_.queue.oncoming &&
                  !(along > config_.queue.alike * whole * size);
    const float far = size_of(from);
    plan.away = {-from.x / far, -from.z / far};
    if (plan.yields || !queues(body)) plan.away = aside_of(plan.away, from, asked, needs);
    plan.asks = true;
    plan.request = {first, plan.away};
  } else if (turn) {
    plan.asks = true;
    plan.request = {own, size > 0 ? Plane{ahead.x / size, ahead.z / size} : Plane{1, 0}};
    plan.request.order.left = std::min(own.left, QueueOrder::kTurn - 1) - QueueOrder::kTurn;
  } else if (is_head(i) && !(may_rest(body) && is_goal_taken(i))) {
    plan.asks = true;
    plan.request = {own, size > 0 ? Plane{ahead.x / size, ahead.z / size} : Plane{1, 0}};
  }
}

// Is the place clear where it moves so, as long as all others stand?
bool PlainCrowd::can_move(uint32_t i, Plane velocity) const {
  const PlainBody& body = bodies_[i];
  const Spot to{body.at.x + config_.units.displacement(velocity.x),
                body.at.z + config_.units.displacement(velocity.z)};
  return std::none_of(near_[i].begin(), near_[i].end(), [&](const Near& n) {
    const Spot d = between(to, bodies_[n.other].at);
    return can_touch(i, n) &&
           crowd::nearer_than(d.x, d.z, int64_t{body.radius} + bodies_[n.other].radius);
  });
}

// The first four directions that are clear, or else the first four: on an open plane each permits a
// step.
void PlainCrowd::make_room(uint32_t i, Plan& plan, const Plane& best) const {
  const PlainBody& body = bodies_[i];
  const float wanted = size_of(preferred_of(body));
  const bool creeps = plan.asks && (size_of(best) < config_.queue.creep_share * wanted ||
                                    !can_move(i, reachable(body, best)));
  plan.creeps = plan.makes_room || creeps;
  if (!plan.creeps) return;
  float speed = (plan.yields ? config_.queue.back_share : config_.queue.room_share) * body.speed;
  if (!plan.makes_room) speed = std::min(config_.queue.creep_speed * body.speed, wanted);
  const auto all = crowd::room_directions(plan.makes_room ? plan.away : plan.request.ahead);
  std::vector<Plane> room;
  for (size_t d = 0; d < (plan.makes_room ? 15u : 7u); ++d) {
    for (const float part : {1.0f, 0.5f, 0.25f}) {
      const Plane velocity{all[d].x * speed * part, all[d].z * speed * part};
      if (!can_move(i, velocity)) continue;
      room.push_back(velocity);
      break;
    }
  }
  if (room.empty()) {
    for (const Plane direction : all) room.push_back({direction.x * speed, direction.z * speed});
  }
  room.resize(std::min<size_t>(room.size(), 4));
  plan.room = room;
}

Plane PlainCrowd::reachable(const PlainBody& body, Plane velocity) const {
  if (config_.acceleration <= 0) return velocity;
  return steer::within_acceleration(body.velocity, velocity,
                                    config_.acceleration * config_.units.dt,
                                    config_.units.rounding(), body.speed);
}

}  // namespace throng::test
