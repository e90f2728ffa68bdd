// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "throng/crowd.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "core/random.h"
#include "crowd/collision_map.h"
#include "throng/bake.h"

namespace throng {
namespace {

// Two floors with pillars, a ramp between them and a hole in the upper one.
Scene small_garage() {
  Scene scene;
  scene.add_quad({0, 0, 0}, {0, 0, 30}, {36, 0, 30}, {36, 0, 0});
  scene.add_quad({0, 3, 0}, {0, 3, 30}, {18, 3, 30}, {18, 3, 0});
  scene.add_quad({18, 3, 0}, {18, 3, 4}, {30, 0, 4}, {30, 0, 0});
  for (double x = 3; x < 30; x += 6) {
    for (double z = 8; z < 30; z += 6) scene.add_box({x, 0, z}, {x + 0.5, 2.9, z + 0.5});
  }
  scene.add_box({8, 0, 1}, {12, 1.5, 3}, kAreaBlocked);
  return scene;
}

World baked(const Scene& scene, BakeConfig config = {}) {
  Context context;
  auto world = bake_world(scene, config, context);
  EXPECT_TRUE(world) << world.error().message;
  return std::move(*world);
}

TEST(Crowd, NobodyEverOverlapsOrEntersAWall) {
  const World world = baked(small_garage());
  for (int32_t avatar_class = 0; avatar_class < 4; ++avatar_class) {
    auto crowd = Crowd::create(world, {.avatars = 120, .avatar_class = avatar_class, .seed = 5});
    ASSERT_TRUE(crowd) << crowd.error().message;
    uint64_t moved = 0;
    for (int step = 0; step < 400; ++step) {
      moved += crowd->step().moved;
      const CrowdCheck check = crowd->check();
      ASSERT_EQ(check.overlaps, 0u) << "class " << avatar_class << " step " << step;
      ASSERT_EQ(check.wall_entries, 0u) << "class " << avatar_class << " step " << step;
    }
    EXPECT_GT(moved, 120u * 400u / 2) << "class " << avatar_class;
  }
}

TEST(Crowd, AvatarsChangeFloorsByTheRamp) {
  const World world = baked(small_garage());
  auto crowd = Crowd::create(world, {.avatars = 60, .seed = 3});
  ASSERT_TRUE(crowd);
  std::vector<AvatarState> before, after;
  crowd->read(before);
  for (int step = 0; step < 3000; ++step) crowd->step();
  crowd->read(after);
  int up = 0, down = 0;
  for (size_t i = 0; i < before.size(); ++i) {
    up += before[i].position.y < 0.5 && after[i].position.y > 2.5;
    down += before[i].position.y > 2.5 && after[i].position.y < 0.5;
  }
  EXPECT_GT(up, 0);
  EXPECT_GT(down, 0);
}

TEST(Crowd, SameStateForAnyNumberOfThreads) {
  const World world = baked(small_garage());
  for (int32_t workers : {1, 2, 3, 8}) {
    auto crowd = Crowd::create(world, {.avatars = 300, .seed = 11, .workers = workers});
    ASSERT_TRUE(crowd);
    for (int step = 0; step < 300; ++step) crowd->step();
    EXPECT_EQ(crowd->state_hash(), 2494023263461056009u) << "workers = " << workers;
  }
}

TEST(Crowd, TwoCrowdsLiveSideBySide) {
  const World world = baked(small_garage());
  auto a = Crowd::create(world, {.avatars = 50, .seed = 1});
  auto b = Crowd::create(world, {.avatars = 50, .seed = 1});
  ASSERT_TRUE(a && b);
  for (int step = 0; step < 50; ++step) {
    a->step();
    b->step();
  }
  EXPECT_EQ(a->state_hash(), b->state_hash());
}

TEST(Crowd, FastAvatarsCheckEveryCellTheyCross) {
  Scene scene;  // thin walls, 1 m apart: a step of 5 m would jump over them
  scene.add_quad({0, 0, 0}, {0, 0, 20}, {20, 0, 20}, {20, 0, 0});
  for (double x = 2; x < 20; x += 2) scene.add_quad({x, 0, 0}, {x, 2, 0}, {x, 2, 20}, {x, 0, 20});
  const World world = baked(scene);
  auto crowd = Crowd::create(world, {.avatars = 40, .dt = 1, .speed = 5, .seed = 9});
  ASSERT_TRUE(crowd) << crowd.error().message;
  std::vector<AvatarState> before, after;
  crowd->read(before);
  for (int step = 0; step < 200; ++step) crowd->step();
  crowd->read(after);
  for (size_t i = 0; i < before.size(); ++i) {
    EXPECT_EQ(std::floor(before[i].position.x / 2), std::floor(after[i].position.x / 2)) << i;
  }
}

TEST(Crowd, SaysHowManyFit) {
  Scene scene;
  scene.add_quad({0, 0, 0}, {0, 0, 6}, {6, 0, 6}, {6, 0, 0});
  const World world = baked(scene);
  auto crowd = Crowd::create(world, {.avatars = 100000});
  ASSERT_FALSE(crowd);
  EXPECT_EQ(crowd.error().code, Errc::kLimit);
  const int fit = std::stoi(crowd.error().message.substr(7));
  EXPECT_GT(fit, 15);
  EXPECT_LT(fit, 145);
  EXPECT_TRUE(Crowd::create(world, {.avatars = static_cast<uint32_t>(fit)}));
}

TEST(Crowd, BadSettingsAreRefusedWithASentence) {
  const World world = baked(small_garage());
  EXPECT_EQ(Crowd::create(world, {.avatar_class = 9}).error().code, Errc::kNotFound);
  EXPECT_EQ(Crowd::create(world, {.dt = 0}).error().code, Errc::kBadConfig);
  EXPECT_EQ(Crowd::create(world, {.dt = NAN}).error().code, Errc::kBadConfig);
  EXPECT_EQ(Crowd::create(world, {.speed = -1}).error().code, Errc::kBadConfig);
  EXPECT_EQ(Crowd::create(World{}, {}).error().code, Errc::kBadConfig);
}

// [TC00]'s map as printed, on one floor: an integer per pixel, 1 added to nine of them.
struct PrintedMap {
  std::map<std::pair<int, int>, int> count;
  void add(int x, int z, int n) {
    for (int dz = -1; dz <= 1; ++dz) {
      for (int dx = -1; dx <= 1; ++dx) count[{x + dx, z + dz}] += n;
    }
  }
  // May whoever stands on (x, z) enter (nx, nz)? His own share is removed first.
  bool may_enter(int x, int z, int nx, int nz) {
    add(x, z, -1);
    const bool free = count[{nx, nz}] == 0;
    add(x, z, 1);
    return free;
  }
};

TEST(CollisionMap, AnswersLikeThePrintedMap) {
  constexpr int kSide = 20;
  CollisionMap map(kSide, kSide, 1, 0, 3000, 1750);
  PrintedMap printed;
  const auto mark = [&](int x, int z) {
    return map.mark({(int64_t{x} << kUnitBits) + 7, (int64_t{z} << kUnitBits) + 2000}, 120);
  };
  std::vector<std::pair<int, int>> bodies;
  uint64_t n = 0;
  int refused = 0;
  for (int i = 0; i < 20000; ++i) {
    const int x = static_cast<int>(random_below(1, 1, n++, kSide));
    const int z = static_cast<int>(random_below(1, 1, n++, kSide));
    if (bodies.size() < 25) {
      const bool free = printed.count[{x, z}] == 0;
      ASSERT_EQ(map.is_free(mark(x, z)), free);
      if (!free) continue;
      map.set(mark(x, z));
      printed.add(x, z, 1);
      bodies.emplace_back(x, z);
      continue;
    }
    auto& [bx, bz] = bodies[random_below(1, 1, n++, bodies.size())];
    map.clear(mark(bx, bz));
    const bool free = map.is_free(mark(x, z));
    ASSERT_EQ(free, printed.may_enter(bx, bz, x, z));
    if (free) {
      printed.add(bx, bz, -1);
      printed.add(x, z, 1);
      bx = x;
      bz = z;
    }
    refused += !free;
    map.set(mark(bx, bz));
  }
  EXPECT_GT(refused, 1000);
}

TEST(CollisionMap, FloorsAboveEachOtherDoNotSeeEachOther) {
  CollisionMap map(10, 10, 1, 0, 200000, 1750);
  const GroundPoint p{5 << kUnitBits, 5 << kUnitBits};
  for (int32_t y = 0; y < 200000; y += 2250) {  // words of 16 m are crossed many times
    ASSERT_TRUE(map.is_free(map.mark(p, y))) << y;
    map.set(map.mark(p, y));
    ASSERT_FALSE(map.is_free(map.mark(p, y + 1749))) << y;
    ASSERT_FALSE(map.is_free(map.mark({p.x + kUnitsPerCell, p.z}, y))) << y;
    ASSERT_TRUE(map.is_free(map.mark({p.x + 2 * kUnitsPerCell, p.z}, y))) << y;
  }
}

}  // namespace
}  // namespace throng
