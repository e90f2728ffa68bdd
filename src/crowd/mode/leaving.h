// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "crowd/ground/body.h"
#include "crowd/mode/shared_state.h"

/// How avatars leave obstacles that close around them, by whatever mode.
namespace throng::crowd {

inline constexpr float kMaxDetourAngle = 0.4f;  // [radians] of a detour, before one gives its path
                                                // up

/// Does a path from a body over these points (x, z) lead out of obstacles soon, and never back?
/// `least`: the length of the shortest exit. [units, m]
bool leads_out_along(const SharedState& shared, const Body& body, std::span<const uint32_t> slots,
                     std::span<const std::array<int32_t, 2>> points, double least);

/// Has a body a path to its goal that it follows?
inline bool follows_path(const Body& body) {
  return body.has(Body::kHasGoal) && !body.has(Body::kArrived) && !body.has(Body::kNeedsPath);
}

/// A body that has arrived stays where it is now.
inline void stay_arrived(Body& body) {
  body.flags |= Body::kLast;
  body.local_target_x = body.x;
  body.local_target_z = body.z;
}

/// A body that needs a path goes straight to its goal instead, without one. [units]
inline void head_straight(Body& body, int32_t x, int32_t z) {
  body.local_target_x = x;
  body.local_target_z = z;
  body.clear(Body::kNeedsPath);
  body.flags |= Body::kLast;
}

}  // namespace throng::crowd
