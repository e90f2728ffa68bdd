// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "baked.h"
#include "core/access.h"
#include "core/random.h"
#include "throng/path.h"
#include "world/ground.h"
#include "world/place.h"
#include "worlds.h"

// Goals that are not connected with the start: the place where the path ends against all cells of
// the start's component, and against a search of all that is reachable.
namespace throng {
namespace {

using test::bake;

constexpr double kFar = std::numeric_limits<double>::infinity();

template <class T>
T need(Result<T> made) {
  EXPECT_TRUE(made) << made.error().message;
  if constexpr (!std::is_void_v<T>) return *std::move(made);
}

// A floor with blocks on it, whose tops are components of their own.
Scene blocks(uint64_t seed) {
  Scene scene;
  scene.add_quad({0, 0, 0}, {0, 0, 26}, {26, 0, 26}, {26, 0, 0});
  for (uint64_t n = 0; n < 9; ++n) {
    const auto real = [&](uint64_t i, double low, double high) {
      return low + (high - low) * random_unit(seed, n, i);
    };
    const double x = real(0, 1, 20), z = real(1, 1, 20);
    scene.add_box({x, -0.1, z}, {x + real(2, 2, 6), real(3, 1.5, 4), z + real(4, 2, 6)});
  }
  return scene;
}

// How far a point of a level is from a goal, heights counted. [m]
double distance(const World& world, const Place& at, const Place& goal) {
  const world::WorldData& data = *data_of(world);
  const auto height = [&](const Place& place, const world::GroundPoint& p) {
    const auto level = world::ground_level(data, place.level1 - 1, 0);
    return level.view.sample(world::in_tile(p.cell_x()), world::in_tile(p.cell_z())) * 1e-3;
  };
  const auto p = *world::ground_point(data, at), q = *world::ground_point(data, goal);
  const double unit = world.summary().cell / world::kUnitsPerCell;
  const double x = static_cast<double>(p.x - q.x) * unit, z = static_cast<double>(p.z - q.z) * unit;
  const double rise = height(at, p) - height(goal, q);
  return std::sqrt(x * x + z * z + rise * rise);
}

// The least distance of a legal cell that belongs to the start.
double least_distance(const World& world, const Graph& graph, const Place& from,
                      const Place& goal) {
  const world::WorldData& data = *data_of(world);
  const auto to = *world::ground_point(data, goal);
  const auto component = graph.component_at(0, from);
  double least = kFar;
  for (int32_t z = 0; z < data.depth; ++z) {
    for (int32_t x = 0; x < data.width; ++x) {
      const auto levels = data.tile_levels(world::tile_along(x), world::tile_along(z));
      for (uint32_t l = levels.first; l < levels.last; ++l) {
        const world::GroundLevel level = world::ground_level(data, l, 0);
        if (!level.is_legal(world::in_tile(x), world::in_tile(z))) continue;
        const auto clamped = [](int64_t at, int32_t cell) {
          return std::clamp(at, int64_t{cell} << world::kUnitBits,
                            (int64_t{cell + 1} << world::kUnitBits) - 1);
        };
        const Place at = world::place_at(data, level, {clamped(to.x, x), clamped(to.z, z)});
        if (graph.component_at(0, at) != component) continue;
        least = std::min(least, distance(world, at, goal));
      }
    }
  }
  return least;
}

TEST(NearestPlace, IsTheNearestOfTheComponentOfTheStart) {
  Context context;
  uint64_t apart = 0;
  for (const Scene& scene : {blocks(1), blocks(2), worlds::doorway(0.2), worlds::two_floors(),
                             test::builtin({.name = "garage", .size = 45, .levels = 2})}) {
    const World world = bake(scene, 0.25, {{.name = "adult"}});
    const Graph graph = need(Graph::create(world, {}, context));
    PathFinder finder = need(PathFinder::create(world, {}, context));
    PathFinder labels = need(PathFinder::create(world, {.speedup = PathSpeedup::kLabels}, context));
    Path path, other;
    for (uint64_t n = 0; n < 40; ++n) {
      const Place from = world.random_place(0, 9, 2 * n), to = world.random_place(0, 9, 2 * n + 1);
      if (graph.component_at(0, from) == graph.component_at(0, to)) continue;
      ++apart;
      finder.find({.from = from, .to = to, .nearest = true}, path);
      ASSERT_EQ(path.end, PathEnd::kUnreachable);
      ASSERT_FALSE(path.points.empty());
      EXPECT_NE(path.blocked_by, Blocker::kNone);
      const Place last = path.points.back();
      EXPECT_NEAR(distance(world, last, to), least_distance(world, graph, from, to), 1e-6);
      // No more is expanded than by a query to that place.
      finder.find(from, last, other);
      EXPECT_EQ(other.end, PathEnd::kReached);
      EXPECT_EQ(path.nodes, other.nodes);
      EXPECT_EQ(path.length, other.length);
      labels.find({.from = from, .to = to, .nearest = true}, other);
      EXPECT_EQ(other.nodes, 0u);
      EXPECT_EQ(distance(world, other.points.back(), last), 0);
      // In parts.
      finder.begin({.from = from, .to = to, .nearest = true});
      uint64_t before = 0;
      while (!finder.advance(7, other)) {
        EXPECT_EQ(other.nodes, before + 7);
        before = other.nodes;
      }
      EXPECT_EQ(other.end, PathEnd::kUnreachable);
      EXPECT_EQ(other.blocked_by, path.blocked_by);
      EXPECT_EQ(distance(world, other.points.back(), last), 0);
      // If it is not asked for, nothing is searched.
      const PathQuery bare{.from = from, .to = to, .nearest = false};
      finder.find(bare, other);
      EXPECT_EQ(other.end, PathEnd::kUnreachable);
      EXPECT_TRUE(other.points.empty());
      EXPECT_EQ(other.nodes, 0u);
      finder.begin(bare);
      EXPECT_TRUE(finder.advance(1, other));
      EXPECT_EQ(other.end, PathEnd::kUnreachable);
      EXPECT_TRUE(other.points.empty());
      EXPECT_EQ(other.nodes, 0u);
    }
  }
  EXPECT_GT(apart, 40u);
}

// With crates, areas that cost more and closed ones: as a search of all that is reachable has it.
TEST(NearestPlace, IsThatOfASearchOfAllWithEdits) {
  Context context;
  uint64_t apart = 0, obstructed = 0;
  for (uint64_t seed = 1; seed < 5; ++seed) {
    const World world = bake(blocks(seed), 0.25, {{.name = "adult"}});
    const Graph graph = need(Graph::create(world, {}, context));
    Edits edits;
    PathFinder finder = need(PathFinder::create(world, {.edits = edits}, context));
    PathFinder all = need(
        PathFinder::create(world, {.speedup = PathSpeedup::kOnDemand, .edits = edits}, context));
    PathFinder baked = need(PathFinder::create(world, {}, context));
    std::vector<Vec3d> closed;  // middles of areas
    for (uint64_t n = 0; n < 14; ++n) {
      const Vec3d at = world.random_place(0, 17, n).position;
      if (n % 6 == 5) closed.push_back(at);
      const double side = n % 4 == 0 ? 5 : 0.8;
      const Prism prism = Prism::box(at - Vec3d{0.5, 0.2, side}, at + Vec3d{0.5, 1.5, side});
      need(n % 3 == 2 ? edits.add_area(prism, n % 2 == 0 ? 5 : 6) : edits.add_obstacle(prism));
    }
    if (seed > 2) need(edits.set_area_cost(5, 3));
    if (seed > 3) need(edits.set_area_cost(6, kFar));
    Path path, parts, best, bare;
    for (uint64_t n = 0; n < 60; ++n) {
      const Place from = world.random_place(0, 9, 2 * n), to = world.random_place(0, 9, 2 * n + 1);
      if (graph.component_at(0, from) == graph.component_at(0, to)) continue;
      // No path begins in a closed area.
      if (std::any_of(closed.begin(), closed.end(),
                      [&](Vec3d at) { return length(at - from.position) < 2.5; })) {
        continue;
      }
      finder.find({.from = from, .to = to, .nearest = true}, path);
      all.find({.from = from, .to = to, .nearest = true}, best);
      ASSERT_EQ(path.end, best.end);
      if (path.end != PathEnd::kUnreachable) continue;  // a crate stands on an end
      ++apart;
      const double far = distance(world, best.points.back(), to);
      EXPECT_NEAR(distance(world, path.points.back(), to), far, 1e-6) << seed << ", " << n;
      baked.find({.from = from, .to = to, .nearest = true}, bare);
      obstructed += distance(world, bare.points.back(), to) < far - 1e-6;
      finder.begin({.from = from, .to = to, .nearest = true});
      while (!finder.advance(40, parts)) continue;
      EXPECT_EQ(parts.end, PathEnd::kUnreachable);
      EXPECT_EQ(distance(world, parts.points.back(), path.points.back()), 0);
      EXPECT_EQ(parts.blocked_by, path.blocked_by);
      finder.find({.from = from, .to = to, .nearest = false}, path);
      EXPECT_EQ(path.end, PathEnd::kUnreachable);
      EXPECT_TRUE(path.points.empty());
      EXPECT_EQ(path.nodes, 0u) << "the mesh knows it, whatever metres cost";
    }
  }
  EXPECT_GT(apart, 50u);
  EXPECT_GT(obstructed, 0u);
}

// A goal that obstacles enclose: a flood around both ends finds that out.
TEST(NearestPlace, AnEnclosedGoalIsNotSearchedForAllOverTheGround) {
  const World world = bake(worlds::flat(90), 0.25, {{.name = "adult"}});
  Context context;
  Edits edits;
  PathFinder finder = need(PathFinder::create(world, {.edits = edits}, context));
  for (uint64_t n = 0; n < 400; ++n) {
    const Vec3d at = world.random_place(0, 3, n).position;
    if (length(at - Vec3d{45, 0, 45}) < 8 || at.x < 4) continue;
    need(edits.add_obstacle(Prism::box(at, at + Vec3d{0.5, 1, 0.5})));
  }
  for (const Vec3d low : {Vec3d{42, 0, 42}, Vec3d{42, 0, 48}}) {
    need(edits.add_obstacle(Prism::box(low, low + Vec3d{6, 2, 0.3})));
  }
  for (const Vec3d low : {Vec3d{42, 0, 42}, Vec3d{48, 0, 42}}) {
    need(edits.add_obstacle(Prism::box(low, low + Vec3d{0.3, 2, 6.3})));
  }
  const PathQuery query{.from = Vec3d{2, 0, 2}, .to = Vec3d{45, 0, 45}, .nearest = false};
  Path path;
  finder.find(query, path);
  EXPECT_EQ(path.end, PathEnd::kUnreachable);
  EXPECT_TRUE(path.points.empty());
  finder.begin(query);
  while (!finder.advance(100, path)) continue;
  EXPECT_EQ(path.end, PathEnd::kUnreachable);
  EXPECT_LE(path.nodes, 4096u);
}

}  // namespace
}  // namespace throng
