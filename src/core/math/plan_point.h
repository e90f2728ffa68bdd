// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>

namespace throng {

/// A point of the ground's plane: x, z. [m]
using PlanPoint = std::array<double, 2>;

/// Twice the area of a triangle; its sign is the orientation of the corners.
inline double turn(PlanPoint a, PlanPoint b, PlanPoint c) {
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

}  // namespace throng
