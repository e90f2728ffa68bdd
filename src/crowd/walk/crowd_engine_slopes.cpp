// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "crowd/walk/crowd_engine.h"

// How stairs and slopes slow bodies, by speeds of U. Weidmann. Transporttechnik der Fussgaenger.
// 1993: docs/design/016-slopes.md. Constant time for each body that decides. A body's speed changes
// only before it decides, so that within a step no move of any body is longer than its speed
// allows.
namespace throng::crowd {
namespace {

using steer::Plane;

constexpr float kStairGradient = 0.17f / 0.29f;  // of common stairs, riser by tread
constexpr float kMinAhead = 0.01f;  // [m] nearer to its local target it keeps its speed

float speed_factor(const SlopeFactors& factors, const GroundSlope& slope) {
  const auto on_stairs =
      static_cast<float>(slope.gradient > 0 ? factors.stairs_up : factors.stairs_down);
  if (slope.has_treads) return on_stairs;
  const float share = std::min(std::abs(slope.gradient) / kStairGradient, 1.0f);
  return 1 - (1 - on_stairs) * share;
}

}  // namespace

void CrowdEngine::slow_down(Body& body, float level_speed, float factor) {
  const float speed = level_speed * factor;
  body.slowed = factor < 1 && speed > 0;
  body.speed = body.slowed ? speed : level_speed;
  if (body.slowed) level_speeds_[body.slot] = level_speed;
}

void CrowdEngine::set_level_speed(Body& body, float speed) {
  const float before = body.speed;
  slow_down(body, speed, body.slowed ? body.speed / level_speeds_[body.slot] : 1);
  // Its last move is longer than others then expect of it.
  if (body.speed < before) body.clear(Body::kContinues);
}

// Of a body that decides in this step.
void CrowdEngine::slow_on_slope(Body& body) {
  if (body.steps == 0 || body.has(Body::kContinues)) return;
  if (body.has(Body::kExternal) || body.has(Body::kMovedElsewhere)) {
    if (body.slowed) end_slowing(body);
    return;
  }
  if (!body.has(Body::kHasGoal) && !body.leaves) return;
  const StrideGround& ground = grounds_[body.avatar_class];
  if (ground.is_level_around(body.level, body.point())) {
    if (body.slowed) end_slowing(body);
    return;
  }
  const Plane ahead =
      config_.units.metres(body.local_target_x - body.x, body.local_target_z - body.z);
  const float far = size_of(ahead);
  if (far < kMinAhead) return;
  const GroundSlope slope =
      ground.slope_along(body.level, body.point(), {ahead.x / far, ahead.z / far});
  slow_down(body, level_speed(body), speed_factor(config_.slope_factors[body.avatar_class], slope));
}

}  // namespace throng::crowd
