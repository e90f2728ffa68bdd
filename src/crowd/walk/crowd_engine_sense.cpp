// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <utility>

#include "crowd/walk/crowd_engine.h"
#include "crowd/walk/precedence.h"
#include "crowd/walk/sense_kernel.h"
#include "steer/sampled_kernel.h"

// What a body senses of its neighbours before it decides: docs/design/008-engine.md. Linear in the
// bodies of the squares around it.
namespace throng::crowd {
namespace {

using steer::Plane;

constexpr float kHeldUpShare = 0.3f;  // of its speed: it is held up
constexpr float kTargetCount = 14;    // bodies, to find the nearest among

// On its last segment, and not at its end yet?
bool is_on_last_segment(const Body& body) {
  constexpr uint8_t kAll =
      Body::kHasGoal | Body::kLast | Body::kArrived | Body::kExternal | Body::kMovedElsewhere;
  // A target can hold many.
  return body.target == 0 && !body.leaves && (body.flags & kAll) == (Body::kHasGoal | Body::kLast);
}

// Does it head to a corner, not to its goal yet?
bool turns_corner(const Body& body) {
  constexpr uint8_t kAll = Body::kHasGoal | Body::kLast | Body::kExternal | Body::kMovedElsewhere;
  return (body.flags & kAll) == Body::kHasGoal && !body.leaves;
}

// What bodies ahead inform those behind of, which would else fill the whole width. No branches:
// half of the neighbours are ahead.
struct Informed {
  void add(const Body& other, bool leads) {
    counterflow |= (leads ? 1 : 0) & (other.in_counterflow ? 1 : 0);
    stream |= (leads ? 1 : 0) & (other.in_stream ? 1 : 0);
  }
  int counterflow = 0, stream = 0;
};

// Is another body ahead that walks in the same direction? Within 45 degrees.
bool leads(Plane apart, Plane preferred, Plane others) {
  const float same = preferred.x * others.x + preferred.z * others.z;
  const float both = (preferred.x * preferred.x + preferred.z * preferred.z) *
                     (others.x * others.x + others.z * others.z);
  const int is_ahead = apart.x * preferred.x + apart.z * preferred.z > 0 ? 1 : 0;
  return (is_ahead & (same > 0 ? 1 : 0) & (2 * same * same > both ? 1 : 0)) != 0;
}

Contender contender(const Body& body, uint32_t name) {
  return {body.x, body.z, body.local_target_x, body.local_target_z, body.radius, name};
}

}  // namespace

// Makes the lists as long as the neighbours may need.
void CrowdEngine::fit_lists(const NeighbourGrid::Around& around, Worker& worker) {
  const size_t wanted = around.bodies() + kSeenSpare;
  if (worker.squares.size() >= wanted) return;
  for (auto* entries : {&worker.entries, &worker.touched}) entries->resize(2 * wanted);
  worker.squares.resize(worker.entries.size());
}

// Farther bodies cannot be touched; the exact test follows. [units]
float CrowdEngine::touch_of(const Body& body) const {
  return static_cast<float>(body.radius + stride_of(body) + widest_ + longest_ + 1) * 1.0001f;
}

// Appends the bodies that it could touch to `others`.
void CrowdEngine::list_touched(const Body& body, const SeenLists& lists, Worker& worker) const {
  const int32_t stride = stride_of(body);
  for (size_t n = 0; n < lists.touches; ++n) {
    const uint32_t j = lists.touched[n];
    const Body& other = bodies_[j];
    const int64_t range = int64_t{body.radius} + other.radius + stride + stride_of(other);
    const int32_t rise = body.y - other.y;
    const bool near = rise < other.height + 2 * kMaxRise && -rise < body.height + 2 * kMaxRise;
    if (near && nearer_than(other.x - body.x, other.z - body.z, range)) worker.others.push_back(j);
  }
}

// Finds its nearest neighbours, at most as many as count in steering, and if required lists the
// bodies that it could touch.
std::span<uint32_t> CrowdEngine::find_nearest(uint32_t i, const NeighbourGrid::Around& around,
                                              bool lists_others, Worker& worker) const {
  const Body& body = bodies_[i];
  fit_lists(around, worker);
  const Places places{grid_->x(), grid_->z(), grid_->y()};
  const float touch = touch_of(body);
  // In a dense crowd the nearest are near: if a smaller range holds enough, no farther body
  // matters.
  const float sight = static_cast<float>(sight_) * static_cast<float>(sight_);
  const float across = grid_->width() * NeighbourGrid::kAround;
  const float target_square = across * across * kTargetCount /
                              (3 * static_cast<float>(around.bodies()));  // 3 for pi, of the circle
  const auto wanted = static_cast<size_t>(config_.steering.neighbours);
  Eye eye{.x = body.x,
          .z = body.z,
          .y = body.y,
          .self = i,
          .max_square = ignores_neighbours(body) ? 0 : std::min(sight, target_square),
          .tall = body.height,
          .touch = lists_others ? touch * touch : 0,
          .touch_tall = std::max<int32_t>(body.height, highest_) + 2 * kMaxRise};
  SeenLists lists;
  const auto query = [&] {
    lists = {worker.squares.data(), worker.entries.data(), worker.touched.data()};
    find_seen(places, around.pieces(), eye, lists);
  };
  query();
  if (lists.seen < wanted && eye.max_square < sight && !ignores_neighbours(body)) {
    eye.max_square = sight;
    query();
  }
  list_touched(body, lists, worker);
  if (ignores_neighbours(body)) return {};
  size_t nearest = keep_nearest(lists, wanted);
  if (nearest > wanted) {  // Some are equally far: of these the first slots.
    const auto key = [&](uint32_t j) {
      return std::pair(near_square(bodies_[j].x - body.x, bodies_[j].z - body.z),
                       name_of(bodies_[j]));
    };
    std::sort(lists.entries, lists.entries + nearest,
              [&](uint32_t a, uint32_t b) { return key(a) < key(b); });
    nearest = wanted;
  }
  return {lists.entries, nearest};
}

// Senses what it steers by, and if required lists the bodies that it could touch.
void CrowdEngine::sense(uint32_t i, Worker& worker, const NeighbourGrid::Around& around,
                        bool lists_others) {
  worker.forget();
  const Body& body = bodies_[i];
  const std::span<uint32_t> nearest = find_nearest(i, around, lists_others, worker);
  if (ignores_neighbours(body)) {  // It senses no more.
    worker.situation.preferred = body.preferred;
    worker.situation.has_walls = false;
    return;
  }
  if (config_.model != SteeringModel::kSampled) return prefer(i, nearest, worker);
  steer::Situation& situation = worker.situation;
  situation.velocity = body.velocity;
  situation.preferred = body.preferred;
  situation.fastest = speed_limit(body);
  situation.near.size = 0;
  const bool pushes = this->pushes(body), turns = turns_corner(body);
  const bool may_wait = pushes && is_on_last_segment(body);
  const bool rests = !body.leaves && !body.has(Body::kExternal) &&
                     (body.has(Body::kArrived) || !body.has(Body::kHasGoal));
  const bool is_slow = size_of(body.velocity) < kHeldUpShare * body.speed;
  const bool steps_back = rests || (is_slow && !body.leaves && !body.has(Body::kExternal));
  // Neighbours have no order of their own: of several that go first the widest counts, or the
  // nearest.
  float waiting_room = 0;
  std::pair<float, uint32_t> nearest_first(HUGE_VALF, 0);
  Plane backward;
  Informed informed;
  const auto contender_of = [this](const Body& of) { return contender(of, name_of(of)); };
  for (const uint32_t j : nearest) {
    const Body& other = bodies_[j];
    const Plane apart = config_.units.metres(other.x - body.x, other.z - body.z);
    informed.add(other, leads(apart, body.preferred, other.preferred));
    const float room = static_cast<float>(body.radius + other.radius) * config_.units.unit;
    if (may_wait && is_on_last_segment(other) &&
        goes_first(contender_of(other), contender_of(body))) {
      waiting_room = std::max(waiting_room, room);
    }
    if (pushes && turns && turns_corner(other) &&
        gives_precedence(contender_of(other), contender_of(body), size_of(apart), room,
                         size_of(other.velocity) / other.speed)) {
      const std::pair distance(size_of(apart), name_of(other));
      if (distance < nearest_first) {
        nearest_first = distance;
        const float back = -0.5f * body.speed / distance.first;
        backward = {apart.x * back, apart.z * back};
      }
    }
    // Bodies that stand or are held up step back from those beside them that leave an obstacle.
    if (other.leaves && steps_back) step_back(body, apart, room, worker);
    // A body that has arrived yields to those that would pass if it were not there: they may stand.
    const bool yields =
        (body.has(Body::kArrived) && !other.has(Body::kArrived)) || (rests && other.leaves);
    const float kept =
        config_.queues && is_close(apart, room) ? room_in_queue(body, other, room, worker) : room;
    situation.near.add(config_.steering,
                       {apart, yields ? other.preferred : other.velocity, kept, other.preferred});
  }
  if (waiting_room > 0) {
    worker.waits = true;
    situation.preferred = preferred_of_waiting(
        config_.units.metres(body.local_target_x - body.x, body.local_target_z - body.z),
        body.speed, waiting_room);
  }
  if (nearest_first.first < HUGE_VALF) {
    worker.waits = true;
    situation.preferred = backward;
  }
  worker.in_counterflow = informed.counterflow != 0;
  if (config_.queues) {
    worker.in_stream = informed.stream != 0 || meets_stream(body, nearest, worker);
    query_queue(i, nearest, around, worker);
  }
  const Plane preferred = situation.preferred;
  situation.preferred = steer::following_fast(config_.steering, situation);
  // Before a corner a body that crawls is turned as one that stands: doors need that.
  worker.follows = !turns && steer::can_but_crawl(config_.deadlock_settings, preferred,
                                                  situation.preferred, body.speed);
}

}  // namespace throng::crowd
