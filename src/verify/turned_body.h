// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <optional>

#include "throng/avatar.h"
#include "verify/cylinder.h"
#include "verify/triangle_tree.h"

/// Bodies that stand along any axis, against the triangles: their exact cylinder is turned upright
/// together with the triangles near it.
namespace throng::verify {

struct Pose {
  Vec3d feet, axis;
};

/// Calls visit(triangle, corners) for the triangles near a body, turned so that its axis points up
/// and its feet are the origin, until it says true.
template <class Visit>
bool for_each_turned(const TriangleTree& tree, const Pose& pose, double radius, double top,
                     Visit visit) {
  const Vec3d up = pose.axis;
  const Vec3d other = std::fabs(up.y) < 0.9 ? Vec3d{0, 1, 0} : Vec3d{1, 0, 0};
  Vec3d side = cross(other, up);
  side = side * (1 / length(side));
  const Vec3d front = cross(side, up);
  const double reach = std::sqrt(radius * radius + top * top);
  Box3d box;
  box.add(pose.feet - Vec3d{reach, reach, reach});
  box.add(pose.feet + Vec3d{reach, reach, reach});
  return tree.find(box, [&](uint32_t triangle, const Corners& corners) {
    Corners turned;
    for (size_t i = 0; i < 3; ++i) {
      const Vec3d d = corners[i] - pose.feet;
      turned[i] = {dot(d, side), dot(d, up), dot(d, front)};
    }
    return visit(triangle, turned);
  });
}

/// How high above its feet a solid may reach before it stops a body that stands along `axis`. Where
/// a climber walks, on level tiles, it is a walker.
inline double turned_bottom(const AvatarClass& avatar, Vec3d axis) {
  const bool upright = axis.y > 1 - 1e-12;
  return avatar.climb_slope > 0 && !upright ? avatar.step_height : body_bottom(avatar);
}

/// A triangle that meets the body, if any.
inline std::optional<uint32_t> turned_intruder(const TriangleTree& tree, const AvatarClass& avatar,
                                               const Pose& pose) {
  const Cylinder body{0, 0, turned_bottom(avatar, pose.axis), avatar.height, avatar.radius};
  std::optional<uint32_t> found;
  for_each_turned(tree, pose, avatar.radius, avatar.height,
                  [&](uint32_t triangle, const Corners& corners) {
                    if (!meets(body, corners)) return false;
                    found = triangle;
                    return true;
                  });
  return found;
}

/// Patches are cut into triangles to within centimetres, and neighbours' curves may differ by a
/// tenth of a metre.
inline constexpr double kOnSurface = 0.15;  // [m]

/// Is there a surface that is not blocked at the feet, in whatever direction?
inline bool turned_support(const TriangleTree& tree, const AvatarClass& avatar, Vec3d feet) {
  const double reach = std::max(kOnSurface, avatar.step_height + 0.01);
  const Cylinder around{feet.x, feet.z, feet.y - reach, feet.y + reach, reach};
  return tree.find(around.bounds(), [&](uint32_t triangle, const Corners& corners) {
    return tree.scene().area[triangle] != kAreaBlocked && meets(around, corners, -1e-9);
  });
}

}  // namespace throng::verify
