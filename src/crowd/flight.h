// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>

/// What an avatar of a class that flies has beside its Body, by slot.
namespace throng {

/// A point of the air.
struct AirSpot {
  int32_t x = 0, z = 0;  // [units]
  int32_t y = 0;         // feet [mm]
  friend bool operator==(const AirSpot&, const AirSpot&) = default;
};

struct Flight {
  static constexpr size_t kPoints = 10;
  static constexpr uint32_t kInAir = UINT32_MAX;

  AirSpot goal;
  uint32_t goal_level = kInAir;  // of the world, for who wants to land
  /// The next bends of the way; when they are used up, the rest is asked for anew.
  std::array<AirSpot, kPoints> points;
  int32_t local_target_y = 0;        // beside Body::local_target_x [mm]
  float rise = 0, preferred_up = 0;  // beside Body::velocity and Body::wish [m/s]
  /// While `in_port`: feet on the ground, and where straight above it the air begins. In between
  /// it moves up and down only (docs/design/005-air.md). [mm]
  int32_t port_low = 0, port_high = 0;
  uint32_t port_level = 0;  // of the ground
  float waited = 0;         // before its landing place, in all [s]
  uint8_t count = 0, next = 0;
  uint8_t whole = 0;  // the last point is the goal, or over the place to land on
  uint8_t lands = 0;  // at the last point
  uint8_t in_port = 0;
  uint8_t descends = 0;  // in its port
  uint8_t to_port = 0;   // on foot, to where it can take off
  uint8_t reserved = 0;

  [[nodiscard]] bool is_last() const { return whole != 0 && next + 1 == count; }
};
static_assert(sizeof(Flight) == 16 + 12 * Flight::kPoints + 7 * 4 + 8 &&
              std::is_trivially_copyable_v<Flight>);

}  // namespace throng
