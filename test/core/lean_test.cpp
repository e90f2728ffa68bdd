// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>

#include "core/random.h"
#include "throng/avatar.h"

// The lean of bodies, against the formula of a rotation by an axis and an angle.
namespace throng {
namespace {

Vec3d unit_vector(uint64_t n) {
  const auto roll = [&](uint64_t what) { return 2 * random_unit(5, n, what) - 1; };
  const Vec3d v{roll(0), roll(1), roll(2)};
  return v * (1 / length(v));
}

Vec3d turned(Vec3d v, Vec3d axis, double angle) {
  return v * std::cos(angle) + cross(axis, v) * std::sin(angle) +
         axis * (dot(axis, v) * (1 - std::cos(angle)));
}

void expect_near(Vec3d a, Vec3d b, double within) {
  EXPECT_LE(length(a - b), within) << a.x << ' ' << a.y << ' ' << a.z;
}

TEST(Lean, IsTheSmallestRotationThatTakesStraightUpToTheAxis) {
  for (uint64_t n = 0; n < 500; ++n) {
    const Vec3d up = unit_vector(n), v = unit_vector(n + 1000) * 3;
    const Vec3d axis = cross({0, 1, 0}, up);
    const double sine = length(axis);
    expect_near(leaned({0, 1, 0}, up), up, 1e-12);
    expect_near(leaned(v, up), turned(v, axis * (1 / sine), std::atan2(sine, up.y)), 1e-11);
  }
  EXPECT_EQ(leaned({1, 2, 3}, {0, 1, 0}), (Vec3d{1, 2, 3})) << "an upright body does not lean";
}

TEST(Lean, UnleanedIsItsInverse) {
  for (uint64_t n = 0; n < 500; ++n) {
    const Vec3d up = unit_vector(n), v = unit_vector(n + 2000) * 3;
    expect_near(unleaned(leaned(v, up), up), v, 1e-11);
    expect_near(leaned(unleaned(v, up), up), v, 1e-11);
    expect_near(unleaned(up, up), {0, 1, 0}, 1e-12);
  }
}

// Where the smallest rotation is not the only one, or nearly so.
TEST(Lean, StraightDownIsHalfATurnAroundX) {
  const Vec3d v{1, 2, 3};
  EXPECT_EQ(leaned(v, {0, -1, 0}), (Vec3d{1, -2, -3}));
  EXPECT_EQ(unleaned(leaned(v, {0, -1, 0}), {0, -1, 0}), v);
  for (const double angle : {1e-9, 1e-6, 1e-4, 1e-3, 2e-3, 1e-2}) {
    for (uint64_t n = 0; n < 20; ++n) {
      const double turn = 6.283185307 * random_unit(6, n, 0);
      const Vec3d up{std::sin(angle) * std::cos(turn), -std::cos(angle),
                     std::sin(angle) * std::sin(turn)};
      EXPECT_NEAR(length(leaned(v, up)), length(v), 1e-8) << angle;
      expect_near(unleaned(leaned(v, up), up), v, 1e-8);
      expect_near(leaned({0, 1, 0}, up), up, 2e-3);
    }
  }
}

}  // namespace
}  // namespace throng
