// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "graph/surface_piece.h"

#include <algorithm>
#include <cmath>

#include "throng/scene.h"

// A piece is a patch of its own, by de Casteljau's construction, and lies in the hull of its
// control points. Its derivatives are means of differences of these, so its normals lie in the cone
// that the products of all pairs of such differences span.
namespace throng::graph {

SurfacePiece surface_piece(const NodeSurface& surface, double s0, double t0, double s1, double t1) {
  BezierPatch patch;
  for (size_t i = 0; i < 16; ++i) {
    const double* at = surface.points + 3 * i;
    patch.points[i] = {at[0], at[1], at[2]};
  }
  if (s1 < 1) patch = split_s(patch, s1)[0];
  if (s0 > 0) patch = split_s(patch, s0 / s1)[1];
  if (t1 < 1) patch = split_t(patch, t1)[0];
  if (t0 > 0) patch = split_t(patch, t0 / t1)[1];
  SurfacePiece piece{.middle = patch.at(0.5, 0.5), .normal = patch.normal(0.5, 0.5)};
  for (const Vec3d& p : patch.points)
    piece.spread = std::max(piece.spread, length(p - piece.middle));
  std::array<Vec3d, 12> by_s, by_t;
  for (size_t j = 0; j < 4; ++j) {
    for (size_t i = 0; i < 3; ++i) {
      by_s[3 * j + i] = patch.points[4 * j + i + 1] - patch.points[4 * j + i];
      by_t[3 * j + i] = patch.points[4 * (i + 1) + j] - patch.points[4 * i + j];
    }
  }
  double min_cosine = 1;
  for (const Vec3d& s : by_s) {
    for (const Vec3d& t : by_t) {
      const Vec3d normal = cross(t, s);
      const double size = length(normal);
      if (size > 0) min_cosine = std::min(min_cosine, dot(normal, piece.normal) / size);
    }
  }
  constexpr double kRounding = 1e-9;
  min_cosine -= kRounding;
  piece.leans = min_cosine > 0;
  piece.cosine = min_cosine;
  piece.sine = std::sqrt(std::max(0.0, 1 - min_cosine * min_cosine));
  return piece;
}

}  // namespace throng::graph
