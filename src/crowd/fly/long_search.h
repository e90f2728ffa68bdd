// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "crowd/ground/air_position.h"

/// Searches for the paths of flyers, which are done in slices.
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
  kAsked,   // by its flyer, since searches were listed
  kListed,  // in FlyMode::searches
  // Of a flyer on the ground, once its path is found:
  kWalks,     // as its route's goal says
  kTakesOff,  // where it stands
};

/// Boxes of the air, and nodes on foot, that a search expands in a slice: 0.3 to 0.5 ms.
inline constexpr uint64_t kSliceBoxes = 1 << 10;
/// The least that a slice counts, for what is done once for each search.
inline constexpr uint64_t kMinBoxes = 1 << 6;

}  // namespace throng::crowd
