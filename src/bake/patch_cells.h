// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "bake/body_sweep.h"
#include "bake/surface_bound.h"
#include "bake/triangle_sieve.h"
#include "graph/node_width.h"
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

/// Where the body is while its feet are anywhere on the surface.
[[nodiscard]] BodySweep sweep_of(const SurfaceBound& surface, const PatchBody& body);

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
  /// A cell whose surface is known, but not yet who may stand on it.
  struct Pending {
    size_t cell = 0;
    double steepest = 0;
    const CellBounds* bounds = nullptr;
    std::array<BodySweep, 2> prism;   ///< What tells the height, along the normal and upright.
    std::array<BodySweep, 2> bodies;  ///< All that may stand there, by their inclination.
    Box3d box;                        ///< Of these, and of the surface.
    int32_t postures = 0;

    [[nodiscard]] const SurfaceBound& surface(size_t posture) const {
      return posture == 0 ? bounds->along : bounds->upright;
    }
  };

  /// How often a patch is halved.
  [[nodiscard]] int32_t depth_of(const BezierPatch& patch) const;
  void visit(const BezierPatch& part, int32_t level, int32_t s, int32_t t, BezierCells& out);
  void cut_region(const BezierPatch& part, int32_t halvings);
  void bound_cells(BezierCells& out);
  void add_posture(size_t posture, Pending& cell) const;
  [[nodiscard]] bool is_asked(const PatchBody& body, size_t posture, const Pending& cell) const {
    return body.climbs == (posture == 0) && cell.steepest >= body.steepest;
  }
  void judge_pending(BezierCells& out);
  void gather(const Box3d& box);
  void find_makers(std::span<const Pending> cells, BezierCells& out);
  void judge_posture(const Pending& cell, size_t posture, Promise& promise);
  void judge_met(const Pending& cell, size_t posture, uint32_t met, Promise& promise);
  [[nodiscard]] uint32_t too_steep(const Pending& cell) const;
  /// Matter in here leaves no height.
  [[nodiscard]] BodySweep low_room(const Pending& cell, size_t posture) const;

  const TriangleSquares* triangles_;
  const PatchSet* set_;
  std::vector<PatchBody> bodies_;
  const NodeBins* bins_;
  std::vector<double> bin_cosine_;
  double size_;
  double tallest_ = 0, least_bottom_ = 0;

  std::vector<uint32_t> beside_;    // patches that go on from this one
  std::vector<uint8_t> is_beside_;  // by patch; and those known to pierce it
  PatchParts parts_, coarser_;      // so many cells of the patch
  std::vector<size_t> part_cell_;   // which they are
  std::vector<CellBounds> bounds_;
  std::vector<Pending> pending_;  // in the order of a quadtree: runs of 4^n make a square
  std::vector<Box3d> boxes_;      // of each kSquare of them
  SieveList near_, foreign_;      // triangles near them; those of other patches, not beside
  SieveList part_, block_;        // those near a part of the region, and near a square of cells
  std::vector<uint32_t> found_;
  SieveHits hits_;
  std::vector<BodySweep> sweeps_;   // where a height ends, then bodies of the posture
  std::vector<uint16_t> tube_bit_;  // by body of the posture: its class
  std::vector<SieveTube> tubes_;    // of these, those that matter may enter
};

}  // namespace throng
