// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "throng/base.h"
#include "throng/scene.h"

/// The oracle of the rasteriser: columns of spans by clipping every triangle
/// against every cell, in double precision.
namespace throng::naive {

/// Columns row by row: cell = z * width + x owns the spans first[cell] to
/// first[cell + 1], lowest first. Spans neither overlap nor touch. Heights in
/// mm from the grid's origin.
struct Columns {
  int32_t width = 0;
  int32_t depth = 0;
  std::vector<uint32_t> first;
  std::vector<int32_t> low;
  std::vector<int32_t> high;

  [[nodiscard]] std::span<const int32_t> lows(size_t cell) const;
  [[nodiscard]] std::span<const int32_t> highs(size_t cell) const;
};

/// Cells of a grid: cell (x, z) is the closed square origin + [x, x + 1] *
/// cell, likewise in z.
struct Grid {
  Vec3d origin{};
  double cell = 0.1;
  int32_t width = 0;
  int32_t depth = 0;
  double widen = 0;  ///< Grows every square on all sides, for upper bounds. [cells]
};

/// Whole millimetres at or below / above `metres`; within 1 um of a whole one
/// counts as on it.
int32_t floor_mm(double metres);
int32_t ceil_mm(double metres);

/// A span for every cell whose closed square a triangle touches. Time:
/// triangles x cells under them.
Columns make_columns(const Scene& scene, const Grid& grid);

/// True if every span of `inner` lies within one span of `outer`, cell by cell.
bool covers(const Columns& outer, const Columns& inner);

/// Columns from a list of [low, high] in mm per cell, sorted and merged; for
/// hand-made worlds.
Columns from_lists(int32_t width, int32_t depth,
                   const std::vector<std::vector<std::pair<int32_t, int32_t>>>& cells);

}  // namespace throng::naive
