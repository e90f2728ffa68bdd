// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstdint>

#include "steer/sampled.h"

/// Converts between velocities and the units of the grid that a body moves by in a step.
namespace throng::crowd {

struct StepUnits {
  float unit = 1;  ///< [m]
  float dt = 1;    ///< [s]

  /// Metres of a displacement in units.
  [[nodiscard]] steer::Plane metres(int32_t x, int32_t z) const {
    return {static_cast<float>(x) * unit, static_cast<float>(z) * unit};
  }
  /// Displacement in a step at a velocity along an axis, to the nearest unit.
  [[nodiscard]] int32_t displacement(float velocity) const {
    return static_cast<int32_t>(std::lrint(velocity * (dt / unit)));
  }
  /// The same for displacements of few units: the n-th of many at one velocity, whose sum is right
  /// to the unit. (As in Bresenham's line.)
  [[nodiscard]] int32_t small_displacement(float velocity, uint64_t n) const {
    const double units = double{velocity} * (double{dt} / unit);
    const auto k = static_cast<double>(n % kMovesPerCycle);
    return static_cast<int32_t>(std::floor(units * (k + 1)) - std::floor(units * k));
  }
  static constexpr uint64_t kMovesPerCycle = 1 << 16;
  [[nodiscard]] float velocity(int32_t displacement) const {
    return static_cast<float>(displacement) * (unit / dt);
  }
  /// No step at this speed is longer. [units]
  [[nodiscard]] int32_t stride(float speed) const {
    return static_cast<int32_t>(speed * (dt / unit)) + 2;
  }
};

/// Square of a distance in units, by which neighbours are sorted: rounded, but the same everywhere.
inline float near_square(int32_t x, int32_t z) {
  return static_cast<float>(x) * static_cast<float>(x) +
         static_cast<float>(z) * static_cast<float>(z);
}

/// Are two points of the plane nearer than `range` units? Exact.
inline bool nearer_than(int32_t x, int32_t z, int64_t range) {
  return int64_t{x} * x + int64_t{z} * z < range * range;
}

}  // namespace throng::crowd
