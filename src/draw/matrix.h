// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>

#include "throng/base.h"
#include "throng/impostor.h"

/// Matrices as OpenGL takes them: column by column.
namespace throng::draw {

using Matrix = std::array<float, 16>;

/// Rows of an affine map, and the last row.
inline Matrix matrix_of(Vec3d x, double dx, Vec3d y, double dy, Vec3d z, double dz, Vec3d w,
                        double dw) {
  const auto f = [](double v) { return static_cast<float>(v); };
  return {f(x.x), f(y.x), f(z.x), f(w.x), f(x.y), f(y.y), f(z.y), f(w.y),
          f(x.z), f(y.z), f(z.z), f(w.z), f(dx),  f(dy),  f(dz),  f(dw)};
}

/// What a camera sees, to clip space.
inline Matrix perspective(const EyeCamera& camera) {
  const CameraAxes axes = camera_axes(camera);
  const double up = 1 / std::tan(0.5 * camera.field_of_view), right = up / camera.aspect;
  const double n = camera.nearest, f = camera.furthest;
  const double a = (f + n) / (f - n), b = -2 * f * n / (f - n);
  const Vec3d e = camera.eye;
  return matrix_of(axes.right * right, -dot(axes.right, e) * right, axes.up * up,
                   -dot(axes.up, e) * up, axes.forward * a, -dot(axes.forward, e) * a + b,
                   axes.forward, -dot(axes.forward, e));
}

/// A box around `middle`, seen along -`towards`, to clip space.
inline Matrix parallel_view(Vec3d right, Vec3d up, Vec3d towards, Vec3d middle, double half_width,
                            double half_depth) {
  const double s = 1 / half_width, d = -1 / half_depth;
  return matrix_of(right * s, -dot(right, middle) * s, up * s, -dot(up, middle) * s, towards * d,
                   -dot(towards, middle) * d, {0, 0, 0}, 1);
}

}  // namespace throng::draw
