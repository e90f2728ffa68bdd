// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "sources.h"

#include <gtest/gtest.h>

// Model arguments: built-in worlds and joined scenes.
namespace throng::app {
namespace {

TEST(Sources, ABuiltinWorldIsANameAndSettings) {
  const auto plain = parse_builtin("builtin:cube");
  ASSERT_TRUE(plain) << plain.error().message;
  EXPECT_EQ(plain->name, "cube");
  EXPECT_EQ(plain->size, 0);
  EXPECT_EQ(plain->seed, 1u);

  const auto full = parse_builtin("builtin:city,size=12.5,levels=3,triangles=900,seed=7");
  ASSERT_TRUE(full) << full.error().message;
  EXPECT_EQ(full->name, "city");
  EXPECT_EQ(full->size, 12.5);
  EXPECT_EQ(full->levels, 3);
  EXPECT_EQ(full->triangles, 900u);
  EXPECT_EQ(full->seed, 7u);
}

TEST(Sources, AWordThatIsNoSettingIsRefusedAndNamed) {
  for (const char* word :
       {"size=", "size=1x", "levels=2.5", "colour=red", "size", "seed=-1", "=3"}) {
    const auto config = parse_builtin(std::string("builtin:cube,") + word);
    ASSERT_FALSE(config) << word;
    EXPECT_EQ(config.error().code, Errc::kBadConfig);
    EXPECT_NE(config.error().message.find(std::string("'") + word + "'"), std::string::npos)
        << config.error().message;
  }
  EXPECT_FALSE(parse_builtin("builtin:"));
  EXPECT_FALSE(parse_builtin("builtin:size=3"));
}

TEST(Sources, NoModelAtAllIsRefused) {
  Context context;
  const auto scene = read_sources({}, context);
  ASSERT_FALSE(scene);
  EXPECT_EQ(scene.error().code, Errc::kBadConfig);
}

TEST(Sources, AppendingAScenePointsItsTrianglesAtItsOwnCorners) {
  Scene first;
  first.add_triangle({0, 0, 0}, {1, 0, 0}, {0, 0, 1});
  first.parts = {
      {.file = "a", .node = {}, .material = {}, .first_triangle = 0, .triangle_count = 1}};
  first.report.triangles_read = 1;
  Scene second;
  second.add_triangle({5, 1, 0}, {6, 1, 0}, {5, 1, 1}, kAreaBlocked);
  second.parts = {
      {.file = "b", .node = {}, .material = {}, .first_triangle = 0, .triangle_count = 1}};
  second.report.triangles_read = 3;
  second.report.non_finite = 2;
  second.report.warnings = {"b is odd"};

  first.append(second);
  ASSERT_EQ(first.triangles.size(), 2u);
  EXPECT_EQ(first.positions[first.triangles[1][0]], (Vec3d{5, 1, 0}));
  EXPECT_EQ(first.area, (std::vector<AreaKind>{kAreaWalkable, kAreaBlocked}));
  EXPECT_EQ(first.parts[1].first_triangle, 1u);
  EXPECT_EQ(first.report.triangles_read, 4u);
  EXPECT_EQ(first.report.non_finite, 2u);
  EXPECT_EQ(first.report.warnings, std::vector<std::string>{"b is odd"});
}

TEST(Sources, TwoBuiltinWorldsMakeOneScene) {
  Context context;
  const auto one =
      read_sources({.files = {"builtin:cube"}, .up = {}, .scale = 0, .scene = {}}, context);
  ASSERT_TRUE(one) << one.error().message;
  const auto two = read_sources(
      {.files = {"builtin:cube", "builtin:cube"}, .up = {}, .scale = 0, .scene = {}}, context);
  ASSERT_TRUE(two) << two.error().message;
  EXPECT_EQ(two->triangles.size(), 2 * one->triangles.size());
  EXPECT_EQ(two->area.size(), two->triangles.size());
}

}  // namespace
}  // namespace throng::app
