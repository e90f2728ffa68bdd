// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

/// The world's grid of cells: cell (0, 0) begins at the origin, heights are whole millimetres.
namespace throng::bake {

inline constexpr int32_t kTileSide = 64;  // cells
inline constexpr int32_t kTileArea = kTileSide * kTileSide;

/// A wall on the border of two cells fills both. What people build stands on round coordinates, so
/// borders keep off them: whole cells lie near the middle of one, half cells just inside.
inline constexpr double kGridPhase = 15.0 / 32;  // cells

struct Grid {
  double origin_x = 0;  // [m]
  double origin_z = 0;  // [m]
  double cell = 0.1;    // [m]
  int32_t width = 0;    // cells
  int32_t depth = 0;

  [[nodiscard]] double to_cell_x(double x) const { return (x - origin_x) / cell; }
  [[nodiscard]] double to_cell_z(double z) const { return (z - origin_z) / cell; }
  [[nodiscard]] int32_t tiles_x() const { return (width + kTileSide - 1) / kTileSide; }
  [[nodiscard]] int32_t tiles_z() const { return (depth + kTileSide - 1) / kTileSide; }
};

}  // namespace throng::bake
