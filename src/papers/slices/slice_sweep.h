// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "throng/base.h"
#include "throng/papers.h"
#include "throng/world.h"

/// The sweep: all slices of a grid from columns that were filled once.
namespace throng::papers {

/// Columns of 64 x 64 cells: cell z * 64 + x owns the spans first[cell] to first[cell + 1], lowest
/// first, neither overlapping nor touching. Heights in mm. Cells beyond the grid must be empty.
struct SliceTile {
  int32_t tile_x = 0;
  int32_t tile_z = 0;
  std::vector<uint32_t> first;  ///< 4097 offsets.
  std::vector<int32_t> low;
  std::vector<int32_t> high;
};

/// Which slices are kept.
enum class SliceRule {
  kDismissAndReplace,  ///< [ML06] algorithm 2 as printed.
  /// Only its first half, DISMISS_CURRENT. Loses nothing at all, where REPLACE_PREVIOUS can lose a
  /// step from under the open sky to under a roof, and what taller classes need.
  kDismissOnly,
};

/// What to cut. All in mm.
struct SweepConfig {
  int32_t width = 0;  ///< Cells of the grid.
  int32_t depth = 0;
  int32_t avatar_height = 1750;  ///< [> 0]
  int32_t resolution = 100;      ///< [> 0]
  int32_t min_y = 0;             ///< Bounds of all solids in the tiles.
  int32_t max_y = 0;
  int32_t far_plane = 0;  ///< What an empty cell records. [< min_y]
  std::span<const int32_t>
      heights{};  ///< Cut at these, highest first; empty: at eq. 1 and 3's own.
  SliceRule rule = SliceRule::kDismissAndReplace;
  int32_t workers = 0;
};

/// Cuts the grid made of `tiles`; a tile that is not there is empty. Fills what SliceSet says of
/// grid and slices, not cell and origin. Time: cells that change, slice by slice. Memory: the kept
/// slices, one working slice and a cursor per cell. Fails with kLimit or kCancelled.
[[nodiscard]] Result<SliceSet> sweep_slices(std::span<const SliceTile> tiles,
                                            const SweepConfig& config, Context& context);

/// Cuts one tile alone, as if it were the whole world: at given heights, or at its own.
[[nodiscard]] SliceSet slice_tile(const SliceTile& tile, const SweepConfig& config);

}  // namespace throng::papers
