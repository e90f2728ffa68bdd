// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "baked.h"
#include "core/random.h"
#include "crowds.h"
#include "throng/crowd.h"

// Avatars that have come as near to their goals as others let them stand still.
namespace throng {
namespace {

constexpr double kDt = 0.1;  // [s]

// Random goals on 16 m2: many are nearer to each other than bodies can stand.
TEST(Rest, ThoseThatMadeRoomReturnWithoutTwitching) {
  constexpr int kPeople = 24;
  Scene scene;
  scene.add_box({0, -0.5, 0}, {16, 0, 16});
  const World world = test::bake(scene, 0.1, {AvatarClass{}});
  int twitches = 0;
  for (uint64_t seed = 1; seed <= 3; ++seed) {
    Crowd crowd = made(world, {.dt = kDt, .seed = seed});
    std::vector<AvatarId> ids;
    for (int i = 0; i < kPeople; ++i) {
      const double angle = 2 * M_PI * i / kPeople;
      const auto draw = [&](uint64_t k) {
        return 6 + 4 * static_cast<double>(random_below(seed, static_cast<uint64_t>(i), k, 1000)) /
                       1000;
      };
      const Place goal = world.find_place(0, {draw(0), 0, draw(1)}, 0.5);
      ids.push_back(added(
          crowd, world.find_place(0, {8 + 7 * std::cos(angle), 0, 8 + 7 * std::sin(angle)}, 0.5)));
      ASSERT_TRUE(ids.back() && goal);
      crowd.set_goals(std::span(&ids.back(), 1), std::span(&goal, 1));
    }
    // A twitch: a move of one or two steps between two stands of at least 0.8 s.
    std::vector<int> stood(kPeople, 0), moved(kPeople, 0), before(kPeople, 0);
    for (int step = 0; step < 600; ++step) {
      (void)crowd.step();
      for (size_t i = 0; i < ids.size(); ++i) {
        const Vec3d v = crowd.read(ids[i])->velocity;
        if (std::hypot(v.x, v.z) > 1e-6) {
          if (moved[i] == 0) before[i] = stood[i];
          stood[i] = 0;
          ++moved[i];
          continue;
        }
        ++stood[i];
        if (stood[i] < 8) continue;
        twitches += stood[i] == 8 && before[i] >= 8 && moved[i] > 0 && moved[i] <= 2 ? 1 : 0;
        moved[i] = 0;
      }
    }
  }
  EXPECT_LE(twitches, 100);  // 246 if they rest again at once
}

// Goals within 0.3 to 2 m of a point: far more people than have room there.
TEST(Rest, ThoseWhoseGoalsLieTooNearToEachOtherComeToRest) {
  Scene scene;
  scene.add_box({0, -0.5, 0}, {16, 0, 16});
  scene.add_box({11, 0, 0}, {11.2, 3, 16});
  const World world = test::bake(scene, 0.1, {AvatarClass{}});
  for (const double range : {0.3, 1.0, 2.0}) {
    for (const size_t people : {10u, 20u, 40u}) {
      for (uint64_t seed = 1; seed <= 2; ++seed) {
        Crowd crowd = made(world, {.dt = kDt, .seed = seed});
        std::vector<AvatarId> ids;
        for (size_t i = 0; i < people; ++i) {
          const auto draw = [&](uint64_t k) { return random_unit(seed, k, i); };
          const double angle = 2 * M_PI * draw(0), off = range * std::sqrt(draw(1));
          const double x = std::min(10.3 + off * std::cos(angle), 10.7);
          const Place goal = world.find_place(0, {x, 0, 8 + off * std::sin(angle)}, 0.5);
          const auto row = static_cast<double>(i / 5), column = static_cast<double>(i % 5);
          ids.push_back(
              added(crowd, world.find_place(0, {1 + 0.6 * column, 0, 3 + 0.9 * row}, 0.5)));
          ASSERT_TRUE(ids.back() && goal);
          crowd.set_goals(std::span(&ids.back(), 1), std::span(&goal, 1));
        }
        for (int step = 0; step < 500; ++step) (void)crowd.step();
        double moved = 0;  // [m/s] each
        for (int step = 0; step < 100; ++step) {
          (void)crowd.step();
          for (const AvatarId id : ids) {
            moved += length(crowd.read(id)->velocity) / static_cast<double>(100 * people);
          }
        }
        EXPECT_LT(moved, 0.01) << range << ' ' << people << ' ' << seed;
      }
    }
  }
}

}  // namespace
}  // namespace throng
