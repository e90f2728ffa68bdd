// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "graph/ground_parts.h"
#include "path/edits/blocked_cells.h"
#include "path/edits/ground_finder_state.h"
#include "path/ground/blocker.h"
#include "world/tile_grid.h"

// What blocks a straight walk over ground with changes: an obstacle, ground of a kind that is
// closed, or what the bake has. Time: the cells of the line and, in the tile where it ends, the
// obstacles and areas there.
namespace throng::path {
namespace {

bool has_cell(const world::CellRows& rows, int32_t x, int32_t z) {
  return (rows[static_cast<size_t>(z)] >> x & 1) != 0;
}

// Without ground that costs infinity, which searches do not enter either.
struct OpenGround : GroundView::Ground {
  [[nodiscard]] bool is_legal(Level level, int32_t x, int32_t z) const {
    return level->is_legal(x, z) && !mesh.is_closed(*level, x, z);
  }
};

}  // namespace

bool GroundView::is_closed(const ViewLevel& level, int32_t x, int32_t z) const {
  const uint32_t rect =
      rect_at(level, level.tile_x * kTileCells + x, level.tile_z * kTileCells + z);
  return rect != kNoRect && std::isinf(factor(rect));
}

ChangeId GroundView::obstacle_at(const ViewLevel& level, int32_t x, int32_t z) const {
  const auto found = changes_of_tile_.find(tile_key(level.tile_x, level.tile_z));
  if (found == changes_of_tile_.end()) return 0;
  const WorldSummary& summary = world().summary;
  const AvatarClass& avatar = summary.classes[static_cast<size_t>(config_.avatar_class)];
  const TileFloor floor{summary, level.ground.view, level.tile_x, level.tile_z};
  const world::CellRows legal = graph::legal_rows(level.ground);
  for (const ChangeId id : found->second) {
    const Change& change = changes_[id - 1];
    if (!change.active || change.is_area) continue;
    const Solid& solid = change.solid;
    if (has_cell(blocked_cells(floor, avatar, solid.prism, solid.triangles, legal.data()), x, z))
      return id;
  }
  return 0;
}

ChangeId GroundView::area_at(const ViewLevel& level, int32_t x, int32_t z) const {
  const auto found = changes_of_tile_.find(tile_key(level.tile_x, level.tile_z));
  if (found == changes_of_tile_.end()) return 0;
  const TileFloor floor{world().summary, level.ground.view, level.tile_x, level.tile_z};
  ChangeId last = 0;
  for (const ChangeId id : found->second) {
    const Change& change = changes_[id - 1];
    if (!change.active || !change.is_area) continue;
    if (has_cell(cells_in(floor, change.solid.prism), x, z)) last = id;
  }
  return last;
}

FoundBlocker GroundFinder::blocker(const Place& from, const Place& to) {
  ViewStop start, goal;
  if (!state_->locate(from, start) || !state_->locate(to, goal)) return {};
  return state_->blocker(start, goal);
}

FoundBlocker GroundFinder::State::blocker(const ViewStop& start, const ViewStop& goal) {
  const ViewLevel* level = mesh.level(start.level);
  const world::WalkStop stop =
      mesh.closes_kinds()
          ? world::walk_far(OpenGround{{mesh}}, level, start.at, goal.at, mesh.step())
          : world::walk_far(mesh.ground(), level, start.at, goal.at, mesh.step());
  if (stop.arrived) return {Blocker::kGap, 0};  // under or over the goal
  if (const FoundBlocker change = changed_beyond(*level, stop); change.blocker != Blocker::kNone)
    return change;
  return {blocker_beyond({mesh.world(), mesh.avatar_class()}, level->ground, stop), 0};
}

// Of the cells into which the walk did not go, the first that the bake would let it into.
FoundBlocker GroundFinder::State::changed_beyond(const ViewLevel& level,
                                                 const world::WalkStop& stop) {
  const world::WorldGround baked{mesh.world(), mesh.avatar_class()};
  for (const auto& [dx, dz] : {std::pair{stop.toward_x, 0}, std::pair{0, stop.toward_z},
                               std::pair{stop.toward_x, stop.toward_z}}) {
    if (dx == 0 && dz == 0) continue;
    const int32_t x = stop.x + dx, z = stop.z + dz;
    const auto next = world::step_to(baked, level.ground, stop.x, stop.z, x, z, mesh.step());
    if (!next) continue;
    const ViewLevel& there = *mesh.level(next->world_level);
    const int32_t in_x = world::in_tile(x), in_z = world::in_tile(z);
    if (!there.is_legal(in_x, in_z))
      return {Blocker::kObstacle, mesh.obstacle_at(there, in_x, in_z)};
    if (mesh.is_closed(there, in_x, in_z))
      return {Blocker::kClosed, mesh.area_at(there, in_x, in_z)};
  }
  return {};
}

}  // namespace throng::path
