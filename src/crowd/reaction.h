// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstdint>

#include "crowd/step_units.h"
#include "world/walk.h"

/// Who decides when. Nobody needs to look around sixty times a second: whoever did what he wanted
/// most goes on with it until his turn comes again, as long as it is free.
/// docs/design/008-engine.md, "Reaction".
namespace throng {

/// Whole steps, at least one.
inline uint64_t steps_of_reaction(float reaction, float dt) {
  return static_cast<uint64_t>(std::max(1.0f, reaction / dt + 1e-3f));
}

/// Turns are spread over the steps of a reaction.
inline bool decides(uint64_t every, uint64_t step, uint32_t slot) {
  return (step + slot) % every == 0;
}

/// Right before where it is bound for it must not go past it. `displacement` there, `stride` of a
/// step.
inline bool is_before(GroundPoint displacement, int32_t stride) {
  const int64_t range = int64_t{2} * stride;
  return displacement.x * displacement.x + displacement.z * displacement.z < range * range;
}

}  // namespace throng
