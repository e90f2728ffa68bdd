// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "baked.h"
#include "crowds.h"
#include "throng/crowd.h"
#include "worlds.h"

// Avatars that do not get on take another route. The oracle is the same crowd without it.
namespace throng {
namespace {

constexpr double kDt = 0.1;  // [s]

// A wall across X at 5 m, with doors 1 m wide whose middles are at z = 2 and z = 8.
World two_doors() {
  Scene scene;
  scene.add_box({0, -0.5, 0}, {10, 0, 10});
  scene.add_box({4.9, 0, 0}, {5.1, 3, 1.5});
  scene.add_box({4.9, 0, 2.5}, {5.1, 3, 7.5});
  scene.add_box({4.9, 0, 8.5}, {5.1, 3, 10});
  return test::bake(scene, 0.1, {AvatarClass{}});
}

AvatarId stand_in_passage(Crowd& crowd, const World& world, double x, double z) {
  const AvatarId id = added(crowd, world.find_place(0, {x, 0, z}, 0.5), {.radius = 0.25});
  EXPECT_TRUE(id);
  const Vec3d still{};
  crowd.set_velocities(std::span(&id, 1), std::span(&still, 1));
  return id;
}

// `count` avatars in rows of four from `corner` on, 0.8 m apart, and goals as far apart behind.
std::vector<AvatarId> add_walkers(Crowd& crowd, const World& world, int count, Vec3d corner,
                                  Vec3d goal) {
  std::vector<AvatarId> ids;
  for (int i = 0; i < count; ++i) {
    const double dx = 0.8 * (i % 4), dz = 0.8 * (i / 4);
    ids.push_back(added(crowd, world.find_place(0, {corner.x + dx, 0, corner.z + dz}, 0.5)));
    const Place to = world.find_place(0, {goal.x + 0.7 * (i % 4), 0, goal.z + 0.7 * (i / 4)}, 0.5);
    EXPECT_TRUE(ids.back() && to) << i;
    crowd.set_goals(std::span(&ids.back(), 1), std::span(&to, 1));
  }
  return ids;
}

struct Outcome {
  uint64_t arrived = 0, changed = 0, searches = 0;

  void step(Crowd& crowd) {
    const CrowdReport report = crowd.step();
    arrived += report.arrived;
    changed += report.changed_route;
    searches += report.jam_searches;
  }
};

// Eight avatars before the first door, in which one stands for good.
Crowd jammed(const World& world, const CrowdConfig& config) {
  Crowd crowd = made(world, config);
  stand_in_passage(crowd, world, 5, 2);
  add_walkers(crowd, world, 8, {1, 0, 1.4}, {7, 0, 1.2});
  return crowd;
}

TEST(Congestion, ThoseBehindAJammedDoorTakeTheOther) {
  const World world = two_doors();
  for (const bool avoid : {false, true}) {
    Crowd crowd = jammed(world, {.avoid_jams = avoid});
    Outcome all;
    for (int step = 0; step < 2400; ++step) {
      all.step(crowd);
      if (step % 100 != 0) continue;
      const CrowdCheck check = crowd.check();
      ASSERT_EQ(check.overlaps + check.wall_entries, 0u) << step;
    }
    // Five of the eight arrive; the others are held up too little to look for another route.
    EXPECT_GE(all.arrived, avoid ? 5u : 0u);
    EXPECT_LE(all.arrived, avoid ? 8u : 0u);
    // Some again in the crowd before the other door.
    EXPECT_GE(all.changed, avoid ? 5u : 0u);
    EXPECT_LE(all.changed, avoid ? 40u : 0u);
    EXPECT_GE(all.searches, all.changed);
  }
}

TEST(Congestion, TheStateIsTheSameForAnyWorkers) {
  const World world = two_doors();
  Crowd one = jammed(world, {.workers = 1}), three = jammed(world, {.workers = 3});
  Outcome by_one, by_three;
  for (int step = 0; step < 1000; ++step) {
    by_one.step(one);
    by_three.step(three);
    ASSERT_EQ(one.state_hash(), three.state_hash()) << step;
  }
  EXPECT_GT(by_one.changed, 0u);
  EXPECT_EQ(by_one.changed, by_three.changed);
  EXPECT_EQ(by_one.searches, by_three.searches);
  EXPECT_EQ(one.save(), three.save());
}

TEST(Congestion, ARestoredCrowdTakesTheSameRoutes) {
  const World world = two_doors();
  Crowd crowd = jammed(world, {});
  for (int step = 0; step < 155; ++step) crowd.step();
  const std::vector<uint8_t> saved = crowd.save();
  Context context;
  EXPECT_FALSE(Crowd::restore(world, {.avoid_jams = false}, saved, context));
  auto restored = Crowd::restore(world, {}, saved, context);
  ASSERT_TRUE(restored) << restored.error().message;
  EXPECT_EQ(restored->save(), saved);
  Outcome was, is;
  for (int step = 0; step < 1000; ++step) {
    was.step(crowd);
    is.step(*restored);
    ASSERT_EQ(restored->state_hash(), crowd.state_hash()) << step;
    ASSERT_EQ(is.changed, was.changed) << step;
  }
  EXPECT_GT(is.changed, 0u);
}

// Nothing changes but a search now and then. In single file none stands aside either.
TEST(Congestion, WhereThereIsNoOtherRouteTheStepsAreTheSame) {
  Scene scene;
  scene.add_box({0, -0.5, 0}, {12, 0, 0.6});
  const World world = test::bake(scene, 0.1, {AvatarClass{}});
  std::vector<uint64_t> hashes;
  for (const bool avoid : {false, true}) {
    Crowd crowd = made(world, {.avoid_jams = avoid});
    stand_in_passage(crowd, world, 9, 0.3);
    for (int i = 0; i < 10; ++i) {
      const AvatarId id = added(crowd, world.find_place(0, {0.5 + 0.7 * i, 0, 0.3}, 0.5));
      const Place goal = world.find_place(0, {11.5, 0, 0.3}, 0.5);
      ASSERT_TRUE(id && goal);
      crowd.set_goals(std::span(&id, 1), std::span(&goal, 1));
    }
    Outcome all;
    for (int step = 0; step < 1200; ++step) all.step(crowd);
    hashes.push_back(crowd.state_hash());
    EXPECT_EQ(all.changed, 0u);
    EXPECT_EQ(all.searches > 0, avoid);
    EXPECT_LE(all.searches, 60u);  // of each avatar after 6, 16, 36 and 76 s
  }
  EXPECT_EQ(hashes[0], hashes[1]);
}

// Detours around the crowd lead back to the door: no avatar may take one.
TEST(Congestion, ACrowdBeforeItsOnlyDoorKeepsItsRoute) {
  Scene scene;
  scene.add_box({0, -0.5, 0}, {20, 0, 20});
  scene.add_box({11.9, 0, 0}, {12.1, 3, 9.55});
  scene.add_box({11.9, 0, 10.45}, {12.1, 3, 20});
  const World world = test::bake(scene, 0.1, {AvatarClass{}});
  for (uint64_t seed = 1; seed <= 3; ++seed) {
    Crowd crowd = made(world, {.seed = seed});
    const Place goal = world.find_place(0, {16, 0, 10}, 0.5);
    ASSERT_TRUE(goal);
    for (int i = 0; i < 120; ++i) {
      const AvatarId id =
          added(crowd, world.find_place(0, {5 + 0.6 * (i % 10), 0, 6.4 + 0.6 * (i / 10)}, 0.5));
      ASSERT_TRUE(id) << i;
      crowd.set_goals(std::span(&id, 1), std::span(&goal, 1));
    }
    Outcome all;
    for (int step = 0; step < 600; ++step) {
      all.step(crowd);
      for (const AvatarId id : crowd.arrived()) crowd.remove(std::span(&id, 1));
    }
    EXPECT_GT(all.arrived, 60u);
    EXPECT_GT(all.searches, 20u);
    EXPECT_EQ(all.changed, 0u);
  }
}

TEST(Congestion, CrowdsBeforeTwoEqualDoorsDoNotOscillate) {
  Scene scene;
  scene.add_box({0, -0.5, 0}, {20, 0, 12});
  scene.add_box({9.9, 0, 0}, {10.1, 3, 2.4});
  scene.add_box({9.9, 0, 3.6}, {10.1, 3, 8.4});
  scene.add_box({9.9, 0, 9.6}, {10.1, 3, 12});
  const World world = test::bake(scene, 0.1, {AvatarClass{}});
  Crowd crowd = made(world);
  for (int i = 0; i < 100; ++i) {
    const double dx = 0.8 * (i % 10), dz = 0.8 * (i / 10);
    const AvatarId id = added(crowd, world.find_place(0, {1 + dx, 0, 2.4 + dz}, 0.5));
    const Place goal = world.find_place(0, {12 + 0.8 * (i % 10), 0, 2.4 + dz}, 0.5);
    ASSERT_TRUE(id && goal) << i;
    crowd.set_goals(std::span(&id, 1), std::span(&goal, 1));
  }
  Outcome all;
  double avatar_minutes = 0;
  for (int step = 0; step < 1200 && all.arrived < 100; ++step) {
    all.step(crowd);
    avatar_minutes += static_cast<double>(100 - all.arrived) * kDt / 60;
  }
  EXPECT_LE(static_cast<double>(all.changed), 0.3 * avatar_minutes);
}

}  // namespace
}  // namespace throng
