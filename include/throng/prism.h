// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <vector>

#include "throng/base.h"
#include "throng/math.h"
#include "throng/result.h"

/// A simple volume for marking things.
namespace throng {

/// A vertical prism over a convex polygon: a crate, a barrier, a door leaf, a marked zone.
struct Prism {
  std::vector<std::array<double, 2>> corners;  ///< (x, z), in either order. [m, 3 to 64]
  double low = 0, high = 0;                    ///< Y of bottom and top. [m, low < high]

  [[nodiscard]] static Prism box(Vec3d low, Vec3d high) {
    return {{{low.x, low.z}, {high.x, low.z}, {high.x, high.z}, {low.x, high.z}}, low.y, high.y};
  }
  /// Is (x, z) over or under it, its border included? [m]
  [[nodiscard]] THRONG_API bool covers(double x, double z) const;
  /// Do feet stand in it that are at a height? [m]
  [[nodiscard]] bool reaches(double y) const { return y >= low - kFeet && y <= high + kFeet; }
  /// Does somebody stand in it whose feet are there?
  [[nodiscard]] bool holds(Vec3d feet) const { return reaches(feet.y) && covers(feet.x, feet.z); }
  static constexpr double kFeet = 0.05;  ///< [m] Heights of feet and floors differ by rounding.
  /// Around an upright cylinder: `middle` is that of its bottom; with 16 corners it reaches 2 % of
  /// the radius beyond. [m, radius > 0, height > 0, corners 3 to 64]
  [[nodiscard]] THRONG_API static Prism circle(Vec3d middle, double radius, double height,
                                               int corners = 16);
};

/// Fails with kBadInput and what is wrong unless the prism is as it says.
[[nodiscard]] THRONG_API Result<void> check_prism(const Prism& prism);

}  // namespace throng
