// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>

#include "baked.h"
#include "core/access.h"
#include "core/random.h"
#include "graph/node_mesh.h"
#include "patch_nets.h"
#include "path/overlay/mesh_finder.h"
#include "path/overlay/node_finder.h"
#include "path/surface/block_squares.h"
#include "path/surface/node_parts.h"
#include "path/surface/node_search.h"
#include "throng/path.h"
#include "throng/verify.h"

// Paths over nodes, against the oracle of src/verify and a search of all crossings.
namespace throng {
namespace {

using test::bake;
using test::builtin;

std::vector<AvatarClass> classes() {
  std::vector<AvatarClass> all = default_classes();
  all.push_back({.name = "climber"});
  all.back().climb_slope = 180;
  all.push_back({.name = "gecko", .height = 0.5, .radius = 0.15, .step_height = 0.2});
  all.back().climb_slope = 95;
  return all;
}

Scene net_scene(double relief) { return test::net_scene({.side = 3, .cell = 8, .relief = relief}); }

Nodes make(const Scene& scene, double cell, double size) {
  Context context;
  const auto nodes = Nodes::create(bake(scene, cell, classes()), scene, {.size = size}, context);
  EXPECT_TRUE(nodes) << nodes.error().message;
  return nodes ? *nodes : Nodes{};
}

struct Costs {
  double slope = 0, narrow = 0, low = 0;
};

path::NodeFinder finder(const Nodes& nodes, int32_t avatar_class, const Costs& costs = {}) {
  Context context;
  auto made = path::NodeFinder::create(nodes,
                                       {.avatar_class = avatar_class,
                                        .slope_cost = costs.slope,
                                        .narrow_cost = costs.narrow,
                                        .low_cost = costs.low},
                                       context);
  EXPECT_TRUE(made) << made.error().message;
  return *std::move(made);
}

// The oracle of src/verify walks them; it also compares what is reachable with the arcs' parts.
TEST(NodePath, EveryPathIsLegalForItsBody) {
  Context context;
  const auto check = [&](const char* name, const Scene& scene, double cell, double size,
                         uint64_t pairs, uint64_t& hole_links) {
    const Nodes nodes = make(scene, cell, size);
    for (int32_t c = 0; c < 6; ++c) {
      const auto report = verify_node_paths(
          nodes, scene, {.samples = pairs, .seed = 5, .avatar_class = c}, context);
      ASSERT_TRUE(report) << report.error().message;
      EXPECT_EQ(report->entered, 0u) << name << ", class " << c;
      EXPECT_EQ(report->unsupported, 0u) << name << ", class " << c;
      EXPECT_EQ(report->broken, 0u) << name << ", class " << c;
      EXPECT_EQ(report->disagree, 0u) << name << ", class " << c;
      EXPECT_EQ(report->reached + report->disconnected, report->pairs) << name << ", class " << c;
      hole_links += report->hole_links;
    }
  };
  uint64_t hole_links = 0;
  check("net", net_scene(6), 0.25, 0.7, 100, hole_links);
  check("garage", builtin({.name = "garage"}), 0.25, 1, 60, hole_links);
  check("bridge", builtin({.name = "bridge"}), 0.25, 1, 40, hole_links);
  check("landscape", builtin({.name = "landscape", .size = 100, .seed = 3}), 0.5, 1.5, 25,
        hole_links);
  EXPECT_GT(hole_links, 0u);
}

// Paths lead through corners of blocks, where they cover no distance. (Over the edge of a patch the
// last point of one and the first of the next may be the same.)
TEST(NodePath, NoPointOnASurfaceRepeatsTheOneBefore) {
  for (const char* name : {"bridge", "landscape"}) {
    const double size = name[0] == 'l' ? 100.0 : 0.0;
    const Nodes nodes = make(builtin({.name = name, .size = size}), 0.25, 1);
    size_t points = 0;
    for (int32_t c = 0; c < 4; ++c) {
      path::NodeFinder paths = finder(nodes, c);
      Path path;
      for (uint64_t n = 0; n < 60; ++n) {
        paths.find(nodes.random_place(c, 9, 2 * n), nodes.random_place(c, 9, 2 * n + 1), path);
        for (size_t i = 1; i < path.points.size() && path.length > 0; ++i) {
          const NodePlace &last = path.node_places[i - 1], &here = path.node_places[i];
          EXPECT_FALSE(path.segments[i - 1] == SegmentKind::kWalk && here.feet == last.feet)
              << name << ", class " << c << ", path " << n << ", point " << i;
        }
        points += path.points.size();
      }
    }
    EXPECT_GT(points, 2000u);
  }
}

// Dijkstra's algorithm with a plain queue over the same crossings, without a bound or a goal.
TEST(NodePath, SearchFindsTheCheapestCrossings) {
  Context context;
  const Nodes nodes = make(net_scene(7), 0.25, 1);
  for (const Costs& costs : {Costs{}, {3, 0, 0}, {0, 4, 0}, {1, 5, 7}}) {
    for (const int32_t c : {0, 4}) {
      const auto mesh = graph::NodeMesh::create(nodes, c, 1, context);
      ASSERT_TRUE(mesh);
      const path::NodeView view(*mesh);
      const std::vector<double> added = path::added_costs(*mesh, costs.narrow, costs.low);
      const path::PieceCost piece(view, costs.slope, added);
      path::NodeFinder found = finder(nodes, c, costs);
      for (uint64_t n = 0; n < 20; ++n) {
        const NodePlace from = nodes.random_place(c, 3, 2 * n),
                        to = nodes.random_place(c, 3, 2 * n + 1);
        const auto block_of = [&](const NodePlace& place) {
          return mesh->block_at(mesh->patch_of_node(place.node1 - 1), place.s, place.t);
        };
        const uint32_t first = block_of(from), last = block_of(to);
        ASSERT_NE(first, graph::kNoNode);
        // A state is a block as it is entered by a portal, 2 p + (1 if backward), or the start.
        const size_t states = 2 * mesh->portals().size() + 1;
        std::vector<double> cost(states, std::numeric_limits<double>::infinity());
        using Entry = std::pair<double, size_t>;
        std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
        cost.back() = 0;
        queue.push({0, states - 1});
        double best = std::numeric_limits<double>::infinity();
        while (!queue.empty()) {
          const auto [so_far, state] = queue.top();
          queue.pop();
          if (so_far > cost[state]) continue;
          uint32_t block = first;
          double s = from.s, t = from.t;
          if (state + 1 < states) {
            const graph::NodePortal portal = mesh->portals()[state / 2];
            const auto& in = state % 2 != 0 ? portal.on_a : portal.on_b;
            block = state % 2 != 0 ? portal.a : portal.b;
            s = (in[0] + in[2]) / 2;
            t = (in[1] + in[3]) / 2;
          }
          const Vec3d at = mesh->surface(block).at(s, t);
          if (block == last) {
            best = std::min(best, so_far + piece(block, s, t, at, to.s, to.t, to.feet).cost);
          }
          for (const uint32_t p : mesh->portals_of(block)) {
            const graph::NodePortal portal = mesh->portals()[p];
            const bool backward = portal.a != block;
            if (backward && portal.one_way) continue;
            const auto& out = backward ? portal.on_b : portal.on_a;
            const auto& in = backward ? portal.on_a : portal.on_b;
            const double s1 = (out[0] + out[2]) / 2, t1 = (out[1] + out[3]) / 2;
            const Vec3d here = mesh->surface(block).at(s1, t1);
            const Vec3d there = mesh->surface(backward ? portal.a : portal.b)
                                    .at((in[0] + in[2]) / 2, (in[1] + in[3]) / 2);
            const double next =
                so_far + piece(block, s, t, at, s1, t1, here).cost + length(there - here);
            const size_t to_state = 2 * size_t{p} + (backward ? 1 : 0);
            if (next >= cost[to_state]) continue;
            cost[to_state] = next;
            queue.push({next, to_state});
          }
        }
        Path path;
        found.find(from, to, path);
        EXPECT_EQ(path.end == PathEnd::kReached, best < std::numeric_limits<double>::infinity());
        if (path.end != PathEnd::kReached) continue;
        EXPECT_NEAR(path.searched_cost, best, 1e-9 * best) << "class " << c << ", pair " << n;
        EXPECT_LE(path.cost, best * (1 + 1e-9));  // String pulling never costs more.
      }
    }
  }
}

// The exact any-angle finder of level tiles shares no code with nodes.
TEST(NodePath, OnLevelTilesPathsAreNearlyTheShortest) {
  Context context;
  for (const char* name : {"garage", "stairs", "church"}) {
    const Scene scene = builtin({.name = name});
    const Nodes nodes = make(scene, 0.2, 1);
    const World world = data_of(nodes)->world;
    auto exact = path::MeshFinder::create(world, {.avatar_class = 0}, context);
    ASSERT_TRUE(exact);
    path::NodeFinder found = finder(nodes, 0);
    double sum = 0, worst = 0;
    int count = 0;
    for (uint64_t n = 0; n < 200; ++n) {
      const NodePlace from = nodes.random_place(0, 1, 2 * n),
                      to = nodes.random_place(0, 1, 2 * n + 1);
      Path shortest;
      exact->find(world.find_place(0, from.feet, 0.1), world.find_place(0, to.feet, 0.1), shortest);
      Path path;
      found.find(from, to, path, 1e9);
      ASSERT_EQ(path.end == PathEnd::kReached, shortest.end == PathEnd::kReached) << name;
      if (path.end != PathEnd::kReached || shortest.length < 2) continue;
      double plan = 0;
      for (size_t i = 1; i < path.points.size(); ++i) {
        const Vec3d d = path.node_places[i].feet - path.node_places[i - 1].feet;
        plan += std::hypot(d.x, d.z);
      }
      sum += plan / shortest.length;
      worst = std::max(worst, plan / shortest.length);
      ++count;
    }
    EXPECT_GT(count, 50) << name;
    EXPECT_GE(sum / count, 1 - 1e-3) << name;
    EXPECT_LE(sum / count, 1.01) << name;
    EXPECT_LE(worst, 1.1) << name;
    RecordProperty(name, std::to_string(sum / count) + ", at most " + std::to_string(worst));
  }
}

TEST(NodePath, ReportsWhereItEnds) {
  Scene scene;  // A floor, a gap, another floor with a wall across.
  scene.add_quad({0, 0, 0}, {0, 0, 6}, {6, 0, 6}, {6, 0, 0});
  scene.add_quad({8, 0, 0}, {8, 0, 6}, {14, 0, 6}, {14, 0, 0});
  scene.add_quad({0, 3, 0}, {0, 3, 6}, {6, 3, 6}, {6, 3, 0});  // and a deck
  const Nodes nodes = make(scene, 0.2, 1);
  path::NodeFinder found = finder(nodes, 0);
  const NodePlace from = found.find_place({1, 0, 3}, 1), to = found.find_place({13, 0, 3}, 1);
  ASSERT_TRUE(from);
  ASSERT_TRUE(to);
  Path path;
  found.find(from, to, path);
  EXPECT_EQ(path.end, PathEnd::kUnreachable);
  EXPECT_EQ(path.blocked_by, Blocker::kGap);
  ASSERT_FALSE(path.points.empty());
  EXPECT_GT(path.node_places.back().feet.x, 5.5);
  EXPECT_LT(path.node_places.back().feet.x, 6);
  EXPECT_NEAR(path.node_places.back().feet.z, 3, 1e-3);
  // Right over it, and to the side: nothing stops it, and yet it does not get there.
  for (const double x : {1.0, 4.0}) {
    found.find(from, found.find_place({x, 3, 3}, 0.5), path);
    EXPECT_EQ(path.end, PathEnd::kUnreachable);
    EXPECT_EQ(path.blocked_by, Blocker::kGap) << x;
  }
  found.find({}, to, path);
  EXPECT_EQ(path.end, PathEnd::kNoPlace);
  found.find(from, from, path);
  EXPECT_EQ(path.end, PathEnd::kReached);
  EXPECT_EQ(path.length, 0);
  EXPECT_FALSE(found.find_place({7, 0, 3}, 0.1));
  EXPECT_FALSE(found.find_place({std::nan(""), 0, 3}, 1));
}

TEST(NodePath, EndsAtTheNearestPlaceThatIsReached) {
  Context context;
  Scene floors;  // Two that nothing joins, the other as wide as a body can see across.
  floors.add_quad({0, 0, 0}, {0, 0, 20}, {12, 0, 20}, {12, 0, 0});
  floors.add_quad({14, 0, 0}, {14, 0, 20}, {30, 0, 20}, {30, 0, 0});
  size_t unreachable = 0;
  for (const auto& [nodes, avatar_class] :
       {std::pair{make(floors, 0.2, 1), 0},
        {make(builtin({.name = "landscape", .size = 100}), 0.5, 2), 0},
        {make(builtin({.name = "landscape", .size = 100}), 0.5, 2), 5}}) {
    path::NodeFinder found = finder(nodes, avatar_class);
    const auto mesh = graph::NodeMesh::create(nodes, avatar_class, 1, context);
    ASSERT_TRUE(mesh);
    const path::NodeView view(*mesh);
    const path::NodeParts parts(*mesh, 1);
    path::NodeParts::Reached reached;
    Path path;
    for (uint64_t n = 0; n < 150; ++n) {
      const NodePlace from = nodes.random_place(avatar_class, 5, 2 * n);
      const NodePlace to = nodes.random_place(avatar_class, 5, 2 * n + 1);
      found.find(from, to, path);
      if (path.end != PathEnd::kUnreachable) continue;
      const uint32_t block = mesh->block_at(mesh->patch_of_node(from.node1 - 1), from.s, from.t);
      parts.reach(block, reached);
      double nearest = std::numeric_limits<double>::infinity();
      for (uint32_t b = 0; b < mesh->blocks().size(); ++b) {
        if (!reached.holds(parts.of_block(b))) continue;
        const auto [s, t] = path::nearest_in(view.surface(b), view.block(b), to.feet);
        nearest = std::min(nearest, length(view.surface(b).at(s, t) - to.feet));
      }
      const double ends = length(path.node_places.back().feet - to.feet);
      EXPECT_GE(ends, nearest - 1e-6) << n;
      if (ends > 25) continue;  // Farther off it may be the nearest crossing.
      ++unreachable;
      EXPECT_LE(ends, nearest + 1e-6) << n;
    }
  }
  EXPECT_GT(unreachable, 50u);
}

TEST(NodePath, OffMeshLinksLeadOnlyWhereTheyAreGiven) {
  Scene scene;
  scene.add_quad({0, 0, 0}, {0, 0, 6}, {6, 0, 6}, {6, 0, 0});
  scene.add_quad({8, 0, 0}, {8, 0, 6}, {14, 0, 6}, {14, 0, 0});
  Context context;
  const auto nodes = Nodes::create(
      bake(scene, 0.2), scene,
      {.off_mesh_links =
           {{.from = {4, 0, 3}, .to = {10, 0, 3}, .avatar_class = 0, .two_way = false}}},
      context);
  ASSERT_TRUE(nodes);
  path::NodeFinder found = finder(*nodes, 0);
  const NodePlace here = found.find_place({1, 0, 3}, 1), there = found.find_place({13, 0, 3}, 1);
  Path path;
  found.find(here, there, path);
  EXPECT_EQ(path.end, PathEnd::kReached);
  EXPECT_NEAR(path.length, 12, 0.05);
  const auto off_mesh_link =
      std::find_if(path.links.begin(), path.links.end(),
                   [](const PathLink& l) { return l.kind == LinkKind::kOffMesh; });
  ASSERT_NE(off_mesh_link, path.links.end());
  EXPECT_TRUE(off_mesh_link->over_hole);
  EXPECT_NEAR(path.node_places[off_mesh_link->point].feet.x, 10, 0.21);
  found.find(there, here, path);
  EXPECT_EQ(path.end, PathEnd::kUnreachable);
}

TEST(NodePath, SteepGroundIsAvoidedForACost) {
  const Nodes nodes = make(net_scene(8), 0.25, 0.7);
  path::NodeFinder straight = finder(nodes, 4), level = finder(nodes, 4, {.slope = 20});
  const auto rise = [](const Path& path) {
    double sum = 0;
    for (size_t i = 1; i < path.points.size(); ++i) {
      const NodePlace &a = path.node_places[i - 1], &b = path.node_places[i];
      sum += length(b.feet - a.feet) * (2 - a.normal.y - b.normal.y) / 2;
    }
    return sum;
  };
  double steep = 0, gentle = 0, length_straight = 0, length_gentle = 0;
  for (uint64_t n = 0; n < 60; ++n) {
    Path a, b;
    const NodePlace from = nodes.random_place(4, 9, 2 * n),
                    to = nodes.random_place(4, 9, 2 * n + 1);
    straight.find(from, to, a);
    level.find(from, to, b);
    ASSERT_EQ(a.end, b.end);
    steep += rise(a);
    gentle += rise(b);
    length_straight += a.length;
    length_gentle += b.length;
  }
  EXPECT_LT(gentle, 0.9 * steep);
  EXPECT_GT(length_gentle, length_straight);
}

// Metres of a path, each times what nodes promise along it, by the public queries alone.
TEST(NodePath, AMetreCostsWhatIsPromisedThere) {
  const Costs costs{2, 5, 7};
  size_t paths = 0, dearer = 0;
  for (const char* name : {"garage", "bridge", "church"}) {
    const Nodes nodes = make(builtin({.name = name}), 0.2, 1);
    const NodeSummary summary = nodes.summary();
    const NodeBins& bins = summary.bins;
    for (const int32_t c : {0, 1}) {
      const AvatarClass& avatar = summary.classes[static_cast<size_t>(c)];
      path::NodeFinder found = finder(nodes, c, costs);
      Path path;
      for (uint64_t n = 0; n < 40; ++n) {
        found.find(nodes.random_place(c, 13, 2 * n), nodes.random_place(c, 13, 2 * n + 1), path,
                   1e9);
        if (path.end != PathEnd::kReached) continue;
        double expected = 0;
        bool is_flat = true;
        for (size_t i = 0; i < path.segments.size(); ++i) {
          const double metres = length(path.node_places[i + 1].feet - path.node_places[i].feet);
          if (path.segments[i] != SegmentKind::kWalk) {
            expected += metres;
            continue;
          }
          const NodeInfo info = nodes.node(path.node_places[i].node1 - 1);
          is_flat = is_flat && info.kind == PatchKind::kLevelTile;
          const double slope = bins.inclination_of(info.inclination) * 3.14159265358979 / 180;
          const double width = std::max(bins.width_of(info.width), avatar.radius);
          const double height = bins.height_of(info.headroom);
          expected +=
              metres *
              (1 + costs.slope * (1 - std::cos(slope)) +
               costs.narrow * (bins.width.back() - width) / (bins.width.back() - avatar.radius) +
               costs.low * (bins.height.back() - height) / (bins.height.back() - avatar.height));
        }
        if (!is_flat) continue;
        ++paths;
        dearer += path.cost > 2 * path.length;
        // From one block to the next of a tile it may step up or down.
        EXPECT_NEAR(path.cost, expected, 1e-2 * expected) << name << ", class " << c << ", " << n;
      }
    }
  }
  EXPECT_GT(paths, 100u);
  EXPECT_GT(dearer, 20u);
}

TEST(NodePath, NarrowAndLowGroundIsAvoidedForACost) {
  const auto wall = [](Scene& scene, double z0, double z1, double bottom) {
    scene.add_box({8, bottom, z0}, {12, 4, z1});
  };
  Scene narrow, low;  // A hall, and a wall across with a wide passage at its end and another one.
  for (Scene* scene : {&narrow, &low}) {
    scene->add_quad({0, 0, 0}, {0, 0, 24}, {20, 0, 24}, {20, 0, 0});
    wall(*scene, 7, 11, 0);
    wall(*scene, 14, 24, 0);
  }
  wall(narrow, 11, 12, 0);  // A metre is left of the nearer passage.
  wall(narrow, 13, 14, 0);
  wall(low, 11, 14, 1.9);
  for (const bool is_low : {false, true}) {
    const Nodes nodes = make(is_low ? low : narrow, 0.2, 1);
    path::NodeFinder straight = finder(nodes, 0),
                     free = finder(nodes, 0, {0, is_low ? 0.0 : 9, is_low ? 9.0 : 0});
    const NodePlace from = straight.find_place({2, 0, 12.5}, 0.5);
    const NodePlace to = straight.find_place({18, 0, 12.5}, 0.5);
    Path path;
    straight.find(from, to, path);
    ASSERT_EQ(path.end, PathEnd::kReached);
    EXPECT_NEAR(path.length, 16, 0.5);
    EXPECT_NEAR(path.cost, path.length, 1e-5);
    free.find(from, to, path);
    ASSERT_EQ(path.end, PathEnd::kReached);
    EXPECT_GT(path.length, 18) << is_low;
    double lowest = 24;
    for (const NodePlace& place : path.node_places) lowest = std::min(lowest, place.feet.z);
    EXPECT_LT(lowest, 7) << is_low;
    // Where there is no other passage, it is taken whatever it costs.
    Scene shut = is_low ? low : narrow;
    shut.add_box({8, 0, 0}, {12, 4, 8});
    const Nodes one = make(shut, 0.2, 1);
    path::NodeFinder dear = finder(one, 0, {0, 1000, 1000});
    dear.find(dear.find_place({2, 0, 12.5}, 0.5), dear.find_place({18, 0, 12.5}, 0.5), path);
    EXPECT_EQ(path.end, PathEnd::kReached);
  }
}

TEST(NodePath, TheNearestPlaceIsFound) {
  const Nodes nodes = make(net_scene(6), 0.25, 1);
  const path::NodeFinder found = finder(nodes, 4);
  for (uint64_t n = 0; n < 100; ++n) {
    const NodePlace place = nodes.random_place(4, 2, n);
    const Vec3d near = place.feet + place.normal * 0.2;
    const NodePlace back = found.find_place(near, 1);
    ASSERT_TRUE(back);
    EXPECT_LE(length(back.feet - near), 0.2 + 1e-6);
    // No place of a thousand others is nearer.
    for (uint64_t k = 0; k < 1000; ++k) {
      EXPECT_GE(length(nodes.random_place(4, 77, k).feet - near), length(back.feet - near) - 1e-3);
    }
  }
}

TEST(NodePath, FindPlaceFindsWhatASearchThroughAllBlocksFinds) {
  Context context;
  for (const bool rocks : {false, true}) {
    const Nodes nodes = rocks ? make(builtin({.name = "landscape", .size = 64}), 0.5, 2)
                              : make(net_scene(6), 0.25, 1);
    const path::NodeFinder found = finder(nodes, 4);
    const auto mesh = graph::NodeMesh::create(nodes, 4, 1, context);
    ASSERT_TRUE(mesh);
    size_t places = 0;
    for (uint64_t n = 0; n < 300; ++n) {
      const NodePlace place = nodes.random_place(4, 5, n);
      const Vec3d near = place.feet + place.normal * (random_unit(9, 1, n) * 3 - 1);
      const double reach = random_unit(9, 2, n) * 2;
      double nearest = reach;
      std::optional<Vec3d> best;
      for (uint32_t b = 0; b < mesh->blocks().size(); ++b) {
        const auto [s, t] = path::nearest_in(mesh->surface(b), mesh->blocks()[b], near);
        const Vec3d feet = mesh->surface(b).at(s, t);
        const double far = length(feet - near);
        if (far > nearest || (best && far == nearest)) continue;
        nearest = far;
        best = feet;
      }
      const NodePlace here = found.find_place(near, reach);
      ASSERT_EQ(static_cast<bool>(here), best.has_value()) << n;
      if (best) {
        EXPECT_EQ(here.feet, *best) << n;
      }
      places += best.has_value();
    }
    EXPECT_GT(places, 100u);
    EXPECT_LT(places, 280u);
  }
}

TEST(NodePath, PathsAreTheSameForCopiesAndAnyThreads) {
  Context context;
  const Nodes nodes = make(builtin({.name = "landscape", .size = 100}), 0.5, 2);
  std::vector<double> first;
  for (const int32_t workers : {1, 2, 0}) {
    auto made = path::NodeFinder::create(nodes, {.avatar_class = 4, .workers = workers}, context);
    ASSERT_TRUE(made);
    path::NodeFinder copy = *made;
    std::vector<double> all;
    Path path;
    for (uint64_t n = 0; n < 20; ++n) {
      (n % 2 == 0 ? *made : copy)
          .find(nodes.random_place(4, 1, 2 * n), nodes.random_place(4, 1, 2 * n + 1), path);
      all.push_back(path.cost);
      for (const NodePlace& p : path.node_places) all.push_back(p.s + p.feet.y);
    }
    if (first.empty()) first = all;
    EXPECT_EQ(all, first);
  }
}

TEST(NodePath, BadInputIsRefusedAndNamed) {
  Context context;
  const auto message = [&](const Nodes& nodes, const PathConfig& config) {
    const auto made = path::NodeFinder::create(nodes, config, context);
    EXPECT_FALSE(made);
    return made ? std::string() : made.error().message;
  };
  const Nodes nodes = make(builtin({.name = "cube"}), 0.25, 1);
  EXPECT_EQ(message({}, {}), "path: there are no nodes");
  EXPECT_EQ(message(nodes, {.avatar_class = 9}), "path: the world has no avatar class 9; it has 6");
  EXPECT_EQ(message(nodes, {.slope_cost = -1}), "path: slope_cost must be 0 to 1000");
  for (const PathConfig& config :
       {PathConfig{.narrow_cost = -1}, {.low_cost = 1001}, {.narrow_cost = std::nan("")}}) {
    EXPECT_EQ(message(nodes, config), "path: narrow_cost and low_cost must be 0 to 1000");
  }
  EXPECT_EQ(message(nodes, {.workers = -1}), "path: workers must be 0 or more");
  EXPECT_EQ(message(nodes, {.speedup = PathSpeedup::kLabels}),
            "path: a speedup is only for paths on the ground");
  context.cancel = true;
  EXPECT_EQ(message(nodes, {}), "path: cancelled");
}

}  // namespace
}  // namespace throng
