// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "graph/flood.h"

/// Rectangles that tile the legal cells of a level.
namespace throng::path {

/// Cells [x0, x1) x [z0, z1) of a tile.
struct CellRect {
  int32_t x0 = 0, z0 = 0, x1 = 0, z1 = 0;
};

/// Tiles `open` with rectangles that no cut crosses, in the order of their first cells: stacks of
/// equal runs of rows, or of columns where that takes fewer. `cuts` may be null.
std::vector<CellRect> tile_with_rects(const world::CellRows& open, const graph::StepCuts* cuts);

}  // namespace throng::path
