// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "bake/sheets.h"

/// The vector loops of sheets. Rows of 64 cells are words of bits: bit x is cell x.
namespace throng {

/// Which gaps of one layer continue each other, row by row.
struct LayerLinks {
  std::array<uint64_t, kTileSide> has;   // the cell has a gap in this layer
  std::array<uint64_t, kTileSide> left;  // it continues the same layer's gap at x - 1
  std::array<uint64_t, kTileSide> up;    // and at z - 1
};

void link_layer(const TileGaps& gaps, int32_t layer, int32_t max_step, int32_t min_gap,
                LayerLinks& links);

/// Lowest and highest top over the cells of a layer that have a gap.
struct TopRange {
  int32_t low = INT32_MAX, high = INT32_MIN;
};
TopRange layer_range(const TileGaps& gaps, int32_t layer);
/// The same over the cells of row z whose bits are set.
TopRange run_range(const GapLayer& layer, int32_t z, uint64_t cells);

/// Sets every cell to "no gap".
void clear_sheet(Sheet& sheet);

/// Copies the gaps of `layer` in row z whose bits are set into the sheet, whose base is set.
void write_gaps(const GapLayer& layer, int32_t z, uint64_t cells, const BodyLimits& limits,
                Sheet& sheet);

/// Fills the sheet's counts and extremes.
void summarise(Sheet& sheet);

/// Could the feet be a plane? Quick and sure when it says no: differences of neighbours must agree
/// to within 2 mm.
bool may_be_plane(const Sheet& sheet);

/// Half of what the feet may rise or fall over each cell, see world/surface.h. [mm]
void make_tilt(const Sheet& sheet, std::array<uint16_t, kTileArea>& tilt);

}  // namespace throng
