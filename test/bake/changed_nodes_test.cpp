// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>

#include "baked.h"
#include "core/random.h"
#include "folder_bytes.h"
#include "node_scenes.h"
#include "patch_nets.h"
#include "scratch_folder.h"
#include "throng/bake.h"
#include "throng/surface.h"

// Nodes of a world that changes: zones that no change affects are reused, and the bytes are those
// of a new bake.
namespace throng {
namespace {

namespace fs = std::filesystem;
using Folder = test::FolderBytes;
using test::climbers;
using test::folder_bytes;
using test::walkers;

// Numbers drawn from a seed.
class Draw {
 public:
  explicit Draw(uint64_t seed) : seed_(seed) {}
  double operator()(double low, double high) {
    return low + (high - low) * random_unit(seed_, 0, count_++);
  }

 private:
  uint64_t seed_, count_ = 0;
};

class ChangedNodes : public testing::Test {
 protected:
  // Bakes into a world that is there or not.
  NodeSummary bake(const std::string& name, const Scene& scene, BakeConfig bake_config,
                   NodeConfig config, bool fresh) {
    Context context;
    bake_config.old_zones = fresh ? OldZones::kBakeAgain : OldZones::kKeep;
    bake_config.carry_nodes = !fresh;
    config.rebuild = fresh;
    const auto report = bake_world_to(at(name), scene, bake_config, context);
    EXPECT_TRUE(report) << report.error().message;
    const auto world = World::open(at(name));
    // All at once, and then written; or so many at a time as fit into little memory.
    config.working_bytes = fresh ? UINT64_MAX : uint64_t{1} << (10 + 2 * (bakes_++ % 6));
    const auto nodes = fresh ? Nodes::create(*world, scene, config, context)
                             : Nodes::create_in_folder(*world, scene, config, context);
    EXPECT_TRUE(nodes) << nodes.error().message;
    if (!nodes) return {};
    EXPECT_TRUE(!fresh || nodes->write(at(name)));
    EXPECT_FALSE(fs::exists(at(name) + "/nodes.old"));
    EXPECT_FALSE(fs::exists(at(name) + "/nodes.part"));
    const auto opened = Nodes::open(at(name));
    EXPECT_TRUE(opened && opened->check_all());
    return nodes->summary();
  }
  // Bakes a scene into the world that is there and into a fresh one: the same bytes?
  NodeSummary compare(const Scene& scene, const BakeConfig& bake_config, const NodeConfig& config,
                      const std::string& what) {
    const NodeSummary reused = bake("w", scene, bake_config, config, false);
    const NodeSummary fresh = bake("fresh", scene, bake_config, config, true);
    EXPECT_EQ(fresh.zones_reused, 0u);
    EXPECT_EQ(reused.zones_made + reused.zones_reused, fresh.zones_made);
    EXPECT_EQ(reused.nodes, fresh.nodes);
    EXPECT_EQ(reused.arcs, fresh.arcs);
    EXPECT_EQ(reused.bytes, fresh.bytes);
    EXPECT_TRUE(folder_bytes(at("w") + "/nodes") == folder_bytes(at("fresh") + "/nodes")) << what;
    return reused;
  }
  [[nodiscard]] std::string at(const std::string& name) const {
    return folder_.path() + "/" + name;
  }

  test::ScratchFolder folder_;
  uint32_t bakes_ = 0;
};

TEST_F(ChangedNodes, ALandscapeThatIsBuiltOnKeepsWhatIsFarAway) {
  const BakeConfig config{.cell = 0.5, .zone = 32, .classes = climbers()};
  Scene bare = test::builtin({.name = "landscape", .size = 192});
  const Vec3d corner = bare.patches.patches[0].bounds().min;
  test::add_solid(bare, corner + Vec3d{40, 10, 40},
                  {2, 2, 2});  // There are level tiles, from now on.
  Draw draw(1);
  uint64_t reused = 0, made = 0;
  compare(bare, config, {.size = 2}, "bare");
  Scene scene = bare;
  for (int i = 0; i < 6; ++i) {
    if (i % 4 == 3) scene = bare;  // All that was built goes again.
    test::add_solid(scene, {corner.x + draw(5, 180), draw(-5, 12), corner.z + draw(5, 180)},
                    {draw(0.3, 6), draw(0.3, 6), draw(0.3, 6)});
    const NodeSummary summary = compare(scene, config, {.size = 2}, std::to_string(i));
    reused += summary.zones_reused;
    made += summary.zones_made;
  }
  EXPECT_GT(reused, made / 4);
  EXPECT_GT(made, 10u);
}

// A landscape that has had no object, then one: a pole of twelve triangles.
TEST_F(ChangedNodes, APoleChangesOnlyTheNodesAroundIt) {
  const BakeConfig config{.cell = 0.5, .zone = 32, .classes = climbers()};
  const Scene bare = test::builtin({.name = "landscape", .size = 192});
  const Vec3d corner = bare.patches.patches[0].bounds().min;
  Scene scene = bare;
  test::add_solid(scene, corner + Vec3d{112, -20, 112}, {0.3, 40, 0.3});
  const NodeSummary without = bake("w", bare, config, {.size = 2}, true);
  const Folder before = folder_bytes(at("w") + "/nodes");
  const NodeSummary with = compare(scene, config, {.size = 2}, "pole");
  // Of 36 zones. Those around the pole's name its nodes by other numbers.
  EXPECT_GE(with.zones_reused, 11u);
  EXPECT_GT(with.nodes, without.nodes * 95 / 100);
  uint64_t same = 0, others = 0;
  for (const auto& [name, bytes] : folder_bytes(at("w") + "/nodes")) {
    const auto old = before.find(name);
    (old != before.end() && old->second == bytes ? same : others) += 1;
  }
  EXPECT_GE(same, 27u);
  EXPECT_LE(others, 10u);  // and the index
}

// In zones that are smaller than how far things bear on each other.
TEST_F(ChangedNodes, PatchesThatMoveAreSeenByThoseAroundThem) {
  const BakeConfig config{
      .cell = 0.1, .zone = 6.4, .classes = {climbers()[0], climbers()[2], climbers()[3]}};
  PatchSet net =
      test::make_net({.side = 20, .cell = 3, .relief = 0.3, .sideways = 0.2, .split_some = false});
  Draw draw(2);
  uint64_t reused = 0, made = 0;
  compare(test::patch_scene(net), config, {.size = 0.5}, "as it was");
  for (int i = 0; i < 4; ++i) {
    // An inner control point: no border moves with it.
    BezierPatch& patch = net.patches[static_cast<size_t>(draw(0, static_cast<double>(net.size())))];
    patch.points[5 + static_cast<size_t>(draw(0, 2)) + 4 * static_cast<size_t>(draw(0, 2))].y +=
        draw(-0.4, 0.4);
    const NodeSummary summary =
        compare(test::patch_scene(net), config, {.size = 0.5}, std::to_string(i));
    reused += summary.zones_reused;
    made += summary.zones_made;
  }
  EXPECT_GT(reused, made / 4);
  EXPECT_GT(made, 10u);
}

// Ground in pieces, walls, and platforms to drop from.
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

TEST_F(ChangedNodes, LevelTilesAndLinksAreMadeWhereAChangeAffectsThem) {
  const BakeConfig config{.cell = 0.2, .zone = 12.8, .classes = walkers()};
  const Scene bare = field();
  Draw draw(3);
  NodeConfig nodes;
  uint64_t reused = 0, made = 0;
  compare(bare, config, nodes, "bare");
  Scene scene = bare;
  for (int i = 0; i < 16; ++i) {
    if (i % 5 == 4) scene = bare;
    if (i % 3 == 2) {
      // Between places of the ground that no crate covers, at the rims of far zones.
      nodes.off_mesh_links.push_back({.from = {3.2 * 4 + 1.6, 0.5, 3.2 * 2 + 1.6},
                                      .to = {3.2 * (6 + i % 5) + 2, 0.8, 3.2 * 10 + 1.6},
                                      .avatar_class = i % 2,
                                      .two_way = i % 4 == 0});
    } else {
      test::add_solid(scene, {draw(16, 60), draw(0, 2.5), draw(10, 28)},
                      {draw(0.2, 3), draw(0.2, 2), draw(0.2, 3)});
    }
    const NodeSummary summary = compare(scene, config, nodes, std::to_string(i));
    reused += summary.zones_reused;
    made += summary.zones_made;
    if (i % 7 == 6) nodes.off_mesh_links.erase(nodes.off_mesh_links.begin());
  }
  EXPECT_GT(reused, made / 4);
  EXPECT_GT(made, 20u);
}

TEST_F(ChangedNodes, WhatHasNotChangedIsReusedAndWhatIsDamagedIsMadeAgain) {
  const BakeConfig config{.cell = 0.2, .zone = 12.8, .classes = walkers()};
  const Scene scene = field();
  const NodeSummary first = compare(scene, config, {}, "first");
  EXPECT_EQ(first.zones_reused, 0u);
  EXPECT_EQ(first.zones_made, 20u);
  const Folder before = folder_bytes(at("w") + "/nodes");
  // The same world: its nodes are there at once.
  Context context;
  BakeConfig carry = config;
  carry.carry_nodes = true;
  ASSERT_TRUE(bake_world_to(at("w"), scene, carry, context));
  ASSERT_TRUE(Nodes::open(at("w")));
  const NodeSummary second = bake("w", scene, config, {}, false);
  EXPECT_EQ(second.zones_reused, 20u);
  EXPECT_EQ(second.zones_made, 0u);
  EXPECT_TRUE(folder_bytes(at("w") + "/nodes") == before);
  // Other classes, sizes of cells, sizes of nodes: nothing can be reused.
  EXPECT_EQ(bake("w", scene, config, {.classes = 1}, false).zones_reused, 0u);
  EXPECT_EQ(bake("w", scene, config, {}, false).zones_reused, 0u);
  // Damaged files are no loss but of time.
  const std::string damaged = at("w") + "/nodes/zone_1_1.thn";
  fs::remove(damaged);
  std::ofstream(damaged, std::ios::binary) << "nothing";
  EXPECT_EQ(bake("w", scene, config, {}, false).zones_made, 1u);
  EXPECT_TRUE(folder_bytes(at("w") + "/nodes") == before);
  std::ofstream(at("w") + "/nodes/index.thn", std::ios::binary) << "nothing";
  EXPECT_EQ(bake("w", scene, config, {}, false).zones_made, 20u);
  EXPECT_TRUE(folder_bytes(at("w") + "/nodes") == before);
  // Without nodes in the config the world has none.
  ASSERT_TRUE(bake_world_to(at("w"), scene, config, context));
  EXPECT_FALSE(Nodes::open(at("w")));
  EXPECT_FALSE(fs::exists(at("w") + "/nodes.old"));
}

TEST_F(ChangedNodes, WhatIsMadeBeforeABakeStopsIsNotMadeAgain) {
  const BakeConfig config{.cell = 0.2, .zone = 12.8, .classes = walkers()};
  const Scene scene = field();
  Context silent;
  bake("fresh", scene, config, {}, true);
  const Folder reference = folder_bytes(at("fresh") + "/nodes");
  ASSERT_TRUE(bake_world_to(at("w"), scene, config, silent));
  for (uint64_t stop_at = 1; stop_at < 20; stop_at += 6) {
    const auto world = World::open(at("w"));
    Context context;
    context.on_progress = [&](const Progress& progress) {
      EXPECT_EQ(progress.stage, "nodes");
      EXPECT_EQ(progress.total, 20u);
      context.cancel = progress.done >= stop_at;
    };
    const auto nodes = Nodes::create_in_folder(*world, scene, {.working_bytes = 1}, context);
    ASSERT_FALSE(nodes);
    EXPECT_EQ(nodes.error().code, Errc::kCancelled);
    EXPECT_FALSE(Nodes::open(at("w")));
    // The world is baked again in between: what was made is reused for it.
    BakeConfig carry = config;
    carry.carry_nodes = true;
    ASSERT_TRUE(bake_world_to(at("w"), scene, carry, silent));
    EXPECT_TRUE(fs::exists(at("w") + "/nodes.part/index.thn"));
  }
  // Half a file, and one that belongs to none.
  std::ofstream(at("w") + "/nodes.part/zone_0_0.thn.part", std::ios::binary) << "half";
  std::ofstream(at("w") + "/nodes.part/zone_77_0.thn", std::ios::binary) << "whose?";
  const auto world = World::open(at("w"));
  const auto nodes = Nodes::create_in_folder(*world, scene, {}, silent);
  ASSERT_TRUE(nodes);
  EXPECT_EQ(nodes->summary().zones_reused, 19u);
  EXPECT_EQ(nodes->summary().zones_made, 1u);
  EXPECT_TRUE(folder_bytes(at("w") + "/nodes") == reference);
  EXPECT_FALSE(fs::exists(at("w") + "/nodes.part"));
}

TEST_F(ChangedNodes, WhatCannotBeMadeLeavesNothingBehind) {
  const BakeConfig config{.cell = 0.2, .zone = 12.8, .classes = walkers()};
  const Scene scene = field();
  Context context;
  NodeConfig nodes{.working_bytes = 1};
  nodes.off_mesh_links.push_back({.from = {8, 0.5, 8}, .to = {500, 0, 500}});
  ASSERT_TRUE(bake_world_to(at("w"), scene, config, context));
  const Folder before = folder_bytes(at("w"));
  const auto world = World::open(at("w"));
  const auto refused = Nodes::create_in_folder(*world, scene, nodes, context);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Errc::kBadInput);
  EXPECT_TRUE(folder_bytes(at("w")) == before);
  const auto in_memory = bake_world(scene, config, context);
  ASSERT_TRUE(in_memory);
  const auto nowhere = Nodes::create_in_folder(*in_memory, scene, {}, context);
  ASSERT_FALSE(nowhere);
  EXPECT_EQ(nowhere.error().code, Errc::kBadInput);
}

// A bake that is given the config of its nodes reports the same errors of off-mesh links as the
// nodes would, and the world that is there stays whole.
TEST_F(ChangedNodes, AnOffMeshLinkWithoutAPlaceIsFoundWhileTheOldWorldIsThere) {
  Scene hills = test::builtin({.name = "landscape", .size = 64});
  Scene both = hills;
  test::add_solid(both, hills.patches.patches[0].bounds().min + Vec3d{40, 10, 40}, {2, 2, 2});
  for (const Scene& scene : {field(), hills, both}) {
    BakeConfig config{.cell = 0.25, .zone = 16, .classes = climbers()};
    NodeConfig wanted{.size = 2};
    Context context;
    bake("w", scene, config, wanted, true);
    const auto world = World::open(at("w"));
    const auto nodes = Nodes::open(at("w"));
    ASSERT_TRUE(world && nodes);
    const auto content = [&] {
      return std::pair{World::open(at("w"))->summary().hash, folder_bytes(at("w") + "/nodes")};
    };
    const auto before = content();
    config.cell = 0.3;
    config.carry_nodes = true;
    config.nodes = &wanted;
    Draw draw(7);
    uint64_t good = 0, bad = 0;
    for (int i = 0; i < 8; ++i) {
      const int32_t avatar_class = i % 4;
      const auto near = [&](uint64_t n) {
        return nodes->random_place(avatar_class, 3, n).feet + Vec3d{0, draw(-1.2, 1.2), 0};
      };
      wanted.off_mesh_links = {{near(2 * i), near(2 * i + 1), avatar_class, true}};
      const auto report = bake_world_to(at("w"), scene, config, context);
      fs::remove_all(at("other"));
      BakeConfig other = config;
      other.nodes = nullptr;
      ASSERT_TRUE(bake_world_to(at("other"), scene, other, context));
      const auto made = Nodes::create(*World::open(at("other")), scene, wanted, context);
      EXPECT_EQ(static_cast<bool>(report), static_cast<bool>(made)) << i;
      ++(report ? good : bad);
      if (report) {
        fs::remove_all(at("w"));
        BakeConfig first = config;
        first.cell = 0.25;
        first.nodes = nullptr;
        bake("w", scene, first, {.size = 2}, true);
      } else {
        EXPECT_EQ(report.error().message, made.error().message + "; nothing was written");
      }
      EXPECT_TRUE(content() == before) << i;
      EXPECT_FALSE(fs::exists(at("w") + ".part"));
      EXPECT_FALSE(fs::exists(at("w") + "/nodes.old"));
    }
    EXPECT_GT(good, 0u);
    EXPECT_GT(bad, 0u);
  }
}

}  // namespace
}  // namespace throng
