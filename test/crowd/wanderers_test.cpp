// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include "throng/bake.h"
#include "throng/papers.h"

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

TEST(Wanderers, NoAvatarEverOverlapsAnotherOrEntersAWall) {
  const World world = baked(small_garage());
  for (int32_t avatar_class = 0; avatar_class < 4; ++avatar_class) {
    auto crowd =
        Wanderers::create(world, {.avatars = 120, .avatar_class = avatar_class, .seed = 5});
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

TEST(Wanderers, AvatarsChangeFloorsByTheRamp) {
  const World world = baked(small_garage());
  auto crowd = Wanderers::create(world, {.avatars = 60, .seed = 3});
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

TEST(Wanderers, SameStateForAnyNumberOfThreads) {
  const World world = baked(small_garage());
  for (int32_t workers : {1, 2, 3, 8}) {
    auto crowd = Wanderers::create(world, {.avatars = 300, .seed = 11, .workers = workers});
    ASSERT_TRUE(crowd);
    for (int step = 0; step < 300; ++step) crowd->step();
    EXPECT_EQ(crowd->state_hash(), 4112767451889562575u) << "workers = " << workers;
  }
}

TEST(Wanderers, ClassesOfAllSizesShareTheFloors) {
  const World world = baked(small_garage());
  WanderConfig config{.avatars = 150,
                      .seed = 6,
                      .also = {{.avatar_class = 3, .avatars = 12},  // giants
                               {.avatar_class = 1, .avatars = 80},
                               {.avatar_class = 2, .avatars = 15}}};
  std::set<uint64_t> hashes;
  for (const int32_t workers : {1, 2, 8}) {
    config.workers = workers;
    auto crowd = Wanderers::create(world, config);
    ASSERT_TRUE(crowd) << crowd.error().message;
    ASSERT_EQ(crowd->size(), 257u);
    std::vector<AvatarState> before, after;
    crowd->read(before);
    uint64_t moved = 0, blocked = 0;
    for (int step = 0; step < 400; ++step) {
      const WanderReport report = crowd->step();
      moved += report.moved;
      blocked += report.blocked_by_avatar;
      const CrowdCheck check = crowd->check();
      ASSERT_EQ(check.overlaps + check.wall_entries, 0u) << "step " << step;
    }
    crowd->read(after);
    EXPECT_GT(moved, 257u * 400u / 2);
    EXPECT_GT(blocked, 100u);
    std::vector<int32_t> counts(4);
    std::vector<double> walked(4);
    for (size_t i = 0; i < after.size(); ++i) {
      EXPECT_EQ(after[i].id, i);
      const auto kind = static_cast<size_t>(after[i].avatar_class);
      ++counts[kind];
      walked[kind] = std::max(walked[kind], length(after[i].position - before[i].position));
    }
    EXPECT_EQ(counts, (std::vector<int32_t>{150, 80, 15, 12}));
    EXPECT_GT(*std::min_element(walked.begin(), walked.end()), 4);
    hashes.insert(crowd->state_hash());
  }
  EXPECT_EQ(hashes.size(), 1u);

  config.also.push_back({.avatar_class = 9, .avatars = 1});
  EXPECT_EQ(Wanderers::create(world, config).error().code, Errc::kNotFound);
  config.also.assign(16, {.avatar_class = 0, .avatars = 1});
  EXPECT_EQ(Wanderers::create(world, config).error().code, Errc::kBadConfig);
  config.also = {{.avatar_class = 3, .avatars = 100000}};
  EXPECT_EQ(Wanderers::create(world, config).error().code, Errc::kLimit);
}

TEST(Wanderers, TwoCrowdsLiveSideBySide) {
  const World world = baked(small_garage());
  auto a = Wanderers::create(world, {.avatars = 50, .seed = 1});
  auto b = Wanderers::create(world, {.avatars = 50, .seed = 1});
  ASSERT_TRUE(a && b);
  for (int step = 0; step < 50; ++step) {
    a->step();
    b->step();
  }
  EXPECT_EQ(a->state_hash(), b->state_hash());
}

TEST(Wanderers, FastAvatarsCheckEveryCellTheyCross) {
  Scene scene;  // thin walls, 1 m apart: a step of 5 m would jump over them
  scene.add_quad({0, 0, 0}, {0, 0, 20}, {20, 0, 20}, {20, 0, 0});
  for (double x = 2; x < 20; x += 2) scene.add_quad({x, 0, 0}, {x, 2, 0}, {x, 2, 20}, {x, 0, 20});
  const World world = baked(scene);
  auto crowd = Wanderers::create(world, {.avatars = 40, .dt = 1, .speed = 5, .seed = 9});
  ASSERT_TRUE(crowd) << crowd.error().message;
  std::vector<AvatarState> before, after;
  crowd->read(before);
  for (int step = 0; step < 200; ++step) crowd->step();
  crowd->read(after);
  for (size_t i = 0; i < before.size(); ++i) {
    EXPECT_EQ(std::floor(before[i].position.x / 2), std::floor(after[i].position.x / 2)) << i;
  }
}

TEST(Wanderers, SaysHowManyFit) {
  Scene scene;
  scene.add_quad({0, 0, 0}, {0, 0, 6}, {6, 0, 6}, {6, 0, 0});
  const World world = baked(scene);
  auto crowd = Wanderers::create(world, {.avatars = 100000});
  ASSERT_FALSE(crowd);
  EXPECT_EQ(crowd.error().code, Errc::kLimit);
  const int fit = std::stoi(crowd.error().message.substr(7));
  EXPECT_GT(fit, 15);
  EXPECT_LT(fit, 145);
  EXPECT_TRUE(Wanderers::create(world, {.avatars = static_cast<uint32_t>(fit)}));
}

TEST(Wanderers, BadSettingsAreRefusedWithASentence) {
  const World world = baked(small_garage());
  EXPECT_EQ(Wanderers::create(world, {.avatar_class = 9}).error().code, Errc::kNotFound);
  EXPECT_EQ(Wanderers::create(world, {.dt = 0}).error().code, Errc::kBadConfig);
  EXPECT_EQ(Wanderers::create(world, {.dt = NAN}).error().code, Errc::kBadConfig);
  EXPECT_EQ(Wanderers::create(world, {.speed = -1}).error().code, Errc::kBadConfig);
  EXPECT_EQ(Wanderers::create(World{}, {}).error().code, Errc::kBadConfig);
}

// Gentle slopes of 0.9 m with a step of 0.1 m between that is too steep to stand on: a single row
// or column of illegal cells, which a walk over every second cell would miss.
Scene washboard(bool along_x) {
  Scene scene;
  const auto strip = [&](double from, double to, double y0, double y1) {
    if (along_x) {
      scene.add_quad({from, y0, 0}, {from, y0, 14}, {to, y1, 14}, {to, y1, 0});
    } else {
      scene.add_quad({0, y0, from}, {0, y1, to}, {14, y1, to}, {14, y0, from});
    }
  };
  for (int i = 0; i < 14; ++i) {
    const double y = 0.3 * i;
    strip(i, i + 0.9, y, y + 0.1);
    strip(i + 0.9, i + 1, y + 0.1, y + 0.3);
  }
  return scene;
}

// No other avatar blocks it, so the passes and short cuts of the crowd must do what the world
// permits.
TEST(Wanderers, AnAvatarAloneWalksAsTheWorldAllows) {
  const BakeConfig wide{.classes = {{.radius = 0.25}}};  // no step of 0.24 m is divided for it
  const World worlds[] = {baked(small_garage(), wide), baked(washboard(true), wide),
                          baked(washboard(false), wide)};
  int moved = 0, blocked = 0;
  for (uint64_t seed = 0; seed < 180; ++seed) {
    const World& world = worlds[seed % 5 < 3 ? 0 : seed % 5 - 2];
    const double speed = seed % 3 == 0 ? 2.4 : 0;  // A long step exceeds the short cuts.
    auto crowd = Wanderers::create(world, {.avatars = 1, .speed = speed, .seed = seed});
    ASSERT_TRUE(crowd);
    std::vector<AvatarState> before, after;
    crowd->read(before);
    for (int step = 0; step < 120; ++step) {
      const WanderReport report = crowd->step();
      crowd->read(after);
      const AvatarState& a = before[0];
      const AvatarState& b = after[0];
      const Place from = world.find_place(0, a.position, 0.001);
      ASSERT_TRUE(from);
      // Half a unit is lost in rounding on output: the world is given what the crowd returned.
      const double length = std::hypot(b.position.x - a.position.x, b.position.z - a.position.z);
      if (report.moved == 1) {
        const MoveResult move =
            world.move(0, from, b.position.x - a.position.x, b.position.z - a.position.z);
        ASSERT_EQ(move.end, MoveEnd::kArrived) << "seed " << seed << " step " << step;
        ASSERT_EQ(move.place.position.y, b.position.y) << "seed " << seed << " step " << step;
        ASSERT_GT(length, 0.1);
      } else {
        ASSERT_EQ(length, 0);
      }
      if (report.blocked_by_wall == 1) {
        const double reach = speed > 0 ? speed * 0.1 : 0.14;
        const MoveResult move = world.move(0, from, a.heading_x * reach, a.heading_z * reach);
        ASSERT_NE(move.end, MoveEnd::kArrived) << "seed " << seed << " step " << step;
      }
      moved += static_cast<int>(report.moved);
      blocked += static_cast<int>(report.blocked_by_wall);
      ASSERT_EQ(report.blocked_by_avatar, 0u);
      before = after;
    }
  }
  EXPECT_GT(moved, 10000);
  EXPECT_GT(blocked, 300);
}

}  // namespace
}  // namespace throng
