// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "bake/columns/triangles.h"
#include "bake/layers/legality.h"

/// The ground around a layer as one plane per cell, taken from the triangles themselves: what a
/// body that barely clears its own slope needs, which whole millimetres of whole cells cannot show.
namespace throng::bake {

/// Per cell, at LayerWindow::index: the highest surface below the free span at the cell's centre,
/// and its plane. Where no triangle is under the centre: a level plane at the window's top.
struct CellPlanes {
  std::vector<float> height;            // [mm from the layer's base]
  std::vector<float> slope_x, slope_z;  // [mm per cell]
  std::vector<float> steepness;         // length of the slope, rounded up
  /// How far a solid below the free span may stand above the plane in the cell, rounded up; of
  /// level planes for want of a triangle: negative. [mm]
  std::vector<float> excess;
};

/// The triangles of a tile and the eight around it, in Neighbourhood's order.
struct TileTriangles {
  std::span<const CellTriangle> all;
  std::array<std::span<const uint32_t>, 9> items;  // of `all`, that may touch the tile
  std::array<const BitPlane*, 9> bare{};           // columns without a solid; null: not known
  int32_t cell_x = 0, cell_z = 0;                  // first cell of the middle tile
};

/// Finds the planes of all cells that a body on one of `asked` reaches. `base` is what the window's
/// heights are from. [mm] Linear in the triangles near, and the cells that they touch.
void find_surface_planes(const LayerWindow& window, int32_t base, const BitPlane& asked,
                         const BodyWindow& body, const TileTriangles& triangles, CellPlanes& cells);

/// legal_cells' test for cells that failed it, and the recheck of slopes, for how high or low the
/// solids around are: it is compared with the plane of the feet's surface, or with its own,
/// whichever proves more.
void recheck_planes(const Layer& layer, const BodyWindow& body, const CellPlanes& planes,
                    const LegalityScratch& scratch, LegalCells& cells);

}  // namespace throng::bake
