// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "import/raw/clean.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "import/formats/obj.h"
#include "import/formats/ply.h"
#include "import/raw/area_rules.h"
#include "import/raw/raw_scene.h"

namespace throng {
namespace {

Result<void> clean(Scene& scene) {
  Context context;
  return importer::clean_scene(scene, "m.obj", context);
}

Scene cube(double side = 10) {
  Scene scene;
  scene.add_box({0, 0, 0}, {side, side, side});
  return scene;
}

TEST(Clean, ACleanSceneStaysAsItIs) {
  Scene scene = cube();
  const Scene before = scene;
  ASSERT_TRUE(clean(scene));
  EXPECT_EQ(scene.positions, before.positions);
  EXPECT_EQ(scene.triangles, before.triangles);
  EXPECT_EQ(scene.report.degenerate + scene.report.duplicate + scene.report.spikes, 0u);
  EXPECT_TRUE(scene.report.warnings.empty());
}

TEST(Clean, BrokenTrianglesAreDroppedAndCountedAndPartsFollow) {
  Scene scene;
  scene.parts = {{"f", "a", "", 0, 3}, {"f", "b", "", 3, 1}, {"f", "c", "", 4, 1}};
  const double nan = std::nan("");
  const double inf = std::numeric_limits<double>::infinity();
  scene.add_triangle({0, 0, 0}, {nan, 0, 0}, {0, 0, 9});
  scene.add_triangle({0, 0, 0}, {9, 0, 0}, {0, 0, 9}, 4);
  scene.add_triangle({0, 0, 0}, {9, 0, 0}, {0, 0, 8});
  scene.triangles.back()[1] = 999;
  scene.add_triangle({0, 0, 0}, {9, inf, 0}, {0, 0, 7});
  scene.add_triangle({0, 0, 0}, {9, 0, 0}, {0, 0, 6}, 5);
  scene.report.triangles_read = 5;
  ASSERT_TRUE(clean(scene));
  EXPECT_EQ(scene.report.non_finite, 2u);
  EXPECT_EQ(scene.report.bad_index, 1u);
  EXPECT_EQ(
      scene.report.warnings,
      std::vector<std::string>{"m.obj: 3 of 5 triangles are left out: 2 with corners that are "
                               "not finite, 1 with bad indices"});
  EXPECT_EQ(scene.triangles.size(), 2u);
  EXPECT_EQ(scene.area, (std::vector<AreaKind>{4, 5}));
  EXPECT_EQ(scene.positions.size(), 6u);
  ASSERT_EQ(scene.parts.size(), 2u);
  EXPECT_EQ(scene.parts[0].triangle_count, 1u);
  EXPECT_EQ(scene.parts[1].node, "c");
  EXPECT_EQ(scene.parts[1].first_triangle, 1u);
}

TEST(Clean, NothingLeftIsRefused) {
  Scene scene;
  scene.report.triangles_read = 3;
  const auto done = clean(scene);
  ASSERT_FALSE(done);
  EXPECT_EQ(done.error().code, Errc::kBadInput);
  EXPECT_EQ(done.error().message,
            "m.obj: no triangle is left of 3 (0 ignored, 0 not finite, 0 with bad indices); check "
            "the file and the rules");
}

TEST(Clean, DegenerateAndCoincidentTrianglesAreKeptAndCounted) {
  Scene scene = cube();
  scene.add_triangle({1, 1, 1}, {1, 1, 1}, {2, 2, 2});  // two corners the same
  scene.add_triangle({0, 0, 0}, {1, 2, 3}, {2, 4, 6});  // on a line
  scene.add_triangle({0, 9, 0}, {1, 9, 0}, {0, 9, 1});
  scene.add_triangle({1, 9, 0}, {0, 9, 1}, {-0.0, 9, 0});  // the same, turned and with another zero
  scene.add_triangle({0, 9, 1}, {1, 9, 0}, {0, 9, 0});     // the same, facing away
  ASSERT_TRUE(clean(scene));
  EXPECT_EQ(scene.report.degenerate, 2u);
  EXPECT_EQ(scene.report.duplicate, 2u);
  EXPECT_EQ(scene.triangles.size(), 17u);
}

TEST(Clean, ATenKilometreSpikeIsCountedAndKept) {
  Scene scene = cube();
  scene.add_triangle({1, 0, 1}, {2, 0, 1}, {1, 10000, 1});
  ASSERT_TRUE(clean(scene));
  EXPECT_EQ(scene.report.spikes, 1u);
  EXPECT_EQ(scene.triangles.size(), 13u);
  ASSERT_EQ(scene.report.warnings.size(), 1u);
  EXPECT_EQ(scene.report.warnings[0],
            "m.obj: 1 spikes, triangles up to 10 km long beside a model of 10 m; they are kept");
}

TEST(Clean, ALargeGroundUnderAHouseIsNoSpike) {
  Scene scene = cube();
  scene.add_quad({-9000, 0, -9000}, {9000, 0, -9000}, {9000, 0, 9000}, {-9000, 0, 9000});
  ASSERT_TRUE(clean(scene));
  EXPECT_EQ(scene.report.spikes, 0u);
}

TEST(Clean, AMillionMetreSpikeIsRefused) {
  Scene scene = cube();
  scene.add_triangle({1, 0, 1}, {2, 0, 1}, {1, 2e6, 1});
  const auto done = clean(scene);
  ASSERT_FALSE(done);
  EXPECT_EQ(done.error().message,
            "m.obj: 1 triangles reach 2000 km while the rest is 0.01 km across; remove them");
  Scene far = cube();
  far.add_triangle({1, 0, 1}, {2, 0, 1}, {1, 1e300, 1});
  EXPECT_FALSE(clean(far));
}

TEST(Clean, FarPartsAreReported) {
  Scene scene;
  for (int i = 0; i < 100; ++i) scene.add_box({1.0 * i, 0, 0}, {i + 0.9, 2, 2});
  scene.add_box({50000, 0, 0}, {50001, 1, 1});
  ASSERT_TRUE(clean(scene));
  ASSERT_EQ(scene.report.warnings.size(), 1u);
  EXPECT_EQ(scene.report.warnings[0],
            "m.obj: 12 triangles lie more than 1 km away from the rest; they are kept");
}

TEST(Clean, SuspiciousUnitsAreReported) {
  Scene small = cube(0.002);
  ASSERT_TRUE(clean(small));
  ASSERT_EQ(small.report.warnings.size(), 1u);
  EXPECT_EQ(
      small.report.warnings[0],
      "m.obj: the model is only 0.002 m across; if its unit is not the metre, give its scale");
  Scene large = cube(2e6);
  ASSERT_TRUE(clean(large)) << clean(large).error().message;
  ASSERT_EQ(large.report.warnings.size(), 1u);
  EXPECT_EQ(large.report.warnings[0],
            "m.obj: the model is 2000 km across; if its unit is not the metre, give its scale");
}

TEST(AreaRules, GlobsMatchAsAShellDoes) {
  EXPECT_TRUE(importer::glob_matches("", "anything"));
  EXPECT_TRUE(importer::glob_matches("IFCspace*", "IfcSpace|12"));
  EXPECT_TRUE(importer::glob_matches("*a*b*c*", "xxaxxbxxcxx"));
  EXPECT_TRUE(importer::glob_matches("a?c", "abc"));
  EXPECT_TRUE(importer::glob_matches("**", ""));
  EXPECT_FALSE(importer::glob_matches("a?c", "ac"));
  EXPECT_FALSE(importer::glob_matches("abc", "abcd"));
  EXPECT_FALSE(importer::glob_matches("*b", "abc"));
  // A pattern that takes a naive matcher exponential time.
  EXPECT_FALSE(importer::glob_matches("*a*a*a*a*a*a*a*a*a*a*b", std::string(5000, 'a')));
  EXPECT_TRUE(importer::glob_matches_path("level2", "House/Level2/Wall 7"));
  EXPECT_TRUE(importer::glob_matches_path("House/*7", "House/Level2/Wall 7"));
  EXPECT_FALSE(importer::glob_matches_path("Level", "House/Level2/Wall 7"));
}

TEST(AreaRules, RoomVolumesAreNotSolidButFurnitureInThemIs) {
  const auto make = [] {
    Scene scene;
    for (int i = 0; i < 5; ++i)
      scene.add_triangle({1.0 * i, 0, 0}, {1.0 * i, 1, 0}, {1.0 * i, 0, 1});
    scene.parts = {{"f", "IfcSpace|1", "", 0, 1},
                   {"f", "IfcBuilding/IfcSpace_Room/IfcFurnishingElement_Table", "", 1, 1},
                   {"f", "IfcWall_a/IfcOpeningElement_b", "", 2, 1},
                   {"f", "Building/b", "ClosureSurface", 3, 1},
                   {"f", "ClearanceSpace/c", "", 4, 1}};
    return scene;
  };
  Scene scene = make();
  importer::apply_rules(scene, {});
  ASSERT_EQ(scene.parts.size(), 1u);
  EXPECT_EQ(scene.parts[0].node, "IfcBuilding/IfcSpace_Room/IfcFurnishingElement_Table");
  EXPECT_EQ(scene.report.ignored, 4u);
  EXPECT_EQ(scene.positions[scene.triangles[0][0]].x, 1);
  Scene kept = make();
  const AreaRule rule{.material = {}, .node = "IfcSpace|*", .kind = 9};
  importer::apply_rules(kept, {&rule, 1});
  ASSERT_EQ(kept.parts.size(), 2u);
  EXPECT_EQ(kept.area[0], 9);
}

TEST(Obj, FacesOfAllKindsAndNames) {
  Context context;
  importer::ReadOptions options;
  options.name = "o.obj";
  const auto raw = importer::read_obj(
      "v 0 0 0\r\nv 4 0 0\nv 4 0 4\nv 0 0 4\nv 2 0 1 # inner\n"
      "o Hall\ng Floor\nusemtl Oak \\\n wood\n"
      "f 1/1/1 2//2 3/3 4\n"      // a quad
      "o Arrow\nf -5 -4 -1 -2\n"  // concave, counted from the end
      "l 1 2\np 1\nf 1 2 9\nf 1 2\nf 1 x 2\nv 1 2\nf 1 2 6\n"
      "v 447000.123 +5e0 1e400\n",
      options, context);
  ASSERT_TRUE(raw) << raw.error().message;
  const Scene& scene = raw->scene;
  ASSERT_EQ(scene.parts.size(), 2u);
  EXPECT_EQ(scene.parts[0].node, "Hall/Floor");
  EXPECT_EQ(scene.parts[0].material, "Oak   wood");
  EXPECT_EQ(scene.parts[0].triangle_count, 2u);
  EXPECT_EQ(scene.parts[1].node, "Arrow");
  EXPECT_EQ(scene.parts[1].triangle_count, 3u);  // Two of the arrow, one with the broken vertex.
  EXPECT_EQ(scene.report.bad_index, 3u);
  double area = 0;
  for (uint32_t t = 2; t < 4; ++t) {
    const auto& [a, b, c] = scene.triangles[t];
    area += length(cross(scene.positions[b] - scene.positions[a],
                         scene.positions[c] - scene.positions[a])) /
            2;
  }
  EXPECT_NEAR(area, 8 - 2, 1e-12);  // The triangle 1 2 4 less the notch 2 5 4 ... kept concave.
  EXPECT_EQ(scene.positions.back().x, 447000.123);
  EXPECT_EQ(scene.report.warnings.size(), 1u);
}

TEST(Ply, ListsOtherPropertiesAndBothByteOrders) {
  Context context;
  importer::ReadOptions options;
  options.name = "p.ply";
  const std::string header =
      "element vertex 4\nproperty float x\nproperty uchar red\nproperty double y\nproperty short "
      "z\n"
      "element face 1\nproperty uchar flags\nproperty list uchar int vertex_index\nend_header\n";
  const auto text = importer::read_ply("ply\nformat ascii 1.0\ncomment made by hand\n" + header +
                                           "0 9 0 0\n2 9 0 0\n2 9 1e-3 2 0 9 0 2\n7 4 0 1 2 3\n",
                                       options, context);
  ASSERT_TRUE(text) << text.error().message;
  EXPECT_EQ(text->scene.triangles.size(), 2u);
  EXPECT_EQ(text->scene.positions[2], (Vec3d{2, 1e-3, 2}));
  std::string body;
  const auto put = [&](const auto& value) {  // Big-endian.
    std::string raw(reinterpret_cast<const char*>(&value), sizeof value);
    body.append(raw.rbegin(), raw.rend());
  };
  for (const Vec3d& p : text->scene.positions) {
    put(static_cast<float>(p.x));
    put(uint8_t{9});
    put(p.y);
    put(static_cast<int16_t>(p.z));
  }
  put(uint8_t{7});
  put(uint8_t{4});
  for (int32_t i = 0; i < 4; ++i) put(i);
  const std::string whole = "ply\nformat binary_big_endian 1.0\n" + header + body;
  const auto binary = importer::read_ply(whole, options, context);
  ASSERT_TRUE(binary) << binary.error().message;
  EXPECT_EQ(binary->scene.positions, text->scene.positions);
  EXPECT_EQ(binary->scene.triangles, text->scene.triangles);
  EXPECT_EQ(importer::read_ply(whole.substr(0, whole.size() - 1), options, context).error().message,
            "p.ply: ends in face 0 of 1; it is truncated or damaged");
  EXPECT_EQ(
      importer::read_ply("ply\nformat ascii 1.0\nelement x 1\nproperty long y\n", options, context)
          .error()
          .message,
      "p.ply:4: unknown type 'long'");
}

}  // namespace
}  // namespace throng
