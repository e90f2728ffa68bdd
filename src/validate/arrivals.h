// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "validate/plane_crowd.h"

/// People that walk to one goal each: how many arrive in time.
namespace throng::validate {

/// Where people start and where they go, equally many. [m]
struct Trips {
  std::vector<Point2> starts, goals;
};

/// How many arrived.
struct Arrivals {
  size_t arrived = 0;
  double last = 0;  ///< When the last of these arrived. [s]
};

/// Lets people with the desired speed of their class walk until all have arrived, or `limit` [s]
/// has gone by. Each leaves where it has arrived. Adds the faults to `result`. Fails as Crowd::add
/// does, with kBadConfig (no room at a start, or no avatar can stand at a goal), and kCancelled.
Result<Arrivals> walk_trips(const World& world, const Trips& trips, double limit,
                            const ValidationConfig& config, ValidationResult& result,
                            Context& context);

/// Adds two measures: how many arrived, which passes only if all of `people` did, and when the last
/// did; NaN unless all did. `at` ends their names.
void add_arrivals(const Arrivals& run, size_t people, const std::string& at,
                  ValidationResult& result);

/// The settings for run `k` of `runs` (from 0): no seed belongs to two runs, nor to runs of two
/// seeds of `config`.
ValidationConfig config_of_run(const ValidationConfig& config, uint64_t runs, uint64_t k);

/// Two square rooms, one after the other along X, and what leads through the wall between them.
struct TwoRooms {
  double side = 8;    ///< Of each room. [m, > 0]
  double width = 1;   ///< Of the corridor or door, in the middle of the wall. [m, > 0, < side]
  double length = 1;  ///< Thickness of the wall. [m, > 0]

  [[nodiscard]] double all() const { return 2 * side + length; }  ///< From end to end. [m]
};

/// The ground of two rooms, from (0, 0) to (all, side).
PlaneConfig two_rooms_plane(const TwoRooms& rooms);

}  // namespace throng::validate
