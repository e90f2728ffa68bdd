// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "baked.h"
#include "crowds.h"
#include "throng/crowd.h"
#include "throng/path.h"
#include "worlds.h"

// A crowd that reads edits: against one that gets the same obstacles by calls of its own, and
// against finders that share the edits.
namespace throng {
namespace {

// A square of 24 m, cut by a wall at x = 12 with openings of 2 m at z = 4 and z = 20.
World two_openings() {
  Scene scene = worlds::flat(24);
  scene.add_box({11.9, 0, 0}, {12.1, 3, 3});
  scene.add_box({11.9, 0, 5}, {12.1, 3, 19});
  scene.add_box({11.9, 0, 21}, {12.1, 3, 24});
  return test::bake(scene, 0.1);
}

const Prism kNearDoor = Prism::box({11, 0, 2.8}, {13, 2, 5.2});
const Prism kFarDoor = Prism::box({11, 0, 18.8}, {13, 2, 21.2});

// Where an avatar crosses the line x = 12 from one place to another, by z; negative: nowhere.
double crossing(Crowd& crowd, const World& world, Vec3d from, Vec3d to) {
  const AvatarId id = added(crowd, world.find_place(0, from, 0.5));
  const Place goal = world.find_place(0, to, 0.5);
  crowd.set_goals({&id, 1}, {&goal, 1});
  double crossed = -1;
  for (int step = 0; step < 600; ++step) {
    const Vec3d before = crowd.read(id)->position;
    const CrowdReport report = crowd.step();
    const CrowdCheck check = crowd.check();
    EXPECT_EQ(check.wall_entries + check.overlaps + check.obstacle_entries, 0u);
    const Vec3d now = crowd.read(id)->position;
    if ((before.x < 12) != (now.x < 12)) crossed = now.z;
    if (report.arrived + crowd.goal_unreachable().size() > 0) break;
  }
  crowd.remove({&id, 1});
  return crossed;
}

TEST(CrowdEdits, AreObstaclesAsIfTheCrowdHadBeenGivenThem) {
  const World world = two_openings();
  Edits edits;
  Crowd reads = made(world, {.edits = edits}), given = made(world);
  std::vector<Place> goals;
  for (uint64_t n = 0; n < 60; ++n) goals.push_back(world.random_place(0, 3, n));
  EXPECT_FALSE(reads.obstacle_of(0) || reads.obstacle_of(1));
  EditId door = 0, crate = 0;
  ObstacleId own_door, own_crate;
  for (int step = 0; step < 240; ++step) {
    if (step == 0) {
      for (Crowd* crowd : {&reads, &given}) crowd->set_goals(scattered(*crowd, 60), goals);
    }
    if (step == 20) {
      door = *edits.add_obstacle(kNearDoor);
      own_door = *given.add_obstacle(kNearDoor);
      crate = *edits.add_obstacle(Prism::circle({6, 0, 12}, 0.7, 1));
      own_crate = *given.add_obstacle(Prism::circle({6, 0, 12}, 0.7, 1));
    }
    if (step == 80 || step == 150) {
      EXPECT_TRUE(edits.set_active(door, step == 150));
      EXPECT_TRUE(given.set_obstacle_active(own_door, step == 150));
    }
    if (step == 100) {
      EXPECT_TRUE(edits.remove(crate));
      EXPECT_TRUE(given.remove_obstacle(own_crate));
    }
    const CrowdReport a = reads.step(), b = given.step();
    ASSERT_EQ(a.waiting, b.waiting);
    if (step == 20) {
      EXPECT_EQ(reads.obstacle_of(door), own_door);
      EXPECT_EQ(reads.obstacle(reads.obstacle_of(door))->waits(),
                given.obstacle(own_door)->waits());
    }
    if (step == 100) {
      EXPECT_FALSE(reads.obstacle_of(crate));
    }
    std::vector<AvatarState> now, other;
    reads.read(now);
    given.read(other);
    ASSERT_EQ(now.size(), other.size());
    for (size_t i = 0; i < now.size(); ++i) {
      ASSERT_EQ(now[i].position.x, other[i].position.x) << "step " << step;
      ASSERT_EQ(now[i].position.z, other[i].position.z) << "step " << step;
    }
  }
}

TEST(CrowdEdits, ClimbersPlanByAreas) {
  const Scene scene = worlds::flat(24);
  const World world = test::bake(
      scene, 0.25, {{.name = "climber", .height = 1.0, .radius = 0.3, .climb_slope = 180}});
  Context context;
  const auto nodes = Nodes::create(world, scene, {}, context);
  ASSERT_TRUE(nodes) << nodes.error().message;
  Edits edits;
  Crowd crowd = made(world, {.nodes = *nodes, .edits = edits});
  const Vec3d from{4, 0, 4}, to{20, 0, 4};
  EXPECT_NEAR(crossing(crowd, world, from, to), 4, 2);
  const auto area = edits.add_area(Prism::box({10, -1, -1}, {14, 1, 16}), 3);
  ASSERT_TRUE(area);
  EXPECT_NEAR(crossing(crowd, world, from, to), 4, 2);
  for (const double cost : {10.0, std::numeric_limits<double>::infinity()}) {
    ASSERT_TRUE(edits.set_area_cost(3, cost));
    EXPECT_GT(crossing(crowd, world, from, to), 15.5);
  }
  EXPECT_TRUE(edits.remove(*area));
  EXPECT_NEAR(crossing(crowd, world, from, to), 4, 2);
}

TEST(CrowdEdits, OneDoorForFindersAndCrowd) {
  const World world = two_openings();
  Edits edits;
  Context context;
  auto finder = PathFinder::create(world, {.edits = edits}, context);
  ASSERT_TRUE(finder);
  Crowd crowd = made(world, {.edits = edits});
  const Vec3d from{4, 0, 4}, to{20, 0, 4};
  const auto finder_crosses = [&] {
    Path path;
    finder->find({.from = from, .to = to}, path);
    double most = 0;
    for (const Place& point : path.points) most = std::max(most, point.position.z);
    return most;
  };
  EXPECT_LT(crossing(crowd, world, from, to), 6);
  EXPECT_LT(finder_crosses(), 6);
  const auto door = edits.add_obstacle(kNearDoor);
  ASSERT_TRUE(door);
  EXPECT_GT(crossing(crowd, world, from, to), 18);
  EXPECT_GT(finder_crosses(), 18);
  // Triangles block a crowd by the box around them.
  const std::vector<Vec3d> corners{{12, 0, 18}, {12, 0, 22}, {12, 2, 20}};
  const std::vector<std::array<uint32_t, 3>> triangles{{0, 1, 2}};
  const auto sheet = edits.add_obstacle(corners, triangles);
  ASSERT_TRUE(sheet);
  EXPECT_LT(crossing(crowd, world, from, to), 0) << "both openings are shut";
  ASSERT_TRUE(edits.remove(*door));
  EXPECT_LT(crossing(crowd, world, from, to), 6);
  EXPECT_LT(finder_crosses(), 6);
}

TEST(CrowdEdits, AvatarsPlanByTheCostsOfAreas) {
  const World world = two_openings();
  Edits edits;
  Crowd crowd = made(world, {.edits = edits});
  const Vec3d from{4, 0, 4}, to{20, 0, 4};
  const auto area = edits.add_area(Prism::box({10, -1, 2}, {14, 1, 6}), 5);
  ASSERT_TRUE(area);
  const double near = crossing(crowd, world, from, to);
  EXPECT_TRUE(near > 0 && near < 6) << "a metre costs one";
  ASSERT_TRUE(edits.set_area_cost(5, 50));
  EXPECT_GT(crossing(crowd, world, from, to), 18);
  ASSERT_TRUE(edits.set_active(*area, false));
  EXPECT_LT(crossing(crowd, world, from, to), 6);
  ASSERT_TRUE(edits.set_active(*area, true));
  ASSERT_TRUE(edits.set_area_cost(5, std::numeric_limits<double>::infinity()));
  EXPECT_GT(crossing(crowd, world, from, to), 18) << "closed";
  // With a crate in the other opening nothing is left.
  const auto crate = edits.add_obstacle(kFarDoor);
  ASSERT_TRUE(crate);
  EXPECT_LT(crossing(crowd, world, from, to), 0);
  ASSERT_TRUE(edits.remove(*area));
  EXPECT_LT(crossing(crowd, world, from, to), 6);
}

// An avatar on its path when the cost changes, and avatars that head to a target.
TEST(CrowdEdits, ACostThatChangesTurnsAvatarsOnTheirPaths) {
  const World world = two_openings();
  Edits edits;
  Crowd crowd = made(world, {.edits = edits});
  ASSERT_TRUE(edits.add_area(Prism::box({10, -1, 2}, {14, 1, 6}), 5));
  Context context;
  const Prism there = Prism::box({19, -1, 3}, {21, 1, 5});
  const auto target = crowd.add_target({&there, 1}, context);
  ASSERT_TRUE(target);
  const AvatarId one = added(crowd, world.find_place(0, {3, 0, 4}, 0.5)),
                 other = added(crowd, world.find_place(0, {3, 0, 6}, 0.5));
  const Place goal = world.find_place(0, {20, 0, 6}, 0.5);
  crowd.set_goals({&one, 1}, {&goal, 1});
  crowd.set_targets({&other, 1}, *target);
  double highest_one = 0, highest_other = 0;
  uint64_t arrived = 0;
  for (int step = 0; step < 600 && arrived < 2; ++step) {
    if (step == 20) {
      ASSERT_TRUE(edits.set_area_cost(5, 50));
    }
    arrived += crowd.step().arrived;
    highest_one = std::max(highest_one, crowd.read(one)->position.z);
    highest_other = std::max(highest_other, crowd.read(other)->position.z);
  }
  EXPECT_EQ(arrived, 2u);
  EXPECT_GT(highest_one, 18);
  EXPECT_GT(highest_other, 18);
}

TEST(CrowdEdits, ASlopeCostLeadsAroundAHill) {
  Scene scene = worlds::flat(24);
  // A ridge of 20 %, 0.8 m high, over two thirds of the width.
  scene.add_quad({8, 0, 0}, {8, 0, 16}, {12, 0.8, 16}, {12, 0.8, 0});
  scene.add_quad({12, 0.8, 0}, {12, 0.8, 16}, {16, 0, 16}, {16, 0, 0});
  const World world = test::bake(scene, 0.1);
  for (const double slope_cost : {0.0, 10.0}) {
    Crowd crowd = made(world, {.slope_cost = slope_cost});
    const double at = crossing(crowd, world, {4, 0, 8}, {20, 0, 8});
    if (slope_cost == 0) {
      EXPECT_NEAR(at, 8, 1);
    } else {
      EXPECT_GT(at, 15.5);
    }
  }
}

TEST(CrowdEdits, ASavedCrowdGoesOnWithThem) {
  const World world = two_openings();
  Edits edits;
  Crowd crowd = made(world, {.edits = edits});
  const auto door = edits.add_obstacle(kNearDoor);
  ASSERT_TRUE(door);
  ASSERT_TRUE(edits.add_area(Prism::box({14, -1, 8}, {18, 1, 16}), 2));
  ASSERT_TRUE(edits.set_area_cost(2, 7));
  std::vector<Place> goals;
  for (uint64_t n = 0; n < 40; ++n) goals.push_back(world.random_place(0, 3, n));
  crowd.set_goals(scattered(crowd, 40), goals);
  for (int step = 0; step < 30; ++step) crowd.step();
  const std::vector<uint8_t> saved = crowd.save();
  Context context;
  auto restored = Crowd::restore(world, {.workers = 2, .edits = edits}, saved, context);
  ASSERT_TRUE(restored) << restored.error().message;
  EXPECT_EQ(restored->obstacle_of(*door), crowd.obstacle_of(*door));
  for (int step = 0; step < 60; ++step) {
    if (step == 20) {
      EXPECT_TRUE(edits.set_active(*door, false));
    }
    if (step == 40) {
      ASSERT_TRUE(edits.set_area_cost(2, 1));
    }
    crowd.step();
    restored->step();
  }
  EXPECT_EQ(crowd.save(), restored->save());
  EXPECT_FALSE(Crowd::restore(world, {.edits = edits, .slope_cost = 3}, saved, context));
}

TEST(CrowdEdits, RefusedSettings) {
  const World world = test::bake(worlds::flat(6), 0.2);
  for (const double cost : {-1.0, 1001.0, std::nan("")}) {
    EXPECT_FALSE(Crowd::create(world, {.slope_cost = cost}));
  }
  EXPECT_FALSE(Crowd::create(world, {.speedup = PathSpeedup::kOnDemand}));
}

}  // namespace
}  // namespace throng
