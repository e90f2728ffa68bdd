// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "crowd/step_units.h"

/// Who goes first of those who are bound for one place.
namespace throng {

/// A body on its last leg, not there yet.
struct Bound {
  int32_t x = 0, z = 0;                            // [units]
  int32_t local_target_x = 0, local_target_z = 0;  // [units]
  int32_t radius = 0;                              // [units]
  uint32_t slot = 0;

  [[nodiscard]] int64_t left() const {  // square of the way [units^2]
    const int64_t dx = int64_t{local_target_x} - x, dz = int64_t{local_target_z} - z;
    return dx * dx + dz * dz;
  }
};

/// Must `self` wait for `other`? Their goals have no room for both, and the other is nearer to his.
/// Only near the goal: a column that is bound for one place walks.
inline bool goes_first(const Bound& other, const Bound& self) {
  constexpr int64_t kNear = 6;  // times what both need
  const int64_t room = int64_t{other.radius} + self.radius;
  if (!nearer_than(other.local_target_x - self.local_target_x,
                   other.local_target_z - self.local_target_z, room))
    return false;
  const int64_t theirs = other.left(), mine = self.left();
  if (mine > kNear * kNear * room * room) return false;
  return theirs < mine || (theirs == mine && other.slot < self.slot);
}

/// The wish of who waits for another: to leave him room, then to stand. `displacement`: to one's
/// own goal. `room`: sum of the radii. [m]
inline steer::Plane preferred_of_waiting(steer::Plane displacement, float speed, float room) {
  const float left = std::sqrt(displacement.x * displacement.x + displacement.z * displacement.z);
  if (left >= 2 * room || left < 1e-6f) return {};
  const float back = -0.5f * speed / left;
  return {displacement.x * back, displacement.z * back};
}

/// Must `self` step back for `other`, who would turn the same corner first, and stands? `far`,
/// `room`: between their middles, and the sum of the radii. [m] `speed`: the other's, by his
/// wished.
inline bool gives_precedence(const Bound& other, const Bound& self, float far, float room,
                             float speed) {
  constexpr float kClose = 0.1f;   // [m] from touching him
  constexpr float kStands = 0.2f;  // of his wished speed
  return far < room + kClose && far > 1e-6f && speed < kStands && goes_first(other, self);
}

}  // namespace throng
