// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "import/raw/orient.h"
#include "throng/base.h"

/// Polygons with holes, in space, cut into triangles.
namespace throng::importer {

/// Keeps its scratch memory from polygon to polygon: city models have millions of small ones.
class PolygonCutter {
 public:
  /// Ring r has the points ring_first[r] to ring_first[r + 1]; ring 0 is the outer one, the others
  /// are holes; either winding. Corners are appended to `out` as indices into `points`; triangles
  /// face like the outer ring. False if the rings cross so that the area could not be kept exactly:
  /// then `out` holds a best effort. A polygon without area gives triangles without area, so that
  /// it still counts as solid. All corners are used but those that are straight in space. A part
  /// that folds back onto itself, seen along the longest axis of the normal, is lost: faces must be
  /// nearly planar.
  bool cut(std::span<const Vec3d> points, std::span<const uint32_t> ring_first,
           std::vector<std::array<uint32_t, 3>>& out);

 private:
  struct Node {
    Vec2d at;
    uint32_t point = 0;
    uint32_t prev = 0;
    uint32_t next = 0;
    bool alive = false;
  };

  bool project(std::span<const Vec3d> points, std::span<const uint32_t> ring_first);
  uint32_t add_ring(std::span<const uint32_t> ring_first, size_t ring, double sign);
  double ring_area(std::span<const uint32_t> ring_first, size_t ring) const;
  void split_edges_at(uint32_t start, uint32_t hole);
  bool bridge(uint32_t start, uint32_t hole);
  bool sees(uint32_t start, uint32_t from, uint32_t to) const;
  bool opens_towards(uint32_t node, Vec2d target) const;
  bool clip(uint32_t start, std::vector<std::array<uint32_t, 3>>& out);
  bool is_ear(uint32_t node);
  bool bends_in_space(uint32_t node) const;
  bool blocks(uint32_t node, uint32_t ear) const;
  void build_grid(uint32_t start);
  uint32_t remove(uint32_t node);
  void fan(std::span<const uint32_t> ring_first, std::vector<std::array<uint32_t, 3>>& out) const;

  std::span<const Vec3d> points_;
  std::vector<Vec2d> flat_;
  std::vector<Node> nodes_;
  std::vector<uint32_t> holes_;
  std::vector<uint32_t> queue_;
  uint64_t bridge_budget_ = 0;
  uint64_t ear_budget_ = 0;
  double cut_area_ = 0;
  bool straighten_ = false;

  // Nodes by grid cell: cell c owns grid_nodes_[grid_first_[c]] to [grid_first_[c + 1]].
  std::vector<uint32_t> grid_first_;
  std::vector<uint32_t> grid_nodes_;
  Vec2d grid_low_;
  double grid_step_ = 1;
  int32_t grid_width_ = 0;
  int32_t grid_depth_ = 0;
};

}  // namespace throng::importer
