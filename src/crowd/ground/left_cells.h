// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <unordered_map>
#include <vector>

#include "crowd/ground/air_obstacle.h"
#include "throng/world.h"
#include "world/cell_blocks.h"
#include "world/ground.h"

/// Cells that obstacles block for a class while bodies stand on them: such a body may continue over
/// the cells of the obstacles in which it stands, and leave them. For all others these cells are
/// walls.
namespace throng::crowd {

class LeftCells {
 public:
  using Level = uint32_t;  // of the world

  /// In place of an obstacle: what a density map blocks.
  static constexpr uint32_t kZeroWeight = UINT32_MAX;
  /// An obstacle, and its cells on a level.
  struct Part {
    uint32_t obstacle = 0;
    world::CellRows rows{};
    std::optional<AirObstacle> solid = {};  // none: its cells say all
  };
  struct Cell {
    Level level = 0;
    int32_t x = 0, z = 0;  // of the tile
  };

  /// For which bodies, in which world; levels stay.
  void begin(const WorldSummary& summary, const AvatarClass& avatar);
  [[nodiscard]] Part part(uint32_t obstacle, const Prism& prism,
                          const world::CellRows& rows) const {
    return {obstacle, rows, AirObstacle(prism, origin_, unit_)};
  }
  /// `kept`: the cells that other obstacles block there. Without parts: the level has no such
  /// cells.
  void set_level(Level level, std::vector<Part> parts, const world::CellRows& kept);

  [[nodiscard]] bool is_empty() const { return levels_.empty(); }
  [[nodiscard]] bool holds(const Cell& cell) const;
  /// Appends the obstacles whose cells contain the cell, or kZeroWeight.
  void list_obstacles(const Cell& cell, std::vector<uint32_t>& obstacles) const;
  /// May a body that stands on the cell `from` cross a cell that was legal before it was blocked?
  [[nodiscard]] bool may_cross(const Cell& from, const Cell& over) const;
  /// Would a body that stands on a cell enter, between two points, an obstacle in which it is not,
  /// though it stands on one of that obstacle's cells? Y: the feet.
  [[nodiscard]] bool enters(const Cell& cell, const AirPosition& from, const AirPosition& to) const;

  /// Steps from a cell to an exit, by cells; kNone: there is none.
  static constexpr uint16_t kNone = UINT16_MAX;
  [[nodiscard]] uint16_t steps_out(const Cell& cell) const;
  /// Is the cell of weight 0?
  [[nodiscard]] bool is_zero(const Cell& cell) const;

 private:
  friend class ExitSearch;
  struct OfLevel {
    std::vector<Part> parts;
    world::CellRows held{};  // the cells of all parts
    world::CellRows kept{};
    std::array<uint16_t, 4096> steps{};
  };
  [[nodiscard]] const OfLevel* find(Level level) const {
    const auto found = levels_.find(level);
    return found == levels_.end() ? nullptr : &found->second;
  }

  std::unordered_map<Level, OfLevel> levels_;  // looked up only
  Vec3d origin_;
  double unit_ = 0, radius_ = 0;     // [m]
  int32_t bottom_ = 0, height_ = 0;  // of a body, above its feet [mm]
};

}  // namespace throng::crowd
