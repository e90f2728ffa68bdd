// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "verify/segment_check.h"

#include <algorithm>
#include <array>
#include <cmath>

// Tests the exact body at equal distances along one segment of a path.
namespace throng::verify {
namespace {

// The claimed place at a point of a move, feet within `reach` of the point. Worlds round positions;
// where the line passes a corner of the legal area, a 512th of a cell to a side is close enough.
Place place_on_segment(const Claims& claims, Vec3d point, double reach) {
  const double nudge = claims.cell / 512;
  constexpr std::array<std::array<double, 2>, 5> kOffsets = {
      {{0, 0}, {1, 0}, {-1, 0}, {0, 1}, {0, -1}}};
  for (const auto& [dx, dz] : kOffsets) {
    const Place place =
        claims.find_place({point.x + dx * nudge, point.y, point.z + dz * nudge}, reach);
    if (place) return place;
  }
  return {};
}

void look(const BodyCheck& body, Vec3d feet, SegmentRecord& record) {
  ++record.bodies;
  if (!record.entered) {
    if (const auto intruder = body.intruder(feet)) {
      record.entered = true;
      record.entered_at = feet;
      record.intruder = *intruder;
    }
  }
  if (!record.unsupported && !body.is_supported(feet)) {
    record.unsupported = true;
    record.unsupported_at = feet;
  }
}

void mark_broken(Vec3d at, SegmentRecord& record) {
  if (!record.broken) record.broken_at = at;
  record.broken = true;
}

}  // namespace

void check_segment(const Claims& claims, const BodyCheck& body, const Place& from, const Place& to,
                   double spacing, SegmentRecord& record) {
  const Vec3d a = from.position;
  const Vec3d b = to.position;
  const double dx = b.x - a.x;
  const double dz = b.z - a.z;
  const double length = std::sqrt(dx * dx + dz * dz);
  const int parts = std::max(1, static_cast<int>(std::ceil(length / spacing)));
  // More than the floor may change over a quarter of a cell by a step, or on the steepest slope.
  const double reach = claims.avatar.step_height + std::max(claims.cell, 2 * spacing);
  double y = a.y;
  for (int k = 1; k < parts; ++k) {
    const double t = static_cast<double>(k) / parts;
    const Vec3d point{a.x + t * dx, y, a.z + t * dz};
    const Place place = place_on_segment(claims, point, reach);
    if (!place) {
      mark_broken(point, record);
      return;
    }
    look(body, place.position, record);
    y = place.position.y;
  }
  look(body, {b.x, claims.feet(to), b.z}, record);
  if (std::fabs(b.y - y) > reach) mark_broken(b, record);
}

}  // namespace throng::verify
