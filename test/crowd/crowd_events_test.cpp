// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <vector>

#include "throng/bake.h"
#include "throng/crowd.h"
#include "throng/scene.h"

namespace throng {
namespace {

World plane() {
  const auto scene =
      create_plane_scene({.ground = {{{0, 0}, {30, 0}, {30, 20}, {0, 20}}, {}},
                          .obstacles = {{{{14, 0}, {15, 0}, {15, 8}, {14, 8}}, {}}}});
  EXPECT_TRUE(scene);
  Context context;
  auto world = bake_world(*scene, {}, context);
  EXPECT_TRUE(world);
  return *world;
}

// Avatars that enter areas, found from positions alone, step by step.
TEST(CrowdEvents, ReportAvatarsThatEnterAreas) {
  const World world = plane();
  Context context;
  auto crowd = Crowd::create(world, {.workers = 2});
  ASSERT_TRUE(crowd);
  const auto ids = crowd->scatter(150, {}, context);
  ASSERT_TRUE(ids);
  std::vector<Place> goals;
  for (size_t i = 0; i < ids->size(); ++i) goals.push_back(world.random_place(0, 7, i));
  crowd->set_goals(*ids, goals);
  const std::vector<Prism> left = {Prism::box({0, -1, 0}, {8, 1, 20})};
  const std::vector<Prism> two = {Prism::box({10, -1, 10}, {13, 1, 20}),
                                  Prism::box({20, -1, 0}, {25, 1, 9})};
  ASSERT_EQ(*crowd->watch_area(left), 0);
  ASSERT_EQ(*crowd->watch_area(two), 1);
  const auto is_in = [&](const std::vector<Prism>& prisms, const Vec3d& p) {
    for (const Prism& prism : prisms) {
      const auto &low = prism.corners[0], &high = prism.corners[2];
      if (p.x >= low[0] && p.x <= high[0] && p.z >= low[1] && p.z <= high[1]) return true;
    }
    return false;
  };
  std::set<std::pair<uint32_t, int>> before;
  size_t entries = 0;
  std::vector<AvatarState> states;
  for (int step = 0; step < 200; ++step) {
    crowd->step();
    crowd->read(states);
    std::set<std::pair<uint32_t, int>> now, came;
    for (const AvatarState& a : states) {
      if (is_in(left, a.position)) now.emplace(a.id, 0);
      if (is_in(two, a.position)) now.emplace(a.id, 1);
    }
    for (const auto& one : now) {
      if (before.count(one) == 0) came.insert(one);
    }
    std::set<std::pair<uint32_t, int>> reported;
    for (const AreaEntry& entry : crowd->entered())
      reported.emplace(entry.id.slot1 - 1, entry.area);
    ASSERT_EQ(reported, came) << step;
    entries += reported.size();
    before = now;
  }
  EXPECT_GT(entries, 100U);
}

TEST(CrowdEvents, WatchingChangesNothingAndHasLimits) {
  const World world = plane();
  Context context;
  auto plain = Crowd::create(world, {}),
       watched = Crowd::create(world, {.tuning = {.no_progress_after = 1}});
  ASSERT_TRUE(plain && watched);
  for (Crowd* crowd : {&*plain, &*watched}) {
    const auto ids = crowd->scatter(100, {}, context);
    ASSERT_TRUE(ids);
    std::vector<Place> goals;
    for (size_t i = 0; i < ids->size(); ++i) goals.push_back(world.random_place(0, 3, i));
    crowd->set_goals(*ids, goals);
  }
  const std::vector<Prism> box = {Prism::box({0, -1, 0}, {8, 1, 20})};
  for (int n = 0; n < 64; ++n) EXPECT_TRUE(watched->watch_area(box));
  EXPECT_EQ(watched->watch_area(box).error().code, Errc::kLimit);
  EXPECT_FALSE(plain->watch_area({}));
  EXPECT_FALSE(plain->watch_area(std::vector<Prism>(1)));
  EXPECT_FALSE(Crowd::create(world, {.tuning = {.no_progress_after = -1}}));
  for (int step = 0; step < 50; ++step) {
    plain->step();
    watched->step();
    ASSERT_EQ(plain->state_hash(), watched->state_hash()) << step;
  }
}

// An avatar with a crate on every side makes no progress; one that walks, stands or is new is not
// reported.
TEST(CrowdEvents, ReportAvatarsWithoutProgress) {
  const World world = plane();
  Context context;
  auto crowd =
      Crowd::create(world, {.routing = Routing::kStraight, .tuning = {.no_progress_after = 2}});
  ASSERT_TRUE(crowd);
  const auto at = [&](double x, double z) { return world.find_place(0, {x, 0, z}, 1); };
  const std::vector<AvatarSpawn> spawns = {
      {at(13.6, 4), 0, 0, 0}, {at(2, 15), 0, 0, 0}, {at(5, 5), 0, 0, 0}};
  const auto ids = crowd->add(spawns, context);
  ASSERT_TRUE(ids);
  // Straight into the wall; along the hall; no goal.
  crowd->set_goals(*ids, std::vector<Place>{at(20, 4), at(28, 15), Place()});
  int checks = 0, reported = 0;
  for (int step = 1; step <= 100; ++step) {
    crowd->step();
    if (step % 20 != 0) {
      EXPECT_TRUE(crowd->no_progress().empty()) << step;
    }
    if (step % 20 != 0 || step == 20) continue;
    ++checks;
    for (const AvatarId id : crowd->no_progress()) {
      EXPECT_EQ(id, (*ids)[0]);
      ++reported;
    }
  }
  EXPECT_EQ(checks, 4);
  EXPECT_GE(reported, 1);
}

}  // namespace
}  // namespace throng
