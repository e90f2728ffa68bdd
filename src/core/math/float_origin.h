// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>

#include "throng/base.h"

/// Where floats hold coordinates, wherever in the world these are.
namespace throng {

/// The whole multiples of 4096 m next to a position: relative to them floats resolve 0.25 mm around
/// it. Zero near the coordinate origin.
inline Vec3d float_origin(Vec3d position) {
  constexpr double kSpacing = 4096;  // [m]
  const auto axis = [](double v) { return std::round(v / kSpacing) * kSpacing; };
  return {axis(position.x), axis(position.y), axis(position.z)};
}

}  // namespace throng
