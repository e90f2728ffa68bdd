// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "steer/social_force.h"

#include <cmath>
#include <vector>

#include "core/math/exponential.h"

// [HM95]: each walker has a potential whose level lines are ellipses along its next stride, eq. 4;
// the force is its gradient, eq. 3, weaker from behind, eq. 8 and 9. Walls push by their nearest
// point, eq. 5.
namespace throng::steer {
namespace {

// Not the C library's hypot, which differs between machines.
double size_of(double x, double z) { return std::sqrt(x * x + z * z); }

}  // namespace

Force repulsion(const ForceWalker& a, const ForceWalker& b, const SocialForceConfig& config) {
  const double rx = a.x - b.x, rz = a.z - b.z;
  const double sx = rx - b.vx * config.stride, sz = rz - b.vz * config.stride;
  const double r = size_of(rx, rz), s = size_of(sx, sz);
  const double step = size_of(b.vx, b.vz) * config.stride;
  const double twice = (r + s) * (r + s) - step * step;  // (2 b) squared
  if (r == 0 || s == 0 || twice <= 0) return {};
  const double axis = std::sqrt(twice) / 2;
  const double size =
      config.strength / config.range * exp_of(-axis / config.range) * (r + s) / (4 * axis);
  return {size * (rx / r + sx / s), size * (rz / r + sz / s)};
}

Force drive(const ForceWalker& a, const SocialForceConfig& config) {
  return {(a.preferred_x - a.vx) / config.relaxation, (a.preferred_z - a.vz) / config.relaxation};
}

void add_repulsion(Force& sum, const ForceWalker& a, const ForceWalker& b,
                   const SocialForceConfig& config) {
  const double preferred = size_of(a.preferred_x, a.preferred_z);
  const Force force = repulsion(a, b, config);
  // The force points away from its source, so the source lies opposite to it.
  const double ahead =
      preferred > 0 ? -(force.x * a.preferred_x + force.z * a.preferred_z) / preferred : 0;
  const bool seen = ahead >= size_of(force.x, force.z) * config.sight_cosine;
  sum.x += (seen ? 1 : config.behind) * force.x;
  sum.z += (seen ? 1 : config.behind) * force.z;
}

void add_wall(Force& sum, double x, double z, const SocialForceConfig& config) {
  const double far = size_of(x, z);
  if (far == 0) return;
  const double size =
      config.wall_strength / config.wall_range * exp_of(-far / config.wall_range) / far;
  sum.x -= size * x;
  sum.z -= size * z;
}

void step_social_force(std::span<ForceWalker> walkers, double dt, const SocialForceConfig& config) {
  std::vector<Force> forces;
  for (size_t i = 0; i < walkers.size(); ++i) {
    Force& sum = forces.emplace_back(drive(walkers[i], config));
    for (size_t j = 0; j < walkers.size(); ++j) {
      if (i != j) add_repulsion(sum, walkers[i], walkers[j], config);
    }
  }
  for (size_t i = 0; i < walkers.size(); ++i) {
    ForceWalker& a = walkers[i];
    a.vx += forces[i].x * dt;
    a.vz += forces[i].z * dt;
    const double max_speed = config.max_speed * size_of(a.preferred_x, a.preferred_z);
    const double speed = size_of(a.vx, a.vz);
    if (speed > max_speed) {
      a.vx *= max_speed / speed;
      a.vz *= max_speed / speed;
    }
    a.x += a.vx * dt;
    a.z += a.vz * dt;
  }
}

}  // namespace throng::steer
