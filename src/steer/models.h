// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>

#include "steer/sampled.h"
#include "throng/steering_model.h"

/// The other models that a crowd can be steered by, for comparison: from what an avatar sees to the
/// velocity that it would walk at. No memory: all that they keep is the present velocity.
namespace throng::steer {

/// Somebody whom an avatar sees.
struct Other {
  Plane at, velocity;  ///< `at` from the avatar's own middle.
  float radius = 0;    ///< [m]
  uint32_t slot = 0;
};

/// What an avatar sees.
struct View {
  Plane velocity;
  Plane preferred;    ///< The velocity if nobody were there.
  Plane way;          ///< To where it is bound in a straight line. [m]
  bool stops = true;  ///< There it is to stand.
  float fastest = 1;  ///< [m/s, > 0]
  float radius = 0;   ///< [m]
  uint32_t slot = 0;
  std::span<const Other> others;  ///< At most kMaxNear, the nearest first.
  bool has_wall = false;
  Plane wall = {};  ///< From the middle to the nearest point of a wall.
};

/// The velocity after a step of `dt` in which all others walk on as they do; at most `fastest`.
/// Others are looked at again every 28 ms or so. [model: not kSampled]
Plane preferred_velocity(SteeringModel model, const View& view, float dt);

/// What is tried, in order, by who prefers a velocity: that, then slanted by 30 and 60 degrees,
/// then sideways, each to the right first, then straight on, slower.
Choices ways_about(Plane preferred);

}  // namespace throng::steer
