// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "validate/maze.h"
#include "validate/tests.h"

// People that meet in random mazes: one has to wait in a passing place, or to walk back to one.
namespace throng::validate {
namespace {

constexpr uint64_t kMazes = 1000, kBriefMazes = 3;
constexpr uint64_t kPeople = 30;
constexpr double kMazeTime = 600;  // [s] in which all must arrive

// Walks people through `count` mazes.
Result<ValidationResult> walk_mazes(uint64_t count, const ValidationConfig& config,
                                    Context& context) {
  ValidationResult result;
  double all_there = 0, arrived = 0, slowest = 0, first_missed = std::nan("");
  for (uint64_t k = 0; k < count; ++k) {
    ValidationConfig one = config_of_run(config, count, k);
    const Maze maze = make_maze(one.seed);
    const auto world = bake_plane(maze.plane, AvatarClass{}, one, context);
    if (!world) return world.error();
    one.workers = 1;  // Few avatars: threads would cost more than they save.
    const Trips trips = maze_trips(maze, kPeople, one.seed);
    const auto run = walk_trips(*world, trips, kMazeTime, one, result, context);
    if (!run) return run.error();
    arrived += static_cast<double>(run->arrived);
    if (run->arrived == kPeople) {
      all_there += 1;
      slowest = std::max(slowest, run->last);
    } else if (std::isnan(first_missed)) {
      first_missed = static_cast<double>(one.seed);
    }
  }
  const auto people = static_cast<double>(count * kPeople);
  result.measures = {
      {.name = "mazes with all there",
       .value = all_there,
       .unit = "of " + std::to_string(count),
       .low = static_cast<double>(count)},
      {.name = "arrived", .value = 100 * arrived / people, .unit = "%"},
      {.name = "longest time until all were there", .value = slowest, .unit = "s"},
      {.name = "seed of the first other maze", .value = first_missed},
  };
  return result;
}

Result<ValidationResult> mazes(const ValidationConfig& config, Context& context) {
  return walk_mazes(config.brief ? kBriefMazes : kMazes, config, context);
}

const std::array<Test, 1> kMazeTests{
    Test{{.name = "motion.mazes",
          .title = "30 people in each of 1000 mazes whose corridors are one body wide",
          .method = "8 x 8 blocks of 2.4 m, connected by a random tree and some corridors more, "
                    "0.6 m wide; dead ends, junctions and half of the other blocks are passing "
                    "places of 1.4 x 1.4 m. Default adults start in the middles of different "
                    "passing places, go to others, and leave where they have arrived.",
          .source = "ours: in each maze all arrive within 600 s",
          .in_work = true},
         mazes}};

}  // namespace

std::span<const Test> maze_tests() { return kMazeTests; }

}  // namespace throng::validate
