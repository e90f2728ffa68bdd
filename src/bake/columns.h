// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "bake/grid.h"
#include "bake/triangles.h"

/// Columns of solid spans over the 64 x 64 cells of a tile, by conservative rasterisation.
namespace throng {

inline constexpr int32_t kNoSupport = INT32_MIN;
inline constexpr int32_t kNoSpan = INT32_MAX;  // as the low end of one that is not there
inline constexpr double kWiden = 1e-4;         // cells

/// Up to one span per cell. Cell (x, z) of the tile is index z * 64 + x.
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
  int32_t lanes = 1;                               // cells that are filled together
  std::array<uint8_t, kTileArea> depth;            // layers in use, per `lanes` cells
  std::vector<std::unique_ptr<SpanLayer>> layers;  // unsorted
  std::vector<Spill> spills;                       // by cell

  /// Does layer k hold a span of this cell?
  [[nodiscard]] bool holds(int32_t k, size_t cell) const {
    return k < depth[cell / static_cast<size_t>(lanes)] &&
           layers[static_cast<size_t>(k)]->low[cell] != kNoSpan;
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

/// Free space over solid matter, up to one per cell. Heights from the columns' base.
struct GapLayer {
  alignas(64) std::array<int32_t, kTileArea> top;      // of the matter below
  alignas(64) std::array<int32_t, kTileArea> ceiling;  // kOpenSkyMm where nothing is above
  alignas(64) std::array<int32_t, kTileArea> support;  // as in SpanLayer
};

inline constexpr int32_t kOpenSkyMm = INT32_MAX;

struct TileGaps {
  int32_t base = 0;
  int32_t max_count = 0;
  uint64_t spans = 0;  // after joining
  alignas(64) std::array<int32_t, kTileArea> count;
  std::vector<std::unique_ptr<GapLayer>>
      layers;  // ascending; layer k of cell c holds if k < count[c]
};

/// Bit x of row z: column (x, z) of the tile has no matter at all.
std::array<uint64_t, kTileSide> bare_columns(const TileGaps& gaps);

/// Joins spans that are less than `min_gap` apart and lists what is free above each run.
void find_gaps(const TileColumns& columns, int32_t min_gap, TileGaps& gaps);

}  // namespace throng
