// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "throng/scene.h"

#include <gtest/gtest.h>

namespace throng {
namespace {

TEST(Scene, ABoxIsClosedAndFacesOut) {
  Scene scene;
  scene.add_box({-1, 0, 2}, {3, 5, 4}, 7);
  ASSERT_EQ(scene.triangles.size(), 12u);
  EXPECT_EQ(scene.area, std::vector<AreaKind>(12, 7));
  double volume = 0;
  for (const auto& t : scene.triangles) {
    volume += dot(scene.positions[t[0]], cross(scene.positions[t[1]], scene.positions[t[2]])) / 6;
  }
  EXPECT_DOUBLE_EQ(volume, 4 * 5 * 2);  // Positive and whole only if all sides face out.
  EXPECT_EQ(scene.bounds().min, (Vec3d{-1, 0, 2}));
  EXPECT_EQ(scene.bounds().max, (Vec3d{3, 5, 4}));
}

TEST(Scene, BoundsUseCornersOfTrianglesOnly) {
  Scene scene;
  EXPECT_TRUE(scene.bounds().empty());
  scene.positions.push_back({1e9, 0, 0});  // a corner that no triangle uses
  scene.add_quad({0, 0, 0}, {1, 0, 0}, {1, 0, 1}, {0, 0, 1});
  scene.add_triangle({0, 2, 0}, {1, 2, 0}, {0, 2, 1}, kAreaBlocked);
  EXPECT_EQ(scene.bounds().max, (Vec3d{1, 2, 1}));
  EXPECT_EQ(scene.area, (std::vector<AreaKind>{1, 1, 0}));
}

}  // namespace
}  // namespace throng
