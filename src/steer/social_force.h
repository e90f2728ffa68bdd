// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <span>

/// The social force model as published, written plainly, for comparison with other models. The same
/// bytes everywhere. Source: [HM95].
namespace throng::steer {

/// A pedestrian moved by forces. [m, m/s]
struct ForceWalker {
  double x = 0, z = 0;
  double vx = 0, vz = 0;
  double preferred_x = 0, preferred_z = 0;  ///< Preferred velocity.
};

/// The numbers of [HM95], section III.
struct SocialForceConfig {
  double relaxation = 0.5;  ///< Time in which the preferred velocity is approached. [s]
  double strength = 2.1;    ///< Of the repulsion by others. [m2/s2]
  double range = 0.3;       ///< Of it. [m]
  double stride = 2;        ///< Time ahead for which the path of another is kept free. [s]
  double sight_cosine = -0.17364817766693033;  ///< Of 100 degrees: half the field of view.
  double behind = 0.5;                         ///< Weight of forces from outside of it.
  double max_speed = 1.3;                      ///< Speed by the desired one.
  double wall_strength = 10;                   ///< Of the repulsion by walls. [m2/s2]
  double wall_range = 0.2;                     ///< Of it. [m]
};

struct Force {
  double x = 0, z = 0;  ///< [m/s2]
};

/// The force of walker `b` on walker `a`, without regard to the field of view. 0 if both are at the
/// same point.
Force repulsion(const ForceWalker& a, const ForceWalker& b, const SocialForceConfig& config);

/// The force towards the preferred velocity of `a`.
Force drive(const ForceWalker& a, const SocialForceConfig& config);
/// Adds the force of `b` on `a`, weaker if `b` is outside the field of view.
void add_repulsion(Force& sum, const ForceWalker& a, const ForceWalker& b,
                   const SocialForceConfig& config);
/// Adds the force of a wall whose nearest point has the offset `x`, `z`.
void add_wall(Force& sum, double x, double z, const SocialForceConfig& config);

/// One step of all, by Euler's method. Time: the square of the walkers. [dt: s]
void step_social_force(std::span<ForceWalker> walkers, double dt, const SocialForceConfig& config);

}  // namespace throng::steer
