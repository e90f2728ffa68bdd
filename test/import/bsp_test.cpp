// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "import/bsp.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "core/random.h"
#include "import/bezier.h"
#include "scratch_folder.h"
#include "tiny_bsp.h"

namespace throng {
namespace {

Result<RawScene> read(const std::string& bytes) {
  Context context;
  ReadOptions options;
  options.name = "level.bsp";
  return read_bsp(bytes, options, context);
}

Vec3d surface_point(int columns, const std::vector<Vec3d>& control, int i, int j, double u,
                    double v) {
  const double bu[3] = {(1 - u) * (1 - u), 2 * u * (1 - u), u * u};
  const double bv[3] = {(1 - v) * (1 - v), 2 * v * (1 - v), v * v};
  Vec3d p;
  for (int b = 0; b < 3; ++b) {
    for (int a = 0; a < 3; ++a) {
      p = p + control[static_cast<size_t>((2 * j + b) * columns + 2 * i + a)] * (bu[a] * bv[b]);
    }
  }
  return p;
}

// Closest point of a triangle, by its three regions of edges and the inside.
double distance_to_triangle(Vec3d p, Vec3d a, Vec3d b, Vec3d c) {
  const auto to_segment = [](Vec3d q, Vec3d s, Vec3d t) {
    const Vec3d d = t - s;
    const double length2 = dot(d, d);
    const double k = length2 > 0 ? std::fmin(1, std::fmax(0, dot(q - s, d) / length2)) : 0;
    return length(q - (s + d * k));
  };
  const Vec3d n = cross(b - a, c - a);
  if (dot(n, n) > 0 && dot(cross(b - a, p - a), n) >= 0 && dot(cross(c - b, p - b), n) >= 0 &&
      dot(cross(a - c, p - c), n) >= 0) {
    return std::fabs(dot(p - a, n)) / length(n);
  }
  return std::fmin(to_segment(p, a, b), std::fmin(to_segment(p, b, c), to_segment(p, c, a)));
}

TEST(Bezier, TrianglesStayWithinTheToleranceOfTheSurface) {
  for (uint64_t seed = 0; seed < 20; ++seed) {
    uint64_t counter = 0;
    const auto roll = [&] { return random_unit(seed, 0, counter++); };
    const int columns = 3 + 2 * static_cast<int>(seed % 2);
    const int rows = 3 + 2 * static_cast<int>(seed % 3);
    std::vector<Vec3d> control;
    for (int j = 0; j < rows; ++j) {
      for (int i = 0; i < columns; ++i) {
        control.push_back({i + roll(), 2 * roll(), j + roll()});
      }
    }
    const double tolerance = 0.02;
    const PatchMesh mesh = tessellate_biquadratic(columns, rows, control, tolerance);
    ASSERT_EQ(mesh.points.size(), static_cast<size_t>(mesh.columns) * mesh.rows);
    double worst = 0;
    for (int j = 0; j < rows / 2; ++j) {
      for (int i = 0; i < columns / 2; ++i) {
        for (int k = 0; k < 60; ++k) {
          const Vec3d p = surface_point(columns, control, i, j, roll(), roll());
          double nearest = INFINITY;
          for (int32_t y = 0; y + 1 < mesh.rows; ++y) {
            for (int32_t x = 0; x + 1 < mesh.columns; ++x) {
              const size_t a = static_cast<size_t>(y) * mesh.columns + x;
              const size_t b = a + static_cast<size_t>(mesh.columns);
              nearest = std::fmin(nearest, distance_to_triangle(p, mesh.points[a], mesh.points[b],
                                                                mesh.points[a + 1]));
              nearest = std::fmin(
                  nearest,
                  distance_to_triangle(p, mesh.points[a + 1], mesh.points[b], mesh.points[b + 1]));
            }
          }
          worst = std::fmax(worst, nearest);
        }
      }
    }
    EXPECT_LE(worst, tolerance);
    EXPECT_GT(worst, tolerance / 100);  // Not simply cut as fine as can be.
  }
}

TEST(Bezier, AFlatPatchIsOneQuadAPiece) {
  std::vector<Vec3d> control;
  for (int j = 0; j < 3; ++j) {
    for (int i = 0; i < 5; ++i) control.push_back({1.0 * i, 0, 1.0 * j});
  }
  const PatchMesh mesh = tessellate_biquadratic(5, 3, control, 0.01);
  EXPECT_EQ(mesh.columns, 3);
  EXPECT_EQ(mesh.rows, 2);
}

TEST(Bsp, FloorPatchAndDoorAreReadAndWaterIsNot) {
  const auto raw = read(test::tiny_level());
  ASSERT_TRUE(raw) << raw.error().message;
  const Scene& scene = raw->scene;
  ASSERT_EQ(scene.parts.size(), 3u);
  EXPECT_EQ(scene.parts[0].material, "textures/base/floor");
  EXPECT_EQ(scene.parts[0].triangle_count, 2u);
  EXPECT_EQ(scene.parts[1].material, "textures/base/arch");
  EXPECT_GT(scene.parts[1].triangle_count, 20u);
  EXPECT_EQ(scene.parts[2].node, "func_door");
  EXPECT_EQ(scene.parts[2].triangle_count, 2u);
  ASSERT_EQ(scene.patches.size(), 1u);
  EXPECT_EQ(scene.patches[0].columns, 3);
  EXPECT_EQ(scene.patches[0].points.size(), 9u);
  ASSERT_EQ(scene.report.warnings.size(), 1u);
  EXPECT_NE(scene.report.warnings[0].find("1 faces that are not solid"), std::string::npos);
  EXPECT_EQ(raw->up, 'z');
}

TEST(Bsp, ALevelBecomesMetresWithYUp) {
  const test::ScratchFolder folder;
  Context context;
  SceneConfig config;
  config.sources.push_back({.path = folder.write("tiny.bsp", test::tiny_level()),
                            .up = {},
                            .scale = {},
                            .transform = {}});
  const auto scene = load_scene(config, context);
  ASSERT_TRUE(scene) << scene.error().message;
  const Box3d box = scene->bounds();
  EXPECT_NEAR(box.max.x, 400 * 0.0254, 1e-6);
  EXPECT_NEAR(box.min.z, -400 * 0.0254, 1e-6);
  EXPECT_NEAR(box.max.y, 100 * 0.0254, 0.02);  // The arch's crown: half of its control height.
  EXPECT_NEAR(scene->patches[0].points[1].y, 200 * 0.0254, 1e-6);
  SceneConfig rough = config;
  rough.curve_tolerance = 0.5;
  const auto coarse = load_scene(rough, context);
  ASSERT_TRUE(coarse) << coarse.error().message;
  EXPECT_LT(coarse->triangles.size(), scene->triangles.size() / 2);
}

TEST(Bsp, OtherKindsOfFileAreToldApart) {
  std::string level = test::tiny_level();
  level[4] = 47;
  EXPECT_EQ(read(level).error().message,
            "level.bsp: level of version 47; only 46 (Quake 3) is read");
  level[0] = 'V';
  EXPECT_EQ(read(level).error().message,
            "level.bsp: not a Quake 3 level: it does not begin with IBSP");
  EXPECT_EQ(read("IBSP").error().message, "level.bsp: too short for a level's header");
  const std::string whole = test::tiny_level();
  EXPECT_EQ(read(whole.substr(0, whole.size() - 1)).error().message.substr(0, 29),
            "level.bsp: the lump of faces ");
}

TEST(Bsp, WildNumbersInFacesAreCounted) {
  const std::string whole = test::tiny_level();
  int32_t lump[2];
  std::memcpy(lump, whole.data() + 8 + 13 * 8, sizeof lump);
  for (const size_t field : {size_t{0}, size_t{2}, size_t{3}, size_t{4}, size_t{5}, size_t{6}}) {
    for (const int32_t value : {-1, 1 << 30, INT32_MIN, INT32_MAX}) {
      std::string level = whole;
      std::memcpy(level.data() + lump[0] + field * 4, &value, 4);
      const auto raw = read(level);
      ASSERT_TRUE(raw) << raw.error().message;
      EXPECT_EQ(raw->scene.report.bad_index, 1u) << field << " = " << value;
    }
  }
}

}  // namespace
}  // namespace throng
