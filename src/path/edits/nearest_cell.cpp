// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "path/edits/nearest_cell.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <tuple>

#include "world/tile_grid.h"

// A search outwards from the goal, in rings of tiles. A component is known for each rectangle of
// the mesh, so nothing is searched from the start. Time: linear in the rectangles of the tiles that
// are nearer than the cell found, and in the cells of those that may hold a nearer one.
namespace throng::path {
namespace {

class Search {
 public:
  Search(const world::WorldData& world, const PathMesh& mesh, GroundView* view, uint32_t component,
         const Stop& goal)
      : world_(world), mesh_(mesh), view_(view), component_(component), goal_(goal.at) {
    const uint32_t level = mesh.rects[goal.rect].level;
    closes_kinds_ = view != nullptr && view->closes_kinds();
    goal_height_ = sample(world::ground_level(world, level, mesh.avatar_class), goal_);
  }

  std::optional<Stop> run() {
    const int32_t x = world::tile_along(goal_.cell_x()), z = world::tile_along(goal_.cell_z());
    const int32_t wide = world::tile_along(world_.width - 1) + 1;
    const int32_t deep = world::tile_along(world_.depth - 1) + 1;
    const int32_t rings = std::max({x, z, wide - 1 - x, deep - 1 - z});
    for (int32_t ring = 0; ring <= rings; ++ring) {
      // The goal lies in the middle tile, so the ring is at least so far away.
      if (static_cast<double>((ring - 1) * kTileCells) > distance_) break;
      for (int32_t tz = std::max(z - ring, 0); tz <= std::min(z + ring, deep - 1); ++tz) {
        const bool whole = std::abs(tz - z) == ring;
        for (int32_t tx = x - ring; tx <= x + ring; tx += whole || ring == 0 ? 1 : 2 * ring) {
          if (tx >= 0 && tx < wide) look_at_tile(tx, tz);
        }
      }
    }
    return best_;
  }

 private:
  static int32_t sample(const world::GroundLevel& level, world::GroundPoint p) {
    return level.view.sample(world::in_tile(p.cell_x()), world::in_tile(p.cell_z()));
  }
  static int64_t clamped(int64_t at, int32_t first, int32_t cells) {
    return std::clamp(at, int64_t{first} << world::kUnitBits,
                      (int64_t{first + cells} << world::kUnitBits) - 1);
  }

  void look_at_tile(int32_t tile_x, int32_t tile_z) {
    const auto levels = world_.tile_levels(tile_x, tile_z);
    const bool is_changed =
        view_ != nullptr && (closes_kinds_ || view_->is_changed(tile_x, tile_z));
    for (uint32_t level = levels.first; level < levels.last; ++level) {
      bool is_read = false;
      for (uint32_t r = mesh_.first[level]; r < mesh_.first[level + 1]; ++r) {
        const MeshRect& rect = mesh_.rects[r];
        if (rect.component != component_) continue;
        const world::GroundPoint near{clamped(goal_.x, rect.x, rect.width),
                                      clamped(goal_.z, rect.z, rect.depth)};
        if (distance_of(near, goal_) > distance_) continue;
        if (!is_read) {
          ground_ = world::ground_level(world_, level, mesh_.avatar_class);
          changed_ = is_changed ? view_->level(level) : nullptr;
          is_read = true;
        }
        look_at_rect(r, near);
      }
    }
  }

  void look_at_rect(uint32_t r, world::GroundPoint near) {
    const MeshRect& rect = mesh_.rects[r];
    // Level with the goal, no other cell of the rectangle is nearer.
    if (look_at_cell(r, near.cell_x(), near.cell_z()) && sample(ground_, near) == goal_height_)
      return;
    for (int32_t z = rect.z; z < rect.z + rect.depth; ++z) {
      const world::GroundPoint row{near.x, clamped(goal_.z, z, 1)};
      if (distance_of(row, goal_) > distance_) continue;
      for (int32_t x = rect.x; x < rect.x + rect.width; ++x) look_at_cell(r, x, z);
    }
  }

  // Is it open? Also true if it is not near enough to matter.
  bool look_at_cell(uint32_t r, int32_t x, int32_t z) {
    const world::GroundPoint at{clamped(goal_.x, x, 1), clamped(goal_.z, z, 1)};
    const double away = distance_of(at, goal_);
    if (away > distance_) return true;
    if (changed_ != nullptr) {
      if (!changed_->is_legal(world::in_tile(x), world::in_tile(z))) return false;
      if (!std::isfinite(view_->factor(view_->rect_at(*changed_, x, z)))) return false;
    }
    const double rise = (sample(ground_, at) - goal_height_) * 1e-3 / world_.summary.cell;
    const double distance = std::sqrt(away * away + rise * rise);
    if (distance > distance_) return true;
    const std::tuple cell{mesh_.rects[r].level, z, x};
    if (distance == distance_ && best_ && cell > cell_) return true;
    distance_ = distance;
    cell_ = cell;
    best_ = {at, r};
    return true;
  }

  const world::WorldData& world_;
  const PathMesh& mesh_;
  GroundView* view_;
  uint32_t component_;
  bool closes_kinds_ = false;
  world::GroundPoint goal_;
  int32_t goal_height_ = 0;  // [mm]
  // Of the level that is looked at.
  world::GroundLevel ground_;
  const ViewLevel* changed_ = nullptr;  // null: as it was baked
  // The nearest so far. [cells]
  double distance_ = std::numeric_limits<double>::infinity();
  std::tuple<uint32_t, int32_t, int32_t> cell_{};
  std::optional<Stop> best_;
};

}  // namespace

std::optional<Stop> nearest_of_component(const world::WorldData& world, const PathMesh& mesh,
                                         GroundView* view, uint32_t component, const Stop& goal) {
  return Search(world, mesh, view, component, goal).run();
}

}  // namespace throng::path
