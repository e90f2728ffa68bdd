// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "throng/scene.h"

// The real models, where they are present: sizes in metres, triangles, and the warnings of each.
namespace throng {
namespace {

struct Expected {
  const char* file;
  char up;  // 0: the format's own
  uint64_t triangles;
  Vec3d size;  // of the bounds
};

const Expected kWorlds[] = {
    {"recast/nav_test.obj", 0, 1612, {91.384, 21.880, 77.353}},
    {"recast/dungeon.obj", 0, 10133, {74.320, 40.179, 98.932}},
    {"recast/undulating.obj", 0, 5202, {98.89, 10.87, 99.25}},
    {"recast/city400.obj", 0, 195536, {400.47, 20.68, 400.0}},
    {"sponza/sponza.obj", 0, 66450, {34.82, 16.56, 15.60}},
    {"buildings/parking_garage.dae", 0, 6413, {60.48, 45.90, 41.52}},
    {"buildings/powerplant.dae", 0, 4693, {99.14, 48.03, 64.65}},
    {"buildings/school.dae", 0, 5128, {33.02, 14.24, 17.52}},
    {"buildings/duplex_arch.obj", 0, 26774, {9.28, 8.18, 26.57}},
    {"buildings/office_a.obj", 0, 49923, {50.58, 16.04, 36.84}},
    {"buildings/schependomlaan.obj", 0, 464562, {27.60, 15.06, 24.47}},
    {"buildings/wd1_psup.obj", 'z', 44638, {21.52, 3.95, 22.60}},
    {"cities/delft.city.json", 0, 36271, {524.37, 17.30, 327.64}},
    {"cities/rotterdam_subset.city.json", 0, 646, {548.23, 18.29, 433.34}},
    {"cities/denhaag_01.obj", 'z', 41197, {787.36, 35.02, 671.85}},
    {"cities/lod3_railway.obj", 'z', 113537, {193.28, 24.38, 112.64}},
    // 132 polygons need 582 triangles for all corners; 177 corners are straight in space.
    {"cities/parking_garage.gml", 0, 582 - 177, {113.04, 11.56, 76.57}},
    {"cities/road_over_bridge.gml", 0, 28, {1181.1, 51.18, 196.85}},
};

std::string world(const std::string& name) {
  return std::string(THRONG_SHARED_WORLDS) + "/" + name;
}

bool present() { return std::filesystem::is_directory(THRONG_SHARED_WORLDS); }

Result<Scene> load(const std::string& name, char up = 0) {
  Context context;
  SceneConfig config;
  config.sources.push_back({.path = world(name), .up = {}, .scale = {}, .transform = {}});
  if (up != 0) config.sources[0].up = up;
  return load_scene(config, context);
}

TEST(SharedWorlds, EveryModelHasItsTrianglesAndItsSize) {
  if (!present()) GTEST_SKIP() << "no shared worlds here";
  for (const Expected& expected : kWorlds) {
    const auto scene = load(expected.file, expected.up);
    ASSERT_TRUE(scene) << scene.error().message;
    // Polygons with straight corners need fewer triangles than corners - 2.
    const auto read = static_cast<double>(scene->report.triangles_read);
    EXPECT_NEAR(read, static_cast<double>(expected.triangles), 0.002 * read) << expected.file;
    EXPECT_EQ(scene->report.bad_index + scene->report.non_finite, 0u) << expected.file;
    const Box3d box = scene->bounds();
    const Vec3d size = box.max - box.min;
    EXPECT_NEAR(size.x, expected.size.x, 0.02) << expected.file;
    EXPECT_NEAR(size.y, expected.size.y, 0.02) << expected.file;
    EXPECT_NEAR(size.z, expected.size.z, 0.02) << expected.file;
  }
}

TEST(SharedWorlds, NationalCoordinatesKeepTheirMillimetres) {
  if (!present()) GTEST_SKIP() << "no shared worlds here";
  const auto scene = load("cities/delft.city.json");
  ASSERT_TRUE(scene) << scene.error().message;
  EXPECT_NEAR(scene->bounds().min.x, 84616.468, 5e-5);
  EXPECT_NEAR(scene->bounds().max.z, -447422.999, 5e-5);
}

TEST(SharedWorlds, RoomVolumesAreLeftOutOfTheFlats) {
  if (!present()) GTEST_SKIP() << "no shared worlds here";
  const auto scene = load("buildings/schependomlaan.obj");
  ASSERT_TRUE(scene) << scene.error().message;
  EXPECT_EQ(scene->report.ignored, 1224u);
  for (const ScenePart& part : scene->parts) EXPECT_NE(part.node.rfind("IfcSpace", 0), 0u);
}

// assimp's IFC loses parts that a full kernel keeps: 5 % of the triangles of these two houses.
TEST(SharedWorlds, IfcThroughAssimpLosesAFewParts) {
  if (!present()) GTEST_SKIP() << "no shared worlds here";
  for (const auto& [name, low, high] :
       {std::tuple{"duplex_arch", 0.95, 0.96}, {"office_a", 0.95, 0.96}}) {
    const auto ifc = load(std::string("buildings/") + name + ".ifc");
    const auto obj = load(std::string("buildings/") + name + ".obj");
    ASSERT_TRUE(ifc) << ifc.error().message;
    ASSERT_TRUE(obj) << obj.error().message;
    const double share =
        static_cast<double>(ifc->triangles.size()) / static_cast<double>(obj->triangles.size());
    EXPECT_GT(share, low) << name;
    EXPECT_LT(share, high) << name;
    EXPECT_EQ(ifc->report.ignored, 0u) << name;  // Furniture hangs below IfcSpace nodes: it stays.
  }
}

TEST(SharedWorlds, LevelsKeepAllTheirCurvedPieces) {
  if (!present()) GTEST_SKIP() << "no shared worlds here";
  const auto scene = load("quake3/am_thornish.bsp");
  ASSERT_TRUE(scene) << scene.error().message;
  EXPECT_EQ(scene->patches.size(), 1459u);
  const auto small = load("quake3/oa_dm5.bsp");
  ASSERT_TRUE(small) << small.error().message;
  EXPECT_EQ(small->patches.size(), 214u);  // Of 54 grids.
}

}  // namespace
}  // namespace throng
