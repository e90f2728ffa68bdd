// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>

#include "throng/base.h"

/// An exact test of an upright cylinder against a prism, independent of the library's.
namespace throng::test {

/// Distance of a point of the plane from the prism's polygon; 0 inside. [m]
inline double plan_distance(const Prism& prism, double x, double z) {
  bool left = false, right = false;
  double least = HUGE_VAL;
  for (size_t i = 0; i < prism.corners.size(); ++i) {
    const auto& a = prism.corners[i];
    const auto& b = prism.corners[(i + 1) % prism.corners.size()];
    const double ux = b[0] - a[0], uz = b[1] - a[1], px = x - a[0], pz = z - a[1];
    const double side = ux * pz - uz * px;
    left |= side > 0;
    right |= side < 0;
    const double t = std::clamp((px * ux + pz * uz) / (ux * ux + uz * uz), 0.0, 1.0);
    least = std::min(least, std::hypot(px - t * ux, pz - t * uz));
  }
  return left && right ? least : 0;
}

/// Does a body from `low` to `high` around (x, z) overlap it?
inline bool is_touched(const Prism& prism, double x, double z, double low, double high,
                       double radius) {
  return high > prism.low && low < prism.high && plan_distance(prism, x, z) < radius;
}

}  // namespace throng::test
