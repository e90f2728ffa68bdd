// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <vector>

#include "throng/base.h"
#include "throng/math.h"
#include "throng/result.h"

/// Prisms: simple volumes for obstacles and areas.
namespace throng {

/// A vertical prism over a convex polygon: a crate, a barrier, a door leaf, a marked zone.
struct Prism {
  std::vector<std::array<double, 2>> corners;  ///< (x, z), in either order. [m, 3 to 64]
  double low = 0, high = 0;                    ///< Y of bottom and top. [m, low < high]

  [[nodiscard]] static Prism box(Vec3d low, Vec3d high) {
    return {{{low.x, low.z}, {high.x, low.z}, {high.x, high.z}, {low.x, high.z}}, low.y, high.y};
  }
  /// Is (x, z) inside its polygon, border included? [m]
  [[nodiscard]] THRONG_API bool covers(double x, double z) const;
  /// Is this height of feet within the prism's, up to kFeet? [m]
  [[nodiscard]] bool reaches(double y) const { return y >= low - kFeet && y <= high + kFeet; }
  /// Does an avatar with these feet stand in it?
  [[nodiscard]] bool holds(Vec3d feet) const { return reaches(feet.y) && covers(feet.x, feet.z); }
  /// Tolerance: heights of feet and floors differ by rounding. [m]
  static constexpr double kFeet = 0.05;
  /// A prism around an upright cylinder: `middle` is that of its bottom; with 16 corners it is 2 %
  /// of the radius larger. [m, radius > 0, height > 0, corners 3 to 64]
  [[nodiscard]] THRONG_API static Prism circle(Vec3d middle, double radius, double height,
                                               int corners = 16);
};

/// Checks that a prism is convex and within its limits. Fails with kBadInput and the reason.
[[nodiscard]] THRONG_API Result<void> check_prism(const Prism& prism);

}  // namespace throng
