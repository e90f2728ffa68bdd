// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "throng/base.h"
#include "verify/cylinder.h"
#include "verify/triangle_tree.h"

/// Where a body could stand, and walk to, by the triangles alone: the measure of what a bake loses.
namespace throng::verify {

/// A body for standing tests. The bake's rules: a solid up to `bottom` above the feet is climbed, a
/// rim more than `bottom` below the feet is an obstacle.
struct BodyShape {
  double radius = 0;     ///< [m]
  double bottom = 0;     ///< [m]
  double height = 0;     ///< Top above the feet. [m]
  double step = 0;       ///< Largest change of floor in one sub-step. [m]
  double levelness = 0;  ///< Cosine of the steepest slope.
  double spacing = 0;    ///< Between the points of the disc where support is looked for. [m]
};

/// How a walk through places where a body stands ended.
enum class WalkEnd {
  kReached,  ///< It came to a place that the caller accepts.
  kIsland,   ///< The whole area that can be walked from there has no such place.
  kLarge,    ///< The area is larger than the limit, and no such place was met in it.
};

/// Stands one body shape on a scene. Owns scratch memory: one per thread.
class Stance {
 public:
  Stance(const TriangleTree& tree, const BodyShape& shape);

  /// Does the body stand with its feet here? `feet` must be the topmost surface within `bottom`,
  /// not blocked and not too steep; no triangle meets the body from `bottom` up; and the disc
  /// under it has a surface within `bottom` of the feet everywhere.
  bool stands(Vec3d feet);

  /// The topmost surface on the vertical line within [y - reach, y + reach]. [m]
  std::optional<double> floor_at(double x, double z, double y, double reach) const;

  /// Walks from `start`, where the body stands, over a square lattice of `spacing`, nearest points
  /// first, to the first place that `accepts`. Stops after `max_points` places.
  WalkEnd walk(Vec3d start, double spacing, size_t max_points,
               const std::function<bool(Vec3d feet)>& accepts);

 private:
  struct Candidate {
    Corners corners;
    uint32_t triangle;
  };

  void gather(Vec3d feet);
  [[nodiscard]] bool is_floor(Vec3d feet) const;
  [[nodiscard]] bool is_free(Vec3d feet) const;
  [[nodiscard]] bool is_supported(Vec3d feet) const;

  const TriangleTree* tree_;
  BodyShape shape_;
  std::vector<std::array<double, 2>> disc_;  ///< Offsets from the centre, rim first.
  double reach_ = 0;                         ///< Of the disc's points. [m]
  std::vector<Candidate> near_;              ///< Triangles near the last feet.
};

}  // namespace throng::verify
