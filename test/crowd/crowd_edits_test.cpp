// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include "baked.h"
#include "core/hash.h"
#include "core/random.h"
#include "crowds.h"
#include "throng/crowd.h"
#include "throng/path.h"
#include "worlds.h"

// A crowd that follows edits: at its next step as at once, against finders that share them, saved
// and restored.
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

// Calls at random: obstacles come, move, switch and go, some twice between two steps.
struct Calls {
  const World& world;
  std::vector<Edits> lists;  // each gets all calls
  std::vector<EditId> ids = {};
  uint64_t n = 0;

  double draw() { return random_unit(3, 55, n++); }
  Prism somewhere() {
    const Vec3d at = world.random_place(0, 17, n++).position;
    return Prism::circle({at.x, at.y, at.z}, 0.2 + draw(), 1);
  }
  // Makes one call to all lists, and has the crowd of the first follow it.
  void make_one(Crowd& first) {
    const double what = draw();
    const size_t i = static_cast<size_t>(draw() * static_cast<double>(ids.size()));
    const Prism prism = somewhere();
    const auto kind = draw() < 0.5 ? ObstacleKind::kStatic : ObstacleKind::kKinematic;
    const auto policy = draw() < 0.7 ? ObstaclePolicy::kRefuseEntry : ObstaclePolicy::kWait;
    const bool adds = ids.size() < 10 || what < 0.1, active = draw() < 0.5;
    EditId made = 0;
    for (Edits& edits : lists) {
      if (adds) {
        made = *edits.add_obstacle(prism, kind, policy);
      } else if (what < 0.5) {
        EXPECT_TRUE(edits.set_active(ids[i], active));
      } else if (what < 0.9) {
        EXPECT_TRUE(edits.move_obstacle(ids[i], prism));
      } else {
        EXPECT_TRUE(edits.remove(ids[i]));
      }
    }
    if (adds) ids.push_back(made);
    if (!adds && what >= 0.9) ids.erase(ids.begin() + static_cast<ptrdiff_t>(i));
    follow(first);
  }
};

TEST(CrowdEdits, WhatWasCalledSinceTheLastStepIsCalledInItsOrderAtTheNext) {
  const World world = two_openings();
  Edits one, two;
  Crowd at_once = made(world, {.edits = one}), later = made(world, {.edits = two});
  std::vector<Place> goals;
  for (uint64_t n = 0; n < 60; ++n) goals.push_back(world.random_place(0, 3, n));
  for (Crowd* crowd : {&at_once, &later}) crowd->set_goals(scattered(*crowd, 60), goals);
  Calls calls{world, {one, two}};
  uint64_t waiting = 0;
  for (int step = 0; step < 200; ++step) {
    if (step == 100) {
      for (Crowd* crowd : {&at_once, &later}) {
        const std::vector<AvatarId> arrived(crowd->arrived().begin(), crowd->arrived().end());
        crowd->remove(arrived);
      }
    }
    for (int k = 0; k < 4 && step % 3 == 0; ++k) calls.make_one(at_once);
    const CrowdReport a = at_once.step(), b = later.step();
    ASSERT_EQ(a.waiting, b.waiting) << step;
    ASSERT_EQ(a.planned, b.planned) << step;
    ASSERT_EQ(at_once.state_hash(), later.state_hash()) << step;
    waiting += a.waiting;
    for (const EditId id : calls.ids) {
      const ObstacleState x = *at_once.obstacle(id), y = *later.obstacle(id);
      ASSERT_EQ(x.phase, y.phase) << step << ' ' << id;
      ASSERT_EQ(x.prism.corners, y.prism.corners) << step << ' ' << id;
      ASSERT_EQ(x.requested_at, y.requested_at) << step << ' ' << id;
      ASSERT_EQ(x.up_at, y.up_at) << step << ' ' << id;
      ASSERT_EQ(x.occupants, y.occupants) << step << ' ' << id;
    }
  }
  EXPECT_GT(waiting, 20u);
  EXPECT_EQ(at_once.save(), later.save());
}

TEST(CrowdEdits, ADoorThatWasSwitchedOffAndOnBetweenTwoStepsClosesAgain) {
  const World world = two_openings();
  Edits edits;
  Crowd crowd = made(world, {.edits = edits});
  ASSERT_TRUE(added(crowd, world.find_place(0, {4, 0, 12}, 0.5)));
  const EditId door = put_up(crowd, edits, kNearDoor);
  for (int step = 0; step < 10; ++step) crowd.step();
  EXPECT_EQ(crowd.obstacle(door)->requested_at, 0);
  EXPECT_TRUE(edits.set_active(door, false) && edits.set_active(door, true));
  crowd.step();
  EXPECT_TRUE(crowd.obstacle(door)->is_up());
  EXPECT_NEAR(crowd.obstacle(door)->requested_at, 1, 1e-9);
  EXPECT_NEAR(crowd.obstacle(door)->up_at, 1, 1e-9);
}

// The hull of its first and last place holds an avatar; those with the place between do not.
TEST(CrowdEdits, ACartMovesByEachOfItsMoves) {
  const World world = two_openings();
  const auto cart_at = [](double x, double z) { return Prism::circle({x, 0, z}, 0.4, 1); };
  for (const bool by_corner : {true, false}) {
    Edits edits;
    Crowd crowd = made(world, {.edits = edits});
    ASSERT_TRUE(added(crowd, world.find_place(0, {6, 0, 12}, 0.5)));
    const EditId cart = put_up(crowd, edits, cart_at(4, 12), ObstacleKind::kKinematic);
    if (by_corner) {
      ASSERT_TRUE(edits.move_obstacle(cart, cart_at(6, 8)));
    }
    ASSERT_TRUE(edits.move_obstacle(cart, cart_at(8, 12)));
    EXPECT_EQ(crowd.obstacle(cart)->phase, ObstaclePhase::kUp);
    EXPECT_EQ(crowd.obstacle(cart)->prism.corners, cart_at(4, 12).corners);
    crowd.step();
    EXPECT_EQ(crowd.obstacle(cart)->waits(), !by_corner);
    EXPECT_EQ(crowd.obstacle(cart)->prism.corners, cart_at(by_corner ? 8 : 4, 12).corners);
  }
}

TEST(CrowdEdits, UntilACrowdFollowsItReportsWhatItHas) {
  const World world = two_openings();
  Edits edits;
  Crowd crowd = made(world, {.edits = edits});
  ASSERT_TRUE(added(crowd, world.find_place(0, {4, 0, 12}, 0.5)));
  const auto door = edits.add_obstacle(kNearDoor, ObstacleKind::kStatic, ObstaclePolicy::kWait);
  const auto cart = edits.add_obstacle(kFarDoor, ObstacleKind::kKinematic);
  ASSERT_TRUE(door && cart && edits.set_active(*cart, false));
  EXPECT_EQ(crowd.obstacle(*door)->phase, ObstaclePhase::kWaitsToComeUp);
  EXPECT_EQ(crowd.obstacle(*door)->policy, ObstaclePolicy::kWait);
  EXPECT_EQ(crowd.obstacle(*door)->prism.corners, kNearDoor.corners);
  EXPECT_LT(crowd.obstacle(*door)->requested_at, 0);
  EXPECT_EQ(crowd.obstacle(*cart)->phase, ObstaclePhase::kOff);
  EXPECT_EQ(crowd.obstacle(*cart)->kind, ObstacleKind::kKinematic);
  EXPECT_TRUE(crowd.obstacles().empty());
  crowd.step();
  EXPECT_EQ(crowd.obstacle(*door)->phase, ObstaclePhase::kUp);
  EXPECT_EQ(crowd.obstacle(*cart)->phase, ObstaclePhase::kOff);
  EXPECT_EQ(crowd.obstacles().size(), 1u);
  ASSERT_TRUE(edits.set_active(*door, false) && edits.set_active(*cart, true));
  EXPECT_EQ(crowd.obstacle(*door)->phase, ObstaclePhase::kUp);
  EXPECT_EQ(crowd.obstacle(*cart)->phase, ObstaclePhase::kOff);
  follow(crowd);
  EXPECT_EQ(crowd.obstacle(*door)->phase, ObstaclePhase::kOff);
  EXPECT_EQ(crowd.obstacle(*cart)->phase, ObstaclePhase::kUp);
  ASSERT_TRUE(edits.remove(*cart));
  EXPECT_EQ(crowd.obstacle(*cart).error().code, Errc::kNotFound);
  EXPECT_EQ(crowd.obstacles().size(), 1u);
  crowd.step();
  EXPECT_TRUE(crowd.obstacles().empty());
  EXPECT_EQ(crowd.obstacle(*cart).error().code, Errc::kNotFound);
}

// Edits that were made before the crowd, and more calls at once than the list remembers.
TEST(CrowdEdits, ACrowdThatIsFarBehindTakesTheStateOfTheEdits) {
  const World world = two_openings();
  Edits edits;
  const auto gone = edits.add_obstacle(kNearDoor), off = edits.add_obstacle(kNearDoor),
             moved = edits.add_obstacle(kNearDoor);
  ASSERT_TRUE(gone && off && moved && edits.remove(*gone) && edits.set_active(*off, false));
  ASSERT_TRUE(edits.move_obstacle(*moved, kFarDoor));
  Crowd crowd = made(world, {.edits = edits});
  ASSERT_TRUE(added(crowd, world.find_place(0, {12, 0, 4}, 0.5)));
  EXPECT_EQ(crowd.obstacles().size(), 1u);
  EXPECT_EQ(crowd.obstacle(*off)->phase, ObstaclePhase::kOff);
  EXPECT_EQ(crowd.obstacle(*moved)->prism.corners, kFarDoor.corners);
  const auto shifted = [](double by) { return Prism::box({3 + by, 0, 20}, {4 + by, 1, 21}); };
  for (int n = 0; n < 20000; ++n) ASSERT_TRUE(edits.move_obstacle(*moved, shifted(n % 7)));
  ASSERT_TRUE(edits.set_active(*off, true));
  const auto last = edits.add_obstacle(shifted(10));
  ASSERT_TRUE(last);
  crowd.step();
  EXPECT_EQ(crowd.obstacle(*moved)->prism.corners, shifted(19999 % 7).corners);
  EXPECT_TRUE(crowd.obstacle(*off)->waits()) << "an avatar stands there";
  EXPECT_TRUE(crowd.obstacle(*last)->is_up());
  EXPECT_EQ(crowd.obstacles().size(), 2u);
}

// A square of 24 m for a class that climbs.
struct ClimbersFloor {
  Scene scene = worlds::flat(24);
  World world = test::bake(scene, 0.25,
                           {{.name = "climber", .height = 1.0, .radius = 0.3, .climb_slope = 180}});
  Nodes nodes;

  ClimbersFloor() {
    Context context;
    auto made = Nodes::create(world, scene, {}, context);
    EXPECT_TRUE(made) << made.error().message;
    if (made) nodes = *made;
  }
};

TEST(CrowdEdits, ClimbersPlanByAreas) {
  const ClimbersFloor floor;
  const World& world = floor.world;
  Edits edits;
  Crowd crowd = made(world, {.nodes = floor.nodes, .edits = edits});
  const Vec3d from{4, 0, 4}, to{20, 0, 4};
  EXPECT_NEAR(crossing(crowd, world, from, to), 4, 2);
  const auto area = edits.add_area(Prism::box({10, -1, -1}, {14, 1, 16}), 3);
  ASSERT_TRUE(area);
  EXPECT_NEAR(crossing(crowd, world, from, to), 4, 2);
  for (const double cost : {6.0, 10.0, std::numeric_limits<double>::infinity()}) {
    ASSERT_TRUE(edits.set_area_cost(3, cost));
    EXPECT_GT(crossing(crowd, world, from, to), 15.5) << cost;
  }
  EXPECT_TRUE(edits.remove(*area));
  EXPECT_NEAR(crossing(crowd, world, from, to), 4, 2);
}

// For how many steps in a row a climber that is alone hardly moves before it arrives; negative: it
// does not arrive.
int steps_at_rest(Crowd& crowd, const World& world, Vec3d from, Vec3d to) {
  constexpr double kRest = 0.1;  // [m/s]
  const AvatarId id = added(crowd, world.find_place(0, from, 0.5));
  const Place goal = world.find_place(0, to, 0.5);
  crowd.set_goals({&id, 1}, {&goal, 1});
  int here = 0, longest = 0;
  bool arrives = false;
  for (int step = 0; step < 600 && !arrives; ++step) {
    const Vec3d before = crowd.read(id)->position;
    arrives = crowd.step().arrived > 0;
    const double moved = length(crowd.read(id)->position - before);
    here = moved < kRest * CrowdConfig{}.dt ? here + 1 : 0;
    longest = std::max(longest, here);
  }
  crowd.remove({&id, 1});
  return arrives ? longest : -1;
}

// Their paths have many points where they bend around the area's squares, and go on from points
// where the kept part of a path ended, between two squares.
TEST(CrowdEdits, ClimbersDoNotStandStillOnPathsAroundAnArea) {
  const ClimbersFloor floor;
  const World& world = floor.world;
  for (const Prism& prism :
       {Prism::box({10, -1, -1}, {14, 1, 16}), Prism::box({9.4, -1, -1}, {13.6, 1, 14.2}),
        Prism::circle({12, -1, 9}, 6.3, 2)}) {
    for (const double cost : {6.0, 10.0, std::numeric_limits<double>::infinity()}) {
      Edits edits;
      ASSERT_TRUE(edits.add_area(prism, 3) && edits.set_area_cost(3, cost));
      Crowd crowd = made(world, {.nodes = floor.nodes, .edits = edits});
      for (int k = 0; k < 8; ++k) {
        const double z = 2.1 + 1.7 * k;
        const int steps = steps_at_rest(crowd, world, {3, 0, z}, {21, 0, 16.5 - z});
        EXPECT_TRUE(steps >= 0 && steps <= 5) << "cost " << cost << ", from " << z << ": " << steps;
      }
    }
  }
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

// The openings have area kinds of the bake, and no edit adds an area.
TEST(CrowdEdits, AvatarsPlanByTheCostsOfBakedAreas) {
  Scene scene;
  const auto add = [&](double x0, double z0, double x1, double z1, AreaKind kind) {
    scene.add_quad({x0, 0, z0}, {x0, 0, z1}, {x1, 0, z1}, {x1, 0, z0}, kind);
  };
  add(0, 0, 10, 24, kAreaWalkable);
  add(10, 0, 14, 12, 5);
  add(10, 12, 14, 24, 6);
  add(14, 0, 24, 24, kAreaWalkable);
  scene.add_box({11.9, 0, 0}, {12.1, 3, 3});
  scene.add_box({11.9, 0, 5}, {12.1, 3, 19});
  scene.add_box({11.9, 0, 21}, {12.1, 3, 24});
  const World world = test::bake(scene, 0.1);
  for (const PathSpeedup speedup : {PathSpeedup::kNone, PathSpeedup::kLabels}) {
    Edits edits;
    Crowd crowd = made(world, {.speedup = speedup, .edits = edits});
    const Vec3d from{4, 0, 4}, to{20, 0, 4};
    const double near = crossing(crowd, world, from, to);
    EXPECT_TRUE(near > 0 && near < 6) << "a metre costs one";
    ASSERT_TRUE(edits.set_area_cost(5, 50));
    EXPECT_GT(crossing(crowd, world, from, to), 18);
    ASSERT_TRUE(edits.set_area_cost(6, std::numeric_limits<double>::infinity()));
    const double dear = crossing(crowd, world, from, to);
    EXPECT_TRUE(dear > 0 && dear < 6) << "the other opening is closed";
    // A crowd that is made when the costs are set already.
    ASSERT_TRUE(edits.set_area_cost(5, 50) && edits.set_area_cost(6, 1));
    Crowd later = made(world, {.speedup = speedup, .edits = edits});
    EXPECT_GT(crossing(later, world, from, to), 18);
  }
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
  EXPECT_EQ(restored->obstacle(*door)->phase, crowd.obstacle(*door)->phase);
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

// All kinds of edits, some of which the crowd has not followed when it is saved.
struct Saved {
  World world = two_openings();
  Edits edits;
  EditId door = 0, cart = 0, sheet = 0, area = 0, link = 0;
  Crowd crowd = made(world, {.edits = edits});

  Saved() {
    scattered(crowd, 40);
    make_calls(edits, crowd);
  }
  // To edits of the same crowd or, with another, of one that has as many steps.
  void make_calls(Edits& to, Crowd& of) {
    for (int step = 0; step < 5; ++step) of.step();
    door = *to.add_obstacle(kNearDoor, ObstacleKind::kStatic, ObstaclePolicy::kWait);
    cart = *to.add_obstacle(Prism::circle({6, 0, 6}, 0.4, 1), ObstacleKind::kKinematic);
    EXPECT_TRUE(to.remove(*to.add_obstacle(kFarDoor)));
    area = *to.add_area(Prism::box({14, -1, 8}, {18, 1, 16}), 2);
    EXPECT_TRUE(to.set_area_cost(2, 7) && to.set_area_cost(9, INFINITY));
    for (int step = 0; step < 5; ++step) of.step();
    const std::vector<Vec3d> corners{{12, 0, 18}, {12, 0, 22}, {12, 2, 20}};
    const std::vector<std::array<uint32_t, 3>> triangles{{0, 1, 2}};
    sheet = *to.add_obstacle(corners, triangles);
    link = *to.add_off_mesh_link(
        {world.find_place(0, {11, 0, 12}, 1), world.find_place(0, {13, 0, 12}, 1), 3, false});
    EXPECT_TRUE(to.move_obstacle(cart, Prism::circle({6, 0, 6.3}, 0.4, 1)));
    EXPECT_TRUE(to.set_active(door, false) && to.set_active(door, true));
  }
  void go_on(Crowd& of, Edits& with) const {
    for (int step = 0; step < 20; ++step) {
      if (step == 5) {
        EXPECT_TRUE(with.set_active(door, false) && with.remove(sheet));
        EXPECT_TRUE(with.move_obstacle(cart, Prism::circle({6.4, 0, 6.3}, 0.4, 1)));
      }
      if (step == 10) {
        EXPECT_TRUE(with.set_area_cost(2, 1) && with.set_active(link, false));
        EXPECT_TRUE(with.set_active(door, true));
      }
      of.step();
    }
  }
};

TEST(CrowdEdits, ASavedCrowdFillsEditsInWhichNothingWasEverChanged) {
  Saved s;
  const std::vector<uint8_t> saved = s.crowd.save();
  Context context;
  Edits filled;
  PathFinder finder = *PathFinder::create(s.world, {.edits = filled}, context);
  auto restored = Crowd::restore(s.world, {.workers = 2, .edits = filled}, saved, context);
  ASSERT_TRUE(restored) << restored.error().message;
  EXPECT_EQ(filled.version(), s.edits.version());
  EXPECT_EQ(restored->save(), saved);
  Path path;
  finder.find({.from = Vec3d{11, 0, 4}, .to = Vec3d{20, 0, 4}}, path);
  EXPECT_EQ(path.end, PathEnd::kNoPlace) << "a finder of the same edits knows the door";
  s.go_on(s.crowd, s.edits);
  s.go_on(*restored, filled);
  EXPECT_EQ(restored->save(), s.crowd.save());
  const auto next = filled.add_obstacle(kFarDoor), same = s.edits.add_obstacle(kFarDoor);
  ASSERT_TRUE(next && same);
  EXPECT_EQ(*next, *same) << "ids go on";
}

TEST(CrowdEdits, ASavedCrowdTakesEditsOfTheSameCallsAndNoOthers) {
  Saved s;
  const std::vector<uint8_t> saved = s.crowd.save();
  Context context;
  Edits same;
  Crowd spare = made(s.world, {.edits = same});
  s.make_calls(same, spare);
  auto restored = Crowd::restore(s.world, {.edits = same}, saved, context);
  ASSERT_TRUE(restored) << restored.error().message;
  EXPECT_EQ(restored->save(), saved);
  // One more call, one less, another one.
  ASSERT_TRUE(same.set_area_cost(3, 2));
  Edits fewer, other;
  ASSERT_TRUE(fewer.set_area_cost(1, 1) && other.add_obstacle(kFarDoor));
  for (const Edits& wrong : {same, fewer, other}) {
    const uint64_t version = wrong.version();
    const auto refused = Crowd::restore(s.world, {.edits = wrong}, saved, context);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, Errc::kBadFile);
    EXPECT_NE(refused.error().message.find("has other edits"), std::string::npos);
    EXPECT_EQ(wrong.version(), version);
  }
  // What fails fills nothing.
  Edits empty;
  EXPECT_FALSE(Crowd::restore(s.world, {.seed = 9, .edits = empty}, saved, context));
  Context cancelled;
  cancelled.cancel = true;
  EXPECT_FALSE(Crowd::restore(s.world, {.edits = empty}, saved, cancelled));
  EXPECT_EQ(empty.version(), 0u);
}

TEST(CrowdEdits, SavedNonsenseIsRefusedOrHarmless) {
  Saved s;
  std::vector<uint8_t> saved = s.crowd.save();
  Context context;
  uint64_t accepted = 0, refused = 0;
  const size_t size = saved.size() - 8;
  // The edits and calls are the last that is saved.
  const size_t first = (size - std::min<size_t>(size, 2000)) * 8;
  for (size_t bit = first; bit < size * 8; bit += bit % 97 + 1) {
    saved[bit / 8] ^= static_cast<uint8_t>(1 << bit % 8);
    const uint64_t sum = hash_bytes(saved.data(), size);
    std::memcpy(saved.data() + size, &sum, 8);
    Edits edits;
    auto restored = Crowd::restore(s.world, {.workers = 1, .edits = edits}, saved, context);
    if (restored) {
      for (int step = 0; step < 2; ++step) restored->step();
      ++accepted;
    } else {
      EXPECT_EQ(restored.error().code, Errc::kBadFile);
      EXPECT_EQ(edits.version(), 0u);
      ++refused;
    }
    saved[bit / 8] ^= static_cast<uint8_t>(1 << bit % 8);
  }
  EXPECT_GT(accepted, 20u);
  EXPECT_GT(refused, 20u);
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
