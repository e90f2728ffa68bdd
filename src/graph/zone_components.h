// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "world/region_data.h"

/// The connected components within a zone, by its links.
namespace throng::graph {

/// The parts of a zone's regions: one for each class that a region has, region by region, in order
/// of bits.
struct ZoneParts {
  std::span<const uint32_t> first;  // regions + 1: where a region's begin
  std::span<const uint32_t> cells;  // legal, of each
};

/// Fills the groups of a zone whose regions, without their groups, and links are known.
void find_components(const world::WorldData& world, size_t slot, const ZoneParts& parts,
                     world::RegionTables& tables);

}  // namespace throng::graph
