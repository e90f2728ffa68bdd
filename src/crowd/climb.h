// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "throng/math.h"

/// What an avatar that goes over nodes has beside its Body, by slot. docs/design/013-climbers.md.
namespace throng {

/// A point of a way over nodes.
struct ClimbPoint {
  double s = 0, t = 0;  ///< Of its node's patch. In the air above the next one: `s` is the height.
  uint32_t node1 = 0;   ///< That holds it and, if that is reached on the surface, the next one.
  uint8_t on_surface = 0;  ///< How it is reached: else straight through the air, turning evenly.
  uint8_t drops = 0;       ///< On the way to it one is let down: nobody goes back.
  uint16_t reserved = 0;
};
static_assert(sizeof(ClimbPoint) == 24 && std::is_trivially_copyable_v<ClimbPoint>);

/// Where a body is on its way.
struct ClimbStance {
  double s = 0, t = 0;  ///< On the ground: of the patch of `node1`.
  double part = 0;      ///< In the air: of the leg to the next point.
  uint32_t node1 = 0;
  uint8_t next = 0;  ///< The point that it is bound for; the number of points: it has been there.
  uint8_t in_air = 0;
  uint16_t reserved = 0;
};
static_assert(sizeof(ClimbStance) == 32 && std::is_trivially_copyable_v<ClimbStance>);

struct Climb {
  static constexpr size_t kPoints = 16, kStations = 8;

  ClimbStance at;
  Vec3d feet, axis;  ///< As `at` says. [m]
  double goal_s = 0, goal_t = 0;
  double radius = 0;  ///< The body's own; Body::radius holds it however it leans. [m]
  /// The next points of the way, from where it began; if they are not all, the rest is asked for
  /// when they are used up.
  std::array<ClimbPoint, kPoints> points{};
  /// Of a way that is longer: where it leads through later, so that the rest is never asked for as
  /// a whole again.
  std::array<ClimbPoint, kStations> stations{};
  uint32_t goal_node1 = 0;
  float rise = 0, preferred_up = 0;  ///< Beside Body::velocity and Body::wish. [m/s]
  std::array<float, 3> external{};   ///< What a caller wishes. [m/s]
  float waited = 0;                  ///< Without getting on. [s]
  float detour = 0;                  ///< Left of a way that is not to the goal. [s]
  uint8_t count = 0;
  uint8_t whole = 0;                       ///< The last point is the goal.
  uint8_t turns_off = 0;                   ///< It has waited long enough.
  uint8_t station = 0, station_count = 0;  ///< The next one.
  uint8_t to_station = 0;                  ///< The last point is that.
  uint8_t reserved[2] = {};

  /// Could it ask for another way from where it is?
  [[nodiscard]] bool is_on_ground() const {
    return at.in_air == 0 || (at.part == 0 && points[at.next - 1u].node1 != 0);
  }
  [[nodiscard]] bool is_last_segment() const { return whole != 0 && at.next + 1 >= count; }
};
static_assert(sizeof(Climb) ==
                  32 + 48 + 24 + 24 * (Climb::kPoints + Climb::kStations) + 4 + 8 + 12 + 8 + 8 &&
              std::is_trivially_copyable_v<Climb>);

}  // namespace throng
