// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "world/ground.h"
#include "world/place.h"

/// The cells around a place that are connected to it.
namespace throng::path {

/// Cells that are connected to a first one over cells that touch a circle, each once, nearest first
/// in number of cells crossed. Owns its memory: no allocation once it has grown.
class CircleFlood {
 public:
  struct Cell {
    world::GroundLevel level;
    int32_t x = 0, z = 0;  // of the grid
  };

  /// Restarts at a cell that is legal for the ground's class. The circle may shrink meanwhile.
  void start(const world::GroundLevel& level, int32_t x, int32_t z);
  /// Calls visit(cell) for every cell, then blocked(cell, toward_x, toward_z) for each side of it
  /// over which no step leads. within(x, z): is that cell of the grid still wanted? open(level, x,
  /// z): may this legal one be stood on?
  template <class Within, class Visit, class Blocked, class Open>
  void run(const world::WorldGround& ground, int32_t step, Within within, Visit visit,
           Blocked blocked, Open open) {
    uint64_t all = UINT64_MAX;
    advance(ground, step, all, within, visit, blocked, open);
  }

  /// The same in parts: visits `cells` cells at most, and takes those that it visits from it.
  /// False: call it again.
  template <class Within, class Visit, class Blocked, class Open>
  bool advance(const world::WorldGround& ground, int32_t step, uint64_t& cells, Within within,
               Visit visit, Blocked blocked, Open open) {
    constexpr int32_t kSides[4][2] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}};
    for (; next_ < cells_.size(); ++next_) {
      const Cell cell = cells_[next_];
      if (!within(cell.x, cell.z)) continue;
      if (cells == 0) return false;
      --cells;
      visit(cell);
      for (const auto& side : kSides) {
        const int32_t x = cell.x + side[0], z = cell.z + side[1];
        const auto next = world::step_to(ground, cell.level, cell.x, cell.z, x, z, step);
        if (!next) {
          blocked(cell, side[0], side[1]);
        } else if (within(x, z) && open(*next, x, z) && add_once(next->world_level, x, z)) {
          cells_.push_back({*next, x, z});
        }
      }
    }
    return true;
  }

  template <class Within, class Visit, class Blocked>
  void run(const world::WorldGround& ground, int32_t step, Within within, Visit visit,
           Blocked blocked) {
    run(ground, step, within, visit, blocked,
        [](const world::GroundLevel&, int32_t, int32_t) { return true; });
  }

 private:
  bool add_once(uint32_t level, int32_t x, int32_t z);
  void grow();

  std::vector<Cell> cells_;
  size_t next_ = 0;             // of these, to be visited
  std::vector<uint64_t> seen_;  // open addressing; 0 is free
};

}  // namespace throng::path
