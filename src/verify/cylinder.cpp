// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "verify/cylinder.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

// A cylinder is a disc times a slab. What a triangle has inside the slab is a convex polygon of at
// most five corners; seen from above it meets the disc iff its distance to the axis is below the
// radius. Coordinates are taken relative to the axis first, so that far-off worlds lose nothing.
namespace throng::verify {
namespace {

struct ClippedPolygon {
  std::array<Vec3d, 5> points;
  size_t count = 0;
};

// Keeps the part with sign * y >= sign * height (Sutherland-Hodgman, one plane).
ClippedPolygon clip(const ClippedPolygon& in, double height, double sign) {
  ClippedPolygon out;
  for (size_t i = 0; i < in.count; ++i) {
    const Vec3d a = in.points[i];
    const Vec3d b = in.points[(i + 1) % in.count];
    const bool a_inside = sign * a.y >= sign * height;
    const bool b_inside = sign * b.y >= sign * height;
    if (a_inside) out.points[out.count++] = a;
    if (a_inside != b_inside) {
      const double t = (height - a.y) / (b.y - a.y);
      out.points[out.count++] = {a.x + t * (b.x - a.x), height, a.z + t * (b.z - a.z)};
    }
  }
  return out;
}

double squared_distance_to_axis(Vec3d a, Vec3d b) {
  const double dx = b.x - a.x;
  const double dz = b.z - a.z;
  const double squared_length = dx * dx + dz * dz;
  const double t =
      squared_length > 0 ? std::clamp(-(a.x * dx + a.z * dz) / squared_length, 0.0, 1.0) : 0.0;
  const double x = a.x + t * dx;
  const double z = a.z + t * dz;
  return x * x + z * z;
}

// True if the axis passes through the polygon. The box is needed for polygons seen edge-on: on
// their own line all the signs below are noise.
bool contains_axis(const ClippedPolygon& polygon) {
  bool left = true;
  bool right = true;
  double min_x = polygon.points[0].x, max_x = min_x;
  double min_z = polygon.points[0].z, max_z = min_z;
  for (size_t i = 0; i < polygon.count; ++i) {
    const Vec3d a = polygon.points[i];
    const Vec3d b = polygon.points[(i + 1) % polygon.count];
    const double side = a.x * b.z - a.z * b.x;
    left = left && side >= 0;
    right = right && side <= 0;
    min_x = std::min(min_x, a.x);
    max_x = std::max(max_x, a.x);
    min_z = std::min(min_z, a.z);
    max_z = std::max(max_z, a.z);
  }
  return (left || right) && min_x <= 0 && 0 <= max_x && min_z <= 0 && 0 <= max_z;
}

}  // namespace

Box3d Cylinder::bounds() const {
  Box3d box;
  box.min = {x - radius, low, z - radius};
  box.max = {x + radius, high, z + radius};
  return box;
}

bool meets(const Cylinder& cylinder, const Corners& triangle, double touch) {
  const double low = cylinder.low + touch;
  const double high = cylinder.high - touch;
  const double radius = cylinder.radius - touch;
  if (!(low <= high && radius > 0)) return false;

  ClippedPolygon polygon;
  for (const Vec3d& p : triangle) {
    polygon.points[polygon.count++] = {p.x - cylinder.x, p.y, p.z - cylinder.z};
  }
  polygon = clip(polygon, low, 1);
  if (polygon.count == 0) return false;
  polygon = clip(polygon, high, -1);
  if (polygon.count == 0) return false;

  for (size_t i = 0; i < polygon.count; ++i) {
    const double d2 =
        squared_distance_to_axis(polygon.points[i], polygon.points[(i + 1) % polygon.count]);
    if (d2 < radius * radius) return true;
  }
  return contains_axis(polygon);
}

std::optional<double> height_at(const Corners& triangle, double x, double z) {
  const Vec3d a{triangle[0].x - x, triangle[0].y, triangle[0].z - z};
  const Vec3d b{triangle[1].x - x, triangle[1].y, triangle[1].z - z};
  const Vec3d c{triangle[2].x - x, triangle[2].y, triangle[2].z - z};
  const double area2 = (b.x - a.x) * (c.z - a.z) - (b.z - a.z) * (c.x - a.x);
  if (std::fabs(area2) < 1e-14) return std::nullopt;
  const double wa = (b.x * c.z - b.z * c.x) / area2;
  const double wb = (c.x * a.z - c.z * a.x) / area2;
  const double wc = (a.x * b.z - a.z * b.x) / area2;
  constexpr double kOutside = -1e-9;  // Two triangles that share an edge leave no gap there.
  if (wa < kOutside || wb < kOutside || wc < kOutside) return std::nullopt;
  const double y = wa * a.y + wb * b.y + wc * c.y;
  return std::clamp(y, std::min({a.y, b.y, c.y}), std::max({a.y, b.y, c.y}));
}

double levelness(const Corners& triangle) {
  const Vec3d normal = cross(triangle[1] - triangle[0], triangle[2] - triangle[0]);
  const double size = length(normal);
  return size > 0 ? std::fabs(normal.y) / size : 0;
}

}  // namespace throng::verify
