// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

/// Who is within sight, many at a time.
namespace throng {

/// Where the others stand. [units, units, mm]
struct Places {
  const int32_t *x, *z, *y;
};

struct Eye {
  int32_t x, z, y;
  uint32_t self;       ///< Entry that is left out.
  float max_square;    ///< Square of how far it sees. [units^2]
  int32_t tall;        ///< Whoever is as much higher or lower is on another floor. [mm]
  float touch;         ///< Square of how far it could touch somebody. [units^2]
  int32_t touch_tall;  ///< Whoever is as much higher or lower cannot be touched. [mm]
};

/// Lists with room for all who could be in them and kSeenSpare more.
struct SeenLists {
  float* squares;     ///< near_square of the ways to those who are in sight,
  uint32_t* entries;  ///< who they are,
  uint32_t* touched;  ///< and who could be touched.
  size_t seen = 0, touches = 0;
};
inline constexpr size_t kSeenSpare = 64;

/// [first, last)
struct Entries {
  uint32_t first = 0, last = 0;
};

/// Appends those of `around`.
void find_seen(const Places& places, std::span<const Entries> around, const Eye& eye,
               SeenLists& lists);

/// Keeps the nearest so many of those in sight, in order of entries, and all that are as near as
/// the farthest of them. Returns how many.
size_t keep_nearest(SeenLists& lists, size_t max_count);

}  // namespace throng
