// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "validate/arrivals.h"

/// Random mazes whose corridors are one body wide.
namespace throng::validate {

/// A maze of square blocks: corridors 0.6 m wide lead from block to block, and squares of 1.4 m,
/// the passing places, have room for two bodies of 0.5 m.
struct Maze {
  PlaneConfig plane;
  /// Middles of the passing places, block by block. Each dead end, each junction and about half of
  /// the other blocks are one.
  std::vector<Point2> places;
};

/// Makes a maze of 8 x 8 blocks, all connected, with 36 passing places or more. A few corridors
/// close loops.
Maze make_maze(uint64_t seed);

/// Trips between passing places: no two start at the same one, no two go to the same one, and none
/// goes to where it starts. [people: at most the number of places]
Trips maze_trips(const Maze& maze, uint64_t people, uint64_t seed);

}  // namespace throng::validate
