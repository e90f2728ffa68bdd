// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "crowd/ground/body.h"
#include "steer/sampled.h"

/// Moves of externally controlled bodies. A step moves whole units; what rounding leaves over is
/// carried into the next step, so that a body is never farther along than the velocities that it
/// was given lead, but for one unit, and never lags behind by more.
namespace throng::crowd {

/// The fastest that a body may go, whatever it avoids: an externally controlled one no faster than
/// it was given, but above 0, because costs are divided by it. [m/s]
inline float speed_limit(const Body& body) {
  constexpr float kMinLimit = 1e-3f;  // [m/s]
  if (!body.has(Body::kExternal)) return body.speed;
  return std::min(body.speed, std::max(size_of(body.preferred), kMinLimit));
}

/// A velocity, cut to a speed.
inline steer::Plane cut_to(steer::Plane velocity, float max_speed) {
  const float size = size_of(velocity);
  if (size <= max_speed) return velocity;
  return {velocity.x * (max_speed / size), velocity.z * (max_speed / size)};
}

/// A displacement along an axis in whole units, and what it leaves over.
struct CarriedMove {
  static constexpr int32_t kParts = 1 << 30;  // of a unit

  int32_t units = 0;
  int32_t rest = 0;  // [1 / kParts units, at most half a unit]
};

/// Rounds a displacement and the rest of the moves before it. `rest`: any, as a row of a saved
/// crowd may hold it. [units]
inline CarriedMove carry(double displacement, int32_t rest) {
  constexpr int32_t kHalf = CarriedMove::kParts / 2;
  const double exact = displacement + std::clamp(rest, -kHalf, kHalf) / double{CarriedMove::kParts};
  const auto units = static_cast<int32_t>(std::lrint(exact));
  return {units, static_cast<int32_t>(std::lrint((exact - units) * CarriedMove::kParts))};
}

/// The move of an externally controlled body that takes the velocity which it was given.
struct GivenMove {
  CarriedMove x, z;

  /// `units_by_speed`: how many units a body with 1 m/s moves in the step.
  GivenMove(const Body& body, double units_by_speed)
      : x(carry(double{body.preferred.x} * units_by_speed, body.local_target_x)),
        z(carry(double{body.preferred.z} * units_by_speed, body.local_target_z)) {}
};

/// Keeps the rest of a move that an externally controlled body is about to make, if it is the given
/// one. Others are never longer than their velocities, and leave nothing.
inline void keep_rest(Body& body, int32_t to_x, int32_t to_z, double units_by_speed) {
  if (!body.has(Body::kExternal)) return;
  const GivenMove given(body, units_by_speed);
  if (to_x - body.x != given.x.units || to_z - body.z != given.z.units) return;
  body.local_target_x = given.x.rest;
  body.local_target_z = given.z.rest;
}

/// Before a body is controlled: no move has left anything over.
inline void forget_rest(Body& body) {
  body.local_target_x = 0;
  body.local_target_z = 0;
}

}  // namespace throng::crowd
