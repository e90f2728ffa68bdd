// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <span>

#include "graph/flood.h"

/// Connected parts of several sets of cells of a tile at once.
namespace throng::graph {

/// What finding parts in lanes takes beside its results, kept from one time to the next.
struct LaneScratch {
  static constexpr size_t kLanes = 8;  // at most

  alignas(64) std::array<std::array<uint64_t, kLanes>, 64> open{}, filled{};  // per row and lane
  std::array<PartList, kLanes> found;                                         // per lane
};

/// Adds to a list the parts of each set, as PartFinder finds them without cuts; `first` gets where
/// those of each begin, and where the last end. [first.size() == sets.size() + 1]
void find_parts_of(std::span<const world::CellRows* const> sets, LaneScratch& scratch,
                   PartList& list, std::span<uint32_t> first);

}  // namespace throng::graph
