// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>

#include "baked.h"
#include "throng/bake.h"
#include "throng/path.h"
#include "throng/scene.h"

// What the standards ask of a wheelchair, of the default class at the default cell: a clear width
// of 0.8 m, wherever the grid lies, and ramps of 1 in 12, not much steeper ones.
namespace throng {
namespace {

constexpr int32_t kWheelchair = 2;

bool gets(const World& world, const Vec3d& from, const Vec3d& to) {
  Context context;
  auto finder = PathFinder::create(world, {.avatar_class = kWheelchair}, context);
  EXPECT_TRUE(finder) << finder.error().message;
  const Place start = world.find_place(kWheelchair, from, 0.5);
  const Place goal = world.find_place(kWheelchair, to, 0.5);
  if (!start || !goal) return false;
  Path path;
  finder->find(start, goal, path);
  return path.end == PathEnd::kReached;
}

TEST(Wheelchair, GetsThroughAClearWidthOf80CentimetresAnywhere) {
  for (int k = 0; k < 20; ++k) {
    const double off = 0.0113 * k;
    Scene scene;
    scene.add_box({0, -0.5, 0}, {8, 0, 6});
    scene.add_box({4 + off, 0, -1}, {4.2 + off, 3, 2.6 + off});
    scene.add_box({4 + off, 0, 3.4 + off}, {4.2 + off, 3, 7});
    EXPECT_TRUE(gets(test::bake(scene, 0.1), {2, 0, 3}, {6, 0, 3})) << off;
  }
}

TEST(Wheelchair, GetsUpRampsOfOneInTwelve) {
  constexpr double kLong = 10;  // [m]
  for (const double turn : {0.0, 0.4, 0.785, 2.0}) {
    for (const double rise : {1.0 / 20, 1.0 / 14, 1.0 / 12, 0.13, 0.2}) {
      Scene scene;
      const auto at = [&](double x, double y, double z) {
        return Vec3d{x * std::cos(turn) - z * std::sin(turn) + 20, y,
                     x * std::sin(turn) + z * std::cos(turn) + 20};
      };
      const auto strip = [&](double x0, double y0, double x1, double y1) {
        scene.add_quad(at(x0, y0, 0), at(x1, y1, 0), at(x1, y1, 3), at(x0, y0, 3));
      };
      strip(0, 0, 3, 0);
      strip(3, 0, 3 + kLong, kLong * rise);
      strip(3 + kLong, kLong * rise, 6 + kLong, kLong * rise);
      EXPECT_EQ(gets(test::bake(scene, 0.1), at(1.5, 0, 1.5), at(4.5 + kLong, kLong * rise, 1.5)),
                rise < 0.1)
          << rise << ' ' << turn;
    }
  }
}

}  // namespace
}  // namespace throng
