// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <cmath>
#include <string>

#include "core/math/plan_point.h"
#include "core/math/trig.h"
#include "throng/base.h"

// Upright convex prisms: circles, containment, checks.
namespace throng {

Prism Prism::circle(Vec3d middle, double radius, double height, int corners) {
  Prism prism{{}, middle.y, middle.y + height};
  // Its sides touch the circle; rounding must not let them cut it.
  const double out = radius / cos_turns(0.5 / corners) * (1 + 1e-9);
  for (int i = 0; i < corners; ++i) {
    const double turns = static_cast<double>(i) / corners;
    prism.corners.push_back({middle.x + out * cos_turns(turns), middle.z + out * sin_turns(turns)});
  }
  return prism;
}

bool Prism::covers(double x, double z) const {
  bool left = false, right = false;
  for (size_t i = 0; i < corners.size(); ++i) {
    const double side = turn(corners[i], corners[(i + 1) % corners.size()], {x, z});
    left |= side > 0;
    right |= side < 0;
  }
  return !(left && right);
}

Result<void> check_prism(const Prism& prism) {
  const auto bad = [](const std::string& what) { return Error{Errc::kBadInput, "prism: " + what}; };
  const size_t count = prism.corners.size();
  if (count < 3 || count > 64) {
    return bad("it has " + std::to_string(count) + " corners, give it 3 to 64");
  }
  if (!(prism.low < prism.high) || !std::isfinite(prism.high - prism.low)) {
    return bad("its bottom must lie below its top, both finite");
  }
  bool left = false, right = false;
  int turns_back = 0;  // along x: a star turns one way too, but goes round more than once
  for (size_t i = 0; i < count; ++i) {
    const PlanPoint& a = prism.corners[i];
    if (!(std::fabs(a[0]) < 1e9 && std::fabs(a[1]) < 1e9)) {
      return bad("corner " + std::to_string(i) + " is not a place on Earth");
    }
    const double side = turn(a, prism.corners[(i + 1) % count], prism.corners[(i + 2) % count]);
    if (side > 0) left = true;
    if (side < 0) right = true;
    const auto goes_up = [&](size_t k) {
      return prism.corners[(k + 1) % count] > prism.corners[k % count];
    };
    if (goes_up(i) != goes_up(i + 1)) ++turns_back;
  }
  if (left == right || turns_back > 2) {
    return bad("its corners are not those of a convex polygon, in order; cut it into convex ones");
  }
  return {};
}

}  // namespace throng
