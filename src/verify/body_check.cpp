// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "verify/body_check.h"

#include <cmath>
#include <numbers>

// Tests one claimed place against the triangles: what enters the body, and the distance from its
// feet to the surface.
namespace throng::verify {
namespace {

double radians(double degrees) { return degrees * std::numbers::pi / 180; }

}  // namespace

double levelness_limit(const AvatarClass& avatar) {
  return std::cos(radians(avatar.max_slope)) - 1e-5;
}

BodyCheck::BodyCheck(const TriangleTree& tree, const AvatarClass& avatar, double cell)
    : tree_(&tree),
      radius_(avatar.radius),
      bottom_(body_bottom(avatar)),
      height_(avatar.height),
      step_(avatar.step_height),
      cell_(cell),
      support_above_(cell * std::tan(radians(avatar.max_slope)) + 0.005),
      levelness_(levelness_limit(avatar)) {}

std::optional<uint32_t> BodyCheck::intruder(Vec3d feet) const {
  const Cylinder body{feet.x, feet.z, feet.y + bottom_, feet.y + height_, radius_};
  std::optional<uint32_t> found;
  tree_->find(body.bounds(), [&](uint32_t triangle, const Corners& corners) {
    if (!meets(body, corners)) return false;
    found = triangle;
    return true;
  });
  return found;
}

bool BodyCheck::is_supported(Vec3d feet) const {
  constexpr double kRounding = 1e-3;
  const Cylinder reach{feet.x, feet.z, feet.y - step_ - kRounding, feet.y + support_above_, cell_};
  return tree_->find(reach.bounds(), [&](uint32_t triangle, const Corners& corners) {
    return tree_->scene().area[triangle] != kAreaBlocked && levelness(corners) >= levelness_ &&
           meets(reach, corners, -1e-9);
  });
}

std::optional<double> BodyCheck::feet_error(Vec3d feet) const {
  Box3d line;
  line.min = {feet.x, feet.y - step_, feet.z};
  line.max = {feet.x, feet.y + step_, feet.z};
  std::optional<double> nearest;
  tree_->find(line, [&](uint32_t, const Corners& corners) {
    const auto y = height_at(corners, feet.x, feet.z);
    if (!y) return false;
    const double error = std::fabs(*y - feet.y);
    if (error <= step_ && (!nearest || error < *nearest)) nearest = error;
    return false;
  });
  return nearest;
}

}  // namespace throng::verify
