// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>

#include "scratch_folder.h"
#include "throng/scene.h"

namespace throng {
namespace {

std::string data(const std::string& name) { return std::string(THRONG_TEST_DATA) + "/" + name; }

Result<Scene> load(const std::string& path, std::vector<AreaRule> rules = {}) {
  Context context;
  SceneConfig config;
  config.sources.push_back({.path = path, .up = {}, .scale = {}, .transform = {}});
  config.rules = std::move(rules);
  return load_scene(config, context);
}

void expect_box(const Scene& scene, Vec3d low, Vec3d high, double error = 1e-6) {
  const Box3d box = scene.bounds();
  EXPECT_NEAR(length(box.min - low), 0, error) << box.min.x << ' ' << box.min.y << ' ' << box.min.z;
  EXPECT_NEAR(length(box.max - high), 0, error)
      << box.max.x << ' ' << box.max.y << ' ' << box.max.z;
}

TEST(LoadScene, EveryFormatGivesTheSameBox) {
  for (const char* name : {"box.obj", "box.stl", "box_binary.stl", "box.ply", "box_binary.ply",
                           "box.dae", "box.glb", "box.gltf"}) {
    const auto scene = load(data(name));
    ASSERT_TRUE(scene) << scene.error().message;
    EXPECT_EQ(scene->triangles.size(), 12u) << name;
    EXPECT_EQ(scene->area.size(), 12u) << name;
    EXPECT_EQ(scene->report.triangles_read, 12u) << name;
    EXPECT_TRUE(scene->report.warnings.empty()) << name << ": " << scene->report.warnings.front();
    expect_box(*scene, {0, 0, 0}, {2, 3, 4});
  }
}

TEST(LoadScene, UnitsAndAxesOfFormatsAreRespected) {
  const auto fbx = load(data("box_ascii.fbx"));  // FBX counts in centimetres.
  ASSERT_TRUE(fbx) << fbx.error().message;
  expect_box(*fbx, {0, 0, 0}, {0.02, 0.03, 0.04});
  const auto ifc = load(data("wall.ifc"));  // Millimetres, Z up.
  ASSERT_TRUE(ifc) << ifc.error().message;
  expect_box(*ifc, {0, 0, -0.2}, {2, 3, 0}, 1e-5);
  EXPECT_EQ(ifc->parts.at(0).node.substr(0, 7), "IfcWall");
  const auto studio = load(data("box.3ds"));  // Z up.
  ASSERT_TRUE(studio) << studio.error().message;
  expect_box(*studio, {0, 0, -3}, {2, 4, 0});
}

TEST(LoadScene, NodesAndMaterialsKeepTheirNames) {
  for (const char* name : {"box.obj", "box.dae", "box.glb"}) {
    const auto scene = load(data(name));
    ASSERT_TRUE(scene) << scene.error().message;
    ASSERT_EQ(scene->parts.size(), 2u) << name;
    EXPECT_EQ(scene->parts[0].node, "Box");
    EXPECT_EQ(scene->parts[0].material, "Stone");
    EXPECT_EQ(scene->parts[0].triangle_count, 8u);
    EXPECT_EQ(scene->parts[1].material, "Glass");
    EXPECT_EQ(scene->parts[1].first_triangle, 8u);
    EXPECT_EQ(scene->parts[1].file, data(name));
  }
}

TEST(LoadScene, SourcesAreScaledTurnedMovedAndJoined) {
  Context context;
  SceneConfig config;
  SceneSource z_up{.path = data("box.obj"), .up = 'z', .scale = 10.0, .transform = {}};
  z_up.transform.m[0][3] = 100;
  config.sources = {{.path = data("box.glb"), .up = {}, .scale = {}, .transform = {}}, z_up};
  const auto scene = load_scene(config, context);
  ASSERT_TRUE(scene) << scene.error().message;
  EXPECT_EQ(scene->triangles.size(), 24u);
  EXPECT_EQ(scene->parts.size(), 4u);
  EXPECT_EQ(scene->parts[3].first_triangle, 20u);
  expect_box(*scene, {0, 0, -30}, {120, 40, 4});  // (x, y, z) with Z up lies at (x, z, -y).
}

TEST(LoadScene, RulesNameKindsAndTheLastOneWins) {
  const auto scene = load(data("box.obj"), {{"*", "", 5}, {"GLASS", "b?x", kAreaBlocked}});
  ASSERT_TRUE(scene) << scene.error().message;
  EXPECT_EQ(scene->area[0], 5);
  EXPECT_EQ(scene->area[11], kAreaBlocked);
  const auto open = load(data("box.obj"), {{"Glass", "", kAreaIgnored}});
  ASSERT_TRUE(open) << open.error().message;
  EXPECT_EQ(open->triangles.size(), 8u);
  EXPECT_EQ(open->report.ignored, 4u);
  EXPECT_EQ(open->report.triangles_read, 12u);
  const auto none = load(data("box.obj"), {{"*", "", kAreaIgnored}});
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().code, Errc::kBadInput);
}

TEST(LoadScene, WhatCannotBeReadIsRefusedWithItsName) {
  const test::ScratchFolder folder;
  const auto message = [&](const std::string& path) {
    const auto scene = load(path);
    return scene ? std::string("accepted") : scene.error().message;
  };
  for (const char* name : {"none.obj", "none.glb", "none.bsp", "none.json"}) {
    EXPECT_EQ(message(folder.path() + "/" + name),
              folder.path() + "/" + name + ": no such file; check the path");
  }
  const std::string text = folder.write("notes.txt", "hello");
  EXPECT_EQ(message(text).substr(0, text.size() + 22), text + ": unknown kind of file");
  for (const char* name : {"empty.obj", "empty.gml", "empty.glb", "empty.wkt", "empty.json",
                           "empty.bsp", "empty.stl", "empty.ply", "empty.ifc", "empty.geojson"}) {
    const std::string path = folder.write(name, "");
    EXPECT_EQ(message(path).substr(0, path.size()), path);
  }
  Context context;
  EXPECT_EQ(load_scene({}, context).error().code, Errc::kBadConfig);
}

TEST(LoadScene, ACancelledReadSaysSo) {
  Context context;
  context.cancel = true;
  SceneConfig config;
  config.sources.push_back({.path = data("box.glb"), .up = {}, .scale = {}, .transform = {}});
  EXPECT_EQ(load_scene(config, context).error().code, Errc::kCancelled);
  Context late;  // From the callback, while the first file is about to be read.
  late.on_progress = [&](const Progress&) { late.cancel = true; };
  EXPECT_EQ(load_scene(config, late).error().code, Errc::kCancelled);
}

}  // namespace
}  // namespace throng
