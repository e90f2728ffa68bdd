// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "import/formats/bsp.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "core/random.h"
#include "scratch_folder.h"
#include "tiny_bsp.h"

namespace throng {
namespace {

Result<importer::RawScene> read(const std::string& bytes) {
  Context context;
  importer::ReadOptions options;
  options.name = "level.bsp";
  return importer::read_bsp(bytes, options, context);
}

TEST(Bsp, FloorPatchAndDoorAreReadAndWaterIsNot) {
  const auto raw = read(test::tiny_level());
  ASSERT_TRUE(raw) << raw.error().message;
  const Scene& scene = raw->scene;
  ASSERT_EQ(scene.parts.size(), 2u);
  EXPECT_EQ(scene.parts[0].material, "textures/base/floor");
  EXPECT_EQ(scene.parts[0].triangle_count, 2u);
  EXPECT_EQ(scene.parts[1].node, "func_door");
  EXPECT_EQ(scene.parts[1].triangle_count, 2u);
  ASSERT_EQ(scene.patches.size(), 1u);
  ASSERT_EQ(scene.patches.runs.size(), 1u);
  EXPECT_EQ(scene.patches.runs[0].material, "textures/base/arch");
  EXPECT_EQ(scene.patches.patches[0].at(0.5, 0.5), (Vec3d{100, 100, 100}));
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
  EXPECT_NEAR(scene->patches.patches[0].at(0.5, 0).y, 100 * 0.0254, 1e-9);
  // Two triangles each for the floor and the door, then those of the arch, which name their patch.
  ASSERT_EQ(scene->parts.size(), 3u);
  EXPECT_EQ(scene->parts[2].material, "textures/base/arch");
  ASSERT_EQ(scene->patch_of_triangle.size(), scene->triangles.size());
  for (size_t t = 0; t < scene->triangles.size(); ++t) {
    EXPECT_EQ(scene->patch_of_triangle[t], t < 4 ? kNoPatch : 0u);
  }
  SceneConfig rough = config;
  rough.curve_tolerance = 0.5;
  const auto coarse = load_scene(rough, context);
  ASSERT_TRUE(coarse) << coarse.error().message;
  EXPECT_LT(coarse->triangles.size(), scene->triangles.size() / 2);
}

// A 5 x 3 grid is two pieces; a second face continues it, and meets it with the same numbers.
TEST(Bsp, PiecesOfAGridAndEqualBordersOfFacesAreNeighbours) {
  const auto grid = [](float from, int32_t columns) {
    test::TinyFace face{0, 2, {}, {}, columns, 3};
    for (int32_t row = 0; row < 3; ++row) {
      for (int32_t column = 0; column < columns; ++column) {
        const float x = from + 70.3f * static_cast<float>(column);
        face.points.push_back({x, 33.1f * static_cast<float>(row), 0.1f * x * x / 70.3f});
      }
    }
    return face;
  };
  const auto raw = read(test::make_bsp({{"stone", 0, 1}}, {grid(0, 5), grid(4 * 70.3f, 3)}, 2, ""));
  ASSERT_TRUE(raw) << raw.error().message;
  const PatchSet& set = raw->scene.patches;
  ASSERT_EQ(set.size(), 3u);
  EXPECT_TRUE(check_patches(set));
  EXPECT_EQ(set.edges[0][2].next[0], (PatchSide{1, 0}));
  EXPECT_EQ(set.edges[1][2].next[0], (PatchSide{2, 0}));
  EXPECT_EQ(set.edges[2][2].bind, EdgeBind::kOpen);
}

TEST(Bsp, OtherKindsOfFileAreDistinguished) {
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
