// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "crowd/walk/lane_offset.h"

#include <algorithm>
#include <cmath>

#include "crowd/walk/step_units.h"

// Lane offsets at corners: docs/design/008-engine.md, "Lane offset at corners". Constant time.
namespace throng::crowd {
namespace {

using steer::Plane;

constexpr float kStraightCosine = 0.9f;  // cosine of a bend too small to matter
constexpr float kAbreast = 5;            // radii that three centres in a row need
constexpr float kMaxOpening = 10;        // radii of an opening, beyond which width is not used
constexpr float kWallRange = 3;          // [m] for the walls on both sides
constexpr int32_t kMaxAttempts = 3;      // each half as far from the corner

Plane towards(world::GroundPoint from, world::GroundPoint to) {
  const Plane displacement{static_cast<float>(to.x - from.x), static_cast<float>(to.z - from.z)};
  const float size = steer::size_of(displacement);
  return size > 0 ? Plane{displacement.x / size, displacement.z / size} : Plane{};
}

// The part of `displacement` across a unit vector, as a unit vector.
Plane across(Plane displacement, Plane ahead) {
  const float along = displacement.x * ahead.x + displacement.z * ahead.z;
  const Plane rest{displacement.x - along * ahead.x, displacement.z - along * ahead.z};
  const float size = steer::size_of(rest);
  return size > 0 ? Plane{rest.x / size, rest.z / size} : Plane{};
}

// The first corner a metre or more beyond the next one, or else the last.
size_t after_bend(const Route& route, float metre) {
  const PathPoint& corner = route.corners[route.next];
  size_t i = route.next + 1u;
  while (i + 1 < route.count && near_square(route.corners[i].x - corner.x,
                                            route.corners[i].z - corner.z) < metre * metre) {
    ++i;
  }
  return i;
}

}  // namespace

PathPoint lane_offset(const Body& body, const Route& route, const StrideGround& ground,
                      Following how) {
  const PathPoint corner = route.corners[route.next];
  if (route.next + 1 >= route.count) return corner;
  const PathPoint& next = route.corners[route.next + 1u];
  const size_t last = how.queues ? after_bend(route, how.metre) : route.next + 1u;
  const world::GroundPoint at{corner.x, corner.z}, beyond{next.x, next.z};
  const Plane in = towards(body.point(), at),
              out = towards(at, {route.corners[last].x, route.corners[last].z});
  if (in.x * out.x + in.z * out.z > kStraightCosine) return corner;
  // Away from the wall that the path bends around.
  Plane away{in.x - out.x, in.z - out.z};
  const float size = steer::size_of(away);
  if (!(size > 1e-3f)) return corner;
  away = {away.x / size, away.z / size};
  const float widest = kMaxOpening * static_cast<float>(body.radius);
  float door = ground.free_distance(corner.level, at, across(away, out), widest);
  for (size_t i = route.next + 1u; i < last; ++i) {
    const PathPoint& other = route.corners[i];
    door = std::min(
        door, ground.free_distance(other.level, {other.x, other.z}, across(away, out), widest));
  }
  if (door < kAbreast * static_cast<float>(body.radius)) return corner;

  const Plane side = across(away, in);
  const float query_range = kWallRange * how.metre;
  const float outer = ground.free_distance(body.level, body.point(), side, query_range);
  const float inner =
      ground.free_distance(body.level, body.point(), {-side.x, -side.z}, query_range);
  float part = inner / std::max(inner + outer, 1.0f);
  // Others come from the opposite direction: theirs is the left half.
  if (body.on_right) part = (part + (away.z * out.x - away.x * out.z > 0 ? 1.0f : 0.0f)) / 2;
  float off = ground.free_distance(corner.level, at, away, widest) * part;
  for (int32_t i = 0; i < kMaxAttempts; ++i, off *= 0.5f) {
    const PathPoint own{corner.x + static_cast<int32_t>(std::lrint(away.x * off)),
                        corner.z + static_cast<int32_t>(std::lrint(away.z * off)), corner.level};
    const world::GroundPoint place{own.x, own.z};
    if (ground.sees(corner.level, at, place, corner.level, 2 * widest) &&
        ground.sees(body.level, body.point(), place, corner.level, query_range) &&
        ground.sees(corner.level, place, beyond, next.level, query_range)) {
      return own;
    }
  }
  return corner;
}

}  // namespace throng::crowd
