// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>

#include "baked.h"
#include "core/access.h"
#include "core/random.h"
#include "graph/node_data.h"
#include "patch_nets.h"
#include "scratch_folder.h"
#include "throng/bake.h"
#include "throng/surface.h"
#include "throng/verify.h"
#include "throng/world.h"
#include "worlds.h"

namespace throng {
namespace {

using test::bake;
using test::builtin;

Nodes make(const World& world, const Scene& scene, NodeConfig config = {}) {
  Context context;
  const auto nodes = Nodes::create(world, scene, config, context);
  EXPECT_TRUE(nodes) << nodes.error().message;
  return nodes ? *nodes : Nodes{};
}

AvatarClass climber() {
  AvatarClass avatar{.name = "climber"};
  avatar.climb_slope = 180;
  return avatar;
}

// Walkers and climbers of many sizes.
std::vector<AvatarClass> many_classes() {
  std::vector<AvatarClass> classes = default_classes();
  classes.push_back(climber());
  classes.push_back({.name = "gecko", .height = 0.5, .radius = 0.15, .step_height = 0.2});
  classes.back().climb_slope = 95;
  classes.push_back(
      {.name = "ogre", .height = 2.5, .radius = 0.8, .step_height = 0.6, .max_slope = 30});
  return classes;
}

// A landscape of Bezier patches only, all kinds of neighbours among them.
Scene net_scene(double relief) { return test::net_scene({.side = 3, .cell = 8, .relief = relief}); }

TEST(Nodes, OnLevelTilesClassesHaveExactlyTheirLegalCells) {
  for (const char* name : {"garage", "stairs", "bridge", "maze"}) {
    const Scene scene = builtin({.name = name});
    const World world = bake(scene, 0.2);
    const Nodes nodes = make(world, scene);
    uint64_t partial = 0;
    std::vector<std::vector<uint16_t>> covered(world.level_tile_count(),
                                               std::vector<uint16_t>(4096, 0));
    for (uint32_t n = 0; n < nodes.node_count(); ++n) {
      const NodeInfo info = nodes.node(n);
      ASSERT_EQ(info.kind, PatchKind::kLevelTile);
      const int32_t size = 64 >> info.block_level;
      for (int32_t t = info.t * size; t < (info.t + 1) * size; ++t) {
        for (int32_t s = info.s * size; s < (info.s + 1) * size; ++s) {
          if (info.cells != 0) continue;
          covered[info.source][static_cast<size_t>(t * 64 + s)] |= info.classes;
        }
      }
      for (int32_t c = 0; info.cells != 0 && c < 4; ++c) {
        const uint64_t cells = nodes.partial_cells(c, n);
        EXPECT_EQ(cells != 0, (info.classes >> c & 1) != 0);
        EXPECT_EQ(cells & ~info.cells, 0u);
        double area = 0;
        for (uint64_t left = cells; left != 0; left &= left - 1) {
          const int32_t bit = std::countr_zero(left);
          const int32_t s = info.s * 8 + bit % 8, t = info.t * 8 + bit / 8;
          covered[info.source][static_cast<size_t>(t * 64 + s)] |= static_cast<uint16_t>(1u << c);
          EXPECT_TRUE(nodes.place(c, n, (s + 0.5) / 64, (t + 0.5) / 64));
          area += 0.04;
        }
        EXPECT_LE(area, static_cast<double>(info.area) + 1e-3);
        EXPECT_NEAR(std::popcount(info.cells) * 0.04, info.area, 1e-5);
      }
      partial += info.cells != 0 ? 1 : 0;
    }
    EXPECT_GT(partial, 100u);
    EXPECT_EQ(partial, nodes.summary().partial);
    for (uint32_t l = 0; l < world.level_tile_count(); ++l) {
      const LevelTileContent tile = world.level_tile(l);
      for (size_t i = 0; i < 4096; ++i) {
        uint16_t legal = 0;
        for (size_t c = 0; c < tile.clearance.size(); ++c) {
          if (tile.clearance[c][i] > 0) legal |= static_cast<uint16_t>(1u << c);
        }
        ASSERT_EQ(covered[l][i], legal) << name << ", level " << l << ", cell " << i;
      }
    }
  }
}

// The regions of src/graph share no code with nodes but the moves' own rule.
TEST(Nodes, OnLevelTilesPartsAreTheRegionsComponents) {
  for (const char* name : {"garage", "stairs", "bridge", "church", "maze", "powerplant"}) {
    const Scene scene = builtin({.name = name});
    const World world = bake(scene, 0.25);
    const Nodes nodes = make(world, scene);
    Context context;
    const auto graph = Graph::create(world, {}, context);
    ASSERT_TRUE(graph);
    for (int32_t c = 0; c < 4; ++c) {
      std::vector<double> by_nodes, by_regions;
      for (const NodeComponent& part : nodes.components(c)) by_nodes.push_back(part.area);
      for (const Component& part : graph->components(c)) by_regions.push_back(part.area);
      ASSERT_EQ(by_nodes.size(), by_regions.size()) << name << ", class " << c;
      for (size_t i = 0; i < by_nodes.size(); ++i) {
        EXPECT_NEAR(by_nodes[i], by_regions[i], 1e-3) << name << ", class " << c;
      }
    }
  }
}

// Alone: of curved patches, in a world baked for the class alone. Level tiles depend a little on
// which classes they are baked for together, so there the world is shared and the nodes are not.
TEST(Nodes, ManyClassesShareOneGraph) {
  const std::vector<AvatarClass> classes = many_classes();
  const auto test_world = [&](const std::string& name, const Scene& scene, double cell) {
    const World world = bake(scene, cell, classes);
    const Nodes together = make(world, scene, {.size = 1.5});
    uint64_t largest = 0;
    for (size_t c = 0; c < classes.size(); ++c) {
      const auto bit = static_cast<uint16_t>(1u << c);
      const bool curved = !scene.patches.empty();
      const Nodes alone = curved ? make(bake(scene, cell, {classes[c]}), scene, {.size = 1.5})
                                 : make(world, scene, {.classes = bit});
      largest = std::max(largest, alone.summary().bytes);
      const auto one = alone.components(curved ? 0 : static_cast<int32_t>(c));
      const auto shared = together.components(static_cast<int32_t>(c));
      ASSERT_EQ(one.size(), shared.size()) << name << ", " << classes[c].name;
      for (size_t i = 0; i < one.size(); ++i) {
        EXPECT_NEAR(one[i].area, shared[i].area, 1e-6 * (1 + one[i].area))
            << name << ", " << classes[c].name;
      }
    }
    RecordProperty(name, std::to_string(static_cast<double>(together.summary().bytes) /
                                        static_cast<double>(largest)));
  };
  test_world("net", net_scene(5), 0.25);
  for (const char* name : {"cube", "stairs", "garage", "bridge", "church", "powerplant", "maze"}) {
    test_world(name, builtin({.name = name}), 0.25);
  }
  test_world("city", builtin({.name = "city", .size = 100}), 0.25);
  test_world("landscape", builtin({.name = "landscape", .size = 160}), 0.5);
}

TEST(Nodes, AreTheSameForAnyNumberOfThreads) {
  const Scene scene = builtin({.name = "landscape", .size = 160});
  const World world = bake(scene, 0.5, many_classes());
  std::vector<uint64_t> first;
  for (const int32_t workers : {1, 2, 3, 0}) {
    const Nodes nodes = make(world, scene, {.size = 2, .workers = workers});
    std::vector<uint64_t> hashes;
    for (const auto& slot : data_of(nodes)->slots) hashes.push_back(slot->entry.hash());
    EXPECT_GT(hashes.size(), 4u);
    if (first.empty()) first = hashes;
    EXPECT_EQ(hashes, first) << workers << " workers";
  }
}

// The oracle of src/verify, which shares no code with the bake.
TEST(Nodes, NoBodyMeetsATriangleAndNoPromiseIsBroken) {
  Context context;
  const auto check = [&](const char* name, const Scene& scene, double cell, double size) {
    const Nodes nodes = make(bake(scene, cell, many_classes()), scene, {.size = size});
    for (int32_t c = 0; c < 7; ++c) {
      const auto report = verify_nodes(nodes, scene, {.samples = 3000, .avatar_class = c}, context);
      ASSERT_TRUE(report) << report.error().message;
      EXPECT_EQ(
          report->entered + report->unsupported + report->steeper + report->lower + report->one_way,
          0u)
          << name << ", class " << c;
    }
  };
  check("net", net_scene(6), 0.25, 0.7);
  check("landscape", builtin({.name = "landscape", .size = 160, .seed = 3}), 0.5, 1.5);
  check("garage", builtin({.name = "garage"}), 0.25, 1);
}

TEST(Nodes, ClimbersReachWhatWalkersCannot) {
  const Scene scene = net_scene(9);
  const Nodes nodes = make(bake(scene, 0.25, {AvatarClass{}, climber()}), scene, {.size = 0.5});
  const auto walker = nodes.components(0), all = nodes.components(1);
  ASSERT_FALSE(walker.empty());
  ASSERT_FALSE(all.empty());
  EXPECT_GT(all[0].area, walker[0].area * 1.2);
  bool steep = false;
  for (uint64_t n = 0; n < 2000; ++n) {
    const NodePlace place = nodes.random_place(1, 1, n);
    ASSERT_TRUE(place);
    EXPECT_EQ(place.axis, place.normal);
    steep |= place.normal.y < 0.5;
    EXPECT_GT(nodes.random_place(0, 1, n).normal.y, 0.70);  // 45 degrees
  }
  EXPECT_TRUE(steep);
}

TEST(Nodes, OffMeshLinksJoinWhatNothingElseJoins) {
  Scene scene;  // Two islands, two metres apart.
  scene.add_quad({0, 0, 0}, {0, 0, 6}, {6, 0, 6}, {6, 0, 0});
  scene.add_quad({8, 0, 0}, {8, 0, 6}, {14, 0, 6}, {14, 0, 0});
  const World world = bake(scene, 0.2);
  EXPECT_EQ(make(world, scene).components(0).size(), 2u);
  NodeConfig config;
  config.off_mesh_links = {
      {.from = {4, 0, 3}, .to = {10, 0.5, 3}, .avatar_class = 0, .two_way = true}};
  const Nodes joined = make(world, scene, config);
  EXPECT_EQ(joined.components(0).size(), 1u);
  EXPECT_EQ(joined.components(1).size(), 2u);  // For its class only.
  config.off_mesh_links[0].two_way = false;
  const Nodes one_way = make(world, scene, config);
  EXPECT_EQ(one_way.components(0).size(), 2u);  // Over a one-way link no body comes back.
  size_t off_mesh_links = 0, back = 0;
  for (uint32_t n = 0; n < one_way.node_count(); ++n) {
    for (const NodeArc& arc : one_way.arcs(n)) {
      if (arc.kind != LinkKind::kOffMesh) continue;
      const Vec3d from = one_way.point(n, arc.from_s, arc.from_t);
      const Vec3d to = one_way.point(arc.to, arc.to_s, arc.to_t);
      EXPECT_NEAR(from.x, 4, 0.21);
      EXPECT_NEAR(to.x, 10, 0.21);
      ++off_mesh_links;
      back += to.x < from.x ? 1 : 0;
    }
  }
  EXPECT_GT(off_mesh_links, 0u);
  EXPECT_EQ(back, 0u);
  config.off_mesh_links[0].to = {7, 0, 3};
  Context context;
  EXPECT_EQ(Nodes::create(world, scene, config, context).error().message,
            "nodes: off-mesh link 1: adult has no place within a metre of where it ends");
}

TEST(Nodes, AreWrittenAndOpened) {
  const test::ScratchFolder folder;
  const std::string path = folder.path() + "/hills.throng";
  const Scene scene = builtin({.name = "landscape", .size = 160});
  Context context;
  ASSERT_TRUE(
      bake_world_to(path, scene, {.cell = 0.5, .zone = 64, .classes = many_classes()}, context));
  EXPECT_EQ(Nodes::open(path).error().message,
            path + ": this world has no nodes; bake it again with --nodes");
  const Nodes made = make(*World::open(path), scene, {.size = 2});
  EXPECT_EQ(made.write(path, -1).error().message, "nodes: workers must be 0 or more");
  EXPECT_FALSE(Nodes::open(path)) << "nothing was written";
  ASSERT_TRUE(made.write(path));
  ASSERT_TRUE(made.write(path));  // In place of those that are there.
  const auto opened = Nodes::open(path);
  ASSERT_TRUE(opened) << opened.error().message;
  ASSERT_TRUE(opened->check_all());
  EXPECT_EQ(opened->node_count(), made.node_count());
  EXPECT_EQ(opened->summary().arcs, made.summary().arcs);
  for (int32_t c = 0; c < 7; ++c) {
    const auto a = made.components(c), b = opened->components(c);
    ASSERT_EQ(a.size(), b.size());
    for (size_t i = 0; i < a.size(); ++i) EXPECT_EQ(a[i].area, b[i].area);
    EXPECT_EQ(made.random_place(c, 5, 6).feet, opened->random_place(c, 5, 6).feet);
  }
  // Another world in the folder: its nodes went with it; nodes of this one are refused there.
  ASSERT_TRUE(bake_world_to(path, scene, {.cell = 0.5, .zone = 32}, context));
  EXPECT_FALSE(Nodes::open(path));
  EXPECT_EQ(made.write(path).error().message, path + ": holds another world than these nodes' own");
}

TEST(Nodes, ExistOnceTheyAreInTheFolderOfTheirWorld) {
  const test::ScratchFolder folder;
  const std::string path = folder.path() + "/cube.throng";
  const Scene scene = builtin({.name = "cube"});
  Context context;
  const World in_memory = bake(scene, 0.25);
  make(in_memory, scene);
  EXPECT_FALSE(Nodes::exist(in_memory)) << "it was opened from no folder";
  EXPECT_FALSE(Nodes::exist(World()));
  ASSERT_TRUE(bake_world_to(path, scene, {.cell = 0.25}, context));
  const auto world = World::open(path);
  ASSERT_TRUE(world) << world.error().message;
  EXPECT_FALSE(Nodes::exist(*world));
  const Nodes made = make(*world, scene);
  EXPECT_FALSE(Nodes::exist(*world)) << "they are in memory";
  ASSERT_TRUE(made.write(path));
  EXPECT_TRUE(Nodes::exist(*world));
  ASSERT_TRUE(bake_world_to(path, scene, {.cell = 0.5}, context));  // Nodes go with their world.
  EXPECT_FALSE(Nodes::exist(*World::open(path)));
  const auto again = World::open(path);
  ASSERT_TRUE(Nodes::create_in_folder(*again, scene, {}, context));
  EXPECT_TRUE(Nodes::exist(*again));
  std::filesystem::remove_all(path);
  EXPECT_FALSE(Nodes::exist(*again)) << "the folder is gone";
}

TEST(NodeConfig, IsCheckedWhateverTheWorld) {
  const auto checked = [](const NodeConfig& config) {
    const auto ok = check_node_config(config);
    if (!ok) {
      EXPECT_EQ(ok.error().code, Errc::kBadConfig) << ok.error().message;
    }
    return ok ? std::string() : ok.error().message;
  };
  const NodeOffMeshLink link{.from = {1, 2, 3}, .to = {4, 5, 6}};
  EXPECT_EQ(checked({}), "");
  EXPECT_EQ(checked({.size = 0.05, .workers = 64}), "");
  EXPECT_EQ(checked({.size = 100, .classes = 0, .off_mesh_links = {link, link}}), "");
  for (const double size : {0.0, 0.0499, 100.1, -1.0, double{INFINITY}, double{NAN}}) {
    EXPECT_EQ(checked({.size = size}), "nodes: the size must be 0.05 to 100 m") << size;
  }
  EXPECT_EQ(checked({.workers = -1}), "nodes: workers must be 0 or more");
  for (const double bad : {double{NAN}, double{INFINITY}, -double{INFINITY}}) {
    const std::string second = "nodes: off-mesh link 2: its ends must be finite";
    EXPECT_EQ(checked({.off_mesh_links = {link, {.from = {bad, 0, 0}, .to = {}}}}), second);
    EXPECT_EQ(checked({.off_mesh_links = {link, {.from = {}, .to = {0, 0, bad}}}}), second);
    EXPECT_EQ(checked({.off_mesh_links = {link, {.from = {0, bad, 0}, .to = {0, bad, 0}}}}),
              second);
  }
}

TEST(Nodes, OverGroundThatCannotBeReadNoBodyStands) {
  const test::ScratchFolder folder;
  const std::string path = folder.path() + "/garage.throng";
  const Scene scene = builtin({.name = "garage"});
  Context context;
  ASSERT_TRUE(bake_world_to(path, scene, {.cell = 0.2, .zone = 32}, context));
  ASSERT_TRUE(make(*World::open(path), scene).write(path));
  const std::string zone = path + "/zone_0_0.thz";
  {
    std::fstream file(zone, std::ios::in | std::ios::out | std::ios::binary);
    file.seekg(2000);
    const auto byte = static_cast<char>(file.get() ^ 0x10);
    file.seekp(2000);
    file.put(byte);
    ASSERT_TRUE(file);
  }
  const auto nodes = Nodes::open(path);
  ASSERT_TRUE(nodes) << nodes.error().message;
  size_t lost = 0, found = 0;
  for (uint32_t n = 0; n < nodes->node_count(); ++n) {
    const NodeInfo info = nodes->node(n);
    const double side = 1.0 / (1 << info.block_level);
    for (int32_t c = 0; c < 4; ++c) {
      const bool stands =
          static_cast<bool>(nodes->place(c, n, (info.s + 0.5) * side, (info.t + 0.5) * side));
      found += stands ? 1 : 0;
      lost += !stands && info.cells == 0 && (info.classes >> c & 1) != 0 ? 1 : 0;
      EXPECT_TRUE(info.cells == 0 || (nodes->partial_cells(c, n) & ~info.cells) == 0);
    }
    (void)nodes->corners(n);
    (void)nodes->middle(n);
  }
  EXPECT_GT(lost, 100u);
  EXPECT_GT(found, 1000u);
  for (uint64_t n = 0; n < 1000; ++n) (void)nodes->random_place(0, 1, n);
  EXPECT_GT(nodes->components(0).size(), 0u);
  const auto checked = nodes->check_all();
  ASSERT_FALSE(checked);
  EXPECT_NE(checked.error().message.find(zone), std::string::npos) << checked.error().message;
}

TEST(Nodes, BadInputIsRefusedAndNamed) {
  const Scene scene = builtin({.name = "cube"});
  const World world = bake(scene, 0.25);
  Context context;
  const auto message = [&](const Result<Nodes>& nodes) {
    EXPECT_FALSE(nodes);
    return nodes ? std::string() : nodes.error().message;
  };
  EXPECT_EQ(message(Nodes::create(world, scene, {.size = 0}, context)),
            "nodes: the size must be 0.05 to 100 m");
  EXPECT_EQ(message(Nodes::create(world, scene, {.workers = -1}, context)),
            "nodes: workers must be 0 or more");
  EXPECT_EQ(message(Nodes::create({}, scene, {}, context)), "nodes: the world is empty");
  EXPECT_NE(message(Nodes::create(world, builtin({.name = "bridge"}), {}, context))
                .find("not baked from this scene"),
            std::string::npos);
  context.cancel = true;
  EXPECT_EQ(message(Nodes::create(world, scene, {}, context)), "nodes: cancelled");
}

}  // namespace
}  // namespace throng
