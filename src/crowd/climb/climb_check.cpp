// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <cmath>

#include "crowd/climb/climb_mode.h"

// Whether climbers are where they may be: in a saved crowd before its first step, and by a check of
// the whole crowd.
namespace throng::crowd {

bool ClimbMode::is_in_place(const Body& body) const {
  if (!body.climbs) return true;
  const auto& parts = classes_[body.avatar_class];
  if (!parts || body.slot >= climbs_.size()) return false;
  const Climb& climb = climbs_[body.slot];
  const ClimbStance& at = climb.at;
  const bool finite =
      std::isfinite(climb.rise + climb.preferred_up + climb.waited + climb.detour) &&
      std::isfinite(climb.external[0] + climb.external[1] + climb.external[2]) && climb.radius > 0;
  if (!finite || climb.count > Climb::kPoints || at.next > climb.count || at.in_air > 1)
    return false;
  if (at.in_air != 0 && (at.next == 0 || at.next == climb.count)) return false;
  if (climb.count > 0 && (climb.points[climb.count - 1u].node1 == 0 || at.next == 0)) return false;
  for (size_t i = 0; i < climb.count; ++i) {
    const ClimbPoint& p = climb.points[i];
    if (p.node1 != 0 && !parts->ground.pose(p.node1, p.s, p.t)) return false;
    if (p.node1 == 0 && !std::isfinite(p.s)) return false;
    // A segment on the surface stays within the node of the point before.
    const bool joined = i == 0 || p.on_surface == 0 ||
                        parts->ground.pose(climb.points[i - 1].node1, p.s, p.t).has_value();
    if (!joined) return false;
  }
  if (climb.station_count > Climb::kStations || climb.to_station > 1) return false;
  for (size_t i = 0; i < climb.station_count; ++i) {
    const ClimbPoint& p = climb.stations[i];
    if (!parts->ground.pose(p.node1, p.s, p.t)) return false;
  }
  const bool has_goal =
      climb.goal_node1 == 0 || parts->ground.pose(climb.goal_node1, climb.goal_s, climb.goal_t);
  if (!has_goal) return false;
  const bool surfaced =
      at.in_air != 0 || at.next >= climb.count ||
      (climb.points[at.next].on_surface != 0 &&
       parts->ground.pose(at.node1, climb.points[at.next].s, climb.points[at.next].t));
  const auto pose = parts->ground.pose_of(climb, at);
  if (!surfaced || !pose || !(pose->feet == climb.feet) || !(pose->axis == climb.axis))
    return false;
  const auto cylinder = parts->ground.cylinder_of(*pose, climb.radius);
  return cylinder && cylinder->low == AirPosition{body.x, body.z, body.y} &&
         cylinder->radius == body.radius && cylinder->height == body.height && at.node1 != 0 &&
         parts->ground.pose(at.node1, at.s, at.t).has_value();
}

void ClimbMode::check(std::span<const Body> bodies, CrowdCheck& found) const {
  if (climbs_.empty()) return;
  for (const Body& body : bodies) {
    if (!body.climbs) continue;
    const Climb& climb = climbs_[body.slot];
    const ClimbCylinder cylinder{feet_of(body), body.radius, body.height};
    const bool inside =
        engine_.is_inside(of(body).ground, cylinder, {climb.feet, climb.axis}, climb.radius);
    found.wall_entries += is_enclosed(body) ? 0 : 1;
    found.obstacle_entries += inside ? 1 : 0;
  }
}

// Does it stand where its class may, and does its cylinder enclose it?
bool ClimbMode::is_enclosed(const Body& body) const {
  constexpr double kTolerance = 1e-9;  // [m]
  const Climb& climb = climbs_[body.slot];
  const ClimberGround& ground = of(body).ground;
  const auto pose = ground.pose_of(climb, climb.at);
  bool sound =
      pose && length(pose->feet - climb.feet) < 1e-6 && length(pose->axis - climb.axis) < 1e-6;
  // All around its rims.
  const double height = shared_.body_class(body.avatar_class).height;
  const Vec3d other = std::fabs(climb.axis.y) < 0.9 ? Vec3d{0, 1, 0} : Vec3d{1, 0, 0};
  Vec3d side = cross(other, climb.axis);
  side = side * (1 / length(side));
  const Vec3d front = cross(side, climb.axis);
  const Vec3d& origin = shared_.origin();
  for (int turn = 0; turn < 16; ++turn) {
    const double angle = turn * (2 * 3.14159265358979 / 16);
    const Vec3d rim =
        side * (climb.radius * std::cos(angle)) + front * (climb.radius * std::sin(angle));
    for (const double up : {0.0, height}) {
      const Vec3d p = climb.feet + climb.axis * up + rim;
      const double dx = p.x - origin.x - (body.x + 0.5) * shared_.unit;
      const double dz = p.z - origin.z - (body.z + 0.5) * shared_.unit;
      const double range = body.radius * shared_.unit + kTolerance;
      sound = sound && dx * dx + dz * dz <= range * range && p.y >= body.y * 1e-3 - kTolerance &&
              p.y <= (body.y + body.height) * 1e-3 + kTolerance;
    }
  }
  return sound;
}

}  // namespace throng::crowd
