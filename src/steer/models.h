// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>

#include "steer/air.h"
#include "steer/sampled.h"
#include "throng/avatar.h"
#include "throng/papers.h"

/// The other models that can steer a crowd, for comparison: from the view of an avatar to its next
/// velocity. Their only state is the present velocity.
namespace throng::steer {

/// Another avatar in the view of an avatar.
struct Other {
  Plane at, velocity;  ///< `at`: offset from the avatar's centre.
  float radius = 0;    ///< [m]
  uint32_t slot = 0;
};

/// The input of steering for one avatar.
struct View {
  Plane velocity;
  Plane preferred;    ///< The velocity without others.
  Plane to_target;    ///< Offset to its target. [m]
  bool stops = true;  ///< It stops at the target.
  float fastest = 1;  ///< [m/s, > 0]
  float radius = 0;   ///< [m]
  uint32_t slot = 0;
  std::span<const Other> others;  ///< At most kMaxNear, the nearest first.
  bool has_wall = false;
  Plane wall = {};  ///< Offset to the nearest point of a wall.
};

/// The velocity after a step of `dt` in which all others keep their velocities; at most `fastest`.
/// A step is integrated in parts of at most about 30 ms. [model: not kSampled; curves: of
/// kCurvilinear]
Plane preferred_velocity(SteeringModel model, const View& view, float dt,
                         const caacd::Model& curves = {});

/// What steering in the air by [CAACD] needs beside an AirSituation.
struct AirView {
  Space to_target;    ///< Offset to its target. [m]
  bool stops = true;  ///< It stops at the target.
  float radius = 0;   ///< [m, > 0]
  uint32_t slot = 0;
};

/// As preferred_velocity of kCurvilinear, in the air. The protection fields are spheres and bodies
/// are upright cylinders, so heights are divided by the body's height and multiplied by its width:
/// two like bodies then touch where their spheres do. [curves: kSide or kSideAndUp in `axes`]
Space curvilinear_in_air(const AirSituation& situation, const AirView& view, float dt,
                         const caacd::Model& curves);

/// As candidates_about, turned in the plane.
AirChoices candidates_in_air(Space preferred);

/// Candidates for a preferred velocity, in order: the velocity itself, turned by 30, 60 and 90
/// degrees, each to the right first, then straight on, slower.
Choices candidates_about(Plane preferred);

}  // namespace throng::steer
