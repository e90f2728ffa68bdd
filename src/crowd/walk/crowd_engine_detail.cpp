// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "crowd/walk/crowd_engine.h"
#include "crowd/walk/reaction.h"

// Levels of detail: docs/design/008-engine.md. A body in low detail makes several steps at once
// when its turn comes, and stands in between. Each move goes through conflict resolution as ever,
// so no body touches another, whatever its level of detail and when that changes.
namespace throng::crowd {

bool CrowdEngine::is_near(const Body& body) const {
  const float unit = config_.units.unit;
  const float x = static_cast<float>(body.x) * unit, z = static_cast<float>(body.z) * unit,
              y = static_cast<float>(body.y) * 1e-3f;
  return std::any_of(detail_.views.begin(), detail_.views.end(), [&](const EngineDetail::View& v) {
    const float dx = x - v.x, dz = z - v.z, dy = y - v.y;
    return dx * dx + dz * dz + dy * dy <= v.radius * v.radius;
  });
}

// At most as many that it moves less than the narrowest body is wide: none passes through another.
uint64_t CrowdEngine::steps_in_low_detail(const Body& body) const {
  constexpr float kRounded = 4;  // [units]
  const float displacement = level_speed(body) * (config_.units.dt / config_.units.unit);
  const float max_steps = (static_cast<float>(detail_.narrowest) - kRounded) / displacement;
  return static_cast<uint64_t>(std::clamp(max_steps, 1.0f, static_cast<float>(detail_.steps)));
}

uint64_t CrowdEngine::steps_of_reaction(const Body& body) const {
  if (!body.has(Body::kLowDetail)) return every_;
  const uint64_t steps = steps_in_low_detail(body);
  return steps * throng::crowd::steps_of_reaction(detail_.reaction,
                                                  config_.units.dt * static_cast<float>(steps));
}

// Low detail or full? And in low detail, does it move in this step?
void CrowdEngine::choose_detail(Body& body, uint64_t step) const {
  body.steps = 1;
  const bool low_detail = !detail_.views.empty() && !body.has(Body::kExternal) &&
                          !body.has(Body::kMovedElsewhere) && !is_near(body);
  if (!low_detail) {
    body.clear(Body::kLowDetail);
    return;
  }
  body.flags |= Body::kLowDetail;
  const uint64_t steps = steps_in_low_detail(body);
  body.steps = ((step + name_of(body)) % steps == 0 ? steps : 0) & 31;
}

}  // namespace throng::crowd
