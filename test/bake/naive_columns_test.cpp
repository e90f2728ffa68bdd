// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "naive_columns.h"

#include <gtest/gtest.h>

#include <vector>

namespace throng {
namespace {

using Ints = std::vector<int32_t>;

Ints lows(const naive::Columns& columns, size_t cell) {
  return {columns.lows(cell).begin(), columns.lows(cell).end()};
}

Ints highs(const naive::Columns& columns, size_t cell) {
  return {columns.highs(cell).begin(), columns.highs(cell).end()};
}

Scene one_triangle(Vec3d a, Vec3d b, Vec3d c) {
  Scene scene;
  scene.positions = {a, b, c};
  scene.triangles = {{0, 1, 2}};
  scene.area = {kAreaWalkable};
  return scene;
}

TEST(NaiveColumns, ARampGivesEveryCellItsOwnPieceOfTheSlope) {
  // y = x over the lower right half of a 2 x 2 m square.
  const Scene scene = one_triangle({0, 0, 0}, {2, 2, 0}, {2, 2, 2});
  const auto columns = naive::make_columns(scene, {.cell = 1, .width = 3, .depth = 3});
  EXPECT_EQ(lows(columns, 0), Ints{0});
  EXPECT_EQ(highs(columns, 0), Ints{1000});
  EXPECT_EQ(lows(columns, 1), Ints{1000});
  EXPECT_EQ(highs(columns, 1), Ints{2000});
  EXPECT_EQ(lows(columns, 2), Ints{2000}) << "touched at x = 2 only";
  EXPECT_EQ(highs(columns, 2), Ints{2000});
  EXPECT_EQ(lows(columns, 3), Ints{1000}) << "touched at one corner";
  EXPECT_EQ(highs(columns, 3), Ints{1000});
  EXPECT_TRUE(lows(columns, 6).empty());
}

TEST(NaiveColumns, AVerticalTriangleFillsItsCellsFromFootToTop) {
  const Scene scene = one_triangle({0.5, -1, 0.2}, {0.5, 3, 0.2}, {0.5, -1, 1.8});
  const auto columns = naive::make_columns(scene, {.cell = 1, .width = 1, .depth = 2});
  EXPECT_EQ(lows(columns, 0), Ints{-1000});
  EXPECT_EQ(highs(columns, 0), Ints{3000});
  EXPECT_EQ(highs(columns, 1), Ints{1000});
}

TEST(NaiveColumns, HeightsRoundOutwardsUnlessTheyAreWithinAMicrometreOfAMillimetre) {
  EXPECT_EQ(naive::floor_mm(0.0019), 1);
  EXPECT_EQ(naive::ceil_mm(0.0011), 2);
  EXPECT_EQ(naive::floor_mm(-0.0001), -1);
  EXPECT_EQ(naive::ceil_mm(-0.0009), 0);
  EXPECT_EQ(naive::floor_mm(1.9999995), 2000);
  EXPECT_EQ(naive::ceil_mm(2.0000005), 2000);
  EXPECT_EQ(naive::ceil_mm(2.000002), 2001);
}

TEST(NaiveColumns, OnlySpansThatOverlapOrTouchAreMerged) {
  const auto columns = naive::from_lists(1, 1, {{{5, 6}, {0, 2}, {2, 4}, {8, 9}, {7, 7}}});
  EXPECT_EQ(lows(columns, 0), (Ints{0, 5, 7, 8}));
  EXPECT_EQ(highs(columns, 0), (Ints{4, 6, 7, 9}));
}

TEST(NaiveColumns, WideningOnlyAddsToTheSolid) {
  const Scene scene = one_triangle({0.3, 0, 0.2}, {2.1, 1.5, 0.9}, {0.6, 4, 2.7});
  const auto exact = naive::make_columns(scene, {.cell = 0.1, .width = 30, .depth = 30});
  const auto wide =
      naive::make_columns(scene, {.cell = 0.1, .width = 30, .depth = 30, .widen = 0.01});
  EXPECT_TRUE(naive::covers(wide, exact));
  EXPECT_FALSE(naive::covers(exact, wide));
}

TEST(NaiveColumns, TheSumOfAllCellsCoversPointsSampledOnTheTriangle) {
  const Vec3d a{0.31, 0.2, 0.24}, b{2.13, 1.5, 0.97}, c{0.66, 4, 2.7};
  const auto columns =
      naive::make_columns(one_triangle(a, b, c), {.cell = 0.1, .width = 30, .depth = 30});
  for (int i = 0; i <= 40; ++i) {
    for (int j = 0; i + j <= 40; ++j) {
      const Vec3d p = a + (b - a) * (i / 40.0) + (c - a) * (j / 40.0);
      const auto cell = static_cast<size_t>(p.z / 0.1) * 30 + static_cast<size_t>(p.x / 0.1);
      ASSERT_EQ(columns.lows(cell).size(), 1u);
      EXPECT_LE(columns.lows(cell)[0], naive::ceil_mm(p.y));
      EXPECT_GE(columns.highs(cell)[0], naive::floor_mm(p.y));
    }
  }
}

}  // namespace
}  // namespace throng
