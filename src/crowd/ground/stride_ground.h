// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>

#include "crowd/ground/crowd_ground.h"
#include "crowd/ground/wall_kernel.h"
#include "steer/sampled.h"

/// The moves of a body of a class over the ground.
namespace throng::crowd {

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
  /// continue inside it, and leave it.
  bool move(uint32_t level, int32_t y, world::GroundPoint from, world::GroundPoint to,
            Landing& landing) const;

  /// Is a square of cells, `range` to each side, free of walls? A quick test: false may be wrong.
  [[nodiscard]] bool is_open_around(uint32_t level, world::GroundPoint from, int32_t range) const;

  /// What surrounds a body, up to a square of cells `range` to each side.
  enum class Around : uint8_t {
    kOpen,   // no walls
    kWalls,  // as marked in the window
    kSteps,  // steps matter, or the range exceeds the window: use `free_distance`
  };
  /// For steering alone: on neighbour tiles all floors count that are at most a step and `rise`
  /// higher or lower, whether or not steps lead there. [cells, mm]
  Around query_walls(uint32_t level, int32_t y, world::GroundPoint from, int32_t range,
                     int32_t rise, WallWindow& window) const;

  // As CrowdGround's.
  [[nodiscard]] bool is_level_around(uint32_t level, world::GroundPoint at) const {
    return ground_->is_level_around(level, at);
  }
  [[nodiscard]] GroundSlope slope_along(uint32_t level, world::GroundPoint at,
                                        steer::Plane direction) const {
    return ground_->slope_along(level, at, direction);
  }

  /// Prefetches what is read of the ground around a body, in two calls: the second reads what the
  /// first prefetched.
  void prefetch_level(uint32_t level) const { ground_->prefetch_open(level); }
  void prefetch_cell(uint32_t level, world::GroundPoint at) const {
    ground_->prefetch_cell(level, at.cell_x(), at.cell_z());
  }

  /// Is the straight line between two points legal, or its first `max_range` units? If it is tested
  /// to its end, it must end on `end`.
  [[nodiscard]] bool sees(uint32_t level, world::GroundPoint from, world::GroundPoint to,
                          uint32_t end, float max_range) const;

  /// The distance to a wall along a unit vector, at most `max_range`. [units]
  [[nodiscard]] float free_distance(uint32_t level, world::GroundPoint from, steer::Plane direction,
                                    float max_range) const;

 private:
  bool leave(uint32_t level, int32_t y, world::GroundPoint from, world::GroundPoint to,
             Landing& landing) const;
  [[nodiscard]] bool leaves(uint32_t level, world::GroundPoint from) const;
  world::WalkStop walk_rows(uint32_t& level, world::GroundPoint from, world::GroundPoint to) const;
  bool walk_open(uint32_t& level, world::GroundPoint from, world::GroundPoint to) const;
  [[nodiscard]] bool box_is_open(uint32_t level, int32_t x0, int32_t z0, int32_t x1,
                                 int32_t z1) const;
  [[nodiscard]] uint32_t beyond(uint32_t level, LevelLine::Side side, int32_t low,
                                int32_t high) const;

  const CrowdGround* ground_ = nullptr;
  int32_t step_mm_ = 0;
};

}  // namespace throng::crowd
