// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "crowd/ground/body.h"
#include "crowd/ground/stride_ground.h"
#include "throng/path.h"
#include "throng/world.h"

/// Where avatars head to, and the corners of their paths.
namespace throng::crowd {

/// A point of the ground.
struct PathPoint {
  int32_t x = 0, z = 0;  // [units]
  uint32_t level = 0;
};

/// The next corners of a path. When they are used up, the rest is searched for from the place
/// reached by then.
struct Route {
  static constexpr size_t kCorners = 12;
  PathPoint goal;
  std::array<PathPoint, kCorners> corners;
  uint8_t count = 0, next = 0;
  bool whole = false;       // the last corner is the goal
  uint8_t by_link : 1 = 0;  // An off-mesh link leads to the last corner, from the one before.
  // Number plus one of a corner on a detour around a jam, from which the shortest path leads on as
  // the corners do; 0: none. It is never the last corner.
  uint8_t via : 7 = 0;
};

/// Is the corner that a body heads to the start of an off-mesh link?
inline bool leads_to_link(const Route& route) {
  return route.by_link != 0 && route.next + 2 == route.count;
}

/// How bodies follow their routes.
struct Following {
  float metre = 1;      ///< [units]
  bool queues = false;  ///< They queue: openings count at their narrowest, corners are left behind.
};

/// Heads to the next corner once it is visible, unless an off-mesh link leads there, and marks a
/// body that has lost its path. `nth`: counts decisions, from a different number for each body, so
/// that not all check in the same step.
void follow(Body& body, Route& route, const StrideGround& ground, uint64_t nth, Following how);

/// Heads to the next corner of its route.
void head_to_corner(Body& body, const Route& route, const StrideGround& ground, Following how);

/// The place of a body that heads to `position`.
Place place_of(const world::WorldData& world, const PathPoint& position);
PathPoint point_of(const world::WorldData& world, const Place& place);

/// Takes the next corners of a path that was found, from where the body is. False: none was found.
bool use_path(const world::WorldData& world, const Path& path, const StrideGround& ground,
              Following how, Body& body, Route& route);

/// Replaces the corners up to number `end` by those of a path from the body to that corner. Corners
/// behind it stay as far as there is room. No link leads to `end`.
void replace_corners(const world::WorldData& world, const Path& path, size_t end,
                     const StrideGround& ground, Following how, Body& body, Route& route);
/// Length from one corner to a later one. [units]
float length_between(const Route& route, size_t from, size_t to);

/// A rectangle of the plane. [units]
struct PlanBox {
  double x0 = 0, z0 = 0, x1 = 0, z1 = 0;
};
/// Do the corners that a body heads to lead through a box?
bool leads_through(const Body& body, const Route& route, const PlanBox& box);

}  // namespace throng::crowd
