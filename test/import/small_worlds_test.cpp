// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "throng/papers.h"
#include "worlds.h"

// The hand-made scenes are as their comments state.
namespace throng {
namespace {

SliceSet slice(const Scene& scene) {
  Context context;
  auto slices = slice_scene(scene, {.avatar_height = 4.5, .resolution = 0.1, .cell = 0.1}, context);
  EXPECT_TRUE(slices) << slices.error().message;
  return slices ? std::move(*slices) : SliceSet{};
}

TEST(SmallWorlds, TheWorkedExampleGives32SlicesTakenAnd2Kept) {
  const SliceSet slices = slice(worlds::worked_example());
  EXPECT_EQ(slices.taken, 32);
  ASSERT_EQ(slices.kept.size(), 2u);
  EXPECT_EQ(slices.kept[0].height, 13600);
  EXPECT_EQ(slices.kept[1].height, 5900);
}

TEST(SmallWorlds, RoofsAt8And7And6Give4SlicesTakenAnd2Kept) {
  const SliceSet slices = slice(worlds::roofs_8_7_6());
  EXPECT_EQ(slices.taken, 4);
  ASSERT_EQ(slices.kept.size(), 2u);
  EXPECT_EQ(slices.kept[0].height, 12600);
  EXPECT_EQ(slices.kept[1].height, 5900);
}

TEST(SmallWorlds, ScenesHaveTheSizesThatTheirNamesSay) {
  EXPECT_EQ(worlds::flat(7).bounds().max, (Vec3d{7, 0, 7}));
  EXPECT_EQ(worlds::two_floors().bounds().max, (Vec3d{10, 3, 6}));
  EXPECT_NEAR(worlds::steps(0.2, 0.3, 5).bounds().max.y, 1.0, 1e-12);
  EXPECT_NEAR(worlds::ramp(45, 4).bounds().max.y, 4.0, 1e-9);
  EXPECT_EQ(worlds::doorway(1).bounds().max, (Vec3d{8, 3, 6}));
  EXPECT_EQ(worlds::low_ceiling(2).bounds().max, (Vec3d{10, 2.2, 4}));
}

TEST(SmallWorlds, TheSoupFillsItsCubeAndDependsOnTheSeedAlone) {
  const Scene soup = worlds::random_soup(3, 500, 20);
  EXPECT_EQ(soup.triangles.size(), 500u);
  const Box3d box = soup.bounds();
  EXPECT_GE(std::min({box.min.x, box.min.y, box.min.z}), 0);
  EXPECT_LE(std::max({box.max.x, box.max.y, box.max.z}), 20);
  EXPECT_GT(box.max.y - box.min.y, 15);
  EXPECT_EQ(soup.positions, worlds::random_soup(3, 500, 20).positions);
  EXPECT_NE(soup.positions, worlds::random_soup(4, 500, 20).positions);
}

}  // namespace
}  // namespace throng
