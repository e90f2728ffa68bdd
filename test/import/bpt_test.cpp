// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "import/formats/bpt.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "core/files/read_file.h"
#include "import/patches/patch_edges.h"
#include "patch_bytes.h"
#include "patch_nets.h"

namespace throng {
namespace {

constexpr test::PatchReader kReader{importer::read_bpt, "pot.bpt"};

// A bilinear square beside a quadratic one; the second direction is t.
const char* const kTwo =
    "# two squares\n2\n1 1\n0 0 0\n0 3 0\n3 0 0\n3 3 0\n"
    "\n# the other\n2 1\n3 0 0\n3 3 0\n4.5 0 2\n4.5 3 2\n6 0 0\n6 3 0\n";

TEST(Bpt, LowerDegreesAreRaisedAndEqualBordersAreNeighbours) {
  const auto raw = kReader.read(kTwo);
  ASSERT_TRUE(raw) << raw.error().message;
  const PatchSet& set = raw->scene.patches;
  ASSERT_EQ(set.size(), 2u);
  EXPECT_TRUE(check_patches(set));
  EXPECT_EQ(set.edges[0][2].next[0], (PatchSide{1, 0}));
  EXPECT_EQ(set.patches[0].at(0.5, 0.25), (Vec3d{1.5, 0.75, 0}));
  EXPECT_LE(length(set.patches[1].at(0.5, 0.5) - Vec3d{4.5, 1.5, 1}), 1e-15);
  EXPECT_EQ(raw->up, 'z');
}

TEST(Bpt, DamageIsNamedByItsLine) {
  const std::string two = kTwo;
  EXPECT_EQ(kReader.fault_of(""),
            "pot.bpt:0: does not begin with the number of patches; write it on a line of its own");
  EXPECT_EQ(kReader.fault_of("0\n").substr(0, 10), "pot.bpt:1:");
  EXPECT_EQ(kReader.fault_of("many\n").substr(0, 10), "pot.bpt:1:");
  EXPECT_EQ(kReader.fault_of("1\n4 1\n"),
            "pot.bpt:2: patch 1 needs its two degrees here, each 1 to 3");
  EXPECT_EQ(kReader.fault_of("1\n1 1\n0 0 0\n0 x 0\n"),
            "pot.bpt:4: control point 2 of patch 1 needs three numbers below 1e9 here");
  EXPECT_EQ(kReader.fault_of("1\n1 1\n0 0 0\n0 nan 0\n"),
            "pot.bpt:4: control point 2 of patch 1 needs three numbers below 1e9 here");
  EXPECT_EQ(kReader.fault_of("1\n1 1\n0 0 0\n0 1e300 0\n").substr(0, 10), "pot.bpt:4:");
  EXPECT_EQ(kReader.fault_of("1\n1 1\n0 0 0 7\n").substr(0, 10), "pot.bpt:3:");
  EXPECT_EQ(kReader.fault_of(two.substr(0, two.size() - 7)),
            "pot.bpt:15: ends before the control points of patch 2 of 2; the file is truncated, or "
            "the number of patches is wrong");
  EXPECT_EQ(kReader.fault_of("99999999999\n1 1\n0 0 0\n0 3 0\n3 0 0\n3 3 0\n").substr(0, 46),
            "pot.bpt:6: ends before the degrees of patch 2 ");
  EXPECT_EQ(kReader.fault_of(two + "1 1\n"),
            "pot.bpt:17: more follows after the last of 2 patches; correct the number");
}

class Teapot : public testing::Test {
 protected:
  static std::string path() { return std::string(THRONG_SHARED_WORLDS) + "/bezier/teapot.bpt"; }
  void SetUp() override {
    if (!std::filesystem::exists(path())) GTEST_SKIP() << "no shared worlds here";
  }
};

TEST_F(Teapot, IsABodyAHandleASpoutAndALidWithPoles) {
  Context context;
  SceneConfig config;
  config.sources.push_back({.path = path(), .up = {}, .scale = {}, .transform = {}});
  const auto scene = load_scene(config, context);
  ASSERT_TRUE(scene) << scene.error().message;
  const PatchSet& set = scene->patches;
  ASSERT_EQ(set.size(), 32u);
  size_t one = 0;
  size_t collapsed = 0;
  size_t outward = 0;
  for (uint32_t p = 0; p < set.size(); ++p) {
    for (int32_t e = 0; e < 4; ++e) {
      one += set.edges[p][static_cast<size_t>(e)].bind == EdgeBind::kOne ? 1 : 0;
      collapsed += importer::is_collapsed(set.patches[p].edge(e)) ? 1 : 0;
    }
    const Vec3d n = set.patches[p].normal(0.5, 0.5);
    EXPECT_NEAR(length(n), 1, 1e-12);
    // The body (patches 4 to 11) faces away from the axis.
    const Vec3d middle = set.patches[p].at(0.5, 0.5);
    if (p >= 4 && p < 12) outward += n.x * middle.x + n.z * middle.z > 0 ? 1 : 0;
  }
  EXPECT_EQ(one, 104u);  // 52 borders.
  EXPECT_EQ(collapsed, 8u);
  EXPECT_EQ(outward, 8u);
  // The tip of the lid and the middle of the bottom are single points with upright normals.
  EXPECT_GT(set.patches[20].normal(0, 0.5).y, 0.99);
  EXPECT_LT(set.patches[28].normal(0, 0.5).y, -0.99);
  const Box3d box = scene->bounds();
  EXPECT_NEAR(box.min.y, 0, 1e-9);
  EXPECT_NEAR(box.max.y, 3.15, 1e-9);

  const auto mesh = tessellate_patches(set, {.tolerance = 0.005}, context);
  ASSERT_TRUE(mesh) << mesh.error().message;
  EXPECT_GT(test::expect_watertight(set, *mesh), 16u);
  for (uint32_t p = 0; p < set.size(); ++p) {
    EXPECT_LE(test::worst_distance(set, *mesh, p, 50), 0.005);
  }
  ASSERT_EQ(scene->patch_of_triangle.size(), scene->triangles.size());
  for (size_t t = 1; t < scene->triangles.size(); ++t) {
    EXPECT_LE(scene->patch_of_triangle[t - 1], scene->patch_of_triangle[t]);
  }
}

TEST_F(Teapot, SurvivesDamage) {
  const auto whole = read_file(path());
  ASSERT_TRUE(whole) << whole.error().message;
  EXPECT_GT(kReader.survive(*whole, "pot.bpt:", 7, 5, 1000), 300u);
}

}  // namespace
}  // namespace throng
