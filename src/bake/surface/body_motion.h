// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include "bake/surface/patch_cells.h"

/// Motions of bodies between two places, against triangles.
namespace throng::bake {

/// A place of a body: its feet and its axis, of unit length.
struct BodyPose {
  Vec3d feet, axis;
};

/// Tests motions of bodies from pose to pose: the feet straight, the axis turning evenly. One per
/// thread: owns scratch memory.
class MotionJudge {
 public:
  explicit MotionJudge(const TriangleSquares& triangles) : triangles_(&triangles) {}

  /// For many motions near each other: lists their triangles once, first those in a box, then of
  /// these those in a smaller one. Changes no answer.
  void look_around(const Box3d& box);
  void look_closer(const Box3d& box);
  /// From the feet of a body to the farthest point that any motion needs to know. [m]
  [[nodiscard]] static double reach_of(const PatchBody& body);

  /// True if no triangle meets the body in its motion. Proved, not sampled: between two poses the
  /// body is grown by as far as any of its points moves.
  [[nodiscard]] bool is_free(const PatchBody& body, const BodyPose& from, const BodyPose& to);

  /// True if there is a surface that is not blocked within `reach` above or below the straight line
  /// between two points, everywhere up to `spacing`.
  [[nodiscard]] bool is_supported(Vec3d from, Vec3d to, double reach, double spacing);

 private:
  // Triangles in a box.
  struct Surroundings {
    Box3d box;
    FilterList list;
  };

  void list_triangles(const Box3d& box, Vec3d around, FilterList& out);
  [[nodiscard]] bool is_free(const PatchBody& body, const BodyPose& from, const BodyPose& to,
                             double move, double t0, double t1);

  const TriangleSquares* triangles_;
  std::vector<uint32_t> found_;
  Surroundings around_, closer_;
  FilterList near_;
  FilterHits hits_;
};

}  // namespace throng::bake
