// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "baked.h"
#include "scratch_folder.h"
#include "throng/bake.h"
#include "throng/scene.h"
#include "worlds.h"

namespace throng {
namespace {

using test::bake;

Scene surface(const World& world, int32_t avatar_class = 0) {
  Context context;
  auto made = walkable_surface(world, avatar_class, context);
  EXPECT_TRUE(made) << made.error().message;
  return *std::move(made);
}

double area_of(const Scene& scene, bool in_plan) {
  double area = 0;
  for (const auto& t : scene.triangles) {
    Vec3d n = cross(scene.positions[t[1]] - scene.positions[t[0]],
                    scene.positions[t[2]] - scene.positions[t[0]]);
    area += (in_plan ? n.y : length(n)) / 2;
  }
  return area;
}

// Height of the surface at (x, z) nearest to `y`, by a test of every triangle.
double height_at(const Scene& scene, double x, double z, double y) {
  double best = 1e9;
  for (const auto& t : scene.triangles) {
    const Vec3d &a = scene.positions[t[0]], &b = scene.positions[t[1]], &c = scene.positions[t[2]];
    const Vec3d n = cross(b - a, c - a);
    const auto side = [&](const Vec3d& p, const Vec3d& q) {
      return (q.z - p.z) * (x - p.x) - (q.x - p.x) * (z - p.z);
    };
    if (side(a, b) < -1e-9 || side(b, c) < -1e-9 || side(c, a) < -1e-9) continue;
    const double height = a.y - (n.x * (x - a.x) + n.z * (z - a.z)) / n.y;
    if (std::fabs(height - y) < std::fabs(best - y)) best = height;
  }
  return best;
}

TEST(WalkableSurface, CoversEveryLegalCellAtItsHeight) {
  uint64_t tested = 0;
  for (const World& world : {bake(worlds::two_floors(), 0.1), bake(worlds::ramp(20, 4), 0.1),
                             bake(test::builtin({.name = "garage"}), 0.3),
                             bake(test::builtin({.name = "bridge"}), 0.3)}) {
    const WorldSummary summary = world.summary();
    for (int32_t c = 0; c < static_cast<int32_t>(summary.classes.size()); ++c) {
      const Scene scene = surface(world, c);
      // Neither more nor less than the legal cells, and all facing up.
      EXPECT_NEAR(area_of(scene, true), summary.walkable_area[static_cast<size_t>(c)],
                  1e-6 * summary.walkable_area[static_cast<size_t>(c)]);
      if (scene.triangles.empty()) continue;
      for (uint64_t n = 0; n < 60; ++n) {
        const Place p = world.random_place(c, 3, n);
        const double x =
            summary.origin.x +
            (std::floor((p.position.x - summary.origin.x) / summary.cell) + 0.5) * summary.cell;
        const double z =
            summary.origin.z +
            (std::floor((p.position.z - summary.origin.z) / summary.cell) + 0.5) * summary.cell;
        Place middle = p;
        middle.position = {x, 0, z};
        const double feet = world.feet(middle);
        EXPECT_NEAR(height_at(scene, x, z, feet), feet, 0.0025);
        ++tested;
      }
    }
  }
  EXPECT_GT(tested, 500u);
}

TEST(WalkableSurface, MergesLevelFloors) {
  const Scene flat = surface(bake(worlds::flat(12), 0.1));
  EXPECT_LE(flat.triangles.size(), 32u);  // a rectangle a tile
  ASSERT_EQ(flat.parts.size(), 1u);
  EXPECT_EQ(flat.parts[0].node, "storey 0");
  EXPECT_EQ(flat.parts[0].triangle_count, flat.triangles.size());
}

TEST(WalkableSurface, IsReadBackFromBothFormats) {
  const Scene scene = surface(bake(worlds::two_floors(), 0.1));
  const test::ScratchFolder folder;
  for (const char* extension : {".glb", ".obj"}) {
    const std::string path = folder.path() + "/surface" + extension;
    const auto written =
        extension == std::string(".glb") ? write_glb(scene, path) : write_obj(scene, path);
    ASSERT_TRUE(written) << written.error().message;
    EXPECT_FALSE(std::filesystem::exists(path + ".part"));
    Context context;
    SceneConfig config;
    config.sources.emplace_back().path = path;
    const auto read = load_scene(config, context);
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_EQ(read->triangles.size(), scene.triangles.size());
    EXPECT_NEAR(area_of(*read, false), area_of(scene, false), 1e-3);
  }
}

TEST(WalkableSurface, IsReadBackFromBothFormatsFarFromTheCoordinateOrigin) {
  const test::ScratchFolder folder;
  for (const Vec3d by : {Vec3d{678000, 370, -5403500}, Vec3d{-1e7, 0, 1e7}}) {
    Scene source = worlds::two_floors();
    for (Vec3d& p : source.positions) p = p + by;
    const Scene scene = surface(bake(source, 0.1));
    for (const char* extension : {".glb", ".obj"}) {
      const std::string path = folder.path() + "/surface" + extension;
      ASSERT_TRUE(extension == std::string(".glb") ? write_glb(scene, path)
                                                   : write_obj(scene, path));
      Context context;
      SceneConfig config;
      config.sources.emplace_back().path = path;
      const auto read = load_scene(config, context);
      ASSERT_TRUE(read) << read.error().message;
      const Box3d wrote = scene.bounds(), found = read->bounds();
      EXPECT_LT(length(found.min - wrote.min), 5e-6) << extension;
      EXPECT_LT(length(found.max - wrote.max), 5e-6) << extension;
      EXPECT_NEAR(area_of(*read, false), area_of(scene, false), 1e-3) << extension;
    }
  }
}

TEST(WalkableSurface, RefusesBadSettings) {
  Context context;
  EXPECT_FALSE(walkable_surface(World(), 0, context));
  EXPECT_FALSE(walkable_surface(bake(worlds::flat(3), 0.1), 99, context));
  EXPECT_FALSE(write_obj(Scene(), "nowhere.obj"));
  const Scene scene = surface(bake(worlds::flat(3), 0.1));
  EXPECT_FALSE(write_obj(scene, "no/such/folder/x.obj"));
}

}  // namespace
}  // namespace throng
