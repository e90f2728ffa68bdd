// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>

#include "throng/base.h"

/// Affine maps for skeletons.
namespace throng::impostor {

/// outer(inner(p)).
inline Transform operator*(const Transform& outer, const Transform& inner) {
  Transform out;
  for (size_t r = 0; r < 3; ++r) {
    for (size_t c = 0; c < 4; ++c) {
      double sum = c == 3 ? outer.m[r][3] : 0;
      for (size_t k = 0; k < 3; ++k) sum += outer.m[r][k] * inner.m[k][c];
      out.m[r][c] = sum;
    }
  }
  return out;
}

/// The 3 x 3 part only, for directions.
inline Vec3d turn(const Transform& t, Vec3d v) {
  return {t.m[0][0] * v.x + t.m[0][1] * v.y + t.m[0][2] * v.z,
          t.m[1][0] * v.x + t.m[1][1] * v.y + t.m[1][2] * v.z,
          t.m[2][0] * v.x + t.m[2][1] * v.y + t.m[2][2] * v.z};
}

inline Vec3d column(const Transform& t, size_t c) { return {t.m[0][c], t.m[1][c], t.m[2][c]}; }

/// Scales, then rotates by the quaternion x, y, z, w, then translates.
inline Transform compose(Vec3d position, const std::array<double, 4>& q, Vec3d scale) {
  const auto [x, y, z, w] = q;
  Transform t;
  t.m[0] = {(1 - 2 * (y * y + z * z)) * scale.x, 2 * (x * y - z * w) * scale.y,
            2 * (x * z + y * w) * scale.z, position.x};
  t.m[1] = {2 * (x * y + z * w) * scale.x, (1 - 2 * (x * x + z * z)) * scale.y,
            2 * (y * z - x * w) * scale.z, position.y};
  t.m[2] = {2 * (x * z - y * w) * scale.x, 2 * (y * z + x * w) * scale.y,
            (1 - 2 * (x * x + y * y)) * scale.z, position.z};
  return t;
}

}  // namespace throng::impostor
