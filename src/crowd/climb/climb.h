// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "throng/base.h"

/// What a climber has beside its Body, by slot. docs/design/013-climbers.md.
namespace throng::crowd {

/// A point of a path over nodes.
struct ClimbPoint {
  double s = 0, t = 0;  ///< Of its node's patch. In the air above the next one: `s` is the height.
  uint32_t node1 = 0;   ///< The node that holds it and, if it is reached on the surface, the next
                        ///< one.
  uint8_t on_surface = 0;  ///< How it is reached: if 0, straight through the air, while it turns
                           ///< evenly.
  uint8_t drops = 0;       ///< The segment to it is a drop: it cannot be walked back.
  uint16_t reserved = 0;
};
static_assert(sizeof(ClimbPoint) == 24 && std::is_trivially_copyable_v<ClimbPoint>);

/// Where a body is on its path.
struct ClimbStance {
  double s = 0, t = 0;  ///< On the ground: of the patch of `node1`.
  double part = 0;      ///< In the air: the fraction of the segment to the next point.
  uint32_t node1 = 0;
  uint8_t next = 0;  ///< The point that it heads to; the number of points: it has reached the last.
  uint8_t in_air = 0;
  uint16_t reserved = 0;
};
static_assert(sizeof(ClimbStance) == 32 && std::is_trivially_copyable_v<ClimbStance>);

struct Climb {
  static constexpr size_t kPoints = 16, kStations = 8;

  ClimbStance at;
  Vec3d feet, axis;  ///< As `at` states. [m]
  double goal_s = 0, goal_t = 0;
  double radius = 0;  ///< The body's own; Body::radius encloses it however it leans. [m]
  /// The next points of the path, from its start. If these are not all, the rest is searched for
  /// when they are used up.
  std::array<ClimbPoint, kPoints> points{};
  /// Of a longer path: nodes that it crosses later, so that the rest is never searched for as a
  /// whole again.
  std::array<ClimbPoint, kStations> stations{};
  uint32_t goal_node1 = 0;
  float rise = 0, preferred_up = 0;  ///< Beside Body::velocity and Body::preferred. [m/s]
  std::array<float, 3> external{};   ///< The velocity that the caller set. [m/s]
  float waited = 0;                  ///< Without progress. [s]
  float detour = 0;                  ///< Left of a path that does not lead to the goal. [s]
  uint8_t count = 0;
  uint8_t whole = 0;                       ///< The last point is the goal.
  uint8_t turns_aside = 0;                 ///< It has waited long enough, and turns aside.
  uint8_t station = 0, station_count = 0;  ///< The next one.
  uint8_t to_station = 0;                  ///< The last point is the next station.
  uint8_t reserved[2] = {};

  /// Can a path start where it is?
  [[nodiscard]] bool is_on_ground() const {
    return at.in_air == 0 || (at.part == 0 && points[at.next - 1u].node1 != 0);
  }
  [[nodiscard]] bool is_last_segment() const { return whole != 0 && at.next + 1 >= count; }
};
static_assert(sizeof(Climb) ==
                  32 + 48 + 24 + 24 * (Climb::kPoints + Climb::kStations) + 4 + 8 + 12 + 8 + 8 &&
              std::is_trivially_copyable_v<Climb>);

}  // namespace throng::crowd
