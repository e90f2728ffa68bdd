// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>

#include "crowd/fly/fly_mode.h"

// What flyers on the ground do: take off, or walk to where they can, or to their goal. A search for
// their path is done as those of flyers in the air are (flight_slices.cpp); all else is constant
// time.
namespace throng::crowd {
namespace {

constexpr double kTakeOffRadius = 0.3;  // [m] from the place of its take-off
constexpr float kTakeOffTimeout = 10;   // [s] there, after which its goal is dropped
constexpr double kLinkRadius = 0.5;     // [m] from a link to the ground below

}  // namespace

bool FlyMode::take_off(Body& body) {
  Flight& flight = flights_[body.slot];
  const auto high = air_of(body).take_off(feet_of(body));
  if (!high) return false;
  flight.in_link = 1;
  flight.descends = 0;
  flight.link_low = body.y;
  flight.link_high = *high;
  flight.link_level = body.level;
  flight.rise = 0;
  flight.to_link = 0;
  flight.lands = 0;
  flight.search = kNoSearch;
  flight.count = flight.next = 0;
  body.detour_angle = 0;
  const bool has_goal = body.has(Body::kHasGoal);
  body.flags &= Body::kExternal | Body::kHasGoal;
  body.flags |= Body::kMovedElsewhere;
  if (has_goal) body.flags |= Body::kNeedsPath;
  return true;
}

// Takes off where this leads into the air of a point. Beside an obstacle, where the finder's cell
// is blocked, any air will do.
bool FlyMode::take_off_into(Body& body, const AirPosition& there) {
  const OfClass& parts = *classes_[body.avatar_class];
  const auto high = parts.air.take_off(feet_of(body));
  if (!high) return false;
  const Vec3d above = parts.air.metres({body.x, body.z, *high});
  return !parts.finders[0].is_cut_off(above, parts.air.metres(there)) && take_off(body);
}

bool FlyMode::plan_on_foot(Body& body) {
  Flight& flight = flights_[body.slot];
  if (body.has(Body::kExternal)) {
    if (flight.preferred_up > 0) take_off(body);
    return true;
  }
  // Where it takes off is not its goal: it does not rest a step before.
  if (flight.to_link != 0 && body.at_rest) walk_.engine().wake(body);
  if (flight.to_link != 0 && body.has(Body::kLast)) {
    const double dx = static_cast<double>(body.local_target_x) - body.x;
    const double dz = static_cast<double>(body.local_target_z) - body.z;
    const double near = kTakeOffRadius / shared_.unit;
    if (dx * dx + dz * dz < near * near) {
      if (take_off_into(body, flight.points[0])) return true;
      flight.waited += shared_.sub_dt();
      if (flight.waited > kTakeOffTimeout) {
        shared_.drop_goal(body);
        return true;
      }
    }
  }
  if (!body.has(Body::kNeedsPath) || body.target != 0) return false;
  const bool lands = flight.goal_level != Flight::kInAir;
  if (shared_.config.routing == Routing::kStraight) {
    if (lands) return false;
    if (!take_off(body)) shared_.drop_goal(body);
    return true;
  }
  if (flight.search == kWalks || flight.search == kTakesOff) {
    if (flight.search == kTakesOff && take_off(body)) {
      shared_.note_planned();
      return true;
    }
    flight.search = kNoSearch;
    return false;
  }
  if (flight.search == kNoSearch) {
    // Into the air from where it stands, unless that air does not lead to the goal; to the ground
    // it may be shorter on foot.
    if (!lands && take_off_into(body, flight.goal)) return true;
    ask_for_search(flight);
  }
  // Until its path is found it walks to its next corner, if it has one.
  if (flight.to_link == 0 && !(lands && walk_.route(body.slot).count > 0)) {
    body.local_target_x = body.x;
    body.local_target_z = body.z;
    body.clear(Body::kLast);
  }
  return true;
}

// What it does by a path that was found, which plan_on_foot then lets it do.
void FlyMode::use_path_on_foot(Body& body, Flight& flight, size_t lane) {
  const OfClass& parts = *classes_[body.avatar_class];
  const Path& path = parts.paths[lane];
  const bool lands = flight.goal_level != Flight::kInAir;
  PathPoint& goal = walk_.route(body.slot).goal;
  flight.to_link = 0;
  flight.search = kWalks;
  if (lands) goal = {flight.goal.x, flight.goal.z, flight.goal_level};
  size_t walked = 0;
  while (walked < path.segments.size() && path.segments[walked] == SegmentKind::kWalk) ++walked;
  const bool takes_off = path.end == PathEnd::kReached && walked < path.segments.size();
  const Place ground_air_link =
      takes_off
          ? shared_.world.find_place(body.avatar_class, path.points[walked].position, kLinkRadius)
          : Place{};
  if (!ground_air_link) {
    if (lands) return;  // as a walker
    flight.search = kNoSearch;
    return shared_.drop_goal(body);
  }
  goal = point_of(*data_of(shared_.world), ground_air_link);
  flight.to_link = 1;
  flight.points[0] = parts.air.position(path.points[walked + 1].position);
  // It may have been pushed to where it cannot: then it walks back.
  if (walked == 0) flight.search = kTakesOff;
}

}  // namespace throng::crowd
