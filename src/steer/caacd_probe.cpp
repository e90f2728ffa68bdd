// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>

#include "throng/papers.h"

// Probes: the "repulsive zones" of [CAACD], the dashed rectangles of figure 7, seen from above.
namespace throng::caacd {
namespace {

// A rectangle by its centre, the directions of its sides and half their lengths.
struct Probe {
  Vec3d middle;
  Vec3d along, aside;
  double half_length = 0, half_width = 0;
};

// Along the heading in the plan, or along X for a body that heads straight up.
Probe probe_of(const Body& body, const Model& model) {
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

// Half the length of a probe's projection on an axis.
double half_shadow(const Probe& probe, Vec3d axis) {
  return probe.half_length * std::fabs(dot(probe.along, axis)) +
         probe.half_width * std::fabs(dot(probe.aside, axis));
}

}  // namespace

double probe_length(const Body& body, const Model& model) {
  return body.fields.precaution + length(body.velocity) * model.probe_time;
}

bool probes_meet(const Body& a, const Body& b, const Model& model) {
  const Probe pa = probe_of(a, model), pb = probe_of(b, model);
  const Vec3d between = pb.middle - pa.middle;
  // Two rectangles are apart iff a side of one of them separates them.
  for (const Vec3d& axis : std::array<Vec3d, 4>{pa.along, pa.aside, pb.along, pb.aside}) {
    if (std::fabs(dot(between, axis)) > half_shadow(pa, axis) + half_shadow(pb, axis)) return false;
  }
  return true;
}

bool probe_overlaps(const Body& body, Vec3d centre, double radius, const Model& model) {
  const Probe probe = probe_of(body, model);
  const Vec3d to{centre.x - probe.middle.x, 0, centre.z - probe.middle.z};
  const double along = std::max(0.0, std::fabs(dot(to, probe.along)) - probe.half_length);
  const double aside = std::max(0.0, std::fabs(dot(to, probe.aside)) - probe.half_width);
  return along * along + aside * aside <= radius * radius;
}

}  // namespace throng::caacd
