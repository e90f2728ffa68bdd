// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "crowd/fly/fly_mode.h"
#include "path/ground/slice.h"

// How flyers find their paths: straight, by a search in the air's octree, or up and over what it
// does not know. Searches are done in slices (flight_slices.cpp). Time of one: kSliceBoxes boxes,
// and of the last one the pulling of its string.
namespace throng::crowd {
namespace {

constexpr double kGroundRadius = 0.5;  // [m] from feet to the ground below them

// Where a path in the air to the goal ends: there, or over the place to land on. None: a solid is
// straight above that place.
std::optional<AirPosition> end_in_air(const FlyerAir& air, const Flight& flight) {
  AirPosition to = flight.goal;
  if (flight.goal_level == Flight::kInAir) return to;
  const auto high = air.take_off(to);
  if (!high) return {};
  to.y = *high;
  return to;
}

// A waypoint in whole units, between the waypoint before it and the one after. It lies at an edge,
// around which the segments lead so closely that those to a rounded point may not be free. Then a
// point next to it is taken, if there are free segments to that.
AirPosition whole_position(const FlyerAir& air, const AirPosition& before, const Vec3d& point,
                           const AirPosition& after) {
  const AirPosition rounded = air.position(point);
  const auto is_free = [&](const AirPosition& at) {
    return air.sees(before, at) && air.sees(at, after);
  };
  if (is_free(rounded)) return rounded;
  for (const int32_t dy : {0, 1, -1}) {
    for (const int32_t dz : {0, 1, -1}) {
      for (const int32_t dx : {0, 1, -1}) {
        const AirPosition beside{rounded.x + dx, rounded.z + dz, rounded.y + dy};
        if (is_free(beside)) return beside;
      }
    }
  }
  return rounded;
}

}  // namespace

void FlyMode::begin_search(OfClass& parts, size_t lane, const AirPosition& from,
                           const AirPosition& to) {
  parts.finders[lane].begin({.from = parts.air.metres(from),
                             .to = parts.air.metres(to),
                             .vertical_tolerance = kGroundRadius,
                             .budget = shared_.search_budget(),
                             .by_turns = true,
                             .nearest = false});
}

bool FlyMode::advance_search(OfClass& parts, size_t lane, uint64_t& boxes) {
  Path& path = parts.paths[lane];
  path::Slice slice{kSliceBoxes};
  const bool is_done = parts.finders[lane].advance(slice, path);
  boxes += std::max(kSliceBoxes - slice.left, kMinBoxes);
  if (is_done) shared_.note_spent(path.spent);
  return is_done;
}

// Is a straight line clear of all active obstacles?
bool FlyMode::is_clear_of_obstacles(const Body& body, const AirPosition& from,
                                    const AirPosition& to) const {
  if (!engine_.has_obstacles()) return true;
  const double dx = static_cast<double>(to.x) - from.x, dz = static_cast<double>(to.z) - from.z;
  const double dy = static_cast<double>(to.y) - from.y;
  const double length =
      std::sqrt((dx * dx + dz * dz) * shared_.unit * shared_.unit + dy * dy * 1e-6);
  const auto steps = static_cast<int32_t>(length / (body.radius * shared_.unit)) + 1;
  for (int32_t i = 1; i <= steps; ++i) {
    const double t = static_cast<double>(i) / steps;
    const AirPosition position{from.x + static_cast<int32_t>(t * dx),
                               from.z + static_cast<int32_t>(t * dz),
                               from.y + static_cast<int32_t>(t * dy)};
    if (engine_.is_blocked(body, position)) return false;
  }
  return true;
}

// Straight up, across, and straight down: no search, but hardly ever short.
bool FlyMode::find_path_over(const Body& body, const AirPosition& from, const AirPosition& to,
                             std::vector<AirPosition>& points) const {
  constexpr int32_t kRise = 3000;  // [mm] more at each attempt
  const FlyerAir& air = air_of(body);
  const auto is_open = [&](const AirPosition& a, const AirPosition& b) {
    return air.sees(a, b) && is_clear_of_obstacles(body, a, b);
  };
  const int32_t ceiling = air.ceiling() - 1;
  for (int32_t y = std::max(from.y, to.y);; y = std::min(y + kRise, ceiling)) {
    const AirPosition up{from.x, from.z, y}, down{to.x, to.z, y};
    if (is_open(from, up) && is_open(up, down) && is_open(down, to)) {
      points.assign({up, down, to});
      return true;
    }
    if (y >= ceiling) return false;
  }
}

// The nearest position beside obstacles that the path finder takes for open, straight on from `at`;
// `at` itself if it is open.
std::optional<AirPosition> FlyMode::open_position(const Body& body, const AirPosition& at,
                                                  size_t lane) const {
  constexpr int32_t kCells = 2;  // to each side
  const OfClass& parts = *classes_[body.avatar_class];
  const FlyerAir& air = parts.air;
  const path::FlightFinder& finder = parts.finders[lane];
  if (finder.is_legal(air.metres(at))) return at;
  const int32_t high = finder.space().shape.cell;
  const auto wide = static_cast<int32_t>(high * 1e-3 / shared_.unit);
  std::optional<AirPosition> nearest;
  int32_t min_square = INT32_MAX;
  for (int32_t dy = -kCells; dy <= kCells; ++dy) {
    for (int32_t dz = -kCells; dz <= kCells; ++dz) {
      for (int32_t dx = -kCells; dx <= kCells; ++dx) {
        const int32_t square = dx * dx + dy * dy + dz * dz;
        const AirPosition there{at.x + dx * wide, at.z + dz * wide, at.y + dy * high};
        if (square >= min_square || there.x < 0 || there.z < 0) continue;
        if (!finder.is_legal(air.metres(there)) || !air.sees(at, there) ||
            !is_clear_of_obstacles(body, at, there)) {
          continue;
        }
        min_square = square;
        nearest = there;
      }
    }
  }
  return nearest;
}

FlightEnds FlyMode::ends_of(const Body& body, const Flight& flight, const AirPosition& from,
                            size_t lane) const {
  FlightEnds ends{from, from, flight.goal};
  if (!engine_.has_obstacles()) return ends;
  // Beside an obstacle the feet may be where the finder's whole cell is blocked.
  const OfClass& parts = *classes_[body.avatar_class];
  const auto is_end = [&](const AirPosition& at) {
    return parts.finders[lane].is_end(parts.air.metres(at), kGroundRadius);
  };
  if (!is_end(from)) ends.begin = open_position(body, from, lane).value_or(from);
  const bool in_air = flight.goal_level == Flight::kInAir;
  if (in_air && !is_end(flight.goal)) {
    ends.to = open_position(body, flight.goal, lane).value_or(flight.goal);
  }
  return ends;
}

// The waypoints of a path that was found, as far as it leads through the air. The path on foot
// after a landing is searched for then.
void FlyMode::add_points(const OfClass& parts, const FlightEnds& ends, size_t lane,
                         std::vector<AirPosition>& points, bool& lands) {
  const Path& path = parts.paths[lane];
  if (ends.begin != ends.from) points.push_back(ends.begin);
  AirPosition before = ends.begin;
  const size_t count = path.segments.size();
  for (size_t i = 0; i < count && path.segments[i] != SegmentKind::kLand; ++i) {
    if (path.segments[i] != SegmentKind::kFly) continue;
    const bool goes_on = i + 1 < count && path.segments[i + 1] == SegmentKind::kFly;
    const Vec3d& point = path.points[i + 1].position;
    const Vec3d& after = path.points[goes_on ? i + 2 : i + 1].position;
    before = whole_position(parts.air, before, point, parts.air.position(after));
    points.push_back(before);
  }
  lands = std::find(path.segments.begin(), path.segments.end(), SegmentKind::kLand) !=
          path.segments.end();
}

// From the path that was found to Buffers::points and Buffers::lands. False: there is none.
bool FlyMode::take_points(const Body& body, const Flight& flight, const FlightEnds& ends,
                          size_t lane) {
  OfClass& parts = *classes_[body.avatar_class];
  Buffers& buffers = parts.buffers[lane];
  std::vector<AirPosition>& points = buffers.points;
  points.clear();
  const Path& path = parts.paths[lane];
  const bool ends_on_ground = flight.goal_level != Flight::kInAir;
  buffers.lands = ends_on_ground;
  const auto to = end_in_air(parts.air, flight);
  if (path.end == PathEnd::kBudgetExhausted) {
    return to && find_path_over(body, ends.from, *to, points);
  }
  if (path.end != PathEnd::kReached) return false;
  bool lands = false;
  add_points(parts, ends, lane, points, lands);
  if (!lands && ends.to != flight.goal) points.push_back(flight.goal);
  if (points.empty()) points.push_back(ends.from);
  buffers.lands = lands || ends_on_ground;
  // The finder does not know obstacles that move. If one blocks the path, a path over it may be
  // free.
  AirPosition at = ends.from;
  const bool clear = std::all_of(points.begin(), points.end(), [&](const AirPosition& next) {
    const AirPosition begin = std::exchange(at, next);
    return is_clear_of_obstacles(body, begin, next);
  });
  if (!clear && to && find_path_over(body, ends.from, *to, buffers.over)) {
    points.assign(buffers.over.begin(), buffers.over.end());
    buffers.lands = ends_on_ground;
  }
  return true;
}

// The straight path to the goal. False: it is not free.
bool FlyMode::find_straight(const Body& body, Flight& flight) const {
  const FlyerAir& air = air_of(body);
  const auto to = end_in_air(air, flight);
  if (!to) return false;
  const AirPosition from = first_in_air(body, flight);
  if (shared_.config.routing != Routing::kStraight &&
      !(air.sees(from, *to) && is_clear_of_obstacles(body, from, *to))) {
    return false;
  }
  set_path(flight, std::span(&*to, 1), flight.goal_level != Flight::kInAir);
  return true;
}

}  // namespace throng::crowd
