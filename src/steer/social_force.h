// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <span>

/// The social force model as it was published, plainly, to hold other models against. The same
/// bytes everywhere. Source: [HM95].
namespace throng::steer {

/// Somebody who is moved by forces. [m, m/s]
struct ForceWalker {
  double x = 0, z = 0;
  double vx = 0, vz = 0;
  double preferred_x = 0, preferred_z = 0;  ///< Velocity that he would walk at alone.
};

/// The numbers of [HM95], section III.
struct SocialForceConfig {
  double relaxation = 0.5;  ///< In which a wish is taken up. [s]
  double strength = 2.1;    ///< Of the repulsion by others. [m2/s2]
  double range = 0.3;       ///< Of it. [m]
  double stride = 2;        ///< For how long a step of somebody else is kept free. [s]
  double sight_cosine = -0.17364817766693033;  ///< Of 100 degrees: half of the field of view.
  double behind = 0.5;                         ///< Weight of what is outside of it.
  double most = 1.3;                           ///< Speed, by the wished one.
  double wall_strength = 10;                   ///< Of the repulsion by walls. [m2/s2]
  double wall_range = 0.2;                     ///< Of it. [m]
};

struct Force {
  double x = 0, z = 0;  ///< [m/s2]
};

/// What walker `a` feels of walker `b`, before the field of view. Nothing where both stand on one
/// place.
Force repulsion(const ForceWalker& a, const ForceWalker& b, const SocialForceConfig& config);

/// What takes up the wish of `a`.
Force drive(const ForceWalker& a, const SocialForceConfig& config);
/// Adds what `a` feels of `b`, less of who is outside of his field of view.
void add_repulsion(Force& sum, const ForceWalker& a, const ForceWalker& b,
                   const SocialForceConfig& config);
/// Adds what he feels of a wall whose nearest point is `x`, `z` from him.
void add_wall(Force& sum, double x, double z, const SocialForceConfig& config);

/// One step of all, by Euler's rule. [dt: s]
void step_social_force(std::span<ForceWalker> walkers, double dt, const SocialForceConfig& config);

}  // namespace throng::steer
