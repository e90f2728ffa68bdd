// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

/// A point in space, in the units that a step calculates in.
namespace throng::crowd {

/// A point of the air.
struct AirPosition {
  int32_t x = 0, z = 0;  // [units]
  int32_t y = 0;         // feet [mm]
  friend bool operator==(const AirPosition&, const AirPosition&) = default;
};

}  // namespace throng::crowd
