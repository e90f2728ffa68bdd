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
  /// Units that a body with 1 m/s moves in a step.
  [[nodiscard]] double units_by_speed() const { return double{dt} / unit; }
  /// Are moves at this speed of so few units that rounding to the nearest would change it by more
  /// than half a percent?
  [[nodiscard]] bool is_short(float speed) const {
    constexpr float kMinStepUnits = 128;
    return speed * (dt / unit) < kMinStepUnits;
  }
  /// As displacement(), for short moves: the n-th of many, whose sum is right to a few units at
  /// every velocity, also if that changes a little from one to the next. To the displacement
  /// the n-th multiple of the golden ratio is added, modulo 1, then it is rounded down.
  [[nodiscard]] int32_t small_displacement(float velocity, uint64_t n) const {
    return towards_0(velocity, static_cast<double>((n * kGoldenRatio) >> 11) * 0x1p-53);
  }
  /// As displacement(), but short moves as small_displacement(), and longer ones rounded down.
  [[nodiscard]] int32_t displacement_within(float velocity, uint64_t n) const {
    return is_short(std::fabs(velocity)) ? small_displacement(velocity, n) : towards_0(velocity, 0);
  }
  [[nodiscard]] float velocity(int32_t displacement) const {
    return static_cast<float>(displacement) * (unit / dt);
  }
  /// As exactly a velocity is known from the displacement in a step: either part is rounded. [m/s]
  [[nodiscard]] float rounding() const { return 1.5f * (unit / dt); }
  /// No step at this speed is longer: moves are rounded to the nearest unit, short ones up. [units]
  [[nodiscard]] int32_t stride(float speed) const {
    return static_cast<int32_t>(speed * (dt / unit)) + (is_short(speed) ? 3 : 2);
  }

 private:
  static constexpr uint64_t kGoldenRatio = 0x9e3779b97f4a7c15;  // less 1, times 2^64
  // Rounded towards 0 once `part` of a unit was added.
  [[nodiscard]] int32_t towards_0(float velocity, double part) const {
    const double units = double{velocity} * units_by_speed();
    const auto size = static_cast<int32_t>(std::floor(std::fabs(units) + part));
    return units < 0 ? -size : size;
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
