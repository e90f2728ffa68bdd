// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "baked.h"
#include "crowd/fly/flyer_air.h"
#include "crowd/ground/crowd_ground.h"
#include "crowds.h"
#include "path/air/flight_finder.h"
#include "throng/bake.h"
#include "throng/crowd.h"
#include "throng/path.h"

// A flyer of a crowd flies what PathFinder finds, to its end, and in about the time that its length
// takes: however many boxes the search expands, and however many waypoints the path has.
namespace throng {
namespace {

constexpr uint64_t kStepBoxes = 16384;  // CrowdReport::flight_boxes in 0.1 s
constexpr int kFloors = 12;
constexpr double kInside = 0.2, kOutside = 8.2;  // [m] of a floor of the tower, along X and Z

AvatarClass drone() {
  AvatarClass avatar = flyer_class();
  avatar.name = "drone";
  avatar.height = 0.3;
  avatar.radius = 0.15;
  avatar.step_height = 0.1;
  avatar.speed = 3;
  return avatar;
}

// Floors 1 m apart, each with a hole in the corner opposite to that of the floor below. Posts stand
// so close together that boxes of the air are a cell or two wide. The path through it is long and
// winding, and a search for it expands nearly all boxes.
Scene tower() {
  constexpr double kHole = 1.2, kSlab = 0.2, kEnd = kOutside + kInside;
  Scene scene;
  scene.add_box({0, -kSlab, 0}, {kEnd, 0, kEnd});
  scene.add_box({0, kFloors - kSlab, 0}, {kEnd, kFloors, kEnd});
  scene.add_box({0, 0, 0}, {kInside, kFloors, kEnd});
  scene.add_box({kOutside, 0, 0}, {kEnd, kFloors, kEnd});
  scene.add_box({0, 0, 0}, {kEnd, kFloors, kInside});
  scene.add_box({0, 0, kOutside}, {kEnd, kFloors, kEnd});
  for (int f = 1; f < kFloors; ++f) {
    const double low = f - kSlab, high = f;
    if (f % 2 == 1) {
      const double to = kOutside - kHole;
      scene.add_box({kInside, low, kInside}, {to, high, kOutside});
      scene.add_box({to, low, kInside}, {kOutside, high, to});
    } else {
      const double from = kInside + kHole;
      scene.add_box({from, low, kInside}, {kOutside, high, kOutside});
      scene.add_box({kInside, low, from}, {from, high, kOutside});
    }
  }
  constexpr double kPost = 0.1;
  for (int i = 0; i < 8; ++i) {
    for (int k = 0; k < 8; ++k) {
      const bool at_hole = (i < 2 && k < 2) || (i > 5 && k > 5);
      if (at_hole) continue;
      const double x = 0.6 + i, z = 0.6 + k;
      scene.add_box({x, 0, z}, {x + kPost, kFloors, z + kPost});
    }
  }
  return scene;
}

// With voxels of the air as small as the openings need.
World fine_air(const Scene& scene, const AvatarClass& avatar) {
  Context context;
  auto world = bake_world(scene, {.cell = 0.1, .air = 0.1, .classes = {avatar}}, context);
  EXPECT_TRUE(world) << world.error().message;
  return std::move(*world);
}

PathFinder finder_of(const World& world) {
  Context context;
  auto finder = PathFinder::create(world, {}, context);
  EXPECT_TRUE(finder) << finder.error().message;
  return std::move(*finder);
}

// A flyer on the lowest floor of a tower, with the goal on the highest.
constexpr Vec3d kBottom{0.45, 0.2, 0.45}, kTop{0.45, kFloors - 0.75, 0.45};

// Enough for the row of a Flight and for the boxes that one step expands, many times.
TEST(FlyerPaths, APathThatTakesAHundredThousandBoxesIsFlownToItsEndSlow) {
  const World world = fine_air(tower(), drone());
  PathFinder finder = finder_of(world);
  Path path;
  finder.find({.from = kBottom, .to = kTop}, path);
  ASSERT_EQ(path.end, PathEnd::kReached);
  ASSERT_GT(path.nodes, uint64_t{1} << 16);
  ASSERT_GT(path.points.size(), 30u);
  Crowd crowd = made(world);
  const AvatarId id = added(crowd, air_place(kBottom));
  const Place goal = air_place(kTop);
  crowd.set_goals({&id, 1}, {&goal, 1});
  const int max_steps = static_cast<int>(3 * path.length / drone().speed / CrowdConfig().dt);
  int steps = 0;
  for (; steps < max_steps && crowd.arrived().empty(); ++steps) {
    crowd.step();
    ASSERT_TRUE(crowd.goal_unreachable().empty()) << steps;
    if (steps % 50 == 0) {
      const CrowdCheck check = crowd.check();
      ASSERT_EQ(check.overlaps + check.wall_entries, 0u) << steps;
    }
  }
  EXPECT_EQ(crowd.arrived().size(), 1u);
}

// Flyers in several places of the tower, more than there are searches at a time.
std::vector<AvatarId> send_through_tower(Crowd& crowd) {
  std::vector<AvatarId> ids;
  for (int i = 0; i < 5; ++i) {
    const double up = 0.2 + i;
    ids.push_back(added(crowd, air_place({0.45, up, 0.45})));
    const Place goal = air_place(i % 2 == 0 ? kTop : Vec3d{7.95, kFloors - 1.75, 7.95});
    crowd.set_goals({&ids.back(), 1}, {&goal, 1});
  }
  return ids;
}

TEST(FlyerPaths, LongSearchesAreTheSameForAnyWorkersSlow) {
  const World world = fine_air(tower(), drone());
  Crowd one = made(world, {.workers = 1}), three = made(world, {.workers = 3});
  send_through_tower(one);
  send_through_tower(three);
  for (int step = 0; step < 60; ++step) {
    one.step();
    three.step();
    ASSERT_EQ(one.state_hash(), three.state_hash()) << step;
  }
}

// Saved while searches go on, wait and end; while an obstacle that makes them begin again is known
// to the edits alone; and after a flyer that waits for its search has lost its goal.
TEST(FlyerPaths, ARestoredCrowdGoesOnWithItsSearchesSlow) {
  const World world = fine_air(tower(), drone());
  Edits edits;
  Crowd crowd = made(world, {.edits = edits});
  const std::vector<AvatarId> ids = send_through_tower(crowd);
  crowd.step();
  Context context;
  for (int part = 0; part < 8; ++part) {
    if (part == 3) {
      ASSERT_TRUE(edits.add_obstacle(Prism::box({4.75, 5, 4.75}, {5.05, 5.8, 5.05})));
    }
    const Place nowhere;
    if (part == 5) crowd.set_goals({&ids[4], 1}, {&nowhere, 1});
    const std::vector<uint8_t> saved = crowd.save();
    auto restored = Crowd::restore(world, {.workers = 1}, saved, context);
    ASSERT_TRUE(restored) << restored.error().message;
    ASSERT_EQ(restored->save(), saved) << part;
    for (int step = 0; step < 4; ++step) {
      ASSERT_EQ(crowd.step().flight_boxes, restored->step().flight_boxes) << part << ' ' << step;
      ASSERT_EQ(crowd.state_hash(), restored->state_hash()) << part << ' ' << step;
    }
  }
}

// One that walks, or takes off from where no path on foot leads, searches as those in the air do.
TEST(FlyerPaths, OneOnTheGroundWaitsForALongSearchAndArrivesSlow) {
  const World world = fine_air(tower(), drone());
  const Place top = world.find_place(0, {kTop.x, kFloors - 1, kTop.z}, 0.5);
  const Place bottom = world.find_place(0, {kBottom.x, 0, kBottom.z}, 0.5);
  ASSERT_TRUE(top && bottom);
  Crowd crowd = made(world);
  const AvatarId id = added(crowd, bottom);
  crowd.set_goals({&id, 1}, {&top, 1});
  uint64_t taken = 0;
  int waited = 0;
  Context context;
  for (int step = 0; step < 1500 && crowd.arrived().empty(); ++step) {
    const CrowdReport report = crowd.step();
    ASSERT_TRUE(crowd.goal_unreachable().empty()) << step;
    ASSERT_LE(report.flight_boxes, kStepBoxes) << step;
    taken += report.flight_boxes;
    waited += report.flying == 0 && report.stood == 1 ? 1 : 0;
    if (step != 2) continue;
    auto restored = Crowd::restore(world, {}, crowd.save(), context);
    ASSERT_TRUE(restored) << restored.error().message;
    for (int more = 0; more < 20; ++more) {
      crowd.step();
      restored->step();
      ASSERT_EQ(crowd.state_hash(), restored->state_hash()) << step << ' ' << more;
    }
  }
  EXPECT_EQ(crowd.arrived().size(), 1u);
  EXPECT_GT(waited, 2);
  EXPECT_GT(taken, uint64_t{1} << 16);
}

// More than there are searches at a time wait, and one whose search is short does not wait for
// them.
TEST(FlyerPaths, AShortSearchDoesNotWaitForLongOnesSlow) {
  const World world = fine_air(tower(), drone());
  Crowd crowd = made(world);
  send_through_tower(crowd);
  for (int step = 0; step < 3; ++step) {
    ASSERT_GT(crowd.step().flight_boxes, kStepBoxes / 2) << step;
  }
  // Around a post.
  const AvatarId id = added(crowd, air_place({4.3, 0.2, 4.65}));
  const Place goal = air_place({5, 0.2, 4.65});
  crowd.set_goals({&id, 1}, {&goal, 1});
  bool arrives = false;
  for (int step = 0; step < 10 && !arrives; ++step) {
    crowd.step();
    arrives = !crowd.arrived().empty() && crowd.arrived()[0] == id;
  }
  EXPECT_TRUE(arrives);
  EXPECT_GT(crowd.step().flight_boxes, kStepBoxes / 2) << "the others still search";
}

TEST(FlyerPaths, AShortStepTakesFewerBoxesSlow) {
  const World world = fine_air(tower(), drone());
  Crowd crowd = made(world, {.dt = 0.02});
  send_through_tower(crowd);
  for (int step = 0; step < 5; ++step) {
    const uint64_t boxes = crowd.step().flight_boxes;
    EXPECT_LE(boxes, kStepBoxes / 4) << step;
    EXPECT_GT(boxes, kStepBoxes / 8) << step;
  }
}

// Goals for all at once, of those in the air and those on the ground: however many boxes this takes
// together, a step has a bound, and none loses a goal to which PathFinder finds a path.
TEST(FlyerPaths, SearchesOfManyShareTheBoxesOfAStepSlow) {
  const World world =
      test::bake(test::builtin({.name = "city", .size = 120, .seed = 2}), 0.2, {flyer_class()});
  PathFinder finder = finder_of(world);
  Crowd crowds[] = {made(world, {.workers = 1}), made(world, {.workers = 3})};
  std::vector<AvatarId> ids = scattered(crowds[0], 100, {.place = air_place({})});
  const std::vector<AvatarId> below = scattered(crowds[0], 100);
  ids.insert(ids.end(), below.begin(), below.end());
  scattered(crowds[1], 100, {.place = air_place({})});
  scattered(crowds[1], 100);
  std::vector<Place> goals;
  std::vector<bool> is_reached;
  Path path;
  uint64_t boxes = 0;
  for (size_t i = 0; i < ids.size(); ++i) {
    const auto in_air = crowds[0].random_air_point(0, 11, i);
    ASSERT_TRUE(in_air);
    goals.push_back(i % 3 == 2 ? world.random_place(0, 11, i) : air_place(*in_air));
    finder.find(
        {.from = crowds[0].read(ids[i])->position, .to = goals.back().position, .nearest = false},
        path);
    is_reached.push_back(path.end == PathEnd::kReached);
    boxes += path.nodes;
  }
  ASSERT_GT(boxes, 4 * kStepBoxes);
  for (Crowd& crowd : crowds) crowd.set_goals(ids, goals);
  Context context;
  std::optional<Crowd> restored;
  uint64_t taken = 0, last = kStepBoxes;
  int full = 0;
  for (int step = 0; step < 80; ++step) {
    const CrowdReport report = crowds[0].step();
    crowds[1].step();
    ASSERT_EQ(crowds[0].state_hash(), crowds[1].state_hash()) << step;
    if (restored) {
      ASSERT_EQ(report.flight_boxes, restored->step().flight_boxes) << step;
      ASSERT_EQ(crowds[0].state_hash(), restored->state_hash()) << step;
    }
    last = report.flight_boxes;
    ASSERT_LE(last, kStepBoxes) << step;
    full += last > kStepBoxes / 2 ? 1 : 0;
    taken += last;
    for (const AvatarId id : crowds[0].goal_unreachable()) {
      EXPECT_FALSE(is_reached[id.slot1 - 1]) << id.slot1 << ", step " << step;
    }
    if (step % 5 == 2) {
      auto made = Crowd::restore(world, {.workers = 2}, crowds[0].save(), context);
      ASSERT_TRUE(made) << made.error().message;
      restored.emplace(std::move(*made));
    }
  }
  EXPECT_GT(taken, boxes / 2);
  EXPECT_GT(full, 3);
  EXPECT_LT(last, kStepBoxes / 2);
  const CrowdCheck check = crowds[0].check();
  EXPECT_EQ(check.overlaps + check.wall_entries, 0u);
}

// Rooms of 4 m on two levels. Openings of 1.4 x 2.4 m, each elsewhere in its wall, and shafts.
Scene rooms() {
  constexpr double kRoom = 4, kWall = 0.2, kHeight = 3.2, kHigh = 3, kOpening = 1.4;
  constexpr int kSide = 3;
  constexpr double kEnd = kSide * kRoom + kWall;
  Scene scene;
  for (int level = 0; level < 2; ++level) {
    const double low = level * kHeight, high = low + kHigh;
    for (int i = 0; i <= kSide; ++i) {
      const double at = i * kRoom;
      for (int k = 0; k < kSide; ++k) {
        const double begin = k * kRoom, end = begin + kRoom;
        const double from = begin + 0.3 + 0.55 * ((i + 2 * k + level) % 5);
        // A wall along Z at x = at, and one along X at z = at.
        const auto wall = [&](double a, double b, double bottom, double top) {
          scene.add_box({at, bottom, a}, {at + kWall, top, b});
          scene.add_box({a, bottom, at}, {b, top, at + kWall});
        };
        if (i == 0 || i == kSide) {
          wall(begin, end + kWall, low, high);
          continue;
        }
        wall(begin, from, low, high);
        wall(from + kOpening, end + kWall, low, high);
        wall(from, from + kOpening, low + 2.6, high);
        wall(from, from + kOpening, low, low + 0.2);
      }
    }
  }
  scene.add_box({0, -kWall, 0}, {kEnd, 0, kEnd});
  scene.add_box({0, 2 * kHeight - kWall, 0}, {kEnd, 2 * kHeight, kEnd});
  // Between the levels, with a shaft in every second room.
  for (int i = 0; i < kSide; ++i) {
    for (int k = 0; k < kSide; ++k) {
      const double x = i * kRoom, z = k * kRoom, far = kRoom + kWall;
      if ((i + k) % 2 == 0) {
        scene.add_box({x, kHigh, z}, {x + far, kHeight, z + far});
        continue;
      }
      scene.add_box({x, kHigh, z}, {x + 0.5, kHeight, z + far});
      scene.add_box({x + 0.5 + kOpening, kHigh, z}, {x + far, kHeight, z + far});
      scene.add_box({x + 0.5, kHigh, z}, {x + 0.5 + kOpening, kHeight, z + 2});
      scene.add_box({x + 0.5, kHigh, z + 2 + kOpening}, {x + 0.5 + kOpening, kHeight, z + far});
    }
  }
  return scene;
}

// From goal to goal: a flyer that nothing is near to.
void expect_no_hovering(const World& world, Vec3d start, double speed, int goals) {
  PathFinder finder = finder_of(world);
  Crowd crowd = made(world, {.workers = 1});
  const double dt = CrowdConfig().dt;
  const AvatarId id = added(crowd, air_place(start), {.speed = speed});
  ASSERT_TRUE(id);
  Path path;
  int flown = 0, turns = 0;
  for (int n = 1; n <= goals; ++n) {
    const Vec3d here = crowd.read(id)->position;
    const auto there = finder.random_point(3, static_cast<uint64_t>(n));
    ASSERT_TRUE(there);
    finder.find({.from = here, .to = *there}, path);
    if (path.end != PathEnd::kReached) continue;
    const auto flies = [](SegmentKind kind) { return kind == SegmentKind::kFly; };
    if (!std::all_of(path.segments.begin(), path.segments.end(), flies)) continue;
    const double limit = 1.2 * path.length / speed + 1;
    const Place goal = air_place(*there);
    crowd.set_goals({&id, 1}, {&goal, 1});
    double seconds = 0;
    bool arrives = false;
    while (!arrives && seconds < 2 * limit) {
      crowd.step();
      seconds += dt;
      arrives = !crowd.arrived().empty();
    }
    EXPECT_TRUE(arrives) << n;
    EXPECT_LE(seconds, limit + dt)
        << "goal " << n << ", " << path.length << " m, " << path.points.size() << " points";
    ++flown;
    turns += path.points.size() > 2 ? 1 : 0;
  }
  EXPECT_GT(flown, goals / 4);
  EXPECT_GT(turns, 1);
}

TEST(FlyerPaths, OneThatIsAloneArrivesInTheTimeThatItsPathTakes) {
  const World inside = fine_air(rooms(), flyer_class());
  expect_no_hovering(inside, {2, 1, 2}, 5, 60);
  expect_no_hovering(inside, {2, 1, 2}, 1.5, 30);
  const World garage =
      test::bake(test::builtin({.name = "garage", .seed = 3}), 0.1, {flyer_class()});
  const auto start = finder_of(garage).random_point(3, 0);
  ASSERT_TRUE(start);
  expect_no_hovering(garage, *start, 5, 60);
}

// Two halls, each with air of its own. Only a door, too low to fly through, leads from one to the
// other.
Scene two_halls() {
  Scene scene;
  scene.add_quad({0, 0, 0}, {0, 0, 8}, {20, 0, 8}, {20, 0, 0});
  for (const double x : {0.0, 19.8}) scene.add_box({x, -0.1, 0}, {x + 0.2, 6, 8});
  scene.add_box({9.8, -0.1, 0}, {10, 6, 3.45});
  scene.add_box({9.8, -0.1, 4.55}, {10, 6, 8});
  scene.add_box({9.8, 2, 3}, {10, 6, 5});
  scene.add_box({0, -0.1, 0}, {20, 6, 0.2});
  scene.add_box({0, -0.1, 7.8}, {20, 6, 8});
  scene.add_box({0, 5.8, 0}, {20, 6, 8});
  return scene;
}

// What a search is given is the cell in which the flyer is: a height in whole millimetres is not
// one less in metres, since it may be the lowest of a cell.
TEST(FlyerPaths, APositionIsTheSameInMetres) {
  const World world = test::bake(two_halls(), 0.1, {flyer_class()});
  Context context;
  const auto flight = path::FlightFinder::create(world, {}, context);
  ASSERT_TRUE(flight) << flight.error().message;
  const crowd::CrowdGround ground;
  const crowd::FlyerAir air(world, flight->space(), ground, 0);
  for (int32_t y = -50000; y <= 50000; ++y) {
    const crowd::AirPosition position{1000 + 3 * (y + 50000), 2000 + (y + 50000), y};
    ASSERT_EQ(air.position(air.metres(position)), position) << y;
  }
}

TEST(FlyerPaths, OneLandsAndWalksWhereOnlyTheGroundLeadsToItsGoal) {
  const World world = test::bake(two_halls(), 0.1, {flyer_class()});
  PathFinder finder = finder_of(world);
  const Vec3d here{3, 2, 4}, there{16, 3, 3};
  Path path;
  finder.find({.from = here, .to = there}, path);
  ASSERT_EQ(path.end, PathEnd::kReached);
  ASSERT_NE(std::count(path.segments.begin(), path.segments.end(), SegmentKind::kLand), 0);
  Crowd crowd = made(world);
  const AvatarId id = added(crowd, air_place(here));
  const Place goal = air_place(there);
  crowd.set_goals({&id, 1}, {&goal, 1});
  int walked = 0;
  for (int step = 0; step < 600 && crowd.arrived().empty(); ++step) {
    crowd.step();
    ASSERT_TRUE(crowd.goal_unreachable().empty()) << step;
    walked += crowd.read(id)->mode == MoveMode::kWalk ? 1 : 0;
  }
  EXPECT_EQ(crowd.arrived().size(), 1u);
  EXPECT_GT(walked, 0);
}

}  // namespace
}  // namespace throng
