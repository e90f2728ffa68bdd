// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "bake/surface/node_drops.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "baked.h"
#include "core/access.h"
#include "core/random.h"
#include "graph/node_data.h"
#include "patch_nets.h"
#include "path/overlay/node_finder.h"
#include "scratch_folder.h"
#include "throng/bake.h"
#include "throng/path.h"
#include "throng/verify.h"
#include "verify/turned_body.h"
#include "world/zone_data.h"

namespace throng {
namespace {

using test::bake;
using test::builtin;

// An adult as ever, one that drops, and a child that drops less far.
std::vector<AvatarClass> divers(double deepest = 3) {
  std::vector<AvatarClass> classes = default_classes();
  classes.resize(1);
  classes.push_back({.name = "diver", .max_drop = deepest});
  classes.push_back(
      {.name = "kid", .height = 1.1, .radius = 0.18, .step_height = 0.3, .max_drop = deepest / 2});
  return classes;
}

// Climbers on curved ground that also drop.
std::vector<AvatarClass> jumpers() {
  std::vector<AvatarClass> classes = divers();
  classes.push_back({.name = "climber", .climb_slope = 100, .max_drop = 4});
  return classes;
}

Scene ground() {
  Scene scene;
  scene.add_quad({0, 0, 0}, {0, 0, 12}, {12, 0, 12}, {12, 0, 0});
  return scene;
}

// A platform of 2 m that no class climbs, with a rail along one side and a ledge along another.
Scene platform() {
  Scene scene = ground();
  scene.add_box({4, 0, 4}, {8, 2, 8});
  scene.add_box({4, 2, 3.9}, {8, 3, 4});      // too high to go over
  scene.add_box({8, 0, 4}, {8.3, 1, 8});      // halfway down, too narrow to stand on
  scene.add_box({2.5, 1.9, 5}, {4, 2, 7});    // a balcony
  scene.add_box({5, 0, 8.45}, {6, 0.5, 12});  // to step down from
  return scene;
}

Scene boxes(uint64_t seed) {
  Scene scene = ground();
  for (uint64_t n = 0; n < 14; ++n) {
    const auto any = [&](uint64_t k, double low, double high) {
      return low + (high - low) * random_unit(seed, n, k);
    };
    const double x = any(0, 0, 10), z = any(1, 0, 10), y = n % 4 == 0 ? any(2, 0.5, 3) : 0;
    scene.add_box({x, y, z}, {x + any(3, 0.2, 3), y + any(4, 0.2, 3), z + any(5, 0.2, 3)});
  }
  return scene;
}

Nodes make(const World& world, const Scene& scene, NodeConfig config = {}) {
  Context context;
  const auto nodes = Nodes::create(world, scene, config, context);
  EXPECT_TRUE(nodes) << nodes.error().message;
  return nodes ? *nodes : Nodes{};
}

// Every cell against every other, by the world's own moves and by bodies every few millimetres of
// the move: it uses nothing of the bake but the world.
std::map<std::pair<bake::DropEnd, bake::DropEnd>, uint16_t> plain_drops(const World& world,
                                                                        const Scene& scene) {
  struct Standing {
    bake::DropEnd end;
    Place place;
  };
  const WorldSummary summary = world.summary();
  const verify::TriangleTree tree(scene, 1);
  std::map<std::pair<bake::DropEnd, bake::DropEnd>, uint16_t> drops;
  for (size_t c = 0; c < summary.classes.size(); ++c) {
    const AvatarClass& avatar = summary.classes[c];
    const auto id = static_cast<int32_t>(c);
    if (avatar.max_drop == 0) continue;
    std::vector<Standing> all;
    for (uint32_t l = 0; l < world.level_tile_count(); ++l) {
      const LevelTileContent tile = world.level_tile(l);
      for (uint32_t i = 0; i < 4096; ++i) {
        if (tile.clearance[c][i] == 0) continue;
        const Vec3d at{summary.origin.x + (tile.tile_x * 64 + i % 64 + 0.5) * summary.cell,
                       tile.floor[i] * 1e-3,
                       summary.origin.z + (tile.tile_z * 64 + i / 64 + 0.5) * summary.cell};
        Place place{at, l + 1};
        place.position.x += 0.5 * summary.cell / 2048;  // Where the moves' middle is.
        place.position.z += 0.5 * summary.cell / 2048;
        all.push_back({{PatchKind::kLevelTile, l, i}, place});
      }
    }
    const auto move = [&](const Place& from, Vec3d to) {
      return world.move(id, from, to.x - from.position.x, to.z - from.position.z);
    };
    const auto goes = [&](const Place& from, Vec3d to, uint32_t level1) {
      const MoveResult there = move(from, to);
      return there.end == MoveEnd::kArrived && there.place.level1 == level1;
    };
    const auto is_edge = [&](const Place& from) {
      for (const auto& [x, z] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}}) {
        const Vec3d to = from.position + Vec3d{x * summary.cell, 0, z * summary.cell};
        const MoveResult there = move(from, to);
        if (there.end != MoveEnd::kArrived) return true;
        if (!goes(there.place, from.position, from.level1)) return true;
      }
      return false;
    };
    const auto is_free = [&](Vec3d from, Vec3d to) {
      const int parts = 1 + static_cast<int>(length(to - from) / 0.004);
      for (int k = 0; k <= parts; ++k) {
        const double f = static_cast<double>(k) / parts;
        if (verify::turned_intruder(tree, avatar, {from * (1 - f) + to * f, {0, 1, 0}})) {
          return false;
        }
      }
      return true;
    };
    const double reach = 2 * avatar.radius + bake::kDropCells * summary.cell;
    for (const Standing& from : all) {
      if (!is_edge(from.place)) continue;
      const Vec3d a = from.place.position;
      std::vector<std::pair<int64_t, const Standing*>> lower;
      for (const Standing& to : all) {
        const Vec3d b = to.place.position;
        const double far2 = (b.x - a.x) * (b.x - a.x) + (b.z - a.z) * (b.z - a.z);
        const double down = a.y - b.y;
        if (far2 <= reach * reach && down > avatar.step_height && down <= avatar.max_drop) {
          lower.push_back({std::llround(far2 * 1e8), &to});
        }
      }
      std::sort(lower.begin(), lower.end(), [](const auto& p, const auto& q) {
        return std::tie(p.first, p.second->end) < std::tie(q.first, q.second->end);
      });
      for (const auto& [far2, to] : lower) {
        const Vec3d b = to->place.position, over{b.x, a.y, b.z};
        if (goes(from.place, b, to->place.level1) || !is_free(a, over) || !is_free(over, b)) {
          continue;
        }
        drops[{from.end, to->end}] |= static_cast<uint16_t>(1u << c);
        break;
      }
    }
  }
  return drops;
}

TEST(NodeDrops, AreThoseOfAPlainSearchOverAllPairs) {
  const auto check = [](const char* name, const Scene& scene, double cell) {
    const World world = bake(scene, cell, divers());
    const bake::TriangleSquares triangles(scene, 1);
    const auto plain = plain_drops(world, scene);
    for (const int32_t workers : {1, 3}) {
      std::map<std::pair<bake::DropEnd, bake::DropEnd>, uint16_t> found;
      std::vector<uint32_t> levels(world.level_tile_count());
      std::iota(levels.begin(), levels.end(), 0u);
      const auto drops = bake::find_drops({.links = {.triangles = &triangles,
                                                     .world = &world,
                                                     .classes = world.summary().classes,
                                                     .cells = {},
                                                     .size = 1},
                                           .edges = {},
                                           .tiles = true,
                                           .levels = levels},
                                          workers);
      for (const bake::NodeDrop& drop : drops) found[{drop.from, drop.to}] |= drop.classes;
      EXPECT_EQ(found.size(), drops.size()) << name;
      EXPECT_GT(found.size(), 20u) << name;
      EXPECT_TRUE(found == plain) << name << ": " << found.size() << " and " << plain.size();
    }
  };
  check("platform", platform(), 0.2);
  check("platform", platform(), 0.15);
  for (uint64_t seed = 1; seed <= 2; ++seed) check("boxes", boxes(seed), 0.2);
}

TEST(NodeDrops, LeadDownOnlyForClassesThatDrop) {
  const Scene scene = platform();
  const Nodes nodes = make(bake(scene, 0.1, divers()), scene);
  Context context;
  std::array<size_t, 3> drops{};
  for (uint32_t n = 0; n < nodes.node_count(); ++n) {
    for (const NodeArc& arc : nodes.arcs(n)) {
      if (arc.kind != LinkKind::kDrop) continue;
      ASSERT_TRUE(arc.over_hole);
      const Vec3d from = nodes.point(n, arc.from_s, arc.from_t);
      const Vec3d to = nodes.point(arc.to, arc.to_s, arc.to_t);
      for (size_t c = 0; c < 3; ++c) {
        if ((arc.classes >> c & 1) == 0) continue;
        ++drops[c];
        EXPECT_GT(from.y - to.y, nodes.summary().classes[c].step_height);
        EXPECT_LE(from.y - to.y, nodes.summary().classes[c].max_drop);
      }
    }
  }
  EXPECT_EQ(drops[0], 0u);
  EXPECT_GT(drops[1], 10u);
  EXPECT_GT(drops[2], 0u);  // The kid: from what is 1.5 m high.
  for (int32_t c = 0; c < 3; ++c) {
    auto finder = path::NodeFinder::create(nodes, {.avatar_class = c}, context);
    ASSERT_TRUE(finder);
    const NodePlace top = finder->find_place({6, 2, 6}, 0.2);
    const NodePlace below = finder->find_place({1, 0, 1}, 0.2);
    ASSERT_TRUE(top);
    ASSERT_TRUE(below);
    Path path;
    finder->find(top, below, path);
    EXPECT_EQ(path.end, c == 1 ? PathEnd::kReached : PathEnd::kUnreachable) << c;
    if (c == 1) {
      ASSERT_EQ(std::count_if(path.links.begin(), path.links.end(),
                              [](const PathLink& l) { return l.kind == LinkKind::kDrop; }),
                1);
      const auto drop = std::find_if(path.links.begin(), path.links.end(),
                                     [](const auto& l) { return l.kind == LinkKind::kDrop; });
      const NodePlace& over = path.node_places[drop->point - 1];
      const NodePlace& down = path.node_places[drop->point];
      EXPECT_FALSE(over);
      EXPECT_EQ(over.feet, (Vec3d{down.feet.x, 2, down.feet.z}));
      EXPECT_EQ(down.feet.y, 0);
      EXPECT_GE(path.cost, length(below.feet - top.feet));
    }
    finder->find(below, top, path);
    EXPECT_EQ(path.end, PathEnd::kUnreachable) << c;
  }
  // What leads one way holds nothing together.
  EXPECT_EQ(nodes.components(0).size(), nodes.components(1).size());
}

// The oracle of src/verify walks the paths; which node reaches which it finds from the arcs.
TEST(NodeDrops, EveryPathCanBeWalkedByItsBody) {
  Context context;
  uint64_t drops = 0;
  const auto check = [&](const std::string& name, const Scene& scene, double cell, double size,
                         uint64_t pairs, int32_t first_class) {
    const Nodes nodes = make(bake(scene, cell, jumpers()), scene, {.size = size});
    const VerifyConfig config{.samples = pairs, .seed = 7};
    for (int32_t c = first_class; c < 4; ++c) {
      VerifyConfig own = config;
      own.avatar_class = c;
      const auto paths = verify_node_paths(nodes, scene, own, context);
      ASSERT_TRUE(paths) << paths.error().message;
      EXPECT_EQ(paths->entered + paths->unsupported + paths->broken + paths->disagree, 0u)
          << name << ", class " << c << ": " << paths->entered << ' ' << paths->unsupported << ' '
          << paths->broken << ' ' << paths->disagree;
      drops += paths->links_of_kind[static_cast<size_t>(LinkKind::kDrop)];
      own.samples = 20 * pairs;
      const auto places = verify_nodes(nodes, scene, own, context);
      ASSERT_TRUE(places);
      EXPECT_EQ(places->entered + places->unsupported + places->one_way, 0u)
          << name << ", class " << c;
    }
  };
  check("platform", platform(), 0.1, 1, 100, 0);
  for (uint64_t seed = 1; seed <= 3; ++seed) {
    check("boxes " + std::to_string(seed), boxes(seed), 0.15, 1, 100, 1);
  }
  check("stairs", builtin({.name = "stairs"}), 0.2, 1, 60, 0);
  EXPECT_GT(drops, 50u);
  drops = 0;
  const Scene net = test::net_scene({.side = 3, .cell = 8, .relief = 7});
  check("net", net, 0.25, 0.7, 60, 1);
  check("landscape", builtin({.name = "landscape", .size = 100, .seed = 3}), 0.5, 1.5, 30, 1);
  EXPECT_GT(drops, 5u);
}

TEST(NodeDrops, AreTheSameForAnyNumberOfThreads) {
  const Scene scene = builtin({.name = "landscape", .size = 100});
  const World world = bake(scene, 0.5, jumpers());
  std::vector<uint64_t> first;
  for (const int32_t workers : {1, 2, 0}) {
    const Nodes nodes = make(world, scene, {.size = 2, .workers = workers});
    std::vector<uint64_t> hashes;
    for (const auto& slot : data_of(nodes)->slots) hashes.push_back(slot->entry.hash());
    if (first.empty()) first = hashes;
    EXPECT_EQ(hashes, first) << workers << " workers";
  }
}

TEST(NodeDrops, AreStoredByAWorldAndItsNodes) {
  const test::ScratchFolder folder;
  const std::string path = folder.path() + "/platform.throng";
  const Scene scene = platform();
  Context context;
  ASSERT_TRUE(bake_world_to(path, scene, {.cell = 0.2, .classes = divers()}, context));
  const auto world = World::open(path);
  ASSERT_TRUE(world);
  EXPECT_EQ(world->summary().classes[0].max_drop, 0);
  EXPECT_EQ(world->summary().classes[1].max_drop, 3);
  ASSERT_TRUE(make(*world, scene).write(path));
  const auto nodes = Nodes::open(path);
  ASSERT_TRUE(nodes) << nodes.error().message;
  size_t drops = 0;
  for (uint32_t n = 0; n < nodes->node_count(); ++n) {
    for (const NodeArc& arc : nodes->arcs(n)) drops += arc.kind == LinkKind::kDrop ? 1 : 0;
  }
  EXPECT_GT(drops, 10u);
  // A class that does not drop is stored as before.
  const std::vector<AvatarClass> plain = default_classes();
  const auto manifest = world::write_manifest(*data_of(bake(scene, 0.2, plain)));
  std::vector<AvatarClass> changed = plain;
  changed[0].max_drop = 2;
  EXPECT_GT(world::write_manifest(*data_of(bake(scene, 0.2, changed))).size(), manifest.size());
}

}  // namespace
}  // namespace throng
