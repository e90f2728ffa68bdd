// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>

#include "throng/steering.h"

// Probes: the "repulsive zones" of [CAACD], the dashed rectangles of figure 7, seen from above.
namespace throng::caacd {
namespace {

// A rectangle by its centre, the directions of its sides and half their lengths.
struct Zone {
  Vec3d middle;
  Vec3d along, aside;
  double half_length = 0, half_width = 0;
};

// Along the heading in the plan, or along X for a body that heads straight up.
Zone zone_of(const Body& body, const Model& model) {
  const Vec3d aside = right_of(body.forward);
  const Vec3d along{aside.z, 0, -aside.x};
  const double half = probe_length(body, model) / 2;
  const Vec3d ground{body.position.x, 0, body.position.z};
  return {.middle = ground + along * half,
          .along = along,
          .aside = aside,
          .half_length = half,
          .half_width = body.fields.repulsive};
}

// Half the length of a zone's projection on an axis.
double half_shadow(const Zone& zone, Vec3d axis) {
  return zone.half_length * std::fabs(dot(zone.along, axis)) +
         zone.half_width * std::fabs(dot(zone.aside, axis));
}

}  // namespace

double probe_length(const Body& body, const Model& model) {
  return body.fields.precaution + length(body.velocity) * model.probe_time;
}

bool probes_meet(const Body& a, const Body& b, const Model& model) {
  const Zone za = zone_of(a, model), zb = zone_of(b, model);
  const Vec3d between = zb.middle - za.middle;
  // Two rectangles are apart iff a side of one of them separates them.
  for (const Vec3d& axis : std::array<Vec3d, 4>{za.along, za.aside, zb.along, zb.aside}) {
    if (std::fabs(dot(between, axis)) > half_shadow(za, axis) + half_shadow(zb, axis)) return false;
  }
  return true;
}

bool probe_overlaps(const Body& body, Vec3d centre, double radius, const Model& model) {
  const Zone zone = zone_of(body, model);
  const Vec3d to{centre.x - zone.middle.x, 0, centre.z - zone.middle.z};
  const double along = std::max(0.0, std::fabs(dot(to, zone.along)) - zone.half_length);
  const double aside = std::max(0.0, std::fabs(dot(to, zone.aside)) - zone.half_width);
  return along * along + aside * aside <= radius * radius;
}

}  // namespace throng::caacd
