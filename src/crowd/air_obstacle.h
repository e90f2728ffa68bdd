// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "crowd/flight.h"
#include "throng/math.h"
#include "throng/prism.h"

/// An obstacle as a cylinder meets it.
namespace throng {

/// Counts a body as in it that is up to two units off.
class AirObstacle {
 public:
  /// For a world whose units are so long, from its corner. `closes`: it is not up yet, but nothing
  /// may enter it. [m]
  AirObstacle(const Prism& prism, const Vec3d& origin, double unit, bool closes = false);
  /// Is a body in it whose feet are there? [m, mm]
  [[nodiscard]] bool holds(const AirSpot& feet, double radius, int32_t height) const;
  [[nodiscard]] bool closes() const { return closes_; }
  /// Appends the nearest places beyond each of its sides, over it and under it. [m, mm]
  void list_exits(const AirSpot& feet, double radius, int32_t height,
                  std::vector<AirSpot>& exits) const;

 private:
  std::vector<std::array<double, 2>> corners_;  // [units]
  double unit_;
  double x0_, z0_, x1_, z1_;  // [units]
  int32_t low_, high_;        // [mm]
  bool closes_;
};

}  // namespace throng
