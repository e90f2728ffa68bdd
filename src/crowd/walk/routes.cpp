// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "crowd/walk/routes.h"

#include <algorithm>
#include <cmath>

#include "crowd/walk/lane_offset.h"
#include "crowd/walk/step_units.h"
#include "world/place.h"

// Follows the corners of a path: heads to the next corner once it is visible, and requests the rest
// of the path. Constant time but for the line of sight.
namespace throng::crowd {
namespace {

constexpr uint64_t kCheckInterval = 16;  // decisions
constexpr uint64_t kBlockedCheckInterval = 4;
constexpr float kCheckRange = 3;       // [m] of a segment, to test whether it is visible
constexpr float kTurnDistance = 0.3f;  // [m] before its lane offset a body turns to the next corner

// Is it as far as its lane offset, on the segment to the next corner? One that turned at first
// sight of that corner would walk along the inner wall after all.
bool is_at_lane_offset(const Body& body, const Route& route, float metre) {
  const PathPoint& corner = route.corners[route.next];
  if (corner.x == body.local_target_x && corner.z == body.local_target_z) return true;
  const PathPoint& next = route.corners[route.next + 1u];
  const auto x = static_cast<float>(next.x - body.local_target_x);
  const auto z = static_cast<float>(next.z - body.local_target_z);
  const float along = static_cast<float>(body.x - body.local_target_x) * x +
                      static_cast<float>(body.z - body.local_target_z) * z;
  return along > -kTurnDistance * metre * std::sqrt(x * x + z * z);
}

// Is it beyond its corner, but beside the straight line to the next one? It would walk back.
bool has_passed_corner(const Body& body, const Route& route) {
  if (route.next + 1 >= route.count || leads_to_link(route)) return false;
  const PathPoint &corner = route.corners[route.next], &next = route.corners[route.next + 1u];
  return int64_t{next.x - corner.x} * (body.x - corner.x) +
             int64_t{next.z - corner.z} * (body.z - corner.z) >
         0;
}

}  // namespace

void head_to_corner(Body& body, const Route& route, const StrideGround& ground, Following how) {
  body.on_right = body.in_counterflow;
  const PathPoint place =
      leads_to_link(route) ? route.corners[route.next] : lane_offset(body, route, ground, how);
  body.local_target_x = place.x;
  body.local_target_z = place.z;
  const bool last = route.whole && route.next + 1 == route.count;
  body.flags = static_cast<uint8_t>(last ? body.flags | Body::kLast : body.flags & ~Body::kLast);
}

void follow(Body& body, Route& route, const StrideGround& ground, uint64_t nth, Following how) {
  const float metre = how.metre;
  const float range = kCheckRange * metre;
  const auto sees = [&](const PathPoint& position) {
    return ground.sees(body.level, body.point(), {position.x, position.z}, position.level, range);
  };
  const float square = near_square(body.local_target_x - body.x, body.local_target_z - body.z);
  if (!body.has(Body::kLast) && square < range * range / 4 && !leads_to_link(route)) {
    const bool at_end = route.next + 1 == route.count;
    const bool there = square < 16;  // a few units: as near as moves come
    if (!at_end && (there || (is_at_lane_offset(body, route, metre) &&
                              sees(route.corners[route.next + 1u])))) {
      ++route.next;
      if (route.via <= route.next) route.via = 0;
      head_to_corner(body, route, ground, how);
      return;
    }
    if (at_end) {  // Corners are used up: the rest is a new path.
      body.flags |= Body::kNeedsPath;
      return;
    }
  }
  if (body.in_counterflow && !body.on_right) head_to_corner(body, route, ground, how);
  if (how.queues && nth % kBlockedCheckInterval == 0 && has_passed_corner(body, route)) {
    body.flags |= Body::kNeedsPath;
    return;
  }
  // A body pushed back behind a corner no longer sees it, and is blocked until it checks.
  const bool is_blocked = body.detour_angle != 0 && body.near_wall;
  if (nth % (is_blocked ? kBlockedCheckInterval : kCheckInterval) != 0) return;
  if (!sees({body.local_target_x, body.local_target_z, route.corners[route.next].level}))
    body.flags |= Body::kNeedsPath;
}

bool leads_through(const Body& body, const Route& route, const PlanBox& box) {
  // Is a part of the segment on the inner side of all four sides? (Liang and Barsky)
  const auto crosses = [&](double ax, double az, double bx, double bz) {
    double from = 0, to = 1;
    const auto cut = [&](double at, double displacement, double low, double high) {
      if (displacement == 0) return at >= low && at <= high;
      const double t0 = (low - at) / displacement, t1 = (high - at) / displacement;
      from = std::max(from, std::min(t0, t1));
      to = std::min(to, std::max(t0, t1));
      return from <= to;
    };
    return cut(ax, bx - ax, box.x0, box.x1) && cut(az, bz - az, box.z0, box.z1);
  };
  double x = body.x, z = body.z;
  for (size_t i = route.next; i < route.count; ++i) {
    const PathPoint& corner = route.corners[i];
    if (crosses(x, z, corner.x, corner.z)) return true;
    x = corner.x;
    z = corner.z;
  }
  return false;
}

Place place_of(const world::WorldData& world, const PathPoint& position) {
  // The floor of a level is the same for all classes.
  const world::GroundLevel level = world::ground_level(world, position.level, 0);
  return world::place_at(world, level, {position.x, position.z});
}

PathPoint point_of(const world::WorldData& world, const Place& place) {
  const world::GroundPoint point = world::to_ground(world, place.position.x, place.position.z);
  return {static_cast<int32_t>(point.x), static_cast<int32_t>(point.z), place.level1 - 1};
}

bool use_path(const world::WorldData& world, const Path& path, const StrideGround& ground,
              Following how, Body& body, Route& route) {
  body.flags = static_cast<uint8_t>(body.flags & ~Body::kNeedsPath);
  route.by_link = 0;
  route.via = 0;
  if (path.end != PathEnd::kReached) return false;
  if (path.points.size() < 2) {  // It stands on its goal.
    route.corners[0] = route.goal;
    route.count = 1;
    route.next = 0;
    route.whole = true;
    head_to_corner(body, route, ground, how);
    return true;
  }
  const size_t segments = path.points.size() - 1;
  // Up to the end of the first off-mesh link: the rest is searched for from there.
  const size_t link_end = path.links.empty() ? SIZE_MAX : path.links.front().point;
  if (link_end <= Route::kCorners) {
    const size_t first = link_end == 1 ? 0 : 1;
    route.count = static_cast<uint8_t>(link_end + 1 - first);
    route.next = 0;
    route.whole = false;
    route.by_link = 1;
    for (size_t i = 0; i < route.count; ++i) {
      route.corners[i] = point_of(world, path.points[first + i]);
    }
    head_to_corner(body, route, ground, how);
    return true;
  }
  route.count = static_cast<uint8_t>(std::min(segments, Route::kCorners));
  route.next = 0;
  route.whole = segments <= Route::kCorners;
  for (size_t i = 0; i < route.count; ++i) {
    route.corners[i] = point_of(world, path.points[i + 1]);
  }
  head_to_corner(body, route, ground, how);
  return true;
}

void replace_corners(const world::WorldData& world, const Path& path, size_t end,
                     const StrideGround& ground, Following how, Body& body, Route& route) {
  const Route old = route;
  const size_t wanted = path.points.size() - 1 + (old.count - 1 - end);
  const size_t count = std::min(wanted, Route::kCorners);
  for (size_t i = 0; i < count; ++i) {
    const bool is_new = i + 1 < path.points.size();
    route.corners[i] = is_new ? point_of(world, path.points[i + 1])
                              : old.corners[end + 1 + (i - (path.points.size() - 1))];
  }
  route.count = static_cast<uint8_t>(count);
  route.next = 0;
  route.via = 0;
  if (count < wanted) {
    route.whole = false;
    route.by_link = 0;
  }
  body.clear(Body::kNeedsPath);
  head_to_corner(body, route, ground, how);
}

float length_between(const Route& route, size_t from, size_t to) {
  float length = 0;
  for (size_t i = from; i < to; ++i) {
    const PathPoint &a = route.corners[i], &b = route.corners[i + 1];
    length += std::sqrt(near_square(b.x - a.x, b.z - a.z));
  }
  return length;
}

}  // namespace throng::crowd
