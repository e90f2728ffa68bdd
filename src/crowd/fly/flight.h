// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "crowd/ground/air_position.h"

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
  uint8_t reserved = 0;

  [[nodiscard]] bool is_last() const { return whole != 0 && next + 1 == count; }
};
static_assert(sizeof(Flight) == 16 + 12 * Flight::kPoints + 7 * 4 + 8 &&
              std::is_trivially_copyable_v<Flight>);

}  // namespace throng::crowd
