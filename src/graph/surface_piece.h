// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include "graph/node_surface.h"

/// Bounds of a part of a curved patch.
namespace throng::graph {

/// All points of a piece are no farther than `spread` from `middle`, and all its normals lean from
/// `normal` by no more than an angle of this sine and cosine; without `leans`, nothing is known.
struct SurfacePiece {
  Vec3d middle;
  double spread = 0;  ///< [m]
  Vec3d normal;
  bool leans = false;
  double cosine = 1, sine = 0;
};

/// Of the parameters [s0, s1] x [t0, t1] of a Bezier patch.
[[nodiscard]] SurfacePiece surface_piece(const NodeSurface& surface, double s0, double t0,
                                         double s1, double t1);

}  // namespace throng::graph
