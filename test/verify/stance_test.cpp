// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "verify/stance.h"

#include <gtest/gtest.h>

#include <cmath>

namespace throng::verify {
namespace {

const BodyShape kAdult{.radius = 0.25,
                       .bottom = 0.4,
                       .height = 1.75,
                       .step = 0.4,
                       .levelness = std::cos(std::acos(-1.0) / 4),
                       .spacing = 0.1};

// A floor at y = 0 from -5 to 5, and whatever else is added.
Scene floor_scene() {
  Scene scene;
  scene.add_quad({-5, 0, -5}, {5, 0, -5}, {5, 0, 5}, {-5, 0, 5});
  return scene;
}

bool stands(const Scene& scene, Vec3d feet) {
  const TriangleTree tree(scene, 1);
  return Stance(tree, kAdult).stands(feet);
}

WalkEnd walk_to_positive_x(const Scene& scene, Vec3d start, size_t max_points = 100000) {
  const TriangleTree tree(scene, 1);
  Stance stance(tree, kAdult);
  EXPECT_TRUE(stance.stands(start));
  return stance.walk(start, 0.05, max_points, [](Vec3d feet) { return feet.x > 1; });
}

TEST(Stance, StandsOnAFloorButNotOverOrUnderIt) {
  const Scene scene = floor_scene();
  EXPECT_TRUE(stands(scene, {0, 0, 0}));
  EXPECT_FALSE(stands(scene, {0, 0.01, 0}));
  EXPECT_FALSE(stands(scene, {0, -0.01, 0}));
  EXPECT_FALSE(stands(scene, {9, 0, 0}));
}

TEST(Stance, RimOfTheFloorIsAnObstacle) {
  const Scene scene = floor_scene();
  EXPECT_TRUE(stands(scene, {4.748, 0, 0}));
  EXPECT_FALSE(stands(scene, {4.751, 0, 0}));
}

TEST(Stance, StraightRimDoesNotSlipBetweenTwoPointsOfTheDisc) {
  for (int degrees = 0; degrees < 360; degrees += 3) {
    const double c = std::cos(degrees * std::acos(-1.0) / 180);
    const double s = std::sin(degrees * std::acos(-1.0) / 180);
    const auto at = [&](double along, double across) {
      return Vec3d{c * along - s * across, 0, s * along + c * across};
    };
    Scene scene;
    scene.add_quad(at(-5, -5), at(0, -5), at(0, 5), at(-5, 5));
    EXPECT_FALSE(stands(scene, at(-0.2499, 0))) << degrees;
    EXPECT_TRUE(stands(scene, at(-0.252, 0))) << degrees;
  }
}

TEST(Stance, DescentOfLessThanTheBottomIsNoRim) {
  Scene scene = floor_scene();
  scene.add_quad({5, -0.39, -5}, {9, -0.39, -5}, {9, -0.39, 5}, {5, -0.39, 5});
  EXPECT_TRUE(stands(scene, {4.9, 0, 0}));
  EXPECT_TRUE(stands(scene, {5.05, -0.39, 0}));
}

TEST(Stance, WallsAndCeilingsCountFromTheBottomUp) {
  Scene kerb = floor_scene();
  kerb.add_box({1, 0, -1}, {3, 0.39, 1});
  EXPECT_TRUE(stands(kerb, {0.9, 0, 0}));
  Scene wall = floor_scene();
  wall.add_box({1, 0, -1}, {3, 0.41, 1});
  EXPECT_TRUE(stands(wall, {0.75, 0, 0}));
  EXPECT_FALSE(stands(wall, {0.76, 0, 0}));
  EXPECT_TRUE(stands(wall, {2, 0.41, 0}));
  Scene ceiling = floor_scene();
  ceiling.add_quad({-1, 1.74, -1}, {1, 1.74, -1}, {1, 1.74, 1}, {-1, 1.74, 1});
  EXPECT_FALSE(stands(ceiling, {0, 0, 0}));
  EXPECT_FALSE(stands(ceiling, {1.2, 0, 0}));
  EXPECT_TRUE(stands(ceiling, {1.25, 0, 0}));
}

TEST(Stance, SurfaceJustAboveTheFeetIsTheRealFloor) {
  Scene scene = floor_scene();
  scene.add_quad({-1, 0.05, -1}, {1, 0.05, -1}, {1, 0.05, 1}, {-1, 0.05, 1});
  EXPECT_FALSE(stands(scene, {0, 0, 0}));
  EXPECT_TRUE(stands(scene, {0, 0.05, 0}));
}

TEST(Stance, BlockedAndSteepSurfacesSupportNoBody) {
  Scene blocked;
  blocked.add_quad({-5, 0, -5}, {5, 0, -5}, {5, 0, 5}, {-5, 0, 5}, kAreaBlocked);
  EXPECT_FALSE(stands(blocked, {0, 0, 0}));
  Scene slope;
  slope.add_quad({-5, -4.9, -5}, {5, 4.9, -5}, {5, 4.9, 5}, {-5, -4.9, 5});
  EXPECT_TRUE(stands(slope, {0, 0, 0}));
  Scene steep;
  steep.add_quad({-5, -5.1, -5}, {5, 5.1, -5}, {5, 5.1, 5}, {-5, -5.1, 5});
  EXPECT_FALSE(stands(steep, {0, 0, 0}));
}

TEST(Stance, HoleWiderThanTheSpacingIsSeen) {
  Scene scene;  // Two halves, 0.12 m apart.
  scene.add_quad({-5, 0, -5}, {0, 0, -5}, {0, 0, 5}, {-5, 0, 5});
  scene.add_quad({0.12, 0, -5}, {5, 0, -5}, {5, 0, 5}, {0.12, 0, 5});
  EXPECT_FALSE(stands(scene, {-0.1, 0, 0}));
  EXPECT_TRUE(stands(scene, {-0.252, 0, 0}));
}

TEST(Stance, FloorIsTheTopmostSurfaceWithinReach) {
  Scene scene = floor_scene();
  scene.add_box({-1, 0, -1}, {1, 0.3, 1});
  const TriangleTree tree(scene, 1);
  const Stance stance(tree, kAdult);
  EXPECT_EQ(stance.floor_at(0, 0, 0, 0.4), 0.3);
  EXPECT_EQ(stance.floor_at(0, 0, 0, 0.2), 0.0);
  EXPECT_EQ(stance.floor_at(2, 0, 0.1, 0.4), 0.0);
  EXPECT_FALSE(stance.floor_at(7, 0, 0, 0.4));
}

TEST(Stance, WalkGoesAroundAWallAndThroughAWideDoor) {
  Scene scene = floor_scene();
  scene.add_box({-0.1, 0, -5}, {0.1, 3, -0.3});
  scene.add_box({-0.1, 0, 0.3}, {0.1, 3, 5});
  EXPECT_EQ(walk_to_positive_x(scene, {-1, 0, 1}), WalkEnd::kReached);
  Scene narrow = floor_scene();
  narrow.add_box({-0.1, 0, -5}, {0.1, 3, -0.24});
  narrow.add_box({-0.1, 0, 0.24}, {0.1, 3, 5});
  EXPECT_EQ(walk_to_positive_x(narrow, {-1, 0, 1}), WalkEnd::kIsland);
  EXPECT_EQ(walk_to_positive_x(narrow, {-1, 0, 1}, 500), WalkEnd::kLarge);
}

TEST(Stance, WalkClimbsStairsButNotASteepSlope) {
  Scene stairs = floor_scene();
  for (int i = 0; i < 8; ++i) stairs.add_box({0.2 * i, 0, -5}, {9, 0.18 * (i + 1), 5});
  EXPECT_EQ(walk_to_positive_x(stairs, {-1, 0, 0}), WalkEnd::kReached);
  Scene steep;  // Each sub-step would rise by 0.1 m, far below a step: it must not add up.
  steep.add_quad({-3, 0, -1}, {0, 0, -1}, {0, 0, 1}, {-3, 0, 1});
  steep.add_quad({0, 0, -1}, {2, 4, -1}, {2, 4, 1}, {0, 0, 1});
  EXPECT_EQ(walk_to_positive_x(steep, {-1, 0, 0}), WalkEnd::kIsland);
}

TEST(Stance, WalkDoesNotStepOverALedge) {
  Scene scene = floor_scene();
  scene.add_box({0, 0, -5}, {5, 0.45, 5});
  EXPECT_EQ(walk_to_positive_x(scene, {-1, 0, 0}), WalkEnd::kIsland);
}

}  // namespace
}  // namespace throng::verify
