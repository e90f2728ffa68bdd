// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstdint>

#include "crowd/walk/step_units.h"
#include "steer/sampled.h"
#include "world/walk.h"

/// When an avatar decides. It need not sense sixty times a second: an avatar that could make its
/// preferred move repeats it until its turn comes again, as long as the move is free.
/// docs/design/008-engine.md, "Reaction".
namespace throng::crowd {

/// Whole steps, at least one.
inline uint64_t steps_of_reaction(float reaction, float dt) {
  return static_cast<uint64_t>(std::max(1.0f, reaction / dt + 1e-3f));
}

/// Decisions are spread over the steps of a reaction.
inline bool decides(uint64_t every, uint64_t step, uint32_t name) {
  return (step + name) % every == 0;
}

/// Just before its local target, where it must not overshoot. `displacement`: to the target.
/// `stride`: of a step.
inline bool is_before(world::GroundPoint displacement, int32_t stride) {
  const int64_t range = int64_t{2} * stride;
  return displacement.x * displacement.x + displacement.z * displacement.z < range * range;
}

/// Can it not walk on for `every` steps and then stop at the end of its path, `left` ahead, because
/// its acceleration is bounded? `every`: steps until it decides again. `acceleration` 0: no bound.
inline bool must_brake(steer::Plane left, float speed, float acceleration, uint64_t every,
                       float dt) {
  if (!(acceleration > 0)) return false;
  const float range = speed * static_cast<float>(every) * dt + speed * speed / (2 * acceleration);
  return left.x * left.x + left.z * left.z < range * range;
}

}  // namespace throng::crowd
