// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "bake/surface/body_sweep.h"
#include "bake/surface/self_support.h"
#include "bake/surface/surface_bound.h"
#include "bake/surface/triangle_filter.h"
#include "graph/node_width.h"
#include "graph/quadtree.h"
#include "throng/scene.h"
#include "throng/surface.h"

/// What the finest sub-patches of Bezier patches promise, proved against all triangles.
namespace throng::bake {

/// One class's body on a patch. A climber's axis is the surface's normal, a walker's straight up.
struct PatchBody {
  double radius = 0;
  double bottom = 0;  ///< A solid up to here above the feet is climbed over. [m]
  double height = 0;
  double steepest = 0;  ///< Cosine of the steepest surface, with a margin for rounding.
  bool climbs = false;
  uint16_t bit = 0;
};

[[nodiscard]] std::vector<PatchBody> patch_bodies(std::span<const AvatarClass> classes);

/// Where the body is while its feet are anywhere on the surface.
[[nodiscard]] BodySweep sweep_of(const SurfaceBound& surface, const PatchBody& body);

/// A patch, its neighbours and theirs, among them those that share a corner with it.
void find_patches_around(const PatchSet& set, uint32_t patch, std::vector<uint32_t>& out);

/// How often a patch is halved until its cells are of a size. [m]
[[nodiscard]] int32_t patch_depth(const BezierPatch& patch, double size);

/// Does a scene state which part of its patch each triangle covers?
[[nodiscard]] inline bool knows_parts(const Scene& scene) {
  return scene.patch_part.size() == scene.triangles.size() &&
         scene.patch_off.size() == scene.patches.size();
}

struct BezierCells {
  graph::PatchCells promise;
  Vec3d origin;  ///< What `shape` is relative to: near the patch.
  std::vector<graph::CellShape> shape;
  std::vector<uint32_t> makers;  ///< Patches that pierce this one, ascending.
};

/// Judges the cells of Bezier patches. One per thread: owns scratch memory.
class PatchJudge {
 public:
  PatchJudge(const TriangleSquares& triangles, std::span<const AvatarClass> classes,
             const NodeBins& bins, double size);

  [[nodiscard]] BezierCells judge(uint32_t patch);

 private:
  /// A cell whose surface is known.
  struct Bounded {
    size_t cell = 0;
    size_t part = 0;  ///< of parts_
    double steepest = 0;
    bool upright = false;  ///< Surely not a ceiling, nor too steep for every walker.
  };

  /// A cell against whose bodies triangles have to be tested; or a block of them, for its box.
  struct Pending {
    size_t cell = 0;
    double steepest = 0;
    const CellBounds* bounds = nullptr;
    std::array<BodySweep, 2> prism;   ///< Prisms for the height, along the normal and upright.
    std::array<BodySweep, 2> bodies;  ///< All that may stand there, by their inclination.
    Box3d box;                        ///< Of these, and of the surface.
    int32_t postures = 0;

    [[nodiscard]] const SurfaceBound& surface(size_t posture) const {
      return posture == 0 ? bounds->along : bounds->upright;
    }
  };

  void visit(const BezierPatch& part, int32_t level, int32_t s, int32_t t, BezierCells& out);
  void cut_region(const BezierPatch& part, int32_t halvings);
  void bound_cells(BezierCells& out);
  void add_posture(size_t posture, Pending& cell) const;
  [[nodiscard]] bool is_asked(const PatchBody& body, size_t posture, double steepest) const {
    return body.climbs == (posture == 0) && steepest >= body.steepest;
  }
  /// The bounded cells of block (s, t) of a level.
  void judge_region(int32_t level, int32_t s, int32_t t, BezierCells& out);
  void judge_block(std::span<const Bounded> cells, const Box3d& box, BezierCells& out);
  [[nodiscard]] Pending pending(const Bounded& cell) const;
  [[nodiscard]] Box3d box_of(const CellBounds& block) const;
  [[nodiscard]] uint32_t bodies_on(const Bounded& cell) const;
  void gather(const Box3d& box, const SelfSupport& own);
  void fill_all();
  void stand_on(const Bounded& cell, BezierCells& out) const;
  void set_spared(const SelfSupport& own, double deviation);
  void find_makers(std::span<const Pending> cells, BezierCells& out);
  void judge_posture(const Pending& cell, size_t posture, graph::Promise& promise);
  uint32_t judge_against(const FilterList& list, const Pending& cell, size_t posture,
                         uint32_t asked, graph::Promise& promise);
  uint32_t judge_met(const FilterList& list, const Pending& cell, size_t posture, uint32_t met,
                     graph::Promise& promise);
  [[nodiscard]] uint32_t too_steep(const Pending& cell) const;
  /// A solid in here leaves no height.
  [[nodiscard]] BodySweep headroom_sweep(const Pending& cell, size_t posture) const;

  const TriangleSquares* triangles_;
  const PatchSet* set_;
  std::vector<PatchBody> bodies_;
  const NodeBins* bins_;
  std::vector<double> bin_cosine_;
  double size_;
  double tallest_ = 0, greatest_bottom_ = 0;
  double steepest_walk_ = 0;  // cosine of what any walker may stand on

  uint32_t patch_ = 0;              // that is judged
  std::vector<uint32_t> beside_;    // patches that continue this one
  std::vector<uint8_t> is_beside_;  // by patch; and those known to pierce it
  PatchParts parts_, coarser_;      // so many cells of the patch
  PatchParts blocks_;               // the same in blocks
  std::vector<size_t> part_cell_;   // which they are
  std::vector<CellBounds> bounds_, block_bounds_;
  std::vector<Bounded> bounded_;  // in the order of a quadtree: runs of 4^n make a square
  std::vector<size_t> block_at_;  // where in these each block begins
  std::vector<Pending> pending_;  // those of one block
  std::vector<Box3d> block_boxes_;
  /// Triangles near a region, a block and a square of cells.
  struct NearLists {
    FilterList region, block, square;
  };
  NearLists others_, all_;         // without those of its own that are spared, and with them
  FilterList not_beside_, maker_;  // those of other patches, not beside; near a square
  FilterList found_others_;        // before their boxes are tested
  bool all_is_filled_ = false, all_is_asked_ = false;
  uint32_t spared_ = 0;                  // bodies that the patch's own triangles here do not reach
  std::array<bool, 2> spares_height_{};  // along the normal and upright
  std::vector<uint32_t> found_, other_ids_;
  FilterHits hits_;
  std::vector<BodySweep> sweeps_;   // where a height ends, then bodies of the posture
  std::vector<uint16_t> tube_bit_;  // by body of the posture: its class
  std::vector<FilterTube> tubes_;   // of these, those that a solid may enter
};

}  // namespace throng::bake
