// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "world/cell_blocks.h"

/// Connected parts of one level tile, whole rows of cells at a time.
namespace throng {

/// Where no step leads from a cell to the next: bit x of `across` row z between (x, z) and
/// (x + 1, z), of `along` row z between (x, z) and (x, z + 1).
struct StepCuts {
  CellRows across{}, along{};
};

/// The cells of `open` that hold together with cell (x, z), which must be open. Neighbours share a
/// side. `cuts` may be null.
CellRows flood(const CellRows& open, const StepCuts* cuts, int32_t x, int32_t z);

/// All connected parts of `open`, in the order of their first cells, row by row.
std::vector<CellRows> connected_parts(const CellRows& open, const StepCuts* cuts);

}  // namespace throng
