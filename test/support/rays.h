// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>

#include "throng/base.h"
#include "throng/scene.h"

/// Rays against triangles: an oracle of visibility that uses no code of the library.
namespace throng {

/// Where a ray meets a triangle's plane: u and v along its sides, `along` the ray (1: its end).
struct RayMeeting {
  double u = 0, v = 0, along = 0;
};

/// None if the ray lies along the triangle.
inline std::optional<RayMeeting> meet(const Scene& scene, const std::array<uint32_t, 3>& triangle,
                                      Vec3d from, Vec3d ray) {
  const Vec3d a = scene.positions[triangle[0]], b = scene.positions[triangle[1]] - a,
              c = scene.positions[triangle[2]] - a;
  const Vec3d p = cross(ray, c);
  const double det = dot(b, p);
  if (std::fabs(det) < 1e-12) return std::nullopt;
  const Vec3d s = from - a, q = cross(s, b);
  return RayMeeting{dot(s, p) / det, dot(ray, q) / det, dot(c, q) / det};
}

}  // namespace throng
