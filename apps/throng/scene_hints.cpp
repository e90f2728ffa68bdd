// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "scene_hints.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

// Two signs of a model that was misread. Of one with another axis up, floors stand upright, so most
// of its area faces one horizontal axis; the walls of a tower face two. Of one in centimetres,
// triangles are 10 000 times as large as they should be. Of the 16 models that were measured, those
// that are read right have up to 1.1 times as much area towards one horizontal axis as level; 11
// have 2.2 to 53 times as much, and twice what faces the other one, if z and y are exchanged.
namespace throng::app {
namespace {

constexpr double kFacing = 0.9;          // cosine: a triangle faces the axis
constexpr double kLevelRatio = 2;        // upright area that faces one axis, to level area
constexpr double kUprightRatio = 2;      // and to what faces the other horizontal axis
constexpr double kLargeTriangle = 1000;  // [m2]
constexpr uint64_t kMinTriangles = 100;  // fewer can be large in any model
constexpr double kMinSide = 3;           // of a place for people [m]

struct Areas {
  double x = 0, y = 0, z = 0;  // that face each axis [m2]
  uint64_t large = 0;          // triangles
};

Areas areas_of(const Scene& scene) {
  Areas areas;
  for (const auto& [a, b, c] : scene.triangles) {
    const Vec3d u = scene.positions[b] - scene.positions[a];
    const Vec3d v = scene.positions[c] - scene.positions[a];
    const Vec3d normal{u.y * v.z - u.z * v.y, u.z * v.x - u.x * v.z, u.x * v.y - u.y * v.x};
    const double twice = length(normal);
    const double facing = kFacing * twice;
    if (std::fabs(normal.x) > facing) areas.x += twice / 2;
    if (std::fabs(normal.y) > facing) areas.y += twice / 2;
    if (std::fabs(normal.z) > facing) areas.z += twice / 2;
    if (twice / 2 > kLargeTriangle) ++areas.large;
  }
  return areas;
}

}  // namespace

std::string size_text(const Box3d& bounds) {
  const Vec3d size = bounds.max - bounds.min;
  return fmt::format("{:.1f} x {:.1f} m, {:.1f} m high", size.x, size.z, size.y);
}

std::vector<std::string> scene_hints(const Scene& scene) {
  std::vector<std::string> hints;
  const Box3d bounds = scene.bounds();
  if (bounds.empty()) return hints;
  const Vec3d size = bounds.max - bounds.min;
  const Areas areas = areas_of(scene);
  const bool is_small = std::max({size.x, size.y, size.z}) < kMinSide;
  const bool is_coarse =
      scene.triangles.size() >= kMinTriangles && 2 * areas.large > scene.triangles.size();
  if (is_small || is_coarse) {
    hints.push_back(fmt::format(
        "{}: check the unit (--scale)",
        is_small ? "the model is small for a place to walk in"
                 : fmt::format("most triangles are larger than {} m2", kLargeTriangle)));
  }
  const double most = std::max(areas.x, areas.z), other = std::min(areas.x, areas.z);
  if (most > kLevelRatio * areas.y && most > kUprightRatio * other) {
    hints.push_back("most surfaces are upright and face one direction: check the up axis (--up)");
  }
  return hints;
}

}  // namespace throng::app
