// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>

/// The slope of the ground over the length of a body, and treads distinguished from ramps.
namespace throng::crowd {

/// Where heights are read along a line: about 0.1 m apart, up to 0.5 m to each side of the body.
/// More would cost time; farther apart two risers could lie between two heights. The whole is
/// longer than two treads, also of stairs that are crossed at 45 degrees, so that a body on stairs
/// has two risers within it.
struct SlopeRange {
  static constexpr int32_t kMaxCount = 8;
  int32_t spacing = 1;   // [cells]
  int32_t count = 5;     // of heights to each side, at most kMaxCount
  int32_t max_jump = 0;  // a floor that much higher or lower is another one [mm]
  float metres = 0.1f;   // of the spacing

  static SlopeRange of_cell(double cell);
};

struct GroundSlope {
  float gradient = 0;       // rise divided by run; above 0: up
  bool has_treads = false;  // two risers, or more
};

/// The slope along heights that are `spacing` metres apart. [mm] Linear in the heights.
GroundSlope slope_of(std::span<const int32_t> heights, float spacing);

}  // namespace throng::crowd
