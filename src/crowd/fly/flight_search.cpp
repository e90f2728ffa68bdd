// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "crowd/fly/fly_mode.h"

// How flyers find their paths: straight, by a search in the air's octree, or up and over what it
// does not know. Time: mostly of the search, kMaxBoxes boxes at most.
namespace throng::crowd {
namespace {

constexpr double kGroundRadius = 0.5;    // [m] from feet to the ground below them
constexpr uint64_t kMaxBoxes = 1 << 16;  // that a search may expand; then it passes over all
                                         // obstacles

void set_path(Flight& flight, std::span<const AirPosition> points, bool lands) {
  flight.count = static_cast<uint8_t>(std::min(points.size(), Flight::kPoints));
  flight.next = 0;
  flight.whole = points.size() <= Flight::kPoints ? 1 : 0;
  flight.lands = lands ? 1 : 0;
  std::copy_n(points.begin(), flight.count, flight.points.begin());
}

}  // namespace

// Into the worker's path.
void FlyMode::search(OfClass& parts, size_t worker, const AirPosition& from,
                     const AirPosition& to) {
  Path& path = parts.paths[worker];
  parts.finders[worker].find({.from = parts.air.metres(from),
                              .to = parts.air.metres(to),
                              .vertical_tolerance = kGroundRadius,
                              .budget = shared_.search_budget(kMaxBoxes),
                              .by_turns = false,
                              .nearest = false},
                             path);
  shared_.note_spent(path.spent);
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
                                                  int32_t worker) const {
  constexpr int32_t kCells = 2;  // to each side
  const OfClass& parts = *classes_[body.avatar_class];
  const FlyerAir& air = parts.air;
  const path::FlightFinder& finder = parts.finders[static_cast<size_t>(worker)];
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

// A path from where a flyer is to its goal. False: there is none.
bool FlyMode::find_flight(const Body& body, Flight& flight, int32_t worker) {
  OfClass& parts = *classes_[body.avatar_class];
  const FlyerAir& air = parts.air;
  AirPosition from = feet_of(body), to = flight.goal;
  if (flight.in_link != 0) from.y = std::max(from.y, flight.link_high);
  const bool lands = flight.goal_level != Flight::kInAir;
  const auto high = lands ? air.take_off(to) : std::nullopt;
  if (high) to.y = *high;
  const bool ends_in_air = !lands || high;
  const bool is_straight = shared_.config.routing == Routing::kStraight;
  if (ends_in_air &&
      (is_straight || (air.sees(from, to) && is_clear_of_obstacles(body, from, to)))) {
    set_path(flight, std::span(&to, 1), lands);
    return true;
  }
  if (shared_.config.routing == Routing::kStraight) return false;
  const auto w = static_cast<size_t>(worker);
  const Path& path = parts.paths[w];
  search(parts, w, from, flight.goal);
  std::vector<AirPosition>& points = parts.buffers[w].points;
  std::vector<AirPosition>& over = parts.buffers[w].over;
  points.clear();
  std::optional<AirPosition> end;
  if (path.end == PathEnd::kNoPlace && engine_.has_obstacles()) {
    // Beside an obstacle the feet may be where the finder's whole cell is blocked.
    const auto out = open_position(body, from, worker);
    end = lands ? flight.goal : open_position(body, to, worker);
    if (out && end) search(parts, w, *out, *end);
    if (out) points.push_back(*out);
  }
  if (path.end == PathEnd::kReached) {
    // The path on foot after the landing is searched for then.
    bool walks_then = false;
    for (size_t i = 0; i < path.segments.size() && !walks_then; ++i) {
      if (path.segments[i] == SegmentKind::kFly)
        points.push_back(air.position(path.points[i + 1].position));
      walks_then = path.segments[i] == SegmentKind::kLand;
    }
    if (end && !lands) points.push_back(to);
    if (points.empty()) points.push_back(from);
    // The finder does not know obstacles that move. If one blocks the path, a path over it may be
    // free.
    AirPosition at = from;
    const bool clear = std::all_of(points.begin(), points.end(), [&](const AirPosition& next) {
      const AirPosition begin = std::exchange(at, next);
      return is_clear_of_obstacles(body, begin, next);
    });
    const bool goes_over = !clear && ends_in_air && find_path_over(body, from, to, over);
    set_path(flight, goes_over ? over : points, lands);
    return true;
  }
  points.clear();
  if (path.end != PathEnd::kBudgetExhausted || !ends_in_air ||
      !find_path_over(body, from, to, points)) {
    return false;
  }
  set_path(flight, points, lands);
  return true;
}

}  // namespace throng::crowd
