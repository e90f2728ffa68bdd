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

// Two streams in opposite directions: through a door, two long columns in a corridor, and a
// corridor into which people come from both ends.
namespace throng::validate {
namespace {

constexpr double kDoorTime = 300;       // [s] in which all must be through
constexpr double kCorridorTime = 1000;  // [s] in which both columns must have arrived
constexpr double kFeedTime = 240;       // [s] for which people come
constexpr double kClearTime = 60;       // [s] after which the last must have left
constexpr double kFeedRate = 2;         // [p/s] from each side

// The point half around the middle of two rooms.
Point2 half_around(Point2 p, const TwoRooms& rooms) {
  return {rooms.all() - p.x, rooms.side - p.z};
}

// As many in each room, a metre apart, and goals beside the far wall of the other room.
Trips door_trips(const TwoRooms& rooms, uint64_t each, uint64_t seed) {
  constexpr uint64_t kInRow = 10;
  constexpr double kMoved = 0.2;  // [m] along each axis, at most
  Trips trips;
  for (uint64_t n = 0; n < 2 * each; ++n) {
    const uint64_t place = n / 2;
    const Point2 start{
        2 + static_cast<double>(place / kInRow) + kMoved * (2 * random_unit(seed, 1, n) - 1),
        1.5 + static_cast<double>(place % kInRow) + kMoved * (2 * random_unit(seed, 2, n) - 1)};
    const Point2 goal{rooms.all() - 0.5 - 2.5 * random_unit(seed, 3, n),
                      0.5 + (rooms.side - 1) * random_unit(seed, 4, n)};
    trips.starts.push_back(n % 2 == 0 ? start : half_around(start, rooms));
    trips.goals.push_back(n % 2 == 0 ? goal : half_around(goal, rooms));
  }
  return trips;
}

Result<void> through_door(const ValidationConfig& config, ValidationResult& result,
                          Context& context) {
  const TwoRooms rooms{.side = 12, .width = 0.8, .length = 0.2};
  const auto world = bake_plane(two_rooms_plane(rooms), AvatarClass{}, config, context);
  if (!world) return world.error();
  const uint64_t each = config.brief ? 5 : 50, runs = config.brief ? 1 : 3;
  for (uint64_t k = 0; k < runs; ++k) {
    const ValidationConfig one = config_of_run(config, runs, k);
    const auto run =
        walk_trips(*world, door_trips(rooms, each, one.seed), kDoorTime, one, result, context);
    if (!run) return run.error();
    add_arrivals(*run, 2 * each, fmt::format("door of 0.8 m, run {}", k + 1), result);
  }
  return {};
}

// A corridor, and a group at each end of it, in rows of four.
struct Columns {
  PlaneConfig plane;
  Trips trips;
};

Columns make_columns(uint64_t each, uint64_t seed) {
  constexpr double kWidth = 4, kEach = 1.3;  // [m]; [m2] for each person
  constexpr double kBetween = 20;            // [m] between the groups
  constexpr double kMoved = 0.15;            // [m] along each axis, at most
  constexpr uint64_t kInRow = 4;
  const double row = kEach * kInRow / kWidth;  // [m]
  const double group = static_cast<double>((each + kInRow - 1) / kInRow) * row;
  const double length = 2 * group + kBetween;
  Columns columns;
  columns.plane.ground = box(0, 0, length, kWidth);
  for (uint64_t n = 0; n < 2 * each; ++n) {
    const uint64_t place = n / 2;
    const Point2 start{(static_cast<double>(place / kInRow) + 0.5) * row +
                           kMoved * (2 * random_unit(seed, 1, n) - 1),
                       (static_cast<double>(place % kInRow) + 0.5) * kWidth / kInRow +
                           kMoved * (2 * random_unit(seed, 2, n) - 1)};
    const Point2 goal{start.x + group + kBetween, start.z};
    const auto turned = [&](Point2 p) {
      return n % 2 == 0 ? p : Point2{length - p.x, kWidth - p.z};
    };
    columns.trips.starts.push_back(turned(start));
    columns.trips.goals.push_back(turned(goal));
  }
  return columns;
}

Result<void> along_corridor(const ValidationConfig& config, ValidationResult& result,
                            Context& context) {
  const uint64_t each = config.brief ? 20 : 1000;
  const Columns columns = make_columns(each, config.seed);
  const auto world = bake_plane(columns.plane, AvatarClass{}, config, context);
  if (!world) return world.error();
  const auto run = walk_trips(*world, columns.trips, kCorridorTime, config, result, context);
  if (!run) return run.error();
  add_arrivals(*run, columns.trips.starts.size(), "corridor of 4 m", result);
  return {};
}

// Person n of a stream: a start beside the far wall of its room, and a goal in the other room
// beyond the corridor, before the places where others start.
struct Trip {
  Point2 start, goal;
};

Trip fed_trip(const TwoRooms& rooms, uint64_t n, uint64_t seed) {
  const double deep = rooms.side - 1;
  const Point2 start{0.5 + random_unit(seed, 1, n), 0.5 + deep * random_unit(seed, 2, n)};
  const Point2 goal{rooms.side + rooms.length + 1 + 2 * random_unit(seed, 3, n),
                    0.5 + deep * random_unit(seed, 4, n)};
  if (n % 2 == 0) return {start, goal};
  return {half_around(start, rooms), half_around(goal, rooms)};
}

// Lets those that wait outside come in where there is room. Leaves the others in `outside`.
Result<void> let_in(std::vector<Trip>& outside, PlaneCrowd& crowd, Context& context) {
  std::vector<Point2> starts;
  for (const Trip& trip : outside) starts.push_back(trip.start);
  const auto ids = crowd.add(starts, std::vector<double>(starts.size(), 0), context);
  if (!ids) return ids.error();
  size_t k = 0;
  std::erase_if(outside, [&](const Trip& trip) {
    const AvatarId id = (*ids)[k++];
    if (id) crowd.set_goal(id, trip.goal);
    return bool(id);
  });
  return {};
}

Result<void> fed_corridor(const ValidationConfig& config, ValidationResult& result,
                          Context& context) {
  const TwoRooms rooms{.side = 6, .width = 2.4, .length = 20};
  const auto world = bake_plane(two_rooms_plane(rooms), AvatarClass{}, config, context);
  if (!world) return world.error();
  auto crowd = PlaneCrowd::create(*world, Routing::kPaths, config);
  if (!crowd) return crowd.error();
  const double feed = config.brief ? 10 : kFeedTime;
  const auto people = static_cast<uint64_t>(2 * kFeedRate * feed);
  std::vector<Trip> outside;
  uint64_t called = 0;
  size_t left = 0, max_outside = 0;
  while (left < people && crowd->time() < feed + kClearTime - 1e-9) {
    while (called < people && static_cast<double>(called / 2) < kFeedRate * crowd->time()) {
      outside.push_back(fed_trip(rooms, called++, config.seed));
    }
    if (auto done = let_in(outside, *crowd, context); !done) return done.error();
    max_outside = std::max(max_outside, outside.size());
    crowd->step();
    if (context.cancel) return Error{Errc::kCancelled, "cancelled"};
    const std::vector<AvatarId> leaving(crowd->arrived().begin(), crowd->arrived().end());
    left += leaving.size();
    crowd->remove(leaving);
  }
  add_arrivals({.arrived = left, .last = crowd->time()}, people, "corridor of 2.4 m, fed", result);
  result.measures.push_back({.name = "max waiting for room to enter, corridor of 2.4 m",
                             .value = static_cast<double>(max_outside)});
  crowd->report(result);
  return {};
}

Result<ValidationResult> counterflow(const ValidationConfig& config, Context& context) {
  ValidationResult result;
  for (const auto part : {through_door, along_corridor, fed_corridor}) {
    if (auto done = part(config, result, context); !done) return done.error();
  }
  return result;
}

const std::array<Test, 1> kCounterflowTests{
    Test{{.name = "motion.counterflow",
          .title = "Counterflow through a door, of two columns, and in a corridor that is fed",
          .method = "Default adults that leave where they have arrived. 50 against 50 between two "
                    "rooms of 12 x 12 m, through a door of 0.8 m, three runs: all within 300 s. "
                    "1000 against 1000 at 1.3 m2 each, 20 m apart in a corridor 4 m wide: all "
                    "within 1000 s. A corridor of 2.4 x 20 m between two rooms, into each of which "
                    "two people a second come for 240 s: all have left 60 s later.",
          .source = "ours: all arrive",
          .in_work = true},
         counterflow}};

}  // namespace

std::span<const Test> counterflow_tests() { return kCounterflowTests; }

}  // namespace throng::validate
