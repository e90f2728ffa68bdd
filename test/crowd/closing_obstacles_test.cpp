// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <span>
#include <vector>

#include "baked.h"
#include "crowds.h"
#include "throng/crowd.h"
#include "worlds.h"

// Obstacles that are to become active where avatars are: from then on none enters, those inside
// leave.
namespace throng {
namespace {

// A hall of 40 m by 40 m, cut by a wall at x = 20 with an opening of 2 m at z = 10.
World hall() {
  Scene scene = worlds::flat(40);
  scene.add_box({20, 0, 0}, {20.4, 3, 9});
  scene.add_box({20, 0, 11}, {20.4, 3, 40});
  return test::bake(scene, 0.1);
}

const Prism kDoor = Prism::box({19.9, 0, 8.9}, {20.5, 2, 11.1});

std::map<uint32_t, Vec3d> positions(const Crowd& crowd) {
  std::vector<AvatarState> states;
  crowd.read(states);
  std::map<uint32_t, Vec3d> found;
  for (const AvatarState& s : states) found[s.id] = s.position;
  return found;
}

// From a place to a box in plan. [m]
double distance_to(const Prism& box, const Vec3d& p) {
  const double dx = std::max({box.corners[0][0] - p.x, p.x - box.corners[2][0], 0.0});
  const double dz = std::max({box.corners[0][1] - p.z, p.z - box.corners[2][1], 0.0});
  return std::hypot(dx, dz);
}

std::set<uint32_t> inside(const Crowd& crowd, const Prism& box, double radius) {
  std::set<uint32_t> found;
  for (const auto& [id, p] : positions(crowd)) {
    if (distance_to(box, p) < radius + 1e-4) found.insert(id);
  }
  return found;
}

bool is_free(const Crowd& crowd) {
  const CrowdCheck found = crowd.check();
  return found.wall_entries + found.overlaps + found.obstacle_entries == 0;
}

// 250 people in the west of the hall that walk to its east, 20 s later.
struct Rush {
  World world = hall();
  double radius = world.summary().classes[0].radius;
  Edits edits;
  CrowdConfig config;
  Crowd crowd;
  std::vector<AvatarId> ids;

  explicit Rush(uint64_t seed, int32_t workers)
      : config{.seed = seed, .workers = workers, .edits = edits}, crowd(made(world, config)) {
    Context context;
    std::vector<AvatarSpawn> spawns;
    for (int i = 0; i < 250; ++i) {
      const double x = 2 + (i % 16) * 1.0 + static_cast<double>(seed % 5) * 0.1;
      spawns.push_back({.place = world.find_place(0, {x, 0, 2 + (i / 16) * 1.0}, 0.5)});
    }
    ids = *crowd.add(spawns, context);
    std::vector<Place> goals;
    for (size_t i = 0; i < ids.size(); ++i) {
      goals.push_back(world.find_place(
          0, {26 + static_cast<double>(i % 12), 0, 3 + static_cast<double>(i / 12) * 0.6}, 0.5));
    }
    crowd.set_goals(ids, goals);
    for (int step = 0; step < 200; ++step) crowd.step();
  }
};

TEST(ClosingObstacles, OnlyAvatarsInsideADoorComeThroughOnceItCloses) {
  for (const uint64_t seed : {1, 2, 3}) {
    uint64_t first = 0;
    for (const int32_t workers : {1, 3}) {
      Rush rush(seed, workers);
      Crowd& crowd = rush.crowd;
      const auto before = positions(crowd);
      const std::set<uint32_t> in_it = inside(crowd, kDoor, rush.radius);
      EXPECT_GT(in_it.size(), 1u);
      const EditId door = put_up(crowd, rush.edits, kDoor);
      EXPECT_TRUE(crowd.obstacle(door)->waits());
      EXPECT_GE(crowd.obstacle(door)->occupants, in_it.size());
      std::set<uint32_t> still = in_it;
      for (int step = 0; step < 100; ++step) {
        crowd.step();
        ASSERT_TRUE(is_free(crowd)) << step;
        const std::set<uint32_t> now = inside(crowd, kDoor, rush.radius - 2e-4);
        for (const uint32_t id : now) ASSERT_TRUE(still.count(id)) << "entered at step " << step;
        still = inside(crowd, kDoor, rush.radius);
        if (crowd.obstacle(door)->is_up()) {
          ASSERT_TRUE(now.empty());
        }
      }
      const ObstacleState state = *crowd.obstacle(door);
      ASSERT_TRUE(state.is_up());
      EXPECT_NEAR(state.requested_at, 20, 1e-9);
      EXPECT_GT(state.up_at, state.requested_at);
      EXPECT_LE(state.up_at, state.requested_at + 3) << seed;
      for (const auto& [id, p] : positions(crowd)) {
        const bool came_through = before.at(id).x < 20.2 && p.x > 20.5;
        if (came_through) {
          EXPECT_TRUE(in_it.count(id));
        }
      }
      if (first == 0) first = crowd.state_hash();
      EXPECT_EQ(crowd.state_hash(), first) << seed << ' ' << workers;
    }
  }
}

TEST(ClosingObstacles, OneThatWaitsStaysOpenAsLongAsPeopleStreamThrough) {
  Rush rush(1, 1);
  const EditId door =
      put_up(rush.crowd, rush.edits, kDoor, ObstacleKind::kStatic, ObstaclePolicy::kWait);
  for (int step = 0; step < 100; ++step) rush.crowd.step();
  const ObstacleState state = *rush.crowd.obstacle(door);
  EXPECT_FALSE(state.is_up());
  EXPECT_EQ(state.policy, ObstaclePolicy::kWait);
  EXPECT_LT(state.up_at, 0);
  EXPECT_NEAR(state.requested_at, 20, 1e-9);
  EXPECT_GT(state.occupants, 0u);
}

TEST(ClosingObstacles, ADoorThatIsSwitchedOnClosesTheSameAndOpensAgain) {
  Rush rush(2, 2);
  Crowd& crowd = rush.crowd;
  // Where no avatar is yet; then it is moved while it is open.
  const EditId door = put_up(crowd, rush.edits, Prism::box({38, 0, 1}, {38.5, 2, 2}));
  const auto set_active = [&](bool active) {
    ASSERT_TRUE(rush.edits.set_active(door, active));
    follow(crowd);
  };
  set_active(false);
  EXPECT_LT(crowd.obstacle(door)->requested_at, 0);
  ASSERT_TRUE(rush.edits.move_obstacle(door, kDoor));
  set_active(true);
  for (int step = 0; step < 30 && !crowd.obstacle(door)->is_up(); ++step) {
    crowd.step();
    ASSERT_TRUE(is_free(crowd));
  }
  EXPECT_TRUE(crowd.obstacle(door)->is_up());
  set_active(false);
  // Requested to close, and to open before it has: avatars come in again.
  const auto west = [&] {
    int count = 0;
    for (const auto& [id, p] : positions(crowd)) count += p.x < 20 ? 1 : 0;
    return count;
  };
  std::vector<Place> goals;
  for (size_t i = 0; i < rush.ids.size(); ++i) {
    goals.push_back(rush.world.find_place(
        0, {26 + static_cast<double>(i % 12), 0, 3 + static_cast<double>(i / 12) * 0.6}, 0.5));
  }
  crowd.set_goals(rush.ids, goals);
  for (int step = 0; step < 100; ++step) crowd.step();
  set_active(true);
  EXPECT_TRUE(crowd.obstacle(door)->waits());
  crowd.step();
  set_active(false);
  crowd.set_goals(rush.ids, goals);
  const int before = west();
  for (int step = 0; step < 100; ++step) {
    crowd.step();
    ASSERT_TRUE(is_free(crowd));
  }
  EXPECT_LT(west(), before - 10);
}

TEST(ClosingObstacles, AvatarsThatStandOrHaveArrivedInsideLeaveToo) {
  const World world = test::bake(worlds::flat(20), 0.1);
  for (const bool has_arrived : {false, true}) {
    Edits edits;
    Crowd crowd = made(world, {.edits = edits});
    const Place place = world.find_place(0, {10, 0, 10}, 0.5);
    const AvatarId id = added(crowd, place);
    if (has_arrived) crowd.set_goals(std::span(&id, 1), std::span(&place, 1));
    for (int step = 0; step < 5; ++step) crowd.step();
    const EditId crate = put_up(crowd, edits, Prism::box({8, 0, 9}, {11, 2, 14}));
    EXPECT_TRUE(crowd.obstacle(crate)->waits());
    for (int step = 0; step < 30; ++step) {
      crowd.step();
      ASSERT_TRUE(is_free(crowd));
    }
    EXPECT_TRUE(crowd.obstacle(crate)->is_up());
    const Vec3d p = positions(crowd).begin()->second;
    EXPECT_TRUE(p.x > 11 || p.z < 9) << "the nearest side, " << p.x << ' ' << p.z;
    EXPECT_TRUE(crowd.no_progress().empty());
  }
}

TEST(ClosingObstacles, AnAvatarThatCannotLeaveKeepsItOpenAndIsReported) {
  Scene scene = worlds::flat(20);
  scene.add_box({9, 0, 9}, {9.1, 3, 11});
  scene.add_box({11, 0, 9}, {11.1, 3, 11});
  scene.add_box({9, 0, 9}, {11, 3, 9.1});
  scene.add_box({9, 0, 11}, {11.1, 3, 11.1});
  const World world = test::bake(scene, 0.1);
  Edits edits;
  Crowd crowd = made(world, {.edits = edits});
  const AvatarId id = added(crowd, world.find_place(0, {10, 0, 10}, 0.5));
  ASSERT_TRUE(id);
  const Place goal = world.find_place(0, {3, 0, 3}, 0.5);
  crowd.set_goals(std::span(&id, 1), std::span(&goal, 1));
  const EditId crate = put_up(crowd, edits, Prism::box({8, 0, 8}, {12, 2, 12}));
  for (int step = 0; step < 100; ++step) {
    EXPECT_EQ(crowd.step().waiting, 1u);
    ASSERT_EQ(crowd.blockers().size(), 1u);
    EXPECT_EQ(crowd.blockers()[0], id);
    ASSERT_TRUE(is_free(crowd));
  }
  const ObstacleState state = *crowd.obstacle(crate);
  EXPECT_TRUE(state.waits());
  EXPECT_EQ(state.occupants, 1u);
  EXPECT_LT(state.up_at, 0);
  crowd.remove(std::span(&id, 1));
  crowd.step();
  EXPECT_TRUE(crowd.obstacle(crate)->is_up());
}

TEST(ClosingObstacles, PathsLeadAroundOneFromTheTimeOfTheRequest) {
  Scene scene = worlds::flat(24);
  scene.add_box({11.9, 0, 0}, {12.1, 3, 3});
  scene.add_box({11.9, 0, 5}, {12.1, 3, 19});
  scene.add_box({11.9, 0, 21}, {12.1, 3, 24});
  const World world = test::bake(scene, 0.1);
  Edits edits;
  Crowd crowd = made(world, {.edits = edits});
  const AvatarId in_door = added(crowd, world.find_place(0, {12, 0, 4}, 0.5));
  const AvatarId id = added(crowd, world.find_place(0, {6, 0, 4}, 0.5));
  const Vec3d still{};
  crowd.set_velocities(std::span(&in_door, 1), std::span(&still, 1));
  const Place goal = world.find_place(0, {20, 0, 4}, 0.5);
  crowd.set_goals(std::span(&id, 1), std::span(&goal, 1));
  for (int step = 0; step < 5; ++step) crowd.step();
  const EditId door = put_up(crowd, edits, Prism::box({11.5, 0, 3}, {12.5, 2, 5}));
  bool there = false;
  for (int step = 0; step < 600 && !there; ++step) {
    crowd.step();
    there = !crowd.arrived().empty();
    ASSERT_TRUE(is_free(crowd));
  }
  EXPECT_TRUE(there) << "by the other door";
  EXPECT_TRUE(crowd.obstacle(door)->waits()) << "an externally controlled avatar stays in it";
}

TEST(ClosingObstacles, ACrowdRestoredWhileOneClosesContinuesTheSame) {
  Rush rush(3, 2);
  Crowd& crowd = rush.crowd;
  const EditId door = put_up(crowd, rush.edits, kDoor);
  for (int step = 0; step < 4; ++step) crowd.step();
  ASSERT_TRUE(crowd.obstacle(door)->waits());
  const std::vector<uint8_t> saved = crowd.save();
  Context context;
  CrowdConfig config = rush.config;
  config.workers = 1;
  auto restored = Crowd::restore(rush.world, config, saved, context);
  ASSERT_TRUE(restored) << restored.error().message;
  EXPECT_EQ(restored->save(), saved);
  for (int step = 0; step < 60; ++step) {
    crowd.step();
    restored->step();
    ASSERT_EQ(restored->state_hash(), crowd.state_hash()) << step;
  }
  EXPECT_TRUE(restored->obstacle(door)->is_up());
  EXPECT_EQ(restored->obstacle(door)->up_at, crowd.obstacle(door)->up_at);
}

TEST(ClosingObstacles, OverlappingOnesAreLeftAndNeverEnteredFromEachOther) {
  const World world = test::bake(worlds::flat(30), 0.1);
  for (const uint64_t seed : {1, 2, 3}) {
    Edits edits;
    Crowd crowd = made(world, {.seed = seed, .edits = edits});
    const auto ids = scattered(crowd, 400);
    std::vector<Place> goals;
    for (size_t i = 0; i < ids.size(); ++i) goals.push_back(world.random_place(0, seed, i));
    crowd.set_goals(ids, goals);
    for (int step = 0; step < 20; ++step) crowd.step();
    const Prism prisms[] = {Prism::box({10, 0, 10}, {14, 2, 13}),
                            Prism::box({12, 0, 11}, {18, 2, 18}),
                            Prism::circle({24, 0, 8}, 2, 2, 9)};
    std::vector<EditId> obstacles;
    for (const Prism& prism : prisms) obstacles.push_back(put_up(crowd, edits, prism));
    const auto up = [&](size_t i) { return crowd.obstacle(obstacles[i])->is_up(); };
    for (int step = 0; step < 300 && !(up(0) && up(1) && up(2)); ++step) {
      std::set<uint32_t> before[2];
      for (size_t k = 0; k < 2; ++k) before[k] = inside(crowd, prisms[k], AvatarClass{}.radius);
      crowd.step();
      ASSERT_TRUE(is_free(crowd));
      for (size_t k = 0; k < 2; ++k) {
        for (const uint32_t id : inside(crowd, prisms[k], AvatarClass{}.radius - 2e-4)) {
          ASSERT_TRUE(before[k].count(id));
        }
      }
    }
    EXPECT_TRUE(up(0) && up(1) && up(2)) << seed;
  }
}

TEST(ClosingObstacles, AFlyerInsideGetsOutAndNoOtherEnters) {
  const World world = test::bake(worlds::flat(30), 0.1, {flyer_class(), default_classes()[0]});
  Edits edits;
  Crowd crowd = made(world, {.edits = edits});
  const AvatarId hovers = added(crowd, air_place({15, 5, 15}));
  const AvatarId crosses = added(crowd, air_place({5, 5, 15}));
  ASSERT_TRUE(hovers && crosses);
  const Place goal = air_place({25, 5, 15});
  crowd.set_goals(std::span(&crosses, 1), std::span(&goal, 1));
  const Prism box = Prism::box({14.5, 0, 10}, {15.8, 12, 20});
  const EditId wall = put_up(crowd, edits, box);
  EXPECT_TRUE(crowd.obstacle(wall)->waits());
  bool there = false;
  double up_at = -1;
  for (int step = 0; step < 600 && !there; ++step) {
    crowd.step();
    ASSERT_TRUE(is_free(crowd));
    for (const AvatarId id : crowd.arrived()) there = there || id == crosses;
    const Vec3d at = crowd.read(crosses)->position;
    ASSERT_TRUE(at.y >= 12 || distance_to(box, at) > 0) << step;
    up_at = crowd.obstacle(wall)->up_at;
  }
  EXPECT_TRUE(there);
  EXPECT_GT(up_at, 0);
  EXPECT_LT(up_at, 5);
}

}  // namespace
}  // namespace throng
