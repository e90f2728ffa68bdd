// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "bake/surface/node_bake.h"
#include "bake/surface/node_plan.h"
#include "baked.h"
#include "core/access.h"
#include "folder_bytes.h"
#include "node_scenes.h"
#include "patch_nets.h"
#include "scene_regions.h"
#include "scratch_folder.h"
#include "throng/bake.h"
#include "throng/surface.h"

// Nodes of a scene that is read region by region have the bytes of those of the whole scene.
namespace throng {
namespace {

namespace fs = std::filesystem;
using test::climbers;
using test::folder_bytes;
using test::RegionsOf;
using test::walkers;

Scene landscape(double size) { return test::builtin({.name = "landscape", .size = size}); }

// A landscape with crates, poles through its patches, a roof and a wall across zones.
Scene built_on(double size) {
  Scene scene = landscape(size);
  const Vec3d corner = scene.patches.patches[0].bounds().min;
  for (int i = 0; i < 14; ++i) {
    const double x = corner.x + size * (0.05 + 0.066 * i), z = corner.z + size * (i * 5 % 14) / 14;
    test::add_solid(scene, {x, corner.y - 5, z}, {0.3, 60, 0.3});
    test::add_solid(scene, {x + 4, corner.y + i, z + 3}, {2.5, 1.0 + i % 3, 2.5});
  }
  test::add_solid(scene, corner + Vec3d{size / 3, 0, size / 2}, {size / 3, 30, 0.5});
  test::add_solid(scene, corner + Vec3d{size / 4, 14, size / 4}, {40, 0.3, 25});
  return scene;
}

// Level tiles alone: ground in pieces, walls, and platforms to drop from.
Scene field() {
  Scene scene;
  for (int z = 0; z < 16; ++z) {
    for (int x = 0; x < 20; ++x) {
      const double x0 = 3.2 * x, z0 = 3.2 * z, y = (x * 5 + z * 3) % 7 == 0 ? 1.5 : 0;
      scene.add_quad({x0, y, z0}, {x0, y, z0 + 3.2}, {x0 + 3.2, y, z0 + 3.2}, {x0 + 3.2, y, z0});
      if ((x * 7 + z * 3) % 11 == 0) scene.add_box({x0 + 1, 0, z0 + 1}, {x0 + 1.4, 2, z0 + 2.5});
    }
  }
  return scene;
}

// Patches with one, two and four neighbours.
Scene net() {
  return test::patch_scene(
      test::make_net({.side = 7, .cell = 4, .relief = 0.6, .sideways = 0.4, .split_some = true}));
}

// Curved pieces on more ground of polygons.
Scene curved_pieces() {
  PatchSet set =
      test::make_net({.side = 4, .cell = 4, .relief = 0.6, .sideways = 0.4, .split_some = true});
  for (BezierPatch& patch : set.patches) {
    for (Vec3d& point : patch.points) point = point + Vec3d{14.3, 0.4, 10.1};
  }
  Scene scene = test::patch_scene(set);
  const Scene ground = field();
  for (size_t t = 0; t < ground.triangles.size(); ++t) {
    const auto& [a, b, c] = ground.triangles[t];
    scene.add_triangle(ground.positions[a], ground.positions[b], ground.positions[c]);
  }
  const bool parts = !scene.patch_part.empty();
  scene.patch_of_triangle.resize(scene.triangles.size(), kNoPatch);
  if (parts) scene.patch_part.resize(scene.triangles.size());
  return scene;
}

class NodesByRegion : public testing::Test {
 protected:
  void bake(const Scene& scene, const BakeConfig& config) {
    Context context;
    const auto report = bake_world_to(at("w"), scene, config, context);
    ASSERT_TRUE(report) << report.error().message;
  }

  // The plans, hashes among them, then the folders, for much and little memory.
  void compare(const Scene& scene, const BakeConfig& bake_config, NodeConfig config) {
    bake(scene, bake_config);
    const auto world = World::open(at("w"));
    ASSERT_TRUE(world);
    config.rebuild = true;
    Context context;
    const auto whole = Nodes::create_in_folder(*world, scene, config, context);
    ASSERT_TRUE(whole) << whole.error().message;
    EXPECT_GT(whole->node_count(), 0u);
    const auto reference = folder_bytes(at("w") + "/nodes");
    for (const uint64_t bytes : {uint64_t{1}, uint64_t{8} << 20, UINT64_MAX}) {
      const RegionsOf regions(scene);
      config.working_bytes = bytes;
      config.workers = bytes == 1 || bytes == UINT64_MAX ? 2 : 1;
      compare_plans(*world, scene, regions, config);
      const auto nodes = Nodes::create_in_folder(*world, regions, config, context);
      ASSERT_TRUE(nodes) << nodes.error().message;
      EXPECT_TRUE(folder_bytes(at("w") + "/nodes") == reference) << bytes;
      EXPECT_EQ(nodes->summary().bezier_patches, whole->summary().bezier_patches);
      EXPECT_EQ(nodes->summary().arcs, whole->summary().arcs);
      if (bytes == 1) largest_ = regions.largest();
    }
  }

  static void compare_plans(const World& world, const Scene& scene, const RegionsOf& regions,
                            const NodeConfig& config) {
    const world::WorldData& data = *data_of(world);
    Context context;
    std::vector<bake::NodePlan> plans;
    for (const bake::NodeScene& from : {bake::NodeScene(scene), bake::NodeScene(regions)}) {
      auto plan = bake::plan_nodes(data, from, config, context);
      ASSERT_TRUE(plan);
      ASSERT_TRUE(bake::find_node_inputs(data, from, config, context, *plan));
      plans.push_back(*std::move(plan));
    }
    const auto& [a, b] = std::tie(plans[0], plans[1]);
    EXPECT_EQ(a.has_patches, b.has_patches);
    EXPECT_EQ(a.has_tiles, b.has_tiles);
    EXPECT_EQ(a.has_objects, b.has_objects);
    EXPECT_EQ(a.knows_parts, b.knows_parts);
    EXPECT_EQ(a.on_patches, b.on_patches);
    EXPECT_TRUE(a.object_tiles == b.object_tiles);
    EXPECT_TRUE(a.sources == b.sources);
    ASSERT_EQ(a.zones.size(), b.zones.size());
    for (size_t z = 0; z < a.zones.size(); ++z) {
      EXPECT_EQ(a.zones[z].first, b.zones[z].first);
      EXPECT_TRUE(a.zones[z].near == b.zones[z].near);
      EXPECT_EQ(a.zones[z].reach, b.zones[z].reach);
      EXPECT_EQ(a.zones[z].bytes, b.zones[z].bytes);
      EXPECT_EQ(a.zones[z].own, b.zones[z].own) << z;
      EXPECT_EQ(a.zones[z].input, b.zones[z].input) << z;
    }
  }

  [[nodiscard]] std::string at(const std::string& name) const {
    return folder_.path() + "/" + name;
  }

  test::ScratchFolder folder_;
  uint64_t largest_ = 0;  // triangles of a region, with the least memory
};

TEST_F(NodesByRegion, OfALandscape) {
  const Scene scene = landscape(224);
  compare(scene, {.cell = 0.5, .zone = 32, .classes = climbers()}, {.size = 2});
  EXPECT_GT(largest_, 0u);
  EXPECT_LT(largest_, scene.triangles.size() * 2 / 3);
}

TEST_F(NodesByRegion, OfALandscapeThatWalkersCross) {
  compare(landscape(160), {.cell = 0.5, .zone = 64, .classes = walkers()}, {.size = 1});
}

TEST_F(NodesByRegion, OfALandscapeWithObjectsAndAir) {
  const BakeConfig config{.cell = 0.5, .air = 1, .zone = 48, .classes = climbers()};
  compare(built_on(160), config, {.size = 2});
  EXPECT_TRUE(AirLinks::exist(*World::open(at("w"))));
}

// So large that regions cut edges with several neighbours.
TEST_F(NodesByRegion, HashAllNeighboursOfAPatch) {
  const Scene scene = test::patch_scene(
      test::make_net({.side = 20, .cell = 8, .relief = 1, .sideways = 1, .split_some = true}));
  bake(scene, {.cell = 0.5, .zone = 32, .classes = {climbers()[0], climbers()[2]}});
  const RegionsOf regions(scene);
  compare_plans(*World::open(at("w")), scene, regions, {.size = 1, .working_bytes = 1});
  EXPECT_GT(regions.count(), 45u);
  EXPECT_LT(regions.largest(), scene.triangles.size() / 2);
}

TEST_F(NodesByRegion, OfPatchesWithSeveralNeighboursOnAnEdge) {
  compare(net(), {.cell = 0.1, .zone = 6.4, .classes = {climbers()[0], climbers()[2]}},
          {.size = 1});
}

TEST_F(NodesByRegion, OfSomePatchesOnGroundOfPolygons) {
  compare(curved_pieces(), {.cell = 0.2, .zone = 12.8, .classes = climbers()}, {.size = 1});
}

TEST_F(NodesByRegion, OfLevelTiles) {
  NodeConfig config;
  config.off_mesh_links.push_back(
      {.from = {14.4, 0.5, 8}, .to = {21.2, 0.8, 33.6}, .avatar_class = 0, .two_way = true});
  compare(field(), {.cell = 0.2, .zone = 12.8, .classes = walkers()}, config);
  // Walkers that drop nowhere need no triangles.
  compare(field(), {.cell = 0.2, .zone = 12.8, .classes = {walkers()[0]}}, config);
}

TEST_F(NodesByRegion, OffMeshLinksAreCheckedAsInTheWholeScene) {
  const Scene scene = landscape(160);
  const RegionsOf regions(scene);
  bake(scene, {.cell = 0.5, .zone = 32, .classes = climbers()});
  const auto world = World::open(at("w"));
  Context context;
  NodeConfig config{.size = 2, .rebuild = true, .working_bytes = 4 << 20};
  const auto plain = Nodes::create_in_folder(*world, scene, config, context);
  ASSERT_TRUE(plain);
  uint64_t good = 0, bad = 0;
  for (uint64_t i = 0; i < 4; ++i) {
    const auto place = [&](uint64_t n) {
      return plain->random_place(static_cast<int32_t>(i), 7, n).feet;
    };
    // Every other link begins in the air.
    config.off_mesh_links = {{place(2 * i), place(2 * i + 1), static_cast<int32_t>(i), true}};
    if (i % 2 == 1) config.off_mesh_links[0].from.y += 50;
    const auto whole = bake::NodeBaker::check_off_mesh_links(*world, scene, config, context);
    const auto parts = bake::NodeBaker::check_off_mesh_links(*world, regions, config, context);
    ASSERT_EQ(static_cast<bool>(whole), static_cast<bool>(parts)) << i;
    ++(whole ? good : bad);
    if (!whole) {
      EXPECT_EQ(whole.error().message, parts.error().message);
      continue;
    }
    ASSERT_TRUE(Nodes::create_in_folder(*world, scene, config, context));
    const auto reference = folder_bytes(at("w") + "/nodes");
    ASSERT_TRUE(Nodes::create_in_folder(*world, regions, config, context));
    EXPECT_TRUE(folder_bytes(at("w") + "/nodes") == reference) << i;
  }
  EXPECT_GT(good, 0u);
  EXPECT_GT(bad, 0u);
}

TEST_F(NodesByRegion, ReuseWhatIsThereWhetherItWasMadeByRegionsOrNot) {
  const BakeConfig config{.cell = 0.5, .zone = 32, .classes = climbers(), .carry_nodes = true};
  Scene scene = built_on(192);
  bake(scene, config);
  Context context;
  const NodeConfig nodes{.size = 2, .working_bytes = 1};
  ASSERT_TRUE(Nodes::create_in_folder(*World::open(at("w")), scene, nodes, context));
  const Vec3d corner = scene.patches.patches[0].bounds().min;
  for (int i = 0; i < 2; ++i) {
    test::add_solid(scene, corner + Vec3d{30 + 110.0 * i, 3, 40}, {2, 9, 2});
    bake(scene, config);
    const auto world = World::open(at("w"));
    const auto made = Nodes::create_in_folder(*world, RegionsOf(scene), nodes, context);
    ASSERT_TRUE(made);
    EXPECT_GT(made->summary().zones_reused, 8u);
    EXPECT_GT(made->summary().zones_made, 1u);
    const auto bytes = folder_bytes(at("w") + "/nodes");
    // Nothing is left to be made.
    for (const bool by_region : {false, true}) {
      const auto again = by_region
                             ? Nodes::create_in_folder(*world, RegionsOf(scene), nodes, context)
                             : Nodes::create_in_folder(*world, scene, nodes, context);
      ASSERT_TRUE(again);
      EXPECT_EQ(again->summary().zones_made, 0u);
      EXPECT_TRUE(folder_bytes(at("w") + "/nodes") == bytes);
    }
    const NodeConfig all{.size = 2, .rebuild = true};
    ASSERT_TRUE(Nodes::create_in_folder(*world, scene, all, context));
    EXPECT_TRUE(folder_bytes(at("w") + "/nodes") == bytes);
  }
}

TEST_F(NodesByRegion, WhatIsMadeBeforeABakeStopsIsNotMadeAgain) {
  const BakeConfig config{.cell = 0.5, .zone = 32, .classes = climbers()};
  const Scene scene = landscape(160);
  const RegionsOf regions(scene);
  bake(scene, config);
  const auto world = World::open(at("w"));
  Context silent;
  NodeConfig nodes{.size = 2, .working_bytes = 1};
  ASSERT_TRUE(Nodes::create_in_folder(*world, scene, nodes, silent));
  const auto reference = folder_bytes(at("w") + "/nodes");
  fs::remove_all(at("w") + "/nodes");
  for (const uint64_t stop_at : {6, 15}) {
    Context context;
    context.on_progress = [&](const Progress& progress) {
      context.cancel = progress.done >= stop_at;
    };
    const auto stopped = Nodes::create_in_folder(*world, regions, nodes, context);
    ASSERT_FALSE(stopped);
    EXPECT_EQ(stopped.error().code, Errc::kCancelled);
    EXPECT_TRUE(fs::exists(at("w") + "/nodes.part/index.thn"));
  }
  const auto made = Nodes::create_in_folder(*world, regions, nodes, silent);
  ASSERT_TRUE(made);
  EXPECT_EQ(made->summary().zones_reused, 15u);
  EXPECT_TRUE(folder_bytes(at("w") + "/nodes") == reference);
}

// A scene of which one region cannot be read, or lacks a patch.
class Broken : public RegionsOf {
 public:
  Broken(const Scene& scene, uint64_t good, bool fails)
      : RegionsOf(scene), good_(good), fails_(fails) {}
  [[nodiscard]] Result<SceneRegion> region(const Box3d& box, Context& context) const override {
    auto region = RegionsOf::region(box, context);
    if (count() <= good_) return region;
    if (fails_) return Error{Errc::kIo, "regions.part: cannot be read"};
    for (uint32_t& number : region->patch_number) number += 1000000;
    return region;
  }

 private:
  uint64_t good_;
  bool fails_;
};

TEST_F(NodesByRegion, AFailureLeavesTheOldNodes) {
  const BakeConfig config{.cell = 0.5, .zone = 32, .classes = climbers()};
  const Scene scene = landscape(160);
  bake(scene, config);
  const auto world = World::open(at("w"));
  Context context;
  NodeConfig nodes{.size = 2, .rebuild = true, .working_bytes = 1};
  ASSERT_TRUE(Nodes::create_in_folder(*world, scene, nodes, context));
  const auto before = folder_bytes(at("w") + "/nodes");
  for (const bool fails : {true, false}) {
    // While it is surveyed, hashed, and made.
    for (const uint64_t good : {10, 40, 60}) {
      const auto made = Nodes::create_in_folder(*world, Broken(scene, good, fails), nodes, context);
      ASSERT_FALSE(made) << good;
      EXPECT_EQ(made.error().code, fails ? Errc::kIo : Errc::kBadInput);
      EXPECT_TRUE(folder_bytes(at("w") + "/nodes") == before);
      EXPECT_FALSE(fs::exists(at("w") + "/nodes.part"));
    }
  }
  Scene other = scene;
  test::add_solid(other, {0, 0, 0}, {1, 1, 1});
  EXPECT_EQ(Nodes::create_in_folder(*world, RegionsOf(other), nodes, context).error().code,
            Errc::kBadInput);
}

TEST_F(NodesByRegion, LinksOfAWorldInMemoryDoNotDependOnTheBatches) {
  const Scene scene = field();
  Context context;
  const auto world = bake_world(scene, {.cell = 0.2, .zone = 12.8, .classes = walkers()}, context);
  ASSERT_TRUE(world);
  const auto at_once = Nodes::create(*world, scene, {}, context);
  const auto one_by_one = Nodes::create(*world, scene, {.working_bytes = 1}, context);
  ASSERT_TRUE(at_once && one_by_one);
  EXPECT_EQ(at_once->summary().arcs, one_by_one->summary().arcs);
  EXPECT_EQ(at_once->summary().bytes, one_by_one->summary().bytes);
}

}  // namespace
}  // namespace throng
