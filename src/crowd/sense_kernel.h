// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>

/// Who is within sight, many at a time.
namespace throng {

/// Where the others stand. [units, units, mm]
struct Places {
  const int32_t *x, *z, *y;
};

struct Eye {
  int32_t x, z, y;
  float most;    ///< Square of how far it sees. [units^2]
  int32_t tall;  ///< Whoever is as much higher or lower is on another floor. [mm]
};

/// Writes those of [first, last) that are within sight: near_square of the way there, and which.
/// Room for all and kSeenSpare more is needed. Returns how many. Whoever looks is among them if he
/// is one of the entries.
size_t find_seen(const Places& places, uint32_t first, uint32_t last, const Eye& eye,
                 float* squares, uint32_t* entries);
inline constexpr size_t kSeenSpare = 64;

}  // namespace throng
