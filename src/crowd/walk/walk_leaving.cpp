// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "crowd/ground/leaving_ground.h"
#include "crowd/mode/leaving.h"
#include "crowd/walk/walk_mode.h"
#include "world/place.h"
#include "world/tile_grid.h"

// Walkers that are in an obstacle when it closes leave it: along their paths if these lead out
// soon, else by the shortest exit. Which moves are allowed, StrideGround::move decides.
// docs/design/008-engine.md, "Obstacles".
namespace throng::crowd {

bool WalkMode::leads_out(const Body& body, std::span<const uint32_t> slots) const {
  std::vector<std::array<int32_t, 2>> points;
  if (shared_.config.routing == Routing::kStraight) {
    points.push_back({body.local_target_x, body.local_target_z});
  } else {
    const Route& route = routes_[body.slot];
    // Not over an off-mesh link: one that leaves takes none.
    const size_t count = route.count - (route.by_link != 0 ? 1u : 0u);
    for (size_t i = route.next; i < count; ++i) {
      points.push_back({route.corners[i].x, route.corners[i].z});
    }
  }
  const uint16_t steps = shared_.ground_of(body).left().steps_out(
      {body.level, world::in_tile(body.point().cell_x()), world::in_tile(body.point().cell_z())});
  const double least =
      steps == LeftCells::kNone ? HUGE_VAL : steps * data_of(shared_.world)->summary.cell;
  return leads_out_along(shared_, body, slots, points, least);
}

void WalkMode::end_leaving(Body& body) {
  if (body.has(Body::kExternal) || !body.has(Body::kHasGoal)) return;
  if (body.has(Body::kArrived)) return stay_arrived(body);
  // Else it searches for another path, if it needs one.
  const bool walks_straight = shared_.config.routing == Routing::kStraight;
  if (!walks_straight || !body.has(Body::kNeedsPath)) return;
  head_straight(body, routes_[body.slot].goal.x, routes_[body.slot].goal.z);
}

// Does it take its path again, since it makes no progress towards the nearest exit either?
bool WalkMode::tries_path_again(Body& body) {
  constexpr uint8_t kAll = Body::kHasGoal | Body::kArrived | Body::kNeedsPath;
  if ((body.flags & kAll) != (Body::kHasGoal | Body::kNeedsPath)) return false;
  const Route& route = routes_[body.slot];
  if (std::fabs(body.detour_angle) <= kMaxDetourAngle || route.next >= route.count) return false;
  body.detour_angle = 0;
  std::vector<uint32_t> slots;
  const world::GroundPoint at = body.point();
  shared_.ground_of(body).left().list_obstacles(
      {body.level, world::in_tile(at.cell_x()), world::in_tile(at.cell_z())}, slots);
  const bool is_on_zero =
      std::find(slots.begin(), slots.end(), LeftCells::kZeroWeight) != slots.end();
  if (slots.empty() || is_on_zero || !leads_out(body, slots)) return false;
  const PathPoint& corner = route.corners[route.next];
  body.local_target_x = corner.x;
  body.local_target_z = corner.z;
  body.clear(Body::kNeedsPath);
  if (route.whole && route.next + 1 == route.count) body.flags |= Body::kLast;
  return true;
}

void WalkMode::plan_exit(Body& body) {
  if (body.has(Body::kExternal)) return;
  const CrowdGround& cells = shared_.ground_of(body);
  const int32_t step_height = world::step_mm(shared_.body_class(body.avatar_class));
  const StrideGround ground(cells, step_height);
  if (follows_path(body)) {
    if (shared_.config.routing == Routing::kPaths && !body.has(Body::kContinues)) {
      const uint64_t nth =
          (shared_.sub_step - 1 + shared_.name_of(body)) / engine_.steps_of_reaction(body);
      follow(body, routes_[body.slot], ground, nth, following());
    }
    if (std::fabs(body.detour_angle) > kMaxDetourAngle) {
      body.flags |= Body::kNeedsPath;
      body.detour_angle = 0;
    }
    if (!body.has(Body::kNeedsPath)) return;
  } else if (tries_path_again(body)) {
    return;
  }
  body.clear(Body::kLast);
  body.clear(Body::kContinues);
  const world::GroundPoint from = body.point();
  if (!is_leaving(cells, body.level, from.cell_x(), from.cell_z())) return;  // It is out.
  body.local_target_x = body.x;
  body.local_target_z = body.z;
  constexpr int32_t kHalf = world::kUnitsPerCell / 2;
  for (uint32_t max_steps = cells.left().steps_out(
           {body.level, world::in_tile(from.cell_x()), world::in_tile(from.cell_z())});
       max_steps > 0 && max_steps != LeftCells::kNone; max_steps /= 2) {
    uint32_t level = body.level;
    int32_t x = from.cell_x(), z = from.cell_z();
    if (!find_exit(cells, step_height, max_steps, level, x, z)) return;
    const world::GroundPoint to{(int64_t{x} << world::kUnitBits) + kHalf,
                                (int64_t{z} << world::kUnitBits) + kHalf};
    if (max_steps > 1 && !ground.sees(body.level, from, to, level, HUGE_VALF)) continue;
    body.local_target_x = static_cast<int32_t>(to.x);
    body.local_target_z = static_cast<int32_t>(to.z);
    return;
  }
}

}  // namespace throng::crowd
