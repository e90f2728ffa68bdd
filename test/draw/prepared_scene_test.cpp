// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "throng/scene.h"
#include "throng_draw/draw.h"

// Scenes and settings before anything is drawn of them.
namespace throng {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(PreparedScene, IsRelativeToItsOrigin) {
  Scene scene;
  scene.add_box({678001, 3, -5403500}, {678003, 4, -5403495});
  const Vec3d origin{678000, 2, -5403499};
  const auto made = PreparedScene::create(scene, origin);
  ASSERT_TRUE(made) << made.error().message;
  EXPECT_EQ(made->origin(), origin);
  EXPECT_EQ(made->bounds().min, (Vec3d{1, 1, -1}));
  EXPECT_EQ(made->bounds().max, (Vec3d{3, 2, 4}));

  const auto empty = PreparedScene::create({}, origin);
  ASSERT_TRUE(empty) << empty.error().message;
  EXPECT_TRUE(empty->bounds().empty());
  EXPECT_EQ(empty->origin(), origin);
}

TEST(PreparedScene, LooksAsTheSceneItself) {
  Scene scene;
  scene.add_box({-4, -0.2, -4}, {4, 0, 4});
  scene.add_box({-1, 0, -1}, {1, 2, 1});
  Result<Drawing> drawing = Drawing::create();
  ASSERT_TRUE(drawing) << drawing.error().message;
  DrawingConfig config;
  config.width = 160, config.height = 90;
  config.camera.eye = {4, 4, 8};
  const auto empty = drawing->draw({}, config);
  ASSERT_TRUE(drawing->set_scene(scene, {}));
  const auto direct = drawing->draw({}, config);
  ASSERT_TRUE(drawing->set_scene({}, {}));
  const auto prepared = PreparedScene::create(scene, {});
  ASSERT_TRUE(prepared);
  ASSERT_TRUE(drawing->set_scene(*prepared));
  const auto later = drawing->draw({}, config);
  ASSERT_TRUE(empty && direct && later);
  EXPECT_NE(direct->rgb, empty->rgb);
  EXPECT_EQ(direct->rgb, later->rgb);
}

TEST(PreparedScene, LeavesOutTrianglesWithoutArea) {
  Scene scene;
  scene.add_triangle({0, 0, 0}, {1, 0, 0}, {0, 0, 1});
  scene.add_triangle({50, 0, 0}, {50, 0, 0}, {60, 0, 0});
  scene.add_triangle({70, 0, 0}, {71, 0, 0}, {72, 0, 0});
  scene.add_triangle({80, 0, 0}, {81, kNan, 0}, {80, 0, 1});
  const auto made = PreparedScene::create(scene, {});
  ASSERT_TRUE(made) << made.error().message;
  EXPECT_EQ(made->bounds().min, (Vec3d{0, 0, 0}));
  EXPECT_EQ(made->bounds().max, (Vec3d{1, 0, 1}));
}

TEST(PreparedScene, MoreTrianglesThanCardsHoldAreRefused) {
  Scene scene;
  scene.positions = {{0, 0, 0}};
  scene.triangles.resize(40'000'001);
  const auto refused = PreparedScene::create(scene, {});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Errc::kLimit);
  EXPECT_NE(refused.error().message.find("40000001 triangles"), std::string::npos)
      << refused.error().message;

  Result<Drawing> drawing = Drawing::create();
  ASSERT_TRUE(drawing) << drawing.error().message;
  DrawingConfig config;
  config.width = 160, config.height = 90;
  Scene crate;
  crate.add_box({-1, 0, -1}, {1, 2, 1});
  ASSERT_TRUE(drawing->set_props(crate, {}));
  const auto before = drawing->draw({}, config);
  const auto as_props = drawing->set_props(scene, {}), as_scene = drawing->set_scene(scene, {});
  ASSERT_FALSE(as_props);
  ASSERT_FALSE(as_scene);
  EXPECT_EQ(as_props.error().code, Errc::kLimit);
  EXPECT_EQ(as_scene.error().code, Errc::kLimit);
  const auto after = drawing->draw({}, config);
  ASSERT_TRUE(before && after);
  EXPECT_EQ(before->rgb, after->rgb) << "what was there stays";
}

template <class Change>
bool passes(Change change) {
  DrawingConfig config;
  change(config);
  const auto ok = Drawing::check(config);
  if (!ok) {
    EXPECT_EQ(ok.error().code, Errc::kBadConfig);
    EXPECT_FALSE(ok.error().message.empty());
  }
  return static_cast<bool>(ok);
}

TEST(DrawingConfig, PassesWithinItsLimits) {
  using Config = DrawingConfig&;
  EXPECT_TRUE(passes([](Config) {}));
  EXPECT_TRUE(passes([](Config c) { c.width = c.height = 16; }));
  EXPECT_TRUE(passes([](Config c) { c.width = c.height = 8192; }));
  for (const int32_t samples : {1, 4}) EXPECT_TRUE(passes([&](Config c) { c.samples = samples; }));
  EXPECT_TRUE(passes([](Config c) { c.to_sun = {1000, 1e-3, 0}; }));
  for (const double none : {0.0, 1e9}) {
    EXPECT_TRUE(passes([&](Config c) { c.mesh_texel = none; }));
    EXPECT_TRUE(passes([&](Config c) { c.point_pixels = none; }));
  }
  for (const double share : {0.0, 1.0}) {
    EXPECT_TRUE(passes([&](Config c) { c.view_blend = c.edges = share; }));
  }
  for (const int32_t side : {256, 8192})
    EXPECT_TRUE(passes([&](Config c) { c.sun_pixels = side; }));
  EXPECT_TRUE(passes([](Config c) { c.cut_height = -100; }));
  EXPECT_TRUE(passes([](Config c) { c.workers = 100; }));
  EXPECT_TRUE(passes([](Config c) { c.camera.field_of_view = 2.99; }));
  EXPECT_TRUE(passes([](Config c) { c.camera.nearest = 1e-3; }));
}

TEST(DrawingConfig, IsRefusedBeyondItsLimits) {
  using Config = DrawingConfig&;
  for (const int32_t side : {-1, 0, 15, 8193}) {
    EXPECT_FALSE(passes([&](Config c) { c.width = side; })) << side;
    EXPECT_FALSE(passes([&](Config c) { c.height = side; })) << side;
  }
  for (const int32_t samples : {-1, 0, 5}) {
    EXPECT_FALSE(passes([&](Config c) { c.samples = samples; })) << samples;
  }
  for (const Vec3d sun : {Vec3d{1, 0, 0}, Vec3d{0, -1, 0}, Vec3d{kNan, 1, 0}, Vec3d{0, kNan, 0},
                          Vec3d{0, kInfinity, 0}}) {
    EXPECT_FALSE(passes([&](Config c) { c.to_sun = sun; })) << sun.x << ' ' << sun.y;
  }
  for (const double below : {-1e-9, -1.0, kNan}) {
    EXPECT_FALSE(passes([&](Config c) { c.mesh_texel = below; })) << below;
    EXPECT_FALSE(passes([&](Config c) { c.point_pixels = below; })) << below;
  }
  for (const double share : {-0.01, 1.01, kNan}) {
    EXPECT_FALSE(passes([&](Config c) { c.view_blend = share; })) << share;
    EXPECT_FALSE(passes([&](Config c) { c.edges = share; })) << share;
  }
  for (const int32_t side : {0, 255, 8193}) {
    EXPECT_FALSE(passes([&](Config c) { c.sun_pixels = side; })) << side;
  }
  EXPECT_FALSE(passes([](Config c) { c.cut_height = kNan; }));
  EXPECT_FALSE(passes([](Config c) { c.workers = -1; }));
  for (const double angle : {-1.0, 0.0, 3.0, kNan}) {
    EXPECT_FALSE(passes([&](Config c) { c.camera.field_of_view = angle; })) << angle;
  }
  for (const double nearest : {0.0, -1.0, kNan}) {
    EXPECT_FALSE(passes([&](Config c) { c.camera.nearest = nearest; })) << nearest;
  }
  EXPECT_FALSE(passes([](Config c) { c.camera.furthest = c.camera.nearest; }));
  EXPECT_FALSE(passes([](Config c) { c.camera.target = c.camera.eye; }));
  EXPECT_FALSE(passes([](Config c) { c.camera.eye.y = kInfinity; }));
}

}  // namespace
}  // namespace throng
