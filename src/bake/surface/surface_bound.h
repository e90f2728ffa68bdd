// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "bake/surface/body_sweep.h"
#include "throng/scene.h"

/// Where sub-patches of Bezier patches lie and how far they are inclined.
namespace throng::bake {

inline constexpr size_t kPatchDoubles = 48;  // of a patch's control points

/// Where all surface points of a sub-patch and their normals are: a cone around `frame.up` of the
/// normals, a cylinder around the frame's axis of the points.
struct SurfaceBound {
  BodyFrame frame;
  double sine = 1, cosine = 0;  ///< Of the cone's half angle; valid if sine < 1.
  double radius = 0;            ///< [m]
  double low = 0, high = 0;     ///< Heights along the axis. [m]
  double area = 0;              ///< About. [m^2]

  /// Of the steepest normal's angle to the vertical.
  [[nodiscard]] double steepest_cosine() const;
};

/// By the hulls of the derivatives, whose products are the normals. None where the cone would be
/// more than about 70 degrees wide: a sub-patch that collapses or folds.
[[nodiscard]] std::optional<SurfaceBound> bound_surface(const BezierPatch& patch);

/// The same, closer and slower: by the heights of the normals.
[[nodiscard]] double steepest_cosine(const BezierPatch& patch, const SurfaceBound& bound);

/// The same around the vertical through `along.frame.centre`, as if the surface were level.
[[nodiscard]] SurfaceBound upright_bound(const BezierPatch& patch, const SurfaceBound& along);

/// Both for a cell.
struct CellBounds {
  bool valid = false;
  SurfaceBound along, upright;
};

/// Parts of patches, side by side: coordinate k of control point p of part i is
/// at[(3 * p + k) * stride + i].
struct PatchParts {
  size_t count = 0;
  size_t stride = 0;  ///< Room for `count` and what fills up a vector.
  std::vector<double> at;

  void resize(size_t parts);
  void set(size_t part, const BezierPatch& patch);
  [[nodiscard]] BezierPatch patch(size_t part) const;
};

/// Halves all along s and those along t: part 4 i + 2 a + b of `out` is split_t's b-th of
/// split_s's a-th half of part i. Eight at a time or so; the same bits as one by one. Linear.
void quarter_parts(const PatchParts& parts, PatchParts& out);

/// Both for each of some cells, eight at a time or so; the same bits as one by one. Linear.
void bound_cells_of(const PatchParts& parts, std::span<CellBounds> out);

}  // namespace throng::bake
