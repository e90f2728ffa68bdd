// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "bake/body_sweep.h"
#include "graph/quadtree.h"
#include "throng/nodes.h"
#include "throng/patch.h"

/// What the finest sub-patches of Bezier patches promise, proved against all triangles.
namespace throng {

/// One class's body on a patch. A climber's axis is the surface's normal, a walker's straight up.
struct PatchBody {
  double radius = 0;
  double bottom = 0;  ///< Matter up to here above the feet is climbed over. [m]
  double height = 0;
  double steepest = 0;  ///< Cosine of the steepest surface, with a margin for rounding.
  bool climbs = false;
  uint16_t bit = 0;
};

[[nodiscard]] std::vector<PatchBody> patch_bodies(std::span<const AvatarClass> classes);

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

/// Where the body is while its feet are anywhere on the surface.
[[nodiscard]] BodySweep sweep_of(const SurfaceBound& surface, const PatchBody& body);

/// The middle of a cell and the radius around it that holds the cell, for floods.
struct CellShape {
  float x = 0, y = 0, z = 0;
  float radius = 0;
  float area = 0;
};

struct BezierCells {
  PatchCells promise;
  std::vector<CellShape> shape;
  std::vector<uint32_t> makers;  ///< Patches that pierce this one, ascending.
};

/// Judges the cells of Bezier patches. One per thread: owns scratch memory.
class PatchJudge {
 public:
  PatchJudge(const TriangleSquares& triangles, std::span<const AvatarClass> classes,
             const NodeBins& bins, double size);

  [[nodiscard]] BezierCells judge(uint32_t patch);

 private:
  /// How often a patch is halved.
  [[nodiscard]] int32_t depth_of(const BezierPatch& patch) const;
  void visit(const BezierPatch& part, int32_t level, int32_t s, int32_t t, BezierCells& out);
  void judge_cell(const BezierPatch& part, size_t cell, BezierCells& out);
  void judge_posture(const BodyFrame& frame, const SurfaceBound& surface, bool climbs,
                     double steepest, Promise& promise);

  const TriangleSquares* triangles_;
  const PatchSet* set_;
  std::vector<PatchBody> bodies_;
  const NodeBins* bins_;
  std::vector<double> bin_cosine_;
  double size_;
  double tallest_ = 0, least_bottom_ = 0;

  std::vector<uint32_t> beside_;    // patches that go on from this one
  std::vector<uint8_t> is_beside_;  // by patch
  std::vector<uint32_t> found_;
  struct AskedBody {
    BodySweep sweep;
    uint16_t bit = 0;
  };
  std::vector<AskedBody> asked_;  // classes of the posture that no triangle has stopped yet
};

}  // namespace throng
