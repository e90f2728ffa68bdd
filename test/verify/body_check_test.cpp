// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "verify/body_check.h"

#include <gtest/gtest.h>

#include <cmath>

namespace throng::verify {
namespace {

constexpr double kCell = 0.1;

struct Checked {
  explicit Checked(Scene s, AvatarClass avatar = {})
      : scene(std::move(s)), tree(scene, 1), body(tree, avatar, kCell) {}
  Scene scene;
  TriangleTree tree;
  BodyCheck body;
};

Scene plate(double y, AreaKind kind = kAreaWalkable) {
  Scene scene;
  scene.add_quad({-1, y, -1}, {1, y, -1}, {1, y, 1}, {-1, y, 1}, kind);
  return scene;
}

TEST(BodyCheck, BodyBeginsAtItsBottomAndEndsAtItsHead) {
  const Checked plates(plate(0));
  EXPECT_FALSE(plates.body.intruder({0, 0, 0}));
  EXPECT_FALSE(plates.body.intruder({0, -0.4, 0}));  // As high as a step.
  EXPECT_EQ(plates.body.intruder({0, -0.401, 0}), 0u);
  EXPECT_TRUE(plates.body.intruder({0, -1.749, 0}));
  EXPECT_FALSE(plates.body.intruder({0, -1.75, 0}));
  EXPECT_TRUE(plates.body.intruder({1.189, -1, 0}));
  EXPECT_FALSE(plates.body.intruder({1.19, -1, 0}));
}

TEST(BodyCheck, BottomOfAWideBodyFollowsItsSlope) {
  AvatarClass wide;
  wide.radius = 0.8;  // 0.8 m at 45 degrees: higher than its step.
  const Checked plates(plate(0), wide);
  EXPECT_FALSE(plates.body.intruder({0, -0.799, 0}));
  EXPECT_TRUE(plates.body.intruder({0, -0.801, 0}));
}

TEST(BodyCheck, SupportReachesAStepDownAndACellAside) {
  const Checked plates(plate(0));
  EXPECT_TRUE(plates.body.is_supported({0, 0, 0}));
  EXPECT_TRUE(plates.body.is_supported({0, 0.4, 0}));
  EXPECT_FALSE(plates.body.is_supported({0, 0.402, 0}));
  EXPECT_TRUE(plates.body.is_supported({0, -0.1, 0}));
  EXPECT_FALSE(plates.body.is_supported({0, -0.106, 0}));
  EXPECT_TRUE(plates.body.is_supported({1.1, 0, 0}));
  EXPECT_FALSE(plates.body.is_supported({1.11, 0, 0}));
}

TEST(BodyCheck, BlockedAndSteepSurfacesAreNoSupport) {
  EXPECT_FALSE(Checked(plate(0, kAreaBlocked)).body.is_supported({0, 0, 0}));
  EXPECT_TRUE(Checked(plate(0, 9)).body.is_supported({0, 0, 0}));
  Scene slope;
  slope.add_quad({-1, -1, -1}, {1, 1, -1}, {1, 1, 1}, {-1, -1, 1});
  EXPECT_TRUE(Checked(slope).body.is_supported({0, 0, 0}));  // Exactly at the limit.
  AvatarClass careful;
  careful.max_slope = 44;
  EXPECT_FALSE(Checked(slope, careful).body.is_supported({0, 0, 0}));
}

TEST(BodyCheck, FeetErrorIsTheDistanceToTheNearestSurfaceExactlyUnderTheCentre) {
  Scene scene = plate(0);
  scene.add_quad({-1, 0.3, -1}, {1, 0.3, -1}, {1, 0.3, 1}, {-1, 0.3, 1});
  const Checked plates(scene);
  EXPECT_NEAR(plates.body.feet_error({0, 0.02, 0}).value(), 0.02, 1e-12);
  EXPECT_NEAR(plates.body.feet_error({0, 0.2, 0}).value(), 0.1, 1e-12);
  EXPECT_NEAR(plates.body.feet_error({0, 0.7, 0}).value(), 0.4, 1e-12);
  EXPECT_FALSE(plates.body.feet_error({0, 0.71, 0}));
  EXPECT_FALSE(plates.body.feet_error({1.05, 0, 0}));
}

}  // namespace
}  // namespace throng::verify
