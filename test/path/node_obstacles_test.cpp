// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "baked.h"
#include "core/random.h"
#include "path/edits/solid.h"
#include "path/overlay/node_finder.h"
#include "path/overlay/overlay_search.h"
#include "path/surface/node_changes.h"
#include "path/surface/node_view.h"
#include "prism_shell.h"
#include "throng/path.h"
#include "throng/verify.h"
#include "verify/triangle_tree.h"
#include "verify/turned_body.h"

// Obstacles on nodes, against the bodies' own geometry and a search of all crossings.
namespace throng {
namespace {

using test::bake;
using test::builtin;

// A walker, one that drops, and climbers with links over holes.
std::vector<AvatarClass> classes() {
  std::vector<AvatarClass> all{{.name = "adult"}, {.name = "dropper"}, {.name = "climber"}};
  all[1].max_drop = 3;
  all[2].climb_slope = 180;
  all[2].max_drop = 6;
  all.push_back({.name = "gecko", .height = 0.5, .radius = 0.15, .step_height = 0.2});
  all.back().climb_slope = 95;
  return all;
}

struct TestWorld {
  Scene scene;
  Nodes nodes;
};

TestWorld make(const BuiltinWorldConfig& world, double cell, double size) {
  Context context;
  TestWorld made{builtin(world), {}};
  auto nodes =
      Nodes::create(bake(made.scene, cell, classes()), made.scene, {.size = size}, context);
  EXPECT_TRUE(nodes);
  if (nodes) made.nodes = *nodes;
  return made;
}

// Boxes, pillars and walls where bodies are: some across, some askew, some in the air.
std::vector<Prism> random_prisms(const Nodes& nodes, uint64_t seed, int count) {
  std::vector<Prism> prisms;
  for (int i = 0; i < count; ++i) {
    const auto draw = [&](uint64_t n, double low, double high) {
      return low + (high - low) * random_unit(seed, static_cast<uint64_t>(i), n);
    };
    const NodePlace at =
        nodes.random_place(static_cast<int32_t>(draw(0, 0, 4)), seed, static_cast<uint64_t>(i));
    if (!at) continue;
    const double up = draw(1, -0.5, 1.5), high = draw(2, 0.1, 3);
    const Vec3d low{at.feet.x, at.feet.y + up, at.feet.z};
    if (i % 3 == 0) {
      prisms.push_back(Prism::circle(low, draw(3, 0.05, 1), high, 3 + i % 9));
      continue;
    }
    const double along = i % 3 == 1 ? draw(3, 0.1, 2) : draw(3, 2, 12), across = draw(4, 0.05, 1);
    const double turn = draw(5, 0, 3.14), c = std::cos(turn), s = std::sin(turn);
    Prism prism{{}, low.y, low.y + high};
    for (const auto& [u, v] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}) {
      prism.corners.push_back({low.x + c * u * along / 2 - s * v * across / 2,
                               low.z + s * u * along / 2 + c * v * across / 2});
    }
    prisms.push_back(prism);
  }
  return prisms;
}

template <class Check>
void for_each_world(Check check) {
  check(make({.name = "landscape", .size = 80, .seed = 2}, 0.25, 1));
  check(make({.name = "garage"}, 0.25, 1));
  check(make({.name = "bridge"}, 0.25, 1));
}

TEST(NodeObstacles, EveryPathAroundThemIsLegalForItsBody) {
  uint64_t pairs = 0, reached = 0, blocked = 0, poses = 0;
  for_each_world([&](const TestWorld& world) {
    Context context;
    for (int32_t c = 0; c < 4; ++c) {
      for (uint64_t seed = 1; seed <= 2; ++seed) {
        VerifyConfig config{.samples = 40, .seed = seed, .avatar_class = c, .workers = 1};
        config.obstacles = random_prisms(world.nodes, 10 * seed, 60);
        const auto report = verify_node_paths(world.nodes, world.scene, config, context);
        ASSERT_TRUE(report) << report.error().message;
        EXPECT_EQ(report->entered, 0u);
        EXPECT_EQ(report->broken, 0u);
        EXPECT_EQ(report->disagree, 0u);
        for (const VerifyFault& fault : report->faults) {
          ADD_FAILURE() << world.scene.triangles.size() << ' ' << c << ' ' << fault.what << ' '
                        << fault.position.x << ' ' << fault.position.y << ' ' << fault.position.z
                        << " triangle " << fault.triangle << " of " << world.scene.triangles.size();
        }
        pairs += report->pairs;
        reached += report->reached;
        blocked += report->blocked;
        poses += report->poses;
      }
    }
  });
  EXPECT_GT(reached, 600u);
  EXPECT_GT(blocked, 10u);
  EXPECT_GT(poses, 1000000u);
  EXPECT_GE(pairs, reached + blocked);
}

path::BlockPoint point_of(const path::NodeView& view, const NodePlace& place) {
  const graph::NodeMesh& mesh = view.mesh();
  const uint32_t block = mesh.block_at(mesh.patch_of_node(place.node1 - 1), place.s, place.t);
  if (block == graph::kNoNode) return {};
  return {view.changes()->part_at(block, place.s, place.t), place.s, place.t};
}

// A search of all crossings that are left.
TEST(NodeObstacles, ASearchOfWhatIsLeftFindsTheSame) {
  uint64_t reached = 0, unreachable = 0, nowhere = 0, islands = 0;
  for_each_world([&](const TestWorld& world) {
    Context context;
    for (int32_t c = 0; c < 4; ++c) {
      const auto mesh = graph::NodeMesh::create(world.nodes, c, 1, context);
      ASSERT_TRUE(mesh);
      const path::BlockSquares squares(*mesh);
      path::NodeChanges changes(*mesh, squares, 20);
      auto finder =
          path::NodeFinder::create(world.nodes, {.avatar_class = c, .workers = 1}, context);
      ASSERT_TRUE(finder);
      for (const Prism& prism : random_prisms(world.nodes, 77, 50)) {
        changes.add({prism, {}});
        ASSERT_TRUE(finder->add_obstacle({prism}));
      }
      // A body is walled in.
      const Vec3d in = world.nodes.random_place(c, 5, 0).feet;
      for (const auto& [u, v] : {std::pair{-1, 0}, {1, 0}, {0, -1}, {0, 1}}) {
        const Prism wall = Prism::box(
            {in.x + 2 * u - (v != 0 ? 2.1 : 0.1), in.y - 5, in.z + 2 * v - (u != 0 ? 2.1 : 0.1)},
            {in.x + 2 * u + (v != 0 ? 2.1 : 0.1), in.y + 5, in.z + 2 * v + (u != 0 ? 2.1 : 0.1)});
        changes.add({wall, {}});
        ASSERT_TRUE(finder->add_obstacle({wall}));
      }
      changes.update();
      const path::NodeView view(*mesh, &changes);
      const path::PieceCost piece(view, 0);
      path::NodeSearch plain(view, piece);
      std::vector<path::Crossing> best;
      Path path;
      for (uint64_t n = 0; n < 40; ++n) {
        const NodePlace from = world.nodes.random_place(c, 5, n < 10 && n % 2 == 0 ? 0 : 2 * n);
        const NodePlace to = world.nodes.random_place(c, 5, n < 10 && n % 2 != 0 ? 0 : 2 * n + 1);
        const path::BlockPoint a = point_of(view, from), b = point_of(view, to);
        finder->find(from, to, path);
        if (a.block == graph::kNoNode || b.block == graph::kNoNode) {
          ++nowhere;
          EXPECT_EQ(path.end, PathEnd::kNoPlace);
          continue;
        }
        const PathEnd end = plain.find(a, b, {}, best);
        ASSERT_EQ(path.end, end) << n;
        if (end == PathEnd::kReached) {
          ++reached;
          EXPECT_LE(path.searched_cost, 1.1 * plain.cost() + 0.5);
          continue;
        }
        ++unreachable;
        islands += n < 10 ? 1 : 0;
        const path::BlockPoint last = best.empty() ? a : path::ends_of(view, best.back()).in;
        // As near as the nearest crossing, or nearer in the block that it leads into.
        EXPECT_LE(length(path.node_places.back().feet - to.feet),
                  length(path::position(view, last) - to.feet) + 1e-9);
        EXPECT_NE(path.blocked_by, Blocker::kNone);
      }
    }
  });
  EXPECT_GT(reached, 250u);
  EXPECT_GT(unreachable, 30u);
  EXPECT_GT(islands, 10u);
  EXPECT_GT(nowhere, 10u);
}

// Over entrances, where overlay cells that obstacles stand in are searched again.
TEST(NodeObstacles, LongPathsLeadOverWhatIsLeft) {
  uint64_t reached = 0, missed = 0;
  double sum = 0;
  for_each_world([&](const TestWorld& world) {
    Context context;
    for (const int32_t c : {0, 2, 3}) {
      const auto mesh = graph::NodeMesh::create(world.nodes, c, 1, context);
      ASSERT_TRUE(mesh);
      const path::BlockSquares squares(*mesh);
      path::NodeChanges changes(*mesh, squares, 20);
      const path::NodeView view(*mesh, &changes);
      const path::PieceCost piece(view, 0);
      const path::NodeView baked(*mesh);
      const path::PieceCost baked_piece(baked, 0);
      const path::Overlay overlay(*mesh, baked_piece, 1, 48);
      ASSERT_FALSE(overlay.empty());
      path::OverlaySearch search(view, piece, overlay);
      path::NodeSearch plain(view, piece), blocks(view, piece);
      std::vector<path::Crossing> best, crossings;
      for (uint64_t round = 0; round < 3; ++round) {
        for (const Prism& prism : random_prisms(world.nodes, 100 + round, 25))
          changes.add({prism, {}});
        changes.update();
        search.update();
        for (uint64_t n = 0; n < 30; ++n) {
          const path::BlockPoint from = point_of(view, world.nodes.random_place(c, 9, 2 * n));
          const path::BlockPoint to = point_of(view, world.nodes.random_place(c, 9, 2 * n + 1));
          if (from.block == graph::kNoNode || to.block == graph::kNoNode) continue;
          const PathEnd end = plain.find(from, to, {}, best);
          const PathEnd over_entrances = search.find(from, to, {}, blocks, crossings);
          if (end != PathEnd::kReached) {
            EXPECT_EQ(over_entrances, end);
            continue;
          }
          // A finder continues with a search of all where entrances no longer lead there.
          missed += over_entrances != PathEnd::kReached ? 1 : 0;
          if (over_entrances != PathEnd::kReached || plain.cost() < 5) continue;
          ++reached;
          EXPECT_GE(search.cost(), plain.cost() * (1 - 1e-9));
          sum += search.cost() / plain.cost();
          path::BlockPoint at = from;
          for (const path::Crossing& crossing : crossings) {
            const auto [out, in] = path::ends_of(view, crossing);
            ASSERT_EQ(out.block, at.block);
            at = in;
          }
          ASSERT_EQ(at.block, to.block);
        }
      }
    }
  });
  EXPECT_GT(reached, 400u);
  EXPECT_LT(missed, reached / 20);
  EXPECT_LE(sum / static_cast<double>(reached), 1.03);
}

bool is_same(const Path& a, const Path& b) {
  if (a.end != b.end || a.points.size() != b.points.size() || a.cost != b.cost) return false;
  for (size_t i = 0; i < a.points.size(); ++i) {
    if (!(a.node_places[i].feet == b.node_places[i].feet)) return false;
  }
  return true;
}

TEST(NodeObstacles, WhatIsTakenAwayOrAddedInAnotherOrderLeavesNoTrace) {
  const TestWorld world = make({.name = "landscape", .size = 64, .seed = 4}, 0.5, 1);
  Context context;
  uint64_t changed = 0;
  for (int32_t c = 0; c < 4; ++c) {
    auto made = path::NodeFinder::create(world.nodes, {.avatar_class = c, .workers = 1}, context);
    ASSERT_TRUE(made);
    path::NodeFinder rebuilt = *made, one = *made, other = *made;
    const std::vector<Prism> prisms = random_prisms(world.nodes, 3, 30);
    std::vector<path::ChangeId> ids;
    for (const Prism& prism : prisms) ids.push_back(one.add_obstacle({prism}));
    for (size_t i = prisms.size(); i-- > 0;) {
      // An obstacle that is removed later, or switched off, does not count.
      const path::ChangeId spare = other.add_obstacle({prisms[(i * 7 + 3) % prisms.size()]});
      ASSERT_TRUE(other.add_obstacle({prisms[i]}));
      if (i % 2 == 0) {
        EXPECT_TRUE(other.remove(spare));
        EXPECT_FALSE(other.remove(spare));
      } else {
        EXPECT_TRUE(other.set_active(spare, false));
      }
    }
    path::NodeFinder copy = one;
    Path a, b, d, e;
    for (uint64_t n = 0; n < 25; ++n) {
      const NodePlace from = world.nodes.random_place(c, 2, 2 * n),
                      to = world.nodes.random_place(c, 2, 2 * n + 1);
      rebuilt.find(from, to, e);
      one.find(from, to, a);
      other.find(from, to, b);
      copy.find(from, to, d);
      EXPECT_TRUE(is_same(a, b));
      EXPECT_TRUE(is_same(a, d));
      changed += is_same(a, e) ? 0 : 1;
      const NodePlace p = one.find_place(to.feet, 2), q = other.find_place(to.feet, 2);
      EXPECT_EQ(p.node1, q.node1);
      EXPECT_TRUE(p.feet == q.feet);
      if (p) {
        one.find(from, p, a);
        EXPECT_TRUE(a.end != PathEnd::kNoPlace || one.find_place(from.feet, 0.1).node1 == 0 ||
                    !(one.find_place(from.feet, 0.1).feet == from.feet));
      }
    }
    for (size_t i = 0; i < ids.size(); ++i) {
      EXPECT_TRUE(i % 2 == 0 ? one.remove(ids[i]) : one.set_active(ids[i], false));
    }
    for (uint64_t n = 0; n < 25; ++n) {
      const NodePlace from = world.nodes.random_place(c, 2, 2 * n),
                      to = world.nodes.random_place(c, 2, 2 * n + 1);
      rebuilt.find(from, to, e);
      one.find(from, to, a);
      EXPECT_TRUE(is_same(a, e));
    }
  }
  EXPECT_GT(changed, 30u);
}

// What is well clear of every obstacle stays open: a random place whose body's ball no prism comes
// near is never blocked.
TEST(NodeObstacles, BlockNoMoreThanNeeded) {
  uint64_t open = 0, blocked = 0, blocked_near = 0;
  for_each_world([&](const TestWorld& world) {
    Context context;
    for (int32_t c = 0; c < 4; ++c) {
      const auto mesh = graph::NodeMesh::create(world.nodes, c, 1, context);
      ASSERT_TRUE(mesh);
      const path::BlockSquares squares(*mesh);
      path::NodeChanges changes(*mesh, squares, 20);
      const std::vector<Prism> prisms = random_prisms(world.nodes, 11, 40);
      for (const Prism& prism : prisms) changes.add({prism, {}});
      changes.update();
      const path::NodeView view(*mesh, &changes);
      const AvatarClass avatar = classes()[static_cast<size_t>(c)];
      for (uint64_t n = 0; n < 4000; ++n) {
        const NodePlace place = world.nodes.random_place(c, 21, n);
        const bool is_blocked = point_of(view, place).block == graph::kNoNode;
        // Along its axis, grown by a cell of half a metre.
        bool is_near = false;
        for (const Prism& prism : prisms) {
          path::BodyRoom body;
          body.feet = place.feet;
          body.axis = place.axis;
          body.spread = 0.5;
          body.top = avatar.height;
          body.radius = avatar.radius;
          is_near = is_near || path::may_touch(body, {prism, {}});
        }
        blocked += is_blocked ? 1 : 0;
        blocked_near += is_blocked && is_near ? 1 : 0;
        open += is_blocked ? 0 : 1;
      }
    }
  });
  EXPECT_GT(open, 30000u);
  EXPECT_GT(blocked, 900u);
  EXPECT_EQ(blocked_near, blocked);
}

// A shell of triangles blocks what its faces touch: no more than the whole prism does, and all
// along the paths no body meets one of them.
TEST(NodeObstacles, MeshesBlockWhatTheirTrianglesTouch) {
  const TestWorld world = make({.name = "landscape", .size = 64, .seed = 6}, 0.5, 1);
  Context context;
  uint64_t around = 0, bodies = 0;
  for (int32_t c = 0; c < 4; ++c) {
    auto made = path::NodeFinder::create(world.nodes, {.avatar_class = c, .workers = 1}, context);
    ASSERT_TRUE(made);
    path::NodeFinder rebuilt = *made, solid = *made, shells = *made;
    Scene scene;
    for (const Prism& prism : random_prisms(world.nodes, 31, 40)) {
      const test::PrismShell shell = test::shell_of(prism);
      ASSERT_TRUE(solid.add_obstacle({prism}));
      ASSERT_TRUE(shells.add_obstacle(*path::make_solid(shell.corners, shell.triangles)));
      test::add_to(scene, shell);
    }
    const verify::TriangleTree tree(scene, 1);
    const AvatarClass avatar = classes()[static_cast<size_t>(c)];
    Path path, other;
    for (uint64_t n = 0; n < 40; ++n) {
      const NodePlace from = world.nodes.random_place(c, 8, 2 * n),
                      to = world.nodes.random_place(c, 8, 2 * n + 1);
      shells.find(from, to, path);
      solid.find(from, to, other);
      // A body in a closed shell of triangles is not in one.
      EXPECT_TRUE(other.end == PathEnd::kNoPlace || path.end != PathEnd::kNoPlace);
      EXPECT_TRUE(other.end != PathEnd::kReached || path.end == PathEnd::kReached);
      for (const NodePlace& place : path.node_places) {
        if (!place) continue;
        ++bodies;
        EXPECT_FALSE(verify::turned_intruder(tree, avatar, {place.feet, place.axis}));
      }
      rebuilt.find(from, to, other);
      around += !is_same(path, other) ? 1 : 0;
    }
  }
  EXPECT_GT(bodies, 10000u);
  EXPECT_GT(around, 30u);
}

TEST(NodeObstacles, UnknownOnesAreNoChanges) {
  const TestWorld world = make({.name = "stairs"}, 0.25, 1);
  Context context;
  auto finder = path::NodeFinder::create(world.nodes, {.workers = 1}, context);
  ASSERT_TRUE(finder);
  EXPECT_FALSE(finder->remove(0));
  EXPECT_FALSE(finder->remove(1));
  EXPECT_FALSE(finder->set_active(7, true));
}

}  // namespace
}  // namespace throng
