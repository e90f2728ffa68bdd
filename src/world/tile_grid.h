// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once
#include <cstddef>
#include <cstdint>

#include "throng/world.h"

/// Cells and tiles along one axis, and cells of a tile by their number.
namespace throng::world {

inline constexpr int32_t kTileBits = 6;
inline constexpr int32_t kInTile = kTileCells - 1;  ///< Bits of a cell that say where in its tile.
inline constexpr int32_t kTileArea = kTileCells * kTileCells;  ///< Cells of a tile.
static_assert(kTileCells == 1 << kTileBits);

/// The tile in which a cell lies.
constexpr int32_t tile_along(int32_t cell) { return cell >> kTileBits; }
/// Its place there: 0 to kTileCells - 1.
constexpr int32_t in_tile(int32_t cell) { return cell & kInTile; }
/// The first and the last cell of a tile.
constexpr int32_t first_cell(int32_t tile) { return tile * kTileCells; }
constexpr int32_t last_cell(int32_t tile) { return tile * kTileCells + kInTile; }
/// The first and the last cell of the tile in which a cell lies.
constexpr int32_t tile_begin(int32_t cell) { return cell & ~kInTile; }
constexpr int32_t tile_last(int32_t cell) { return cell | kInTile; }

/// The number of a cell of a tile, row by row, from its place there; and back.
constexpr int32_t cell_index(int32_t x, int32_t z) { return z * kTileCells + x; }
template <class Index>
constexpr int32_t x_of_cell(Index cell) {
  return static_cast<int32_t>(cell % static_cast<Index>(kTileCells));
}
template <class Index>
constexpr int32_t z_of_cell(Index cell) {
  return static_cast<int32_t>(cell / static_cast<Index>(kTileCells));
}

}  // namespace throng::world
