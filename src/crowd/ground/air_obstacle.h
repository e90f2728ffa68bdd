// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "crowd/ground/air_position.h"
#include "throng/base.h"

/// An obstacle against which upright cylinders are tested.
namespace throng::crowd {

/// A body that is up to two units away counts as inside.
class AirObstacle {
 public:
  /// `unit`: of the world, whose corner `origin` is. [m] `closes`: the obstacle is not active yet,
  /// but no body may enter it.
  AirObstacle(const Prism& prism, const Vec3d& origin, double unit, bool closes = false);
  /// Is a body inside whose feet are at this position? [m, mm]
  [[nodiscard]] bool holds(const AirPosition& feet, double radius, int32_t height) const;
  [[nodiscard]] bool closes() const { return closes_; }
  /// Around its polygon: x0, z0, x1, z1. [units]
  [[nodiscard]] std::array<double, 4> box() const { return {x0_, z0_, x1_, z1_}; }
  /// No body of this radius is inside that is farther from the polygon. [m, m; units]
  static double range(double radius, double unit) { return radius / unit + 2; }
  /// Appends the nearest positions beyond each of its sides, above it and below it. [m, mm]
  void list_exits(const AirPosition& feet, double radius, int32_t height,
                  std::vector<AirPosition>& exits) const;

 private:
  std::vector<std::array<double, 2>> corners_;  // [units]
  double unit_;
  double x0_, z0_, x1_, z1_;  // [units]
  int32_t low_, high_;        // [mm]
  bool closes_;
};

}  // namespace throng::crowd
