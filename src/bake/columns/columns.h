// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "bake/columns/grid.h"
#include "bake/columns/triangles.h"

/// Columns of solid spans over the 64 x 64 cells of a tile, by conservative rasterisation.
namespace throng::bake {

inline constexpr int32_t kNoSupport = INT32_MIN;
inline constexpr int32_t kNoSpan = INT32_MAX;  // as the low end of one that is not there
inline constexpr double kWiden = 1e-4;         // cells

/// Up to one span per cell, at the cell's TileColumns::place.
struct SpanLayer {
  alignas(64) std::array<int32_t, kTileArea> low;
  alignas(64) std::array<int32_t, kTileArea> high;
  /// Highest surface under the cell's centre, height * 256 + surface code, or kNoSupport.
  alignas(64) std::array<int32_t, kTileArea> support;
};

/// Scratch of one worker, reused from tile to tile. Heights are [mm] from `base`.
struct TileColumns {
  struct Spill {  // a span of a column deeper than kMaxLayers
    int32_t cell, low, high, support;
  };
  static constexpr int32_t kMaxLayers = 64;

  int32_t base = 0;                                // [mm]
  int32_t lanes = 1;                               // cells of a block: filled together
  std::array<uint8_t, kTileArea> depth;            // layers in use, per block
  std::vector<std::unique_ptr<SpanLayer>> layers;  // unsorted
  std::vector<Spill> spills;                       // by cell

  /// Where layers keep what they have of cell (x, z) of the tile, z * 64 + x: by blocks of up to
  /// four columns and lanes / 4 rows, blocks and the cells in them by rows.
  [[nodiscard]] size_t place(size_t cell) const {
    const size_t wide = std::min<size_t>(static_cast<size_t>(lanes), 4);
    const size_t high = static_cast<size_t>(lanes) / wide;
    const size_t x = cell % kTileSide, z = cell / kTileSide;
    const size_t block = z / high * (kTileSide / wide) + x / wide;
    return block * static_cast<size_t>(lanes) + z % high * wide + x % wide;
  }
  /// Does layer k hold a span of this cell?
  [[nodiscard]] bool holds(int32_t k, size_t cell) const {
    const size_t at = place(cell);
    return k < depth[at / static_cast<size_t>(lanes)] &&
           layers[static_cast<size_t>(k)]->low[at] != kNoSpan;
  }
  [[nodiscard]] std::span<const Spill> spills_of(int32_t cell) const;
};

/// Part of a tile: cells [x0, x1) x [z0, z1).
struct TileRect {
  int32_t x0 = 0, z0 = 0, x1 = kTileSide, z1 = kTileSide;
};

/// Fills the columns of the tile whose first cell is (cell_x, cell_z). Every cell whose square a
/// triangle touches gets a span that covers the triangle there, widened by at most kWiden cells
/// sideways and 1 mm in height. Spans nearer than `join` mm may be merged already.
void rasterise_tile(std::span<const CellTriangle> triangles, std::span<const uint32_t> items,
                    int32_t cell_x, int32_t cell_z, const TileRect& rect, int32_t join,
                    TileColumns& columns);

/// Sorted spans of a tile: column c owns low/high[first[c]] to [first[c + 1]], ascending, not
/// touching. Absolute heights. [mm]
struct TileSpans {
  std::vector<uint32_t> first;
  std::vector<int32_t> low;
  std::vector<int32_t> high;
};

/// Sorts and merges spans that touch or overlap.
void sort_spans(const TileColumns& columns, TileSpans& spans);

}  // namespace throng::bake
