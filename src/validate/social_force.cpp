// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "validate/social_force.h"

#include <algorithm>
#include <cmath>
#include <vector>

// Around everybody lies a potential whose lines are ellipses along his next step, eq. 4; the force
// is its gradient, eq. 3, weaker from behind, eq. 8 and 9. Walls are left out: nothing here has
// any.
namespace throng::validate {

Force repulsion(const ForceWalker& a, const ForceWalker& b, const SocialForceConfig& config) {
  const double rx = a.x - b.x, rz = a.z - b.z;
  const double sx = rx - b.vx * config.stride, sz = rz - b.vz * config.stride;
  const double r = std::hypot(rx, rz), s = std::hypot(sx, sz);
  const double step = std::hypot(b.vx, b.vz) * config.stride;
  const double twice = (r + s) * (r + s) - step * step;  // (2 b) squared
  if (r == 0 || s == 0 || twice <= 0) return {};
  const double axis = std::sqrt(twice) / 2;
  const double size =
      config.strength / config.reach * std::exp(-axis / config.reach) * (r + s) / (4 * axis);
  return {size * (rx / r + sx / s), size * (rz / r + sz / s)};
}

void step_social_force(std::span<ForceWalker> walkers, double dt, const SocialForceConfig& config) {
  std::vector<Force> forces(walkers.size());
  for (size_t i = 0; i < walkers.size(); ++i) {
    const ForceWalker& a = walkers[i];
    const double wish = std::hypot(a.wish_x, a.wish_z);
    Force& sum = forces[i];
    sum = {(a.wish_x - a.vx) / config.relaxation, (a.wish_z - a.vz) / config.relaxation};
    for (size_t j = 0; j < walkers.size(); ++j) {
      if (i == j) continue;
      const Force force = repulsion(a, walkers[j], config);
      // It pushes away from what is seen: that lies against the force.
      const double ahead = wish > 0 ? -(force.x * a.wish_x + force.z * a.wish_z) / wish : 0;
      const bool seen = ahead >= std::hypot(force.x, force.z) * config.sight_cosine;
      sum.x += (seen ? 1 : config.behind) * force.x;
      sum.z += (seen ? 1 : config.behind) * force.z;
    }
  }
  for (size_t i = 0; i < walkers.size(); ++i) {
    ForceWalker& a = walkers[i];
    a.vx += forces[i].x * dt;
    a.vz += forces[i].z * dt;
    const double most = config.most * std::hypot(a.wish_x, a.wish_z);
    const double speed = std::hypot(a.vx, a.vz);
    if (speed > most) {
      a.vx *= most / speed;
      a.vz *= most / speed;
    }
    a.x += a.vx * dt;
    a.z += a.vz * dt;
  }
}

}  // namespace throng::validate
