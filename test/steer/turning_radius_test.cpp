// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "steer/turning_radius.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/random.h"

namespace throng {
namespace {

using steer::Plane;

// From one to the other, towards the right positive. [radians]
double angle_between(Plane from, Plane to) {
  const double fx = from.x, fz = from.z, tx = to.x, tz = to.z;
  return std::atan2(fz * tx - fx * tz, fx * tx + fz * tz);
}

// By the C library.
TEST(TurningRadius, SharpTurnsSlowABodyDownAndSharperOnesStopIt) {
  constexpr double kStops = std::numbers::pi / 3;
  uint64_t draws = 0, free = 0, slowed = 0, stopped = 0;
  const auto unit = [&] { return random_unit(4, 1, draws++); };
  for (int n = 0; n < 20000; ++n) {
    const auto velocity = [&] {
      const double angle = 2 * std::numbers::pi * unit(), speed = 0.01 + 2 * unit();
      return Plane{static_cast<float>(speed * std::sin(angle)),
                   static_cast<float>(speed * std::cos(angle))};
    };
    const Plane last = velocity(), wanted = velocity();
    const auto dt = static_cast<float>(0.01 + 0.3 * unit());
    const auto radius = static_cast<float>(0.2 + 3 * unit());
    const double turn = angle_between(last, wanted), speed = std::hypot(wanted.x, wanted.z);
    const double excess = std::fabs(turn) - speed * double{dt} / double{radius};
    if (std::fabs(excess) < 1e-4 || std::fabs(excess - kStops) < 1e-4) continue;
    const Plane is = steer::within_turning_radius(last, wanted, dt, radius);
    const double size = std::hypot(is.x, is.z);
    if (excess < 0) {
      EXPECT_EQ(is.x, wanted.x);
      EXPECT_EQ(is.z, wanted.z);
      ++free;
    } else if (excess > kStops) {
      EXPECT_EQ(size, 0);
      ++stopped;
    } else {
      EXPECT_NEAR(size, speed * std::cos(excess), 1e-4);
      EXPECT_NEAR(angle_between(last, is), std::copysign(size * double{dt} / double{radius}, turn),
                  1e-4);
      ++slowed;
    }
  }
  EXPECT_GT(free, 500u);
  EXPECT_GT(slowed, 500u);
  EXPECT_GT(stopped, 500u);
}

TEST(TurningRadius, FromAStopABodyStartsInAnyDirectionAndStopsAtOnce) {
  const Plane start = steer::within_turning_radius({}, {-1, 0.5f}, 0.1f, 2);
  EXPECT_EQ(start.x, -1);
  EXPECT_EQ(start.z, 0.5f);
  const Plane stop = steer::within_turning_radius({1, 0}, {}, 0.1f, 2);
  EXPECT_EQ(stop.x, 0);
  EXPECT_EQ(stop.z, 0);
}

}  // namespace
}  // namespace throng
