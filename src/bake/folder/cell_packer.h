// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "bake/layers/layers.h"
#include "world/cell_blocks.h"

/// Packs the cells of a level tile into the blocks of a zone file (world/cell_blocks.h).
namespace throng::bake {

/// Appends a set of cells. Linear in the rows and the mixed blocks.
void pack_bits(const world::CellRows& rows, std::vector<uint64_t>& words);

/// Appends `values` less `low`, of the cells that have `feet`; a value of kNone16 becomes kNoValue,
/// and cells without feet become anything. `has` are the rows of those with feet, or null for all.
/// Both arrays may be read up to 32 entries past their end. Linear in the cells.
void pack_values(const uint16_t* values, const uint16_t* feet, const world::CellRows* has,
                 uint16_t low, std::vector<uint64_t>& words);

}  // namespace throng::bake
