// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "crowd/ground/air_position.h"

/// Searches for the paths of flyers that go on over several steps.
namespace throng::crowd {

/// Where a path for a flyer is searched.
struct FlightEnds {
  AirPosition from;       // where the flyer is then
  AirPosition begin, to;  // beside obstacles not `from` and not the goal: see open_position
};

/// A search that goes on in the next step. All that it has come to depends on its ends, on the
/// obstacles, and on how many slices were done: so this is saved, and a restored crowd repeats it.
struct LongSearch {
  FlightEnds ends;
  uint32_t slot = 0;    // of the flyer
  uint32_t slices = 0;  // that were done; 0: it has not begun
};
static_assert(sizeof(LongSearch) == 44 && std::is_trivially_copyable_v<LongSearch>);

/// Flight::search.
enum FlightSearchState : uint8_t {
  kNoSearch,
  kAsked,   // by its flyer, in the last step
  kListed,  // in FlyMode::searches
};

}  // namespace throng::crowd
