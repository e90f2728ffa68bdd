// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "core/random.h"
#include "validate/arrivals.h"
#include "validate/tests.h"

// People that go through a narrow corridor between two rooms in opposite directions.
namespace throng::validate {
namespace {

constexpr double kRoom = 8;         // [m] long and wide, one at each end of the corridor
constexpr double kCrowdTime = 300;  // [s] for 20 against 20
constexpr uint64_t kPlaces = 20;    // where people start, in each room

struct Passage {
  double width, length;  // [m]
  uint64_t each;         // people in each room, at most kPlaces

  [[nodiscard]] TwoRooms rooms() const { return {.side = kRoom, .width = width, .length = length}; }
};

// Those of the first room before those of the second.
Trips trips_of(const Passage& passage, uint64_t seed) {
  Trips trips;
  const double all = passage.rooms().all();
  for (uint64_t n = 0; n < 2 * passage.each; ++n) {
    const bool is_second = n >= passage.each;
    const uint64_t shift = random_below(seed, 1, is_second ? 1 : 0, kPlaces);
    const uint64_t place = (n % passage.each + shift) % kPlaces;  // in rows of four
    const double x = 0.8 + 0.6 * static_cast<double>(place % 4) + 0.08 * random_unit(seed, 2, n);
    const double z = 1 + 1.4 * static_cast<double>(place / 4) + 0.4 * random_unit(seed, 3, n);
    const double off = 0.5 + 2.5 * random_unit(seed, 4, n);  // of the goal from the far wall
    const double across = 0.5 + (kRoom - 1) * random_unit(seed, 5, n);
    trips.starts.push_back({is_second ? all - x : x, z});
    trips.goals.push_back({is_second ? off : all - off, across});
  }
  return trips;
}

// Length of the longest path, over the middles of both ends of the corridor. [m]
double longest_path(const Passage& passage, const Trips& trips) {
  double longest = 0;
  for (size_t n = 0; n < trips.starts.size(); ++n) {
    const bool is_second = n >= passage.each;
    const double near = is_second ? kRoom + passage.length : kRoom;
    const double far = is_second ? kRoom : kRoom + passage.length;
    const Point2 &start = trips.starts[n], &goal = trips.goals[n];
    longest = std::max(longest, std::hypot(near - start.x, kRoom / 2 - start.z) + passage.length +
                                    std::hypot(goal.x - far, goal.z - kRoom / 2));
  }
  return longest;
}

Result<Arrivals> walk_through(const World& world, const Passage& passage,
                              const ValidationConfig& config, ValidationResult& result,
                              Context& context) {
  const Trips trips = trips_of(passage, config.seed);
  const double speed = AvatarClass{}.speed;
  const double limit =
      passage.each == 1 ? (3 * longest_path(passage, trips) + passage.length) / speed : kCrowdTime;
  return walk_trips(world, trips, limit, config, result, context);
}

Result<void> measure_passage(const Passage& passage, uint64_t seeds, const ValidationConfig& config,
                             ValidationResult& result, Context& context) {
  const auto world = bake_plane(two_rooms_plane(passage.rooms()), AvatarClass{}, config, context);
  if (!world) return world.error();
  double all_there = 0, share = 0;
  for (uint64_t k = 0; k < seeds; ++k) {
    ValidationConfig one = config_of_run(config, seeds, k);
    one.workers = 1;  // Few avatars: threads would cost more than they save.
    const auto run = walk_through(*world, passage, one, result, context);
    if (!run) return run.error();
    all_there += run->arrived == 2 * passage.each ? 1 : 0;
    share += static_cast<double>(run->arrived) / static_cast<double>(2 * passage.each * seeds);
  }
  const std::string at = fmt::format("{0} against {0}, {1:.1f} x {2:.0f} m: ", passage.each,
                                     passage.width, passage.length);
  result.measures.push_back({.name = at + "seeds with all there",
                             .value = all_there,
                             .unit = "of " + std::to_string(seeds),
                             .low = static_cast<double>(seeds)});
  result.measures.push_back({.name = at + "arrived", .value = 100 * share, .unit = "%"});
  return {};
}

Result<ValidationResult> passages(const ValidationConfig& config, Context& context) {
  std::vector<double> pair_widths{0.6, 0.7, 0.8, 0.9, 1.0, 1.2, 1.5}, lengths{3, 6};
  std::vector<double> crowd_widths{1.2, 1.4, 1.6};
  if (config.brief) {
    pair_widths = {0.6, 1.0, 1.5};
    lengths = {3};
    crowd_widths = {1.6};
  }
  const uint64_t pair_seeds = config.brief ? 5 : 100, crowd_seeds = config.brief ? 2 : 30;
  ValidationResult result;
  for (const double length : lengths) {
    for (const double width : pair_widths) {
      const Passage passage{.width = width, .length = length, .each = 1};
      const auto done = measure_passage(passage, pair_seeds, config, result, context);
      if (!done) return done.error();
    }
  }
  for (const double width : crowd_widths) {
    const Passage passage{.width = width, .length = 6, .each = kPlaces};
    const auto done = measure_passage(passage, crowd_seeds, config, result, context);
    if (!done) return done.error();
  }
  return result;
}

const std::array<Test, 1> kPassageTests{Test{
    {.name = "motion.passages",
     .title = "People pass each other in corridors 0.6 to 1.6 m wide",
     .method = "A corridor between two rooms of 8 x 8 m, and the default adult. Two people in "
               "opposite directions, corridors 3 and 6 m long, 100 seeds: both must arrive within "
               "three times the time of the longer path at the desired speed, and that of the "
               "corridor's length. 20 against 20, 6 m, 30 seeds: all must arrive within 300 s.",
     .source = "ours: all, with all seeds"},
    passages}};

}  // namespace

std::span<const Test> passage_tests() { return kPassageTests; }

}  // namespace throng::validate
