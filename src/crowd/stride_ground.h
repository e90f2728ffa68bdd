// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>

#include "crowd/crowd_ground.h"
#include "crowd/wall_kernel.h"
#include "steer/sampled.h"

/// What the ground lets a body of a class do.
namespace throng {

class StrideGround {
 public:
  StrideGround() = default;  ///< Of no class: to be set.
  StrideGround(const CrowdGround& ground, int32_t step_mm) : ground_(&ground), step_mm_(step_mm) {}

  /// Where a step ended.
  struct Landing {
    uint32_t level = 0;
    int32_t y = 0;  // feet [mm]
  };
  /// The conservative move of algorithm 1 ([ML06]) from one point to another: every cell between is
  /// legal, and no step is too high. False: there is a wall. A body in an obstacle that closes may
  /// go on in it, and out.
  bool move(uint32_t level, int32_t y, GroundPoint from, GroundPoint to, Landing& landing) const;

  /// Is there no wall, as far as a quick look tells, up to a square of cells `range` to each side?
  [[nodiscard]] bool is_open_around(uint32_t level, GroundPoint from, int32_t range) const;

  /// What there is around a body, up to a square of cells `range` to each side.
  enum class Around : uint8_t {
    kOpen,   // no walls
    kWalls,  // as the window has them
    kSteps,  // steps matter, or it is too far for a window: ask `free_distance`
  };
  /// For steering alone: on tiles beside its own a floor counts that is up to a step and `rise`
  /// higher or lower, whether or not steps lead there. [cells, mm]
  Around query_walls(uint32_t level, int32_t y, GroundPoint from, int32_t range, int32_t rise,
                     WallWindow& window) const;

  /// Asks for what is read of the ground around a body, in two goes: the second reads what the
  /// first asks for.
  void prefetch_level(uint32_t level) const { ground_->prefetch_open(level); }
  void prefetch_cell(uint32_t level, GroundPoint at) const {
    ground_->prefetch_cell(level, at.cell_x(), at.cell_z());
  }

  /// Is the straight way from a point to another legal, or its first `max_range` units? Where it is
  /// all looked at, it must end on `end`.
  [[nodiscard]] bool sees(uint32_t level, GroundPoint from, GroundPoint to, uint32_t end,
                          float max_range) const;

  /// How far it is to a wall along a unit vector, at most `max_range`. [units]
  [[nodiscard]] float free_distance(uint32_t level, GroundPoint from, steer::Plane direction,
                                    float max_range) const;

 private:
  bool leave(uint32_t level, int32_t y, GroundPoint from, GroundPoint to, Landing& landing) const;
  [[nodiscard]] bool leaves(uint32_t level, GroundPoint from) const;
  WalkStop walk_rows(uint32_t& level, GroundPoint from, GroundPoint to) const;
  bool walk_open(uint32_t& level, GroundPoint from, GroundPoint to) const;
  [[nodiscard]] bool box_is_open(uint32_t level, int32_t x0, int32_t z0, int32_t x1,
                                 int32_t z1) const;
  [[nodiscard]] uint32_t beyond(uint32_t level, LevelLine::Side side, int32_t low,
                                int32_t high) const;

  const CrowdGround* ground_ = nullptr;
  int32_t step_mm_ = 0;
};

}  // namespace throng
