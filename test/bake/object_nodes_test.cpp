// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "baked.h"
#include "patch_nets.h"
#include "throng/bake.h"
#include "throng/path.h"
#include "throng/surface.h"

// Objects on, in, over and under ground of Bezier patches: patches carry every class on the ground,
// level tiles what lies on objects.
namespace throng {
namespace {

constexpr double kSide = 32;  // [m] of the ground, whose height is 0

std::vector<AvatarClass> classes() {
  std::vector<AvatarClass> classes = {
      {.name = "adult"}, {.name = "gecko", .height = 0.5, .radius = 0.15, .step_height = 0.2}};
  classes[1].climb_slope = 180;
  return classes;
}

Scene flat_ground() {
  PatchSet net = test::make_net({.side = 2, .cell = kSide / 2, .sideways = 0, .split_some = false});
  for (BezierPatch& patch : net.patches) {
    for (Vec3d& point : patch.points) point.y = 0;
  }
  return test::patch_scene(net);
}

void add_object(Scene& scene, Vec3d low, Vec3d high) {
  scene.add_box(low, high);
  scene.patch_of_triangle.resize(scene.triangles.size(), kNoPatch);
  if (!scene.patch_part.empty()) scene.patch_part.resize(scene.triangles.size());
}

struct Made {
  World world;
  Nodes nodes;
  std::vector<uint32_t> component;  // of adults, by node

  // Area of a class on level tiles, or on patches. [m^2]
  [[nodiscard]] double area(PatchKind kind) const {
    double area = 0;
    for (uint32_t n = 0; n < nodes.node_count(); ++n) {
      const NodeInfo info = nodes.node(n);
      const bool has_parent = info.parent1 != 0 && (nodes.node(info.parent1 - 1).classes & 1) != 0;
      if (info.kind == kind && (info.classes & 1) != 0 && !has_parent) area += info.area;
    }
    return area;
  }
  // Of the node of adults that is nearest in height to a point, among those around it.
  [[nodiscard]] uint32_t component_at(Vec3d at) const {
    double nearest = 1e9;
    uint32_t best = UINT32_MAX;
    for (uint32_t n = 0; n < nodes.node_count(); ++n) {
      if ((nodes.node(n).classes & 1) == 0) continue;
      const Vec3d d = nodes.middle(n) - at;
      const double far = d.x * d.x + d.y * d.y * 100 + d.z * d.z;
      if (far >= nearest) continue;
      nearest = far;
      best = n;
    }
    return best == UINT32_MAX ? best : component[best];
  }
};

Made make(const Scene& scene) {
  Context context;
  Made made{test::bake(scene, 0.1, classes()), {}, {}};
  const auto nodes = Nodes::create(made.world, scene, {.size = 0.5}, context);
  EXPECT_TRUE(nodes) << nodes.error().message;
  if (!nodes) return made;
  made.nodes = *nodes;
  EXPECT_FALSE(made.nodes.components(0, &made.component).empty());
  return made;
}

TEST(ObjectNodes, LevelTilesCarryWhatLiesOnObjectsAlone) {
  Scene scene = flat_ground();
  const Made bare = make(scene);
  EXPECT_EQ(bare.area(PatchKind::kLevelTile), 0);
  EXPECT_GT(bare.area(PatchKind::kBezier), 0.8 * kSide * kSide);
  add_object(scene, {6, -1, 6}, {10, 0.3, 10});    // a slab, a step high
  add_object(scene, {20, -1, 20}, {22, 5, 22});    // a tower
  add_object(scene, {20, 2.5, 6}, {26, 2.8, 12});  // a roof without posts
  const Made made = make(scene);
  // The slab, the tower's top and the roof, less a body's radius at their edges.
  EXPECT_GT(made.area(PatchKind::kLevelTile), 3.4 * 3.4 + 1.4 * 1.4 + 5.4 * 5.4);
  EXPECT_LT(made.area(PatchKind::kLevelTile), 16 + 4 + 36 + 1);
  // All of the ground but the tower, the slab, and what is near them.
  EXPECT_GT(made.area(PatchKind::kBezier), bare.area(PatchKind::kBezier) - 16 - 4 - 40);
  const uint32_t ground = made.component_at({16, 0, 16});
  ASSERT_NE(ground, UINT32_MAX);
  EXPECT_EQ(made.component_at({8, 0.3, 8}), ground);   // up the slab and down again
  EXPECT_EQ(made.component_at({23, 0, 9}), ground);    // under the roof
  EXPECT_NE(made.component_at({23, 2.8, 9}), ground);  // not onto it
  EXPECT_NE(made.component_at({21, 5, 21}), ground);
}

TEST(ObjectNodes, PathsLeadOverObjectsThatBridgeAGap) {
  // Two grounds of patches, a metre apart, and a plank between them.
  Scene scene = flat_ground();
  PatchSet both = scene.patches;
  for (size_t p = 0; p < scene.patches.size(); ++p) {
    BezierPatch moved = scene.patches.patches[p];
    for (Vec3d& point : moved.points) point.x += kSide + 1;
    both.add(moved);
  }
  scene = test::patch_scene(both);
  const Made cut = make(scene);
  EXPECT_NE(cut.component_at({16, 0, 16}), cut.component_at({kSide + 17, 0, 16}));
  add_object(scene, {kSide - 2, -0.1, 14}, {kSide + 3, 0.1, 18});
  const Made made = make(scene);
  EXPECT_EQ(made.component_at({16, 0, 16}), made.component_at({kSide + 17, 0, 16}));
}

// Where polygons make up most of the ground, walkers stay on level tiles.
TEST(ObjectNodes, CurvedPartsOfALevelOfPolygonsCarryNoWalkers) {
  Scene scene = flat_ground();
  add_object(scene, {-200, -2, -200}, {200, -1, 200});
  const Made made = make(scene);
  EXPECT_EQ(made.area(PatchKind::kBezier), 0);
  EXPECT_GT(made.area(PatchKind::kLevelTile), 0.9 * 400 * 400);
}

}  // namespace
}  // namespace throng
