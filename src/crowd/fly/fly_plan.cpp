// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <vector>

#include "core/random.h"
#include "crowd/fly/fly_mode.h"
#include "crowd/mode/leaving.h"
#include "steer/air.h"

// How flyers in the air follow their paths, and when they ask for another one. Constant time.
namespace throng::crowd {
namespace {

constexpr double kCheckRange = 3;              // [m] to a waypoint, to test whether the next one is
                                               // visible
constexpr uint64_t kSightInterval = 16;        // steps
constexpr uint64_t kBlockedSightInterval = 4;  // of one that makes little progress
constexpr float kLandingTimeout = 2;     // [s] over its landing place, before it takes another
constexpr uint64_t kRooms = 0x726f6f6d;  // random stream
constexpr int32_t kPointTolerance = 20;  // [units, mm] so near to a waypoint that the rest does not
                                         // matter

}  // namespace

// Others are where it would land: it picks another place, the farther away the longer it has
// waited.
void FlyMode::find_landing_place(Body& body, const Flight& flight) const {
  const FlyerAir& air = air_of(body);
  const AirPosition& over = flight.points[flight.next];
  const auto window = static_cast<uint64_t>(static_cast<double>(shared_.step) * shared_.config.dt /
                                            kLandingTimeout);
  const uint64_t side =
      random_below(shared_.config.seed ^ kRooms, body.slot, window, steer::kEighths.size());
  const double far = FlyerEngine::landing_radius(flight) / shared_.unit;
  const AirPosition there{over.x + static_cast<int32_t>(far * steer::kEighths[side][0]),
                          over.z + static_cast<int32_t>(far * steer::kEighths[side][1]), over.y};
  const bool sees = there.x >= 0 && there.z >= 0 && air.sees(feet_of(body), there);
  body.local_target_x = sees ? there.x : over.x;
  body.local_target_z = sees ? there.z : over.z;
}

// Heads to the next waypoint once it is visible, looks whether the path is still free, and asks for
// the rest of a path that was too long for its row.
void FlyMode::follow_flight(Body& body, Flight& flight) {
  const FlyerAir& air = air_of(body);
  const AirPosition at = feet_of(body);
  const double dx = (static_cast<double>(body.local_target_x) - body.x) * shared_.unit;
  const double dz = (static_cast<double>(body.local_target_z) - body.z) * shared_.unit;
  const double dy = (static_cast<double>(flight.local_target_y) - body.y) * 1e-3;
  const double square = dx * dx + dy * dy + dz * dz;
  const uint64_t interval = body.detour_angle != 0 ? kBlockedSightInterval : kSightInterval;
  const bool checks_path = (shared_.sub_step + body.slot) % interval == 0;
  if (square < kCheckRange * kCheckRange && !flight.is_last()) {
    const AirPosition& here = flight.points[flight.next];
    const bool there = std::abs(here.x - at.x) < kPointTolerance &&
                       std::abs(here.z - at.z) < kPointTolerance &&
                       std::abs(here.y - at.y) < kPointTolerance;
    if (flight.next + 1 == flight.count) {
      if (there || square < 1) body.flags |= Body::kNeedsPath;
    } else {
      // Very near to a waypoint the next one may be hidden that is visible from it.
      const AirPosition& next = flight.points[flight.next + 1u];
      if (at == here || (there && checks_path) ||
          (air.sees(at, next) && is_clear_of_obstacles(body, at, next))) {
        ++flight.next;
        turn_to(body, flight);
      }
    }
  }
  if (checks_path && shared_.config.routing == Routing::kPaths) {
    const AirPosition& local_target = flight.points[flight.next];
    if (!air.sees(at, local_target) || !is_clear_of_obstacles(body, at, local_target)) {
      body.flags |= Body::kNeedsPath;
      flight.search = kNoSearch;
    }
  }
  const bool has_more = flight.whole == 0 && flight.next + 1 == flight.count;
  if (has_more && !body.has(Body::kNeedsPath) && flight.search == kNoSearch) {
    shared_.note_planned();
    ask_for_search(flight);
  }
  if (flight.lands != 0 && flight.is_last() && flight.waited > kLandingTimeout)
    find_landing_place(body, flight);
}

// While the path of a flyer is searched for: straight on to its goal, in the box of the air in
// which it is. From there it sees the place from which the path leads.
void FlyMode::head_on(Body& body, Flight& flight) const {
  flight.count = flight.next = flight.whole = flight.lands = 0;
  const AirPosition at = first_in_air(body, flight);
  const AirPosition to = air_of(body).end_in_box(at, flight.goal);
  const AirPosition& target = is_clear_of_obstacles(body, at, to) ? to : at;
  body.local_target_x = target.x;
  body.local_target_z = target.z;
  flight.local_target_y = target.y;
  body.clear(Body::kLast);
}

// The nearest place of its target, in a straight line. False: it has none.
bool FlyMode::head_to_nearest_landing(const Body& body, Flight& flight) const {
  const FlyerAir& air = air_of(body);
  const AirPosition at = feet_of(body);
  const auto& places = shared_.classes[body.avatar_class]->landings[body.target - 1u];
  double min_square = HUGE_VAL;
  for (const Place& place : places) {
    const AirPosition position = air.position(place.position);
    const double dx = static_cast<double>(position.x) - at.x,
                 dz = static_cast<double>(position.z) - at.z;
    const double dy = (static_cast<double>(position.y) - at.y) * 1e-3 / shared_.unit;
    const double square = dx * dx + dy * dy + dz * dz;
    if (square >= min_square) continue;
    min_square = square;
    flight.goal = position;
    flight.goal_level = place.level1 - 1;
  }
  return !places.empty();
}

void FlyMode::plan(Body& body, Flight& flight, int32_t worker) {
  if (body.leaves && plan_exit(body, flight, worker)) return;
  if (!body.has(Body::kHasGoal)) return;
  if (!body.has(Body::kNeedsPath) && flight.in_link == 0) follow_flight(body, flight);
  if (!body.has(Body::kNeedsPath) || flight.search != kNoSearch) return;
  shared_.note_planned();
  if (body.target != 0 && !head_to_nearest_landing(body, flight)) return shared_.drop_goal(body);
  if (find_straight(body, flight)) {
    body.clear(Body::kNeedsPath);
    return turn_to(body, flight);
  }
  if (shared_.config.routing == Routing::kStraight) return shared_.drop_goal(body);
  ask_for_search(flight);
  head_on(body, flight);
}

bool FlyMode::plan_exit(Body& body, Flight& flight, int32_t worker) const {
  if (body.has(Body::kExternal)) return false;
  if (flight.in_link != 0) {
    flight.descends = 0;  // It may not stand there.
    return true;
  }
  const bool has_path = follows_path(body);
  if (has_path && std::fabs(body.detour_angle) <= kMaxDetourAngle) return false;
  if (has_path) body.flags |= Body::kNeedsPath;
  const FlyerAir& air = air_of(body);
  const AirPosition at = feet_of(body);
  body.clear(Body::kLast);
  body.local_target_x = body.x;
  body.local_target_z = body.z;
  flight.local_target_y = body.y;
  Buffers& buffers = classes_[body.avatar_class]->buffers[static_cast<size_t>(worker)];
  engine_.list_exits(body, buffers.near, buffers.exits);
  double least = HUGE_VAL;
  for (const AirPosition& exit : buffers.exits) {
    const double dx = (static_cast<double>(exit.x) - at.x) * shared_.unit;
    const double dz = (static_cast<double>(exit.z) - at.z) * shared_.unit;
    const double dy = (static_cast<double>(exit.y) - at.y) * 1e-3;
    const double square = dx * dx + dy * dy + dz * dz;
    if (square >= least || !air.is_legal(exit) || !air.sees(at, exit)) continue;
    if (engine_.is_obstructed(body, exit) || !is_clear_of_obstacles(body, at, exit)) continue;
    least = square;
    body.local_target_x = exit.x;
    body.local_target_z = exit.z;
    flight.local_target_y = exit.y;
  }
  return true;
}

}  // namespace throng::crowd
