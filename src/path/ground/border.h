// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "path/ground/mesh.h"

/// Geometry of rectangles and what is seen of them. Distances around a rectangle run from its
/// south-west corner with the inside on the left, as its portals do. [cells]
namespace throng::path {

inline constexpr double kSame = 1e-9;  // cells

inline double distance(CellPoint a, CellPoint b) {
  const double dx = a.x - b.x, dz = a.z - b.z;
  return std::sqrt(dx * dx + dz * dz);
}

// Twice the area of (a, b, c): positive if c lies to the left of a -> b.
inline double cross(CellPoint a, CellPoint b, CellPoint c) {
  return (b.x - a.x) * (c.z - a.z) - (b.z - a.z) * (c.x - a.x);
}

inline double perimeter(const MeshRect& rect) { return 2.0 * (rect.width + rect.depth); }

inline CellPoint point_around(const MeshRect& rect, double at) {
  const double w = rect.width, d = rect.depth;
  if (at <= w) return {rect.x + at, double(rect.z)};
  if (at <= w + d) return {rect.x + w, rect.z + (at - w)};
  if (at <= 2 * w + d) return {rect.x + w - (at - w - d), rect.z + d};
  return {double(rect.x), rect.z + d - (at - 2 * w - d)};
}

// How far around a point of the border is.
inline double around(const MeshRect& rect, CellPoint p) {
  const double w = rect.width, d = rect.depth;
  if (p.z <= rect.z) return p.x - rect.x;
  if (p.x >= rect.x + w) return w + (p.z - rect.z);
  if (p.z >= rect.z + d) return w + d + (rect.x + w - p.x);
  return 2 * w + d + (rect.z + d - p.z);
}

// How far around the ray from `root` through the border point `through` leaves the rectangle.
inline double exit_around(const MeshRect& rect, CellPoint root, CellPoint through) {
  const double dx = through.x - root.x, dz = through.z - root.z;
  double best = 1e300;
  CellPoint exit = through;
  const auto consider = [&](double t, double x, double z) {
    if (t < best) {
      best = t;
      exit = {x, z};
    }
  };
  const double x0 = rect.x, x1 = rect.x + rect.width, z0 = rect.z, z1 = rect.z + rect.depth;
  if (dx != 0) {
    const double x = dx > 0 ? x1 : x0, t = (x - through.x) / dx;
    consider(t, x, std::clamp(through.z + t * dz, z0, z1));
  }
  if (dz != 0) {
    const double z = dz > 0 ? z1 : z0, t = (z - through.z) / dz;
    consider(t, std::clamp(through.x + t * dx, x0, x1), z);
  }
  return around(rect, exit);
}

// True if the ray from `root` through the border point `through` runs along the border.
inline bool runs_along(const MeshRect& rect, CellPoint root, CellPoint through) {
  if (root.z == through.z) return through.z == rect.z || through.z == rect.z + rect.depth;
  if (root.x == through.x) return through.x == rect.x || through.x == rect.x + rect.width;
  return false;
}

/// The rectangles that are connected around a point of `rect`: only that one, unless the point lies
/// on its border and there are portals at it. What lies around the point is seen from them, so no
/// line of sight needs to pass a portal that touches it.
inline void rects_around(const PathMesh& mesh, uint32_t rect, CellPoint point,
                         std::vector<uint32_t>& around_it) {
  around_it.assign(1, rect);
  for (size_t i = 0; i < around_it.size(); ++i) {
    const auto portals = mesh.portals_of(around_it[i]);
    const MeshRect& r = mesh.rects[around_it[i]];
    if (point.x > r.x && point.x < r.x + r.width && point.z > r.z && point.z < r.z + r.depth)
      continue;
    for (const MeshPortal& portal : portals) {
      const CellPoint a = point_around(r, portal.from), b = point_around(r, portal.to);
      const bool touches =
          std::fabs(cross(a, b, point)) <= kSame &&
          std::max(distance(a, point), distance(b, point)) <= distance(a, b) + kSame;
      if (touches && std::find(around_it.begin(), around_it.end(), portal.rect) == around_it.end())
        around_it.push_back(portal.rect);
    }
  }
}

}  // namespace throng::path
