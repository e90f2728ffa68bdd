// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include "crowd/walk/crowd_engine.h"

// Bodies that are steered by another model than steer/sampled.h: the model gives a velocity, which
// replaces the preferred velocity as if that were open. Rounds and walls are the same for all.
namespace throng::crowd {

using steer::Plane;

// Writes the model's velocity to `worker.situation.preferred`.
void CrowdEngine::prefer(uint32_t i, std::span<uint32_t> nearest, Worker& worker) const {
  const Body& body = bodies_[i];
  const auto key = [&](uint32_t j) {
    return std::pair(near_square(bodies_[j].x - body.x, bodies_[j].z - body.z),
                     name_of(bodies_[j]));
  };
  std::sort(nearest.begin(), nearest.end(),
            [&](uint32_t a, uint32_t b) { return key(a) < key(b); });
  std::array<steer::Other, steer::kMaxNear> others;
  const size_t count = std::min(nearest.size(), others.size());
  for (size_t n = 0; n < count; ++n) {
    const Body& other = bodies_[nearest[n]];
    others[n] = {.at = config_.units.metres(other.x - body.x, other.z - body.z),
                 .velocity = other.velocity,
                 .radius = static_cast<float>(other.radius) * config_.units.unit,
                 .slot = name_of(other)};
  }
  steer::View view{
      .velocity = body.velocity,
      .preferred = body.preferred,
      .to_target = config_.units.metres(body.local_target_x - body.x, body.local_target_z - body.z),
      .stops = body.has(Body::kLast) && body.target == 0,
      .fastest = speed_limit(body),
      .radius = static_cast<float>(body.radius) * config_.units.unit,
      .slot = name_of(body),
      .others = {others.data(), count}};
  // A body without a goal of its own keeps the given velocity.
  if (body.has(Body::kExternal) || !body.has(Body::kHasGoal)) {
    view.to_target = body.preferred;
    view.stops = false;
  }
  steer::Situation& situation = worker.situation;
  situation.preferred = body.preferred;
  if (config_.model == SteeringModel::kSocialForce) {
    query_wall_ahead(body, situation);
    query_walls(body, situation);
    const steer::Fan fan = steer::fan_around(situation.preferred);
    const auto& free = situation.free_distance;
    const auto nearest_wall =
        static_cast<size_t>(std::min_element(free.begin(), free.end()) - free.begin());
    view.has_wall =
        situation.has_walls && free[nearest_wall] < std::numeric_limits<float>::infinity();
    const float far = free[nearest_wall] / wall_scale(body) + view.radius;
    if (view.has_wall) view.wall = {fan[nearest_wall].x * far, fan[nearest_wall].z * far};
  }
  situation.has_walls = false;
  worker.waits = false;
  situation.preferred = steer::preferred_velocity(config_.model, view, units_of(body).dt,
                                                  config_.curves_of(body.slot));
}

}  // namespace throng::crowd
