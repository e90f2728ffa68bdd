// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "bake/columns/columns.h"

/// What is free above the solid spans of a tile's columns.
namespace throng::bake {

/// The free spans of one rank, at most one per cell. Heights from the columns' base.
struct FreeSpanLayer {
  alignas(64) std::array<int32_t, kTileArea> top;      // of the solid below
  alignas(64) std::array<int32_t, kTileArea> ceiling;  // kOpenSkyMm where nothing is above
  alignas(64) std::array<int32_t, kTileArea> support;  // as in SpanLayer
};

inline constexpr int32_t kOpenSkyMm = INT32_MAX;

struct TileFreeSpans {
  int32_t base = 0;
  int32_t max_count = 0;
  uint64_t spans = 0;  // after joining
  alignas(64) std::array<int32_t, kTileArea> count;
  std::vector<std::unique_ptr<FreeSpanLayer>>
      layers;  // ascending; layer k of cell c holds if k < count[c]
};

/// Bit x of row z: column (x, z) of the tile has no solid.
std::array<uint64_t, kTileSide> bare_columns(const TileFreeSpans& free_spans);

/// Joins spans that are less than `min_free_span` apart and lists the free span above each run.
void find_free_spans(const TileColumns& columns, int32_t min_free_span, TileFreeSpans& free_spans);

/// Where the solid under a free span supports no body, gives the free span the support of the
/// nearest free span below that has one.
void lend_supports(TileFreeSpans& free_spans);

}  // namespace throng::bake
