// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "bake/layers/legality.h"
#include "bake/layers/surface_planes.h"

/// Which of the 8 x 8 parts of a cell its solids fill: a second test of cells beside walls, where
/// whole cells deny up to a cell and a half of floor that a body fits on.
namespace throng::bake {

/// Memory of recheck_walls.
struct WallScratch {
  struct Slab {
    int32_t floor;      // lower tops are drops [mm from the layer's base]
    int32_t low, high;  // a solid strictly between stops the body
  };
  struct Asked {
    int32_t band;  // of feet, by absolute height: a cell's verdict depends on no other asked cell
    int32_t cell;
    auto operator<=>(const Asked&) const = default;
  };
  struct Near {
    const CellTriangle* triangle;
    int32_t low, high;       // [mm]
    uint8_t side;            // of the nine tiles; the rest is in its frame
    uint8_t x0, x1, z0, z1;  // cells that the triangle may touch, the last included
  };
  /// Cells that may hold what stops a body, of one of the nine tiles.
  struct Side {
    BitPlane wanted{};
    uint64_t rows = 0, columns = 0;  // that have such cells
  };
  std::vector<Asked> asked;
  uint32_t known = 0;                       // bit s: around[s] is; to be cleared for another tile
  std::array<std::vector<Near>, 9> around;  // triangles that bodies on the tile may touch
  std::vector<Near> near;                   // those of them that the wanted cells may touch
  std::array<Side, 9> sides;
  std::array<BitPlane, 9> drops;  // columns that surely stop every body within reach
  std::vector<uint64_t> parts;    // at LayerWindow::index; bit 8 j + i is part (i, j)
};

/// legal_cells' test for its `hemmed` cells that are not legal yet: no part of a cell that the body
/// can touch, from anywhere on its own, holds a solid at its height, by the triangles themselves.
/// `scratch.known` must be 0 for the first layer of a tile. True if any cell passed. Linear in the
/// triangles near, and the cells that they touch.
bool recheck_walls(const Neighbourhood& tiles, size_t layer, const BodyWindow& body,
                   const TileTriangles& triangles, const LegalityScratch& legality,
                   WallScratch& scratch, LegalCells& cells);

}  // namespace throng::bake
