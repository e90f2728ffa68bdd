// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "path/ground/sight.h"

#include <algorithm>
#include <cmath>

#include "core/arrays/prefetch.h"
#include "path/ground/border.h"

// The search of path/ground/search.cpp without its turns: intervals of portals are pushed on as
// long as something is seen through them. Time: linear in the intervals and their rectangles'
// portals, but for sorting what is seen.
namespace throng::path {

void Sight::begin(const PathMesh& mesh, CellPoint from, uint32_t goal, CellPoint goal_point) {
  mesh_ = &mesh;
  from_ = from;
  own_ = kNoCorner;
  goal_ = goal;
  goal_point_ = goal_point;
  sees_goal_ = false;
  in_triangle_ = with_blocks_ = false;
  views_.clear();
  noted_.clear();
  seen_.clear();
  blocks_.clear();
  entered_.clear();
}

void Sight::cast(const PathMesh& mesh, uint32_t rect, CellPoint from, uint32_t goal,
                 CellPoint goal_point) {
  begin(mesh, from, goal, goal_point);
  rects_around(mesh, rect, from, around_);
  for (const uint32_t r : around_) start(r);
  run();
  finish();
}

void Sight::cast_from_corner(const PathMesh& mesh, uint32_t corner, bool with_blocks) {
  const MeshCorner& at = mesh.corners[corner];
  begin(mesh, {double(at.x), double(at.z)}, kNoRect, {});
  own_ = corner;
  with_blocks_ = with_blocks;
  for (uint32_t r = at.first_rect; r < mesh.corners[corner + 1].first_rect; ++r)
    start(mesh.corner_rects[r]);
  run();
  finish();
}

void Sight::cast_into(const PathMesh& mesh, uint32_t corner, uint32_t rect, CellPoint from,
                      CellPoint right, CellPoint left) {
  begin(mesh, from, kNoRect, {});
  in_triangle_ = true;
  right_ = right;
  left_ = left;
  if (corner != kNoCorner) {
    const uint32_t end = mesh.corners[corner + 1].first_rect;
    for (uint32_t r = mesh.corners[corner].first_rect; r < end; ++r) start(mesh.corner_rects[r]);
  } else {
    rects_around(mesh, rect, from, around_);
    for (const uint32_t r : around_) start(r);
  }
  run();
  finish();
}

// True if nothing seen between two points of a line can lie in the triangle: both lie beyond its
// far side, or what is between them lies to its right, to its left or behind the eye.
bool Sight::is_outside(CellPoint right, CellPoint left) const {
  if (cross(right_, left_, right) < -kSame && cross(right_, left_, left) < -kSame) return true;
  const auto is_right = [&](CellPoint p) { return cross(from_, right_, p) < -kSame; };
  const auto is_left = [&](CellPoint p) { return cross(from_, left_, p) > kSame; };
  if (is_right(left) && !is_left(left)) return true;
  if (is_left(right) && !is_right(right)) return true;
  return is_right(left) && is_left(left) && is_right(right) && is_left(right);
}

void Sight::start(uint32_t rect_index) {
  if (is_kept_out(rect_index)) return;
  const auto portals = mesh_->portals_of(rect_index);
  const MeshRect& rect = mesh_->rects[rect_index];
  if (rect_index == goal_) sees_goal_ = true;
  if (with_blocks_) {
    for (uint32_t b = rect.first_block; b < mesh_->rects[rect_index + 1].first_block; ++b)
      blocks_.push_back({b, true});
  }
  for (const MeshPortal& portal : portals) add(rect, portal, portal.from, portal.to);
}

// Most of the time is the wait for the mesh's bytes: they are prefetched as soon as it is known
// which, and views and corners are processed in the order of their prefetches.
void Sight::run() {
  constexpr size_t kForgetFrom = 1 << 14;
  for (size_t i = 0; i < views_.size(); ++i) {
    if (i >= kForgetFrom && i * 2 >= views_.size()) {  // Views that were expanded are not kept.
      views_.erase(views_.begin(), views_.begin() + static_cast<ptrdiff_t>(i));
      i = 0;
    }
    if (i + 1 < views_.size())
      prefetch(mesh_->portals.data() + mesh_->rects[views_[i + 1].rect].first_portal);
    expand(View(views_[i]));
  }
}

void Sight::note(uint32_t corner) {
  if (corner == kNoCorner || corner == own_) return;
  prefetch(&mesh_->corners[corner]);
  noted_.push_back(corner);
}

void Sight::see(uint32_t corner) {
  const MeshCorner& at = mesh_->corners[corner];
  const double dx = at.x - from_.x, dz = at.z - from_.z;
  const CellPoint point{double(at.x), double(at.z)};
  if (!is_taut(at, dx, dz) || (in_triangle_ && is_outside(point, point))) return;
  if (own_ != kNoCorner && !is_taut(mesh_->corners[own_], dx, dz)) return;
  seen_.push_back({corner, std::sqrt(dx * dx + dz * dz)});
}

void Sight::find_blocks() {
  std::sort(entered_.begin(), entered_.end(), [&](const View& a, const View& b) {
    if (a.rect != b.rect) return a.rect < b.rect;
    return cross(from_, a.right, b.right) > 0;
  });
  for (size_t i = 0; i < entered_.size();) {
    size_t end = i;
    while (end < entered_.size() && entered_[end].rect == entered_[i].rect) ++end;
    judge_blocks({entered_.data() + i, end - i});
    i = end;
  }
  std::sort(blocks_.begin(), blocks_.end(), [](const SeenBlock& a, const SeenBlock& b) {
    return a.block != b.block ? a.block < b.block : a.whole > b.whole;
  });
  const auto last =
      std::unique(blocks_.begin(), blocks_.end(),
                  [](const SeenBlock& a, const SeenBlock& b) { return a.block == b.block; });
  blocks_.erase(last, blocks_.end());
}

// A ray enters a rectangle once. So all of a block of it is seen if the views that lead into the
// rectangle, from right to left, cover side by side all directions in which the block lies.
void Sight::judge_blocks(std::span<const View> views) {
  const uint32_t r = views.front().rect;
  const uint32_t count = mesh_->rects[r + 1].first_block - mesh_->rects[r].first_block;
  for (uint32_t n = 0; n < count; ++n) {
    const MeshRect block = mesh_->block(r, n);
    const double x0 = block.x, x1 = block.x + block.width;
    const double z0 = block.z, z1 = block.z + block.depth;
    CellPoint right{x0, z0}, left{x0, z0};
    for (const CellPoint p : {CellPoint{x1, z0}, CellPoint{x1, z1}, CellPoint{x0, z1}}) {
      if (cross(from_, right, p) < 0) right = p;
      if (cross(from_, left, p) > 0) left = p;
    }
    bool whole = true, some = false;
    CellPoint covered = right;
    for (const View& view : views) {
      if (cross(from_, right, view.left) < -kSame || cross(from_, left, view.right) > kSame)
        continue;
      some = true;
      whole = whole && cross(from_, covered, view.right) <= kSame;
      if (cross(from_, covered, view.left) > 0) covered = view.left;
    }
    whole = whole && cross(from_, covered, left) <= kSame;
    if (some) blocks_.push_back({mesh_->rects[r].first_block + n, whole});
  }
}

void Sight::finish() {
  for (const uint32_t corner : noted_) see(corner);
  if (with_blocks_) find_blocks();
  std::sort(seen_.begin(), seen_.end(),
            [](const SeenCorner& a, const SeenCorner& b) { return a.corner < b.corner; });
  seen_.erase(
      std::unique(seen_.begin(), seen_.end(),
                  [](const SeenCorner& a, const SeenCorner& b) { return a.corner == b.corner; }),
      seen_.end());
}

void Sight::add(const MeshRect& rect, const MeshPortal& portal, double from, double to) {
  const bool whole_from = from <= portal.from + kSame, whole_to = to >= portal.to - kSame;
  if (to - from < -kSame) return;
  if (whole_from) note(portal.from_corner);
  if (whole_to) note(portal.to_corner);
  if (!(to - from > kSame) || is_kept_out(portal.rect)) return;
  View view;
  view.right = point_around(rect, whole_from ? portal.from : from);
  view.left = point_around(rect, whole_to ? portal.to : to);
  view.rect = portal.rect;
  if (in_triangle_ && is_outside(view.right, view.left)) return;
  if (own_ != kNoCorner) {
    // No shortest path leaves a corner into the quarter across from its missing cell.
    const MeshCorner& own = mesh_->corners[own_];
    const auto is_across = [&](CellPoint p) {
      return (p.x - from_.x) * own.away_x > kSame && (p.z - from_.z) * own.away_z > kSame;
    };
    if (is_across(view.left) && is_across(view.right)) return;
  }
  prefetch(&mesh_->rects[view.rect]);
  views_.push_back(view);
}

void Sight::expand(const View& view) {
  const auto portals = mesh_->portals_of(view.rect);
  const MeshRect& rect = mesh_->rects[view.rect];
  const double whole = perimeter(rect);
  const double width = distance(view.left, view.right);
  const double base = around(rect, view.right);
  const double last = whole - width;
  const auto from_base = [&](double at) {
    const double rest = at - base;
    return rest < -kSame ? rest + whole : std::max(rest, 0.0);
  };
  double first_seen = 0, last_seen = last;
  // Edge on nothing is seen, and start() covered what is around the eye itself.
  if (std::fabs(cross(view.right, view.left, from_)) <= kSame * width) return;
  if (!runs_along(rect, from_, view.right))
    first_seen = from_base(exit_around(rect, from_, view.right));
  if (!runs_along(rect, from_, view.left))
    last_seen = from_base(exit_around(rect, from_, view.left));
  last_seen = std::max(last_seen, first_seen);
  if (with_blocks_) entered_.push_back(view);
  if (view.rect == goal_ && !sees_goal_) {
    sees_goal_ = cross(from_, view.right, goal_point_) >= -kSame &&
                 cross(from_, view.left, goal_point_) <= kSame;
  }
  for (const MeshPortal& portal : portals) {
    const double first = from_base(portal.from), stop = first + (portal.to - portal.from);
    const auto piece = [&](double a, double b, double offset) {
      a = std::max({a, 0.0, first_seen});
      b = std::min({b, last, last_seen});
      add(rect, portal, a + offset, b + offset);
    };
    piece(first, std::min(stop, whole), portal.from - first);
    if (stop > whole + kSame) piece(0, stop - whole, portal.from - first + whole);
  }
}

}  // namespace throng::path
