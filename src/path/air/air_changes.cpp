// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "path/air/air_changes.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "graph/ground_parts.h"
#include "path/air/air_view.h"
#include "path/edits/blocked_cells.h"

// Active obstacles by box of the space and by tile of the ground: a change cuts again only the
// boxes and tiles that it touches.
namespace throng::path {
namespace {

int64_t tile_key(int32_t x, int32_t z) { return (int64_t{z} << 32) | static_cast<uint32_t>(x); }

bool holds(const world::AirCube& outer, const world::AirCube& inner) {
  return inner.x >= outer.x && inner.x < outer.x + outer.side && inner.y >= outer.y &&
         inner.y < outer.y + outer.side && inner.z >= outer.z && inner.z < outer.z + outer.side;
}

}  // namespace

AirChanges::AirChanges(const world::WorldData& world, const FlightSpace& space,
                       int32_t avatar_class)
    : world_(&world),
      space_(&space),
      class_(avatar_class),
      avatar_(&world.summary.classes[static_cast<size_t>(avatar_class)]),
      grid_(world, space.shape, *avatar_),
      splits_(space),
      islands_(space) {}

ChangeId AirChanges::add(Solid solid) {
  Change& change = changes_.emplace_back();
  change.solid = std::move(solid);
  change.near = air_near(grid_, *space_, change.solid.prism);
  const SquareRange near = tiles_near(*world_, change.solid.prism.corners,
                                      taking_reach(*avatar_) + world_->summary.cell);
  for (int32_t z = near.first_z; z <= near.last_z; ++z) {
    for (int32_t x = near.first_x; x <= near.last_x; ++x) {
      const auto tile = world_->tile_levels(x, z);
      if (tile.first != tile.last) change.tiles.push_back(tile_key(x, z));
    }
  }
  const auto id = static_cast<ChangeId>(changes_.size());
  changes_[id - 1].blocks = touch(id);
  count(changes_[id - 1]);
  return id;
}

bool AirChanges::set_active(ChangeId id, bool active) {
  if (id == 0 || id > changes_.size() || changes_[id - 1].removed) return false;
  Change& change = changes_[id - 1];
  if (change.active == active) return true;
  change.active = active;
  touch(id);
  count(change);
  return true;
}

// After it was switched.
void AirChanges::count(const Change& change) {
  if (!change.blocks) return;
  ++version_;
  active_ = change.active ? active_ + 1 : active_ - 1;
  if (active_ == 0) islands_ = AirIslands(*space_);  // nothing is cut off; frees memory
}

bool AirChanges::remove(ChangeId id) {
  if (!set_active(id, false)) return false;
  Change& change = changes_[id - 1];
  change = {};  // Its id is never used again, its memory is freed.
  change.active = false;
  change.removed = true;
  return true;
}

// Cuts the boxes again that a change touches, after it was switched.
bool AirChanges::touch(ChangeId id) {
  const Change& change = changes_[id - 1];
  bool blocks = false;
  for (const int64_t tile : change.tiles) {
    std::vector<ChangeId>& here = of_tile_[tile];
    if (change.active) {
      here.push_back(id);
    } else {
      std::erase(here, id);
    }
    blocks = block_ground(tile, here, id) || blocks;
    if (here.empty()) of_tile_.erase(tile);
  }
  const AirView air(*space_, this);
  space_->boxes_in(change.near, near_);
  touched_.clear();
  for (const uint32_t box : near_) {
    const world::AirCube& cube = space_->boxes[box];
    CubeCells blocked;
    if (!block_air(grid_, cube, change.near, change.solid.prism, change.solid.triangles, blocked))
      continue;
    std::vector<ChangeId>& here = of_box_[box];
    if (change.active) {
      here.push_back(id);
    } else {
      blocked = {};
      std::erase(here, id);
    }
    for (const ChangeId other : here) {
      const Change& of = changes_[other - 1];
      if (other != id) block_air(grid_, cube, of.near, of.solid.prism, of.solid.triangles, blocked);
    }
    if (here.empty()) of_box_.erase(box);
    old_.clear();
    air.for_pieces(box, [&](uint32_t piece) {
      old_.push_back({air.cube(piece), islands_.label(piece)});
    });
    islands_.set_label(box, space_->component[box]);
    splits_.cut(box, blocked);
    label_pieces(box);
    touched_.push_back(box);
  }
  if (change.active) {
    islands_.divide(air, touched_);
  } else {
    islands_.join(air, touched_);
  }
  return blocks || !touched_.empty();
}

// A piece has the label of a former piece that holds it or lies in it.
void AirChanges::label_pieces(uint32_t box) {
  const AirView air(*space_, this);
  air.for_pieces(box, [&](uint32_t piece) {
    uint32_t label = kNoBox;
    const world::AirCube& cube = air.cube(piece);
    for (const Old& old : old_) {
      if (!holds(old.cube, cube) && !holds(cube, old.cube)) continue;
      label = old.label;
      break;
    }
    islands_.set_label(piece, label);
  });
}

// The cells that obstacles block on every level of a tile.
bool AirChanges::block_ground(int64_t tile, std::span<const ChangeId> here, ChangeId of) {
  bool blocks = false;
  const auto x = static_cast<int32_t>(tile), z = static_cast<int32_t>(tile >> 32);
  const auto levels = world_->tile_levels(x, z);
  for (uint32_t i = levels.first; i < levels.last; ++i) {
    const world::GroundLevel level = world::ground_level(*world_, i, class_);
    if (level.zone == nullptr) continue;
    const world::CellRows legal = graph::legal_rows(level);
    world::CellRows blocked{};
    uint64_t any = 0;
    for (const ChangeId id : here) {
      const Change& change = changes_[id - 1];
      const world::CellRows own =
          blocked_cells({world_->summary, level.view, x, z}, *avatar_, change.solid.prism,
                        change.solid.triangles, legal.data());
      for (size_t row = 0; row < own.size(); ++row) {
        any |= blocked[row] |= own[row];
        blocks = blocks || (id == of && own[row] != 0);
      }
    }
    if (any != 0) {
      blocked_[i] = blocked;
    } else {
      blocked_.erase(i);
    }
  }
  return blocks;
}

ChangeId AirChanges::obstacle_at(uint32_t box, AirPoint p) const {
  const auto here = of_box_.find(box);
  if (here == of_box_.end()) return 0;
  const auto whole = [](double value) { return static_cast<int32_t>(std::floor(value)); };
  const world::AirCube voxel{whole(p.x), whole(p.y), whole(p.z), 1};
  for (const ChangeId id : here->second) {
    const Change& of = changes_[id - 1];
    CubeCells blocked;
    if (block_air(grid_, voxel, of.near, of.solid.prism, of.solid.triangles, blocked)) return id;
  }
  return 0;
}

void AirChanges::add_all_to(GroundFinder& ground, std::vector<ChangeId>& ids) const {
  ids.clear();
  for (const Change& change : changes_) {
    if (change.removed) {
      ids.push_back(0);
      continue;
    }
    ids.push_back(ground.add_obstacle(change.solid));
    ground.set_active(ids.back(), change.active);
  }
}

}  // namespace throng::path
