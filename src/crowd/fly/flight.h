// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>
#include <vector>

#include "crowd/ground/air_position.h"
#include "crowd/ground/body.h"

/// What a flyer has beside its Body, by slot.
namespace throng::crowd {

struct Flight {
  static constexpr size_t kPoints = 10;
  static constexpr uint32_t kInAir = UINT32_MAX;

  AirPosition goal;
  uint32_t goal_level = kInAir;  // of the world, if the goal is on the ground
  /// The next waypoints of the path; when they are used up, the rest is searched for.
  std::array<AirPosition, kPoints> points;
  int32_t local_target_y = 0;        // beside Body::local_target_x [mm, or CarriedMove::rest]
  float rise = 0, preferred_up = 0;  // beside Body::velocity and Body::preferred [m/s]
  /// While `in_link`: feet on the ground, and where the air begins straight above. Between the two
  /// the body moves up and down only (docs/design/005-air.md). [mm]
  int32_t link_low = 0, link_high = 0;
  uint32_t link_level = 0;  // of the ground
  float waited = 0;         // for its landing place, in all [s]
  uint8_t count = 0, next = 0;
  uint8_t whole = 0;  // the last point is the goal, or above the place to land on
  uint8_t lands = 0;  // at the last point
  uint8_t in_link = 0;
  uint8_t descends = 0;  // in its ground-air link
  uint8_t to_link = 0;   // it walks to where it can take off
  uint8_t search = 0;    // FlightSearchState: of a search that did not end in its first step

  [[nodiscard]] bool is_last() const { return whole != 0 && next + 1 == count; }
};
static_assert(sizeof(Flight) == 16 + 12 * Flight::kPoints + 7 * 4 + 8 &&
              std::is_trivially_copyable_v<Flight>);

/// The first waypoints of a path. If it `lands`, it does at the path's end.
inline void set_path(Flight& flight, std::span<const AirPosition> points, bool lands) {
  flight.count = static_cast<uint8_t>(std::min(points.size(), Flight::kPoints));
  flight.next = 0;
  flight.whole = points.size() <= Flight::kPoints ? 1 : 0;
  flight.lands = lands ? 1 : 0;
  std::copy_n(points.begin(), flight.count, flight.points.begin());
}

/// Puts the waypoints that are left before the rest of the path.
inline void put_before(const Flight& flight, std::vector<AirPosition>& rest) {
  rest.insert(rest.begin(), flight.points.begin() + flight.next,
              flight.points.begin() + flight.count);
}

/// Heads to the next waypoint.
inline void turn_to(Body& body, Flight& flight) {
  const AirPosition& point = flight.points[flight.next];
  body.local_target_x = point.x;
  body.local_target_z = point.z;
  flight.local_target_y = point.y;
  body.flags =
      static_cast<uint8_t>(flight.is_last() ? body.flags | Body::kLast : body.flags & ~Body::kLast);
}

/// Where a flyer is, or where it comes into the air.
inline AirPosition first_in_air(const Body& body, const Flight& flight) {
  return {body.x, body.z, flight.in_link != 0 ? std::max(body.y, flight.link_high) : body.y};
}

}  // namespace throng::crowd
