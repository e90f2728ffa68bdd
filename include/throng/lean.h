// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include "throng/math.h"

/// The lean of bodies whose axis is not upright: climbers stand along the surface's normal.
namespace throng {

/// Turns a vector as a body leans: by the smallest rotation that takes straight up to `up`, and by
/// half a turn around X if `up` is straight down. [up: unit length]
inline Vec3d leaned(Vec3d v, Vec3d up) {
  if (up.y < -0.999999) return {v.x, -v.y, -v.z};
  const Vec3d by{up.z, 0, -up.x}, turned = cross(by, v);
  return v + turned + cross(by, turned) * (1 / (1 + up.y));
}
/// The inverse of leaned().
inline Vec3d unleaned(Vec3d v, Vec3d up) { return leaned(v, {-up.x, up.y, -up.z}); }

}  // namespace throng
