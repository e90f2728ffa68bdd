// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "crowd/body.h"
#include "crowd/stride_ground.h"
#include "throng/path.h"
#include "throng/world.h"

/// Where avatars are bound for, and the corners that lead there.
namespace throng {

/// A place of the ground.
struct PathPoint {
  int32_t x = 0, z = 0;  // [units]
  uint32_t level = 0;
};

/// The next corners of a way; when they are used up, the rest is asked for anew, from where one is
/// by then.
struct Route {
  static constexpr size_t kCorners = 12;
  PathPoint goal;
  std::array<PathPoint, kCorners> corners;
  uint8_t count = 0, next = 0;
  bool whole = false;  // the last corner is the goal
};

/// Turns to the next corner where it can be seen, and marks whoever has lost his way. `nth`: of
/// decisions, begun at different numbers, so that not everybody looks around in the same step.
/// `metre`: [units]
void follow(Body& body, Route& route, const StrideGround& ground, uint64_t nth, float metre);

/// Where a body stands, where it is bound for.
Place place_of(const WorldData& world, const Body& body, const PathPoint& position);
PathPoint point_of(const WorldData& world, const Place& place);

/// Takes the next corners of a way that was found, from where the body is. False: none was.
bool use_path(const WorldData& world, const Path& path, const StrideGround& ground, Body& body,
              Route& route);

/// A rectangle of the plane. [units]
struct PlanBox {
  double x0 = 0, z0 = 0, x1 = 0, z1 = 0;
};
/// Do the corners that a body is bound for lead through a box?
bool leads_through(const Body& body, const Route& route, const PlanBox& box);

}  // namespace throng
