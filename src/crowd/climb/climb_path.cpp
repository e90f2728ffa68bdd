// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "crowd/climb/climb_path.h"

#include <algorithm>
#include <cstddef>

// Paths over nodes in rows of fixed size: the next points, and stations of what follows. Linear in
// the points.
namespace throng::crowd {
namespace {

ClimbPoint point_of(const Path& path, size_t i, bool drops) {
  const NodePlace& place = path.node_places[i];
  const bool on_surface = i == 0 || path.segments[i - 1] == SegmentKind::kWalk;
  ClimbPoint made;
  made.node1 = place.node1;
  made.s = made.node1 != 0 ? place.s : place.feet.y;
  made.t = made.node1 != 0 ? place.t : 0;
  made.on_surface = on_surface && made.node1 != 0 ? 1 : 0;
  made.drops = drops ? 1 : 0;
  return made;
}

}  // namespace

void set_segment(Path& path, const NodePlace& from, const NodePlace& to) {
  path.points.assign(1, {from.feet});
  path.node_places.assign(1, from);
  path.segments.clear();
  if (!to) return;
  path.points.push_back({to.feet});
  path.node_places.push_back(to);
  path.segments.push_back(SegmentKind::kWalk);
}

void set_stations(Climb& climb, const Path& path) {
  climb.station = climb.station_count = 0;
  const size_t first = climb.count, all = path.points.size();
  size_t next = first;
  for (size_t k = 0; k < Climb::kStations; ++k) {
    size_t i = std::max(next, first + (all - 1 - std::min(first, all - 1)) * k / Climb::kStations);
    while (i < all && !path.node_places[i]) ++i;
    if (i + 1 >= all) return;
    climb.stations[climb.station_count++] = point_of(path, i, false);
    next = i + 1;
  }
}

void clear_path(Climb& climb) {
  const ClimbStance at = climb.at;
  climb.count = 0;
  climb.whole = 0;
  climb.to_station = 0;
  climb.at = {};
  climb.at.s = at.s;
  climb.at.t = at.t;
  climb.at.node1 = at.node1;
}

void take_path(Climb& climb, const Path& path) {
  const size_t all = path.points.size();
  size_t count = std::min(all, Climb::kPoints);
  while (count > 0 && !path.node_places[count - 1]) --count;
  for (size_t i = 0; i < count; ++i) {
    const bool falls = !path.node_places[i] || (i > 0 && !path.node_places[i - 1]);
    climb.points[i] = point_of(path, i, falls);
  }
  climb.count = static_cast<uint8_t>(count);
  climb.whole = count == all ? 1 : 0;
  climb.to_station = 0;
  climb.at.s = climb.points[0].s;
  climb.at.t = climb.points[0].t;
  climb.at.node1 = climb.points[0].node1;
  climb.at.part = 0;
  climb.at.next = 1;
  climb.at.in_air = count > 1 && climb.points[1].on_surface == 0 ? 1 : 0;
}

}  // namespace throng::crowd
