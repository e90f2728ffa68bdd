// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include "path/air/air_islands.h"
#include "path/air/blocked_air.h"
#include "path/air/split_boxes.h"
#include "path/edits/ground_finder.h"
#include "path/edits/solid.h"
#include "throng/path.h"
#include "world/cell_blocks.h"
#include "world/ground.h"
#include "world/tile_grid.h"

/// Obstacles placed in the air of a class since it was made.
namespace throng::path {

/// The space itself stays as it is. An AirView shows both. A change cuts again only the boxes that
/// it touches.
class AirChanges {
 public:
  /// The world and the space outlive it.
  AirChanges(const world::WorldData& world, const FlightSpace& space, int32_t avatar_class);

  ChangeId add(Solid solid);
  /// False if there is none of that id.
  bool set_active(ChangeId change, bool active);
  bool remove(ChangeId change);

  /// Does an active obstacle block any air or ground?
  [[nodiscard]] bool any() const { return active_ > 0; }
  /// Rises with every change of an obstacle that does.
  [[nodiscard]] uint64_t version() const { return version_; }
  [[nodiscard]] const SplitBoxes& splits() const { return splits_; }
  [[nodiscard]] const AirIslands& islands() const { return islands_; }
  /// May the class stand on a legal cell of the grid, as far as obstacles permit?
  [[nodiscard]] bool may_stand(uint32_t level, int32_t x, int32_t z) const {
    const auto found = blocked_.find(level);
    return found == blocked_.end() ||
           (found->second[static_cast<size_t>(world::in_tile(z))] >> world::in_tile(x) & 1) == 0;
  }
  /// An active obstacle that blocks the voxel around a point of a box of the space; 0: none does.
  [[nodiscard]] ChangeId obstacle_at(uint32_t box, AirPoint p) const;
  /// Adds all obstacles to a ground of the class that has none of them yet; `ids`: their ids there,
  /// by id - 1.
  void add_all_to(GroundFinder& ground, std::vector<ChangeId>& ids) const;

 private:
  struct Change {
    Solid solid;
    AirRange near;
    bool active = true, removed = false;
    bool blocks = false;         // any air or ground
    std::vector<int64_t> tiles;  // of the ground
  };
  /// Does it block any air or ground? [it is active]
  bool touch(ChangeId id);
  void count(const Change& change);
  void label_pieces(uint32_t box);
  /// True if that one blocks a cell of the tile.
  bool block_ground(int64_t tile, std::span<const ChangeId> here, ChangeId of);

  const world::WorldData* world_;
  const FlightSpace* space_;
  int32_t class_;
  const AvatarClass* avatar_;
  AirGrid grid_;
  SplitBoxes splits_;
  AirIslands islands_;
  std::vector<Change> changes_;
  size_t active_ = 0;  // of those that block
  uint64_t version_ = 0;
  // Active ones, by box of the space and by tile of the ground; looked up only.
  std::unordered_map<uint32_t, std::vector<ChangeId>> of_box_;
  std::unordered_map<int64_t, std::vector<ChangeId>> of_tile_;
  std::unordered_map<uint32_t, world::CellRows>
      blocked_;                           // by level of the world that has such cells
  std::vector<uint32_t> near_, touched_;  // boxes
  struct Old {
    world::AirCube cube;
    uint32_t label;
  };
  std::vector<Old> old_;  // pieces of a box before a change
};

}  // namespace throng::path
