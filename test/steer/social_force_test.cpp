// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "steer/social_force.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace throng::steer {
namespace {

TEST(SocialForce, AStandingWalkerPushesByDistanceAlone) {
  // Then b is the distance: 2.1 / 0.3 exp(-1 / 0.3) = 0.249718.
  const Force force = repulsion({.x = 1}, {}, {});
  EXPECT_NEAR(force.x, 0.249718, 1e-6);
  EXPECT_EQ(force.z, 0);
  const Force aside = repulsion({.x = 0.6, .z = 0.8}, {}, {});
  EXPECT_NEAR(aside.x, 0.6 * 0.249718, 1e-6);
  EXPECT_NEAR(aside.z, 0.8 * 0.249718, 1e-6);
  EXPECT_EQ(repulsion({}, {}, {}).x, 0);
}

TEST(SocialForce, AMovingWalkerPushesAlongAnEllipseAroundItsNextStride) {
  // b walks at 1 m/s for 2 s past a, which stands 1 m beside the middle of that stride: both foci
  // are sqrt 2 away, so the small axis is 1, and the push goes straight aside: 7 exp(-1 / 0.3) x (2
  // sqrt 2 / 4) x 2 / sqrt 2 = 0.249718.
  const Force force = repulsion({.x = 1, .z = 1}, {.vx = 1}, {});
  EXPECT_NEAR(force.x, 0, 1e-12);
  EXPECT_NEAR(force.z, 0.249718, 1e-6);
}

// An independent oracle: the slope of the potential.
TEST(SocialForce, TheForceIsTheSlopeOfThePotential) {
  const SocialForceConfig config;
  const auto potential = [&](double x, double z, const ForceWalker& b) {
    const double rx = x - b.x, rz = z - b.z;
    const double sum = std::hypot(rx, rz) + std::hypot(rx - 2 * b.vx, rz - 2 * b.vz);
    const double step = 2 * std::hypot(b.vx, b.vz);
    return config.strength * std::exp(-std::sqrt(sum * sum - step * step) / 2 / config.range);
  };
  const double h = 1e-6;
  for (int k = 0; k < 50; ++k) {
    const ForceWalker b{.x = 0.1 * k, .z = -0.2, .vx = std::sin(k), .vz = std::cos(2 * k)};
    const ForceWalker a{.x = b.x + 0.4 * std::cos(3 * k), .z = b.z + 1 + 0.5 * std::sin(5 * k)};
    const Force force = repulsion(a, b, config);
    EXPECT_NEAR(force.x, -(potential(a.x + h, a.z, b) - potential(a.x - h, a.z, b)) / (2 * h),
                1e-5);
    EXPECT_NEAR(force.z, -(potential(a.x, a.z + h, b) - potential(a.x, a.z - h, b)) / (2 * h),
                1e-5);
  }
}

TEST(SocialForce, ThePreferredVelocityIsApproachedInHalfASecondAndTheSpeedIsLimited) {
  std::vector<ForceWalker> one{{.preferred_x = 1}};
  step_social_force(one, 0.1, {});
  EXPECT_NEAR(one[0].vx, 0.2, 1e-12);  // 1 / 0.5 x 0.1
  EXPECT_NEAR(one[0].x, 0.02, 1e-12);
  // Another right behind: half of 7 exp(-1), as it is out of view; the speed is limited to 1.3.
  std::vector<ForceWalker> two{{.vx = 1, .preferred_x = 1}, {.x = -0.3}};
  step_social_force(two, 0.1, {});
  EXPECT_NEAR(two[0].vx, 1 + 0.05 * 7 * std::exp(-1), 1e-9);
  step_social_force(two, 10, {});
  EXPECT_LE(two[0].vx, 1.3 + 1e-12);
}

}  // namespace
}  // namespace throng::steer
