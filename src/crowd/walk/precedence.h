// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "crowd/walk/step_units.h"

/// Which avatar goes first, of those that head to one place.
namespace throng::crowd {

/// A body on its last segment, not at its end yet.
struct Contender {
  int32_t x = 0, z = 0;                            // [units]
  int32_t local_target_x = 0, local_target_z = 0;  // [units]
  int32_t radius = 0;                              // [units]
  uint32_t name = 0;

  [[nodiscard]] int64_t left() const {  // square of the distance [units^2]
    const int64_t dx = int64_t{local_target_x} - x, dz = int64_t{local_target_z} - z;
    return dx * dx + dz * dz;
  }
};

/// Must `self` wait for `other`? Their goals cannot hold both, and the other is nearer to its own.
/// Only near the goal: a column that heads to one place keeps walking.
inline bool goes_first(const Contender& other, const Contender& self) {
  constexpr int64_t kRangeFactor = 6;  // times what both need
  const int64_t room = int64_t{other.radius} + self.radius;
  if (!nearer_than(other.local_target_x - self.local_target_x,
                   other.local_target_z - self.local_target_z, room))
    return false;
  const int64_t theirs = other.left(), mine = self.left();
  if (mine > kRangeFactor * kRangeFactor * room * room) return false;
  return theirs < mine || (theirs == mine && other.name < self.name);
}

/// The preferred velocity of a body that waits for another: back off, then stand. `displacement`:
/// to its own goal. `room`: sum of the radii. [m]
inline steer::Plane preferred_of_waiting(steer::Plane displacement, float speed, float room) {
  const float left = std::sqrt(displacement.x * displacement.x + displacement.z * displacement.z);
  if (left >= 2 * room || left < 1e-6f) return {};
  const float back = -0.5f * speed / left;
  return {displacement.x * back, displacement.z * back};
}

/// Must `self` step back for `other`, which would turn the same corner first, and stands? `far`,
/// `room`: between their centres, and the sum of the radii. [m] `speed`: the other's, as a fraction
/// of its desired speed.
inline bool gives_precedence(const Contender& other, const Contender& self, float far, float room,
                             float speed) {
  constexpr float kMaxGap = 0.1f;         // [m] between the bodies
  constexpr float kStandingShare = 0.2f;  // of its desired speed
  return far < room + kMaxGap && far > 1e-6f && speed < kStandingShare && goes_first(other, self);
}

}  // namespace throng::crowd
