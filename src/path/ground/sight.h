// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "path/ground/mesh.h"

/// The corners and blocks that are seen from a point of the ground.
namespace throng::path {

/// A block of which something may be seen; `whole` if all of it is.
struct SeenBlock {
  uint32_t block = 0;
  bool whole = false;
};

struct SeenCorner {
  uint32_t corner = kNoCorner;
  double distance = 0;  // cells
};

/// True if a shortest path may come to the corner along (dx, dz) or leave it in that direction: the
/// line through the corner passes the missing cell by.
inline bool is_taut(const MeshCorner& corner, double dx, double dz) {
  return dx * corner.away_x * (dz * corner.away_z) <= 0;
}

/// Casts over a mesh along straight lines. Owns its memory: one per thread.
class Sight {
 public:
  /// From now on, casts into rectangles [first, last) only.
  void stay_within(uint32_t first_rect, uint32_t last_rect) {
    first_rect_ = first_rect;
    last_rect_ = last_rect;
  }
  /// The corners that are seen from a point of a rectangle and that a path may turn at; each once,
  /// by number. If `goal` is a rectangle, also whether `goal_point` in it is seen.
  void cast(const PathMesh& mesh, uint32_t rect, CellPoint from, uint32_t goal,
            CellPoint goal_point);
  /// The corners that are seen from a corner, along lines that may turn at both.
  void cast_from_corner(const PathMesh& mesh, uint32_t corner, bool with_blocks);

  /// The corners that are seen from a point, or from `corner` if that is one, in the triangle of
  /// it, `right` and `left`; of those beyond, some.
  void cast_into(const PathMesh& mesh, uint32_t corner, uint32_t rect, CellPoint from,
                 CellPoint right, CellPoint left);

  [[nodiscard]] const std::vector<SeenCorner>& corners() const { return seen_; }
  [[nodiscard]] bool sees_goal() const { return sees_goal_; }
  /// Blocks of which something may be seen from the corner, by number.
  [[nodiscard]] const std::vector<SeenBlock>& blocks() const { return blocks_; }

 private:
  struct View {
    CellPoint left, right;
    uint32_t rect = kNoRect;
  };

  void begin(const PathMesh& mesh, CellPoint from, uint32_t goal, CellPoint goal_point);
  void start(uint32_t rect);
  void run();
  void expand(const View& view);
  void add(const MeshRect& rect, const MeshPortal& portal, double from, double to);
  void note(uint32_t corner);
  void see(uint32_t corner);
  [[nodiscard]] bool is_outside(CellPoint right, CellPoint left) const;
  void finish();
  void find_blocks();
  void judge_blocks(std::span<const View> views);

  [[nodiscard]] bool is_kept_out(uint32_t rect) const {
    return rect < first_rect_ || rect >= last_rect_;
  }

  const PathMesh* mesh_ = nullptr;
  uint32_t first_rect_ = 0, last_rect_ = kNoRect;
  CellPoint from_;
  uint32_t own_ = kNoCorner;  // the corner that is cast from
  uint32_t goal_ = kNoRect;
  CellPoint goal_point_;
  bool sees_goal_ = false;
  bool with_blocks_ = false;
  bool in_triangle_ = false;  // only what lies in that of from_, right_ and left_
  CellPoint right_, left_;
  std::vector<uint32_t> around_;
  std::vector<View> views_;
  std::vector<uint32_t> noted_;  // corners on what is seen
  std::vector<SeenCorner> seen_;
  std::vector<SeenBlock> blocks_;
  std::vector<View> entered_;  // views that have led into a rectangle
};

}  // namespace throng::path
