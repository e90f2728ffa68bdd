// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "throng/math.h"

/// Biquadratic Bezier patches cut into triangles.
namespace throng {

/// A tessellated control grid: columns x rows points on the surface, row by row.
struct PatchMesh {
  int32_t columns = 0;
  int32_t rows = 0;
  std::vector<Vec3d> points;
};

/// A grid of odd columns x odd rows (both >= 3) of control points, row by row: neighbouring 3 x 3
/// pieces share their border. Triangles on the result's quads, cut along either diagonal, are never
/// farther than `tolerance` from the surface (same unit as the points), unless a piece would need
/// more than 64 steps along a side.
[[nodiscard]] PatchMesh tessellate_biquadratic(int32_t columns, int32_t rows,
                                               std::span<const Vec3d> control, double tolerance);

}  // namespace throng
