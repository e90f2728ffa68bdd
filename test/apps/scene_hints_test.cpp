// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "scene_hints.h"

#include <gtest/gtest.h>

#include <utility>

// Hints at a wrong unit and a wrong axis, for models that were misread on purpose.
namespace throng::app {
namespace {

// Three storeys of a house with walls around and pillars, 12 x 20 m.
Scene house() {
  Scene scene;
  for (int storey = 0; storey < 3; ++storey) {
    const double y = 3.0 * storey;
    scene.add_box({0, y - 0.2, 0}, {12, y, 20});
    scene.add_box({0, y, 0}, {12, y + 2.8, 0.2});
    scene.add_box({0, y, 19.8}, {12, y + 2.8, 20});
    scene.add_box({0, y, 0.2}, {0.2, y + 2.8, 19.8});
    scene.add_box({11.8, y, 0.2}, {12, y + 2.8, 19.8});
    for (int i = 1; i < 4; ++i) scene.add_box({5, y, 5.0 * i}, {5.3, y + 2.8, 5.0 * i + 0.3});
  }
  return scene;
}

Scene scaled(Scene scene, double scale) {
  for (Vec3d& p : scene.positions) p = p * scale;
  return scene;
}

// As if z pointed up in the file, or y in one read with z up.
Scene turned(Scene scene) {
  for (Vec3d& p : scene.positions) p = {p.x, p.z, -p.y};
  return scene;
}

std::string hints_of(const Scene& scene) {
  std::string text;
  for (const std::string& hint : scene_hints(scene)) text += hint + "\n";
  return text;
}

TEST(SceneHints, ModelsThatAreRightGiveNone) {
  EXPECT_EQ(hints_of(house()), "");
  for (const BuiltinWorldInfo& world : builtin_worlds()) {
    const auto scene = create_builtin_world({.name = std::string(world.name)});
    ASSERT_TRUE(scene) << scene.error().message;
    EXPECT_EQ(hints_of(*scene), "") << world.name;
  }
  Scene tower;  // Its walls face two directions.
  tower.add_box({0, 0, 0}, {20, 200, 20});
  EXPECT_EQ(hints_of(tower), "");
  EXPECT_EQ(hints_of({}), "");
}

TEST(SceneHints, AnotherAxisUpIsSeenByFloorsThatStandUpright) {
  EXPECT_EQ(hints_of(turned(house())),
            "most surfaces are upright and face one direction: check the up axis (--up)\n");
  EXPECT_NE(hints_of(scaled(turned(house()), 0.01)).find("--up"), std::string::npos);
}

TEST(SceneHints, AnotherUnitIsSeenBySizesOfNoPlaceForPeople) {
  EXPECT_EQ(hints_of(scaled(house(), 0.01)),
            "the model is small for a place to walk in: check the unit (--scale)\n");
  EXPECT_EQ(hints_of(scaled(house(), 100)),
            "most triangles are larger than 1000 m2: check the unit (--scale)\n");
  EXPECT_EQ(hints_of(scaled(house(), 1000)),
            "most triangles are larger than 1000 m2: check the unit (--scale)\n");
}

TEST(SceneHints, ASizeIsWidthDepthAndHeight) {
  EXPECT_EQ(size_text(house().bounds()), "12.0 x 20.0 m, 9.0 m high");
}

}  // namespace
}  // namespace throng::app
