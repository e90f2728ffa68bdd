// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "naive_columns.h"
#include "papers/slices/slice_sweep.h"

/// [ML06] algorithms 2 and 3 to the letter: every slice is cut again from the columns, every test
/// reads every cell. The oracle of the sweep.
namespace throng::naive {

struct SliceRun {
  std::vector<Slice> taken;  ///< All slices, kept or not.
  std::vector<Slice> kept;
};

/// The highest surface below `height` per cell: the height itself inside a span, the far plane
/// where there is nothing.
Slice cut(const Columns& columns, int32_t height, int32_t far_plane);

/// Algorithm 3 with `config`'s avatar height, resolution and bounds.
SliceRun slice(const Columns& columns, const papers::SweepConfig& config);

/// Columns split into the 64 x 64 tiles that the sweep reads.
std::vector<papers::SliceTile> make_tiles(const Columns& columns);

/// A config with the bounds and grid of `columns`; heights in mm.
papers::SweepConfig sweep_config(const Columns& columns, int32_t avatar_height, int32_t resolution);

}  // namespace throng::naive
