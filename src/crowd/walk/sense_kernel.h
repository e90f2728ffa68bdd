// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

/// Which bodies are within sight, many at a time.
namespace throng::crowd {

/// Where the other bodies are. [units, units, mm]
struct Places {
  const int32_t *x, *z, *y;
};

struct Eye {
  int32_t x, z, y;
  uint32_t self;       ///< Entry that is left out.
  float max_square;    ///< Square of its sight. [units^2]
  int32_t tall;        ///< Bodies that much higher or lower are on another floor. [mm]
  float touch;         ///< Square of the distance at which it could touch another. [units^2]
  int32_t touch_tall;  ///< Bodies that much higher or lower cannot be touched. [mm]
};

/// Lists with capacity for all that could be in them and kSeenSpare more.
struct SeenLists {
  float* squares;     ///< near_square of those within sight,
  uint32_t* entries;  ///< their entries,
  uint32_t* touched;  ///< and the entries that could be touched.
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

/// Keeps the nearest `max_count` of those in sight, in order of entries, and all that are as near
/// as the farthest of these. Returns how many.
size_t keep_nearest(SeenLists& lists, size_t max_count);

}  // namespace throng::crowd
