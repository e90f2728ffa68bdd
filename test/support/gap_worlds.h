// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "bake/columns/free_spans.h"
#include "bake/layers/layers.h"

/// Columns made by hand, for the stages between the rasteriser and the baked world: 3 x 3 tiles of
/// solids, and the free spans above them by the rule of docs/algorithms.md, written out plainly.
namespace throng::naive {

/// The solid spans of one cell. Absolute heights. [mm]
struct Solid {
  int32_t low = 0, high = 0;
  int32_t support = bake::kNoSupport;  // highest surface under the cell's centre
  int32_t code = 0;
};

/// Free spans of one cell. Absolute heights; ceiling kOpenSkyMm under the open sky. [mm]
struct FreeSpan {
  int32_t top = 0, ceiling = bake::kOpenSkyMm;
  int32_t support = bake::kNoSupport;
  int32_t code = 0;
};

/// Cells [-64, 128) in x and in z: the tile under test, and its neighbours.
template <class T>
struct Block {
  static constexpr int32_t kFirst = -bake::kTileSide, kEnd = 2 * bake::kTileSide,
                           kSide = kEnd - kFirst;
  std::vector<std::vector<T>> cells = std::vector<std::vector<T>>(size_t{kSide} * kSide);

  [[nodiscard]] bool inside(int32_t x, int32_t z) const {
    return x >= kFirst && z >= kFirst && x < kEnd && z < kEnd;
  }
  std::vector<T>& at(int32_t x, int32_t z) {
    return cells[static_cast<size_t>((z - kFirst) * kSide + x - kFirst)];
  }
  const std::vector<T>& at(int32_t x, int32_t z) const {
    return cells[static_cast<size_t>((z - kFirst) * kSide + x - kFirst)];
  }
};

using SolidBlock = Block<Solid>;
using FreeSpanBlock = Block<FreeSpan>;

/// The free spans above the solids, after joining solids less than `min_free_span` apart.
FreeSpanBlock free_spans_of(const SolidBlock& solids, int32_t min_free_span);

/// One tile of a block as the bake stores it. Tile (0, 0) is the middle one.
void fill_tile(const FreeSpanBlock& block, int32_t tile_x, int32_t tile_z,
               bake::TileFreeSpans& out);

/// The same free spans, each with the highest support under it in its column.
FreeSpanBlock with_lent_supports(const FreeSpanBlock& free_spans);

/// Free spans of at least BodyLimits::kHighFreeSpan; solids around lower ones are joined.
FreeSpanBlock high_free_spans(const FreeSpanBlock& free_spans);

/// Assigns the free spans of a tile to layers as the bake does.
void assign_tile(const FreeSpanBlock& free_spans, int32_t tile_x, int32_t tile_z,
                 const bake::BodyLimits& limits, bake::LayerPool& pool, bake::TileLayers& layers);

struct RandomBlock {
  uint64_t seed = 1;
  int32_t ground = 0;  // 0 rolling, 1 terraces, 2 folded planes, 3 random heights, 4 level
  bool decks = false;  // floors over floors, with ramps that join them
  bool ceilings = false;
  bool holes = false;
  int32_t codes = 1;  // surfaces take codes 0 to codes - 1
};

/// Ground and the chosen solids over all nine tiles. [cells of 0.1 m]
SolidBlock random_solids(const RandomBlock& config);

}  // namespace throng::naive
