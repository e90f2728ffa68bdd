// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "crowd/walk/crowd_engine.h"
#include "crowd/walk/sense_kernel.h"
#include "steer/sampled_kernel.h"

// Counterflow: lanes, and the right half of narrow places. docs/design/008-engine.md. Constant time
// for each body and its neighbours.
namespace throng::crowd {

using steer::Plane;

// Distances to walls on both sides of its path, up to where a place is narrow. [m]
CrowdEngine::Sides CrowdEngine::sides_of(const Body& body) const {
  Plane ahead = path_ahead(body);
  const float far = size_of(ahead);
  if (far <= 1e-3f) return {config_.lanes.narrow, config_.lanes.narrow};
  ahead = {ahead.x / far, ahead.z / far};
  const StrideGround& ground = grounds_[body.avatar_class];
  const float unit = config_.units.unit, query_range = config_.lanes.narrow / unit;
  const Plane right{-ahead.z, ahead.x}, left{ahead.z, -ahead.x};
  return {ground.free_distance(body.level, body.point(), left, query_range) * unit,
          ground.free_distance(body.level, body.point(), right, query_range) * unit};
}

bool CrowdEngine::has_room_for_two(const Body& body) const {
  const Sides sides = sides_of(body);
  return sides.left + sides.right >= 2 * static_cast<float>(body.radius) * config_.units.unit;
}

// Does a neighbour come towards it? The neighbour's local target counts: in a jam, preferred
// velocities point in all directions.
bool CrowdEngine::has_oncoming(const Body& body, const Worker& worker) const {
  for (size_t n = 0; n < worker.situation.near.size; ++n) {
    const Body& other = bodies_[worker.entries[n]];
    const Plane apart = config_.units.metres(other.x - body.x, other.z - body.z);
    if (comes_towards(body, other, apart)) return true;
  }
  return false;
}

// The vector to its path some metres beyond its local target.
Plane CrowdEngine::path_beyond(const Body& body) const {
  const Plane ahead = path_ahead(body);
  if (body.has(Body::kExternal) || !body.has(Body::kHasGoal) || body.has(Body::kLast)) return ahead;
  const Plane onward = progress_[body.slot].onward;
  return {ahead.x + onward.x, ahead.z + onward.z};
}

// Two at the sides of a door head towards each other, but go on in the same direction.
bool CrowdEngine::go_on_alike(const Body& body, const Body& other) const {
  const Plane a = path_beyond(body), b = path_beyond(other);
  return a.x * b.x + a.z * b.z > config_.queue.alike * steer::size_of(a) * steer::size_of(b);
}

// A body in counterflow between walls leaves the left half to the stream. Where no wall is near,
// which is tested quickly, nothing changes.
void CrowdEngine::keep_right(const Body& body, Worker& worker) const {
  if (worker.situation.near.size == 0) return;
  const float narrow = config_.lanes.narrow;
  const StrideGround& ground = grounds_[body.avatar_class];
  if (ground.is_open_around(body.level, body.point(), cells_of(narrow / config_.units.unit))) {
    return;
  }
  if (!worker.in_counterflow && !has_oncoming(body, worker)) return;
  const Sides sides = sides_of(body);
  if (sides.left >= narrow || sides.right >= narrow) return;
  worker.in_counterflow = true;
  // If there is room for two beside each other, one that queues does not step into the left half.
  const float radius = static_cast<float>(body.radius) * config_.units.unit;
  if (config_.queues && sides.left + sides.right >= 2 * radius &&
      (sides.left - sides.right) / 2 < radius) {
    const Plane ahead = steer::ahead_of(path_ahead(body));
    worker.not_left = {-ahead.z, ahead.x};
  }
  Plane& preferred = worker.situation.preferred;
  const float speed = size_of(preferred);
  if (worker.waits || speed <= 1e-3f || sides.right <= sides.left) return;
  const float off = (sides.right - sides.left) / 2;  // from the middle [m]
  const float aside = config_.lanes.to_right * std::min(off, 1.0f);
  const float scale = 1 / std::sqrt(1 + aside * aside);
  preferred = {(preferred.x - preferred.z * aside) * scale,
               (preferred.z + preferred.x * aside) * scale};
}

// Prefers to step back from a body that leaves an obstacle, `apart` away.
void CrowdEngine::step_back(const Body& body, Plane apart, float room, Worker& worker) {
  constexpr float kStepsBack = 1;  // [m] beside it
  const float far = size_of(apart);
  if (!(far > 0 && far < room + kStepsBack)) return;
  worker.waits = true;
  const float back = -0.5f * body.speed / far;
  worker.situation.preferred = {apart.x * back, apart.z * back};
}

// True if this changed the preferred velocity.
bool CrowdEngine::choose_lane(uint32_t i, Worker& worker, const NeighbourGrid::Around& around) {
  const Body& body = bodies_[i];
  steer::Situation& situation = worker.situation;
  if (!steer::is_opposed_fast(config_.lanes, situation)) return false;
  const Eye eye{.x = body.x,
                .z = body.z,
                .y = body.y,
                .self = i,
                .max_square = static_cast<float>(sight_) * static_cast<float>(sight_),
                .tall = body.height,
                .touch = 0,
                .touch_tall = 0};
  SeenLists lists{worker.squares.data(), worker.entries.data(), worker.touched.data()};
  find_seen({grid_->x(), grid_->z(), grid_->y()}, around.pieces(), eye, lists);
  steer::Lanes lanes(config_.lanes, body.preferred);
  for (size_t n = 0; n < lists.seen; ++n) {
    const Body& other = bodies_[lists.entries[n]];
    lanes.add(config_.units.metres(other.x - body.x, other.z - body.z), path_ahead(other));
  }
  situation.preferred = lanes.preferred();
  situation.preferred = steer::following_fast(config_.steering, situation);
  return true;
}

}  // namespace throng::crowd
