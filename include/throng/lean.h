// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include "throng/math.h"

/// How bodies lean whose axis is not upright: those who climb stand along the surface's normal.
namespace throng {

/// A vector turned as a body that leans: by the least turn that takes straight up to `up`, and by
/// half a turn around X if that is straight down. [up: unit length]
inline Vec3d leaned(Vec3d v, Vec3d up) {
  if (up.y < -0.999999) return {v.x, -v.y, -v.z};
  const Vec3d by{up.z, 0, -up.x}, turned = cross(by, v);
  return v + turned + cross(by, turned) * (1 / (1 + up.y));
}
/// And back.
inline Vec3d unleaned(Vec3d v, Vec3d up) { return leaned(v, {-up.x, up.y, -up.z}); }

}  // namespace throng
