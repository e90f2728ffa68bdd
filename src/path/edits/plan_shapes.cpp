// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "path/edits/plan_shapes.h"

#include <algorithm>
#include <cmath>

// Distances of convex polygons, and heights of a triangle over a square. Linear in the polygon's
// corners; constant time for a triangle.
namespace throng::path {
namespace {

// Convex, of either order.
bool holds(std::span<const PlanPoint> polygon, PlanPoint p) {
  bool left = false, right = false;
  for (size_t i = 0; i < polygon.size(); ++i) {
    const double side = turn(polygon[i], polygon[(i + 1) % polygon.size()], p);
    (side >= 0 ? left : right) = true;
  }
  return left != right;
}

bool cross(PlanPoint a, PlanPoint b, PlanPoint c, PlanPoint d) {
  return (turn(a, b, c) > 0) != (turn(a, b, d) > 0) && (turn(c, d, a) > 0) != (turn(c, d, b) > 0);
}

}  // namespace

double squared_to_segment(PlanPoint p, PlanPoint a, PlanPoint b) {
  const double ux = b[0] - a[0], uz = b[1] - a[1];
  const double size = ux * ux + uz * uz;
  const double t =
      size > 0 ? std::clamp(((p[0] - a[0]) * ux + (p[1] - a[1]) * uz) / size, 0.0, 1.0) : 0;
  const double dx = a[0] + t * ux - p[0], dz = a[1] + t * uz - p[1];
  return dx * dx + dz * dz;
}

bool is_nearer(const PlanSquare& square, std::span<const PlanPoint> polygon, double distance) {
  const std::array<PlanPoint, 4> corners{
      PlanPoint{square.x0, square.z0}, PlanPoint{square.x1, square.z0},
      PlanPoint{square.x1, square.z1}, PlanPoint{square.x0, square.z1}};
  if (polygon.size() > 2 && holds(polygon, corners[0])) return true;
  const double limit = distance * distance;
  for (size_t i = 0; i < polygon.size(); ++i) {
    const PlanPoint a = polygon[i], b = polygon[(i + 1) % polygon.size()];
    const double dx = std::max({square.x0 - a[0], a[0] - square.x1, 0.0});
    const double dz = std::max({square.z0 - a[1], a[1] - square.z1, 0.0});
    if (dx * dx + dz * dz < limit) return true;
    for (size_t k = 0; k < 4; ++k) {
      if (squared_to_segment(corners[k], a, b) < limit) return true;
      if (cross(a, b, corners[k], corners[(k + 1) % 4])) return true;
    }
  }
  return false;
}

std::optional<std::pair<double, double>> heights_over(const PlanSquare& square,
                                                      const std::array<Vec3d, 3>& triangle) {
  // Sutherland and Hodgman's clipping, side after side; a triangle gains a corner at each.
  std::array<Vec3d, 8> in{triangle[0], triangle[1], triangle[2]}, out;
  size_t count = 3;
  const auto clip = [&](auto inside) {  // inside(p): how far; below 0 is outside
    size_t kept = 0;
    for (size_t i = 0; i < count; ++i) {
      const Vec3d &a = in[i], &b = in[(i + 1) % count];
      const double da = inside(a), db = inside(b);
      if (da >= 0) out[kept++] = a;
      if ((da >= 0) != (db >= 0)) out[kept++] = a + (b - a) * (da / (da - db));
    }
    in = out;
    count = kept;
  };
  clip([&](const Vec3d& p) { return p.x - square.x0; });
  clip([&](const Vec3d& p) { return square.x1 - p.x; });
  clip([&](const Vec3d& p) { return p.z - square.z0; });
  clip([&](const Vec3d& p) { return square.z1 - p.z; });
  if (count == 0) return std::nullopt;
  std::pair<double, double> heights{in[0].y, in[0].y};
  for (size_t i = 1; i < count; ++i) {
    heights = {std::min(heights.first, in[i].y), std::max(heights.second, in[i].y)};
  }
  return heights;
}

}  // namespace throng::path
