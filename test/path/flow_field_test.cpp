// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "baked.h"
#include "path/overlay/mesh_finder.h"
#include "throng/path.h"
#include "worlds.h"

// Flow fields against the exact search.
namespace throng {
namespace {

using test::bake;

PathFinder finder_of(const World& world, const Edits& edits = {}) {
  Context context;
  auto made =
      PathFinder::create(world, {.speedup = PathSpeedup::kOnDemand, .edits = edits}, context);
  EXPECT_TRUE(made) << made.error().message;
  return *std::move(made);
}

FlowField field(const PathFinder& finder, const std::vector<Place>& goals,
                double max_distance = 1e9) {
  Context context;
  auto made = FlowField::create(finder, goals, {.max_distance = max_distance}, context);
  EXPECT_TRUE(made) << made.error().message;
  return *std::move(made);
}

TEST(FlowField, IsAsFarAsTheNearestGoalByTheExactSearch) {
  double sum = 0, drawn = 0;
  uint64_t reached = 0, unreached = 0;
  for (const World& world :
       {bake(test::builtin({.name = "garage"}), 0.2), bake(test::builtin({.name = "church"}), 0.15),
        bake(test::builtin({.name = "maze"}), 0.2), bake(worlds::random_soup(7, 400, 12), 0.15)}) {
    Context context;
    auto exact = path::MeshFinder::create(world, {.avatar_class = 0}, context);
    ASSERT_TRUE(exact);
    std::vector<Place> goals;
    for (uint64_t n = 0; n < 3; ++n) goals.push_back(world.random_place(0, 77, n));
    FlowField flow = field(finder_of(world), goals);
    Path best, path;
    for (uint64_t n = 0; n < 150; ++n) {
      const Place from = world.random_place(0, 78, n);
      double nearest = std::numeric_limits<double>::infinity();
      for (const Place& goal : goals) {
        exact->find(from, goal, best);
        if (best.end == PathEnd::kReached) nearest = std::min(nearest, best.length);
      }
      const double distance = flow.distance(from);
      flow.find_path(from, path);
      ASSERT_EQ(std::isfinite(distance), std::isfinite(nearest));
      if (!std::isfinite(nearest)) {
        EXPECT_EQ(path.end, PathEnd::kUnreachable);
        EXPECT_FALSE(flow.next(from));
        ++unreached;
        continue;
      }
      ASSERT_EQ(path.end, PathEnd::kReached);
      EXPECT_GE(distance, nearest - 0.01);
      EXPECT_LE(distance, nearest * 1.1 + 4 * world.summary().cell);
      EXPECT_LE(path.length, distance + 1e-6);
      sum += distance / std::max(nearest, world.summary().cell);
      drawn += path.length / std::max(nearest, world.summary().cell);
      ++reached;
      for (size_t i = 1; i < path.points.size(); ++i) {
        const Vec3d step = path.points[i].position - path.points[i - 1].position;
        ASSERT_EQ(world.move(0, path.points[i - 1], step.x, step.z).end, MoveEnd::kArrived);
      }
    }
  }
  EXPECT_GT(reached, 300u);
  EXPECT_GT(unreached, 20u);
  EXPECT_LT(sum / static_cast<double>(reached), 1.02);
  EXPECT_LT(drawn / static_cast<double>(reached), 1.01);
}

// Walking from point to point, each segment a legal move, leads to a goal on a path that is no
// longer than the field's distance.
TEST(FlowField, FollowingItArrives) {
  uint64_t walked = 0;
  for (const World& world :
       {bake(test::builtin({.name = "garage"}), 0.2), bake(worlds::two_floors(), 0.1),
        bake(worlds::random_soup(7, 400, 12), 0.15)}) {
    const Place goal = world.random_place(0, 5, 0);
    Edits edits;
    PathFinder finder = finder_of(world, edits);
    ASSERT_TRUE(edits.add_obstacle(Prism::box({2, 0, 2}, {2.5, 2, 2.5})));
    if (!finder.is_free(goal)) continue;
    FlowField flow = field(finder, {goal});
    for (uint64_t n = 0; n < 100; ++n) {
      Place at = world.random_place(0, 6, n);
      const double distance = flow.distance(at);
      if (!std::isfinite(distance)) continue;
      double length = 0;
      int segments = 0;
      while (std::hypot(at.position.x - goal.position.x, at.position.z - goal.position.z) > 1e-3 ||
             at.level1 != goal.level1) {
        const Place to = flow.next(at);
        ASSERT_TRUE(to);
        const Vec3d step = to.position - at.position;
        const MoveResult move = world.move(0, at, step.x, step.z);
        ASSERT_EQ(move.end, MoveEnd::kArrived);
        ASSERT_EQ(move.place.level1, to.level1);
        length += std::hypot(step.x, step.z);
        at = to;
        ASSERT_LT(++segments, 1000);
      }
      EXPECT_LE(length, distance + 1e-3 * (segments + 1));
      ++walked;
    }
  }
  EXPECT_GT(walked, 150u);
}

// Two rooms that only links join, against searches from place to place.
TEST(FlowField, LeadsOverOffMeshLinks) {
  const World world = bake(worlds::doorway(0.2), 0.1);
  const auto at = [&](double x, double z) { return world.find_place(0, {x, 0, z}, 0.5); };
  Edits edits;
  PathFinder finder = finder_of(world, edits);
  const Place goal = at(7, 5);
  FlowField apart = field(finder, {goal});
  ASSERT_TRUE(edits.add_off_mesh_link({at(3.3, 3), at(4.7, 3), 4, false}));
  const auto cheap = edits.add_off_mesh_link({at(4.6, 1), at(3.4, 1), 0.5, true});
  ASSERT_TRUE(cheap);
  ASSERT_TRUE(edits.add_off_mesh_link({at(4.6, 5), at(3.4, 5), 1, false}));  // away from the goal
  FlowField both = field(finder, {goal});
  ASSERT_TRUE(edits.set_active(*cheap, false));
  FlowField dear = field(finder, {goal});
  ASSERT_TRUE(edits.set_active(*cheap, true));
  Path path, found;
  uint64_t compared = 0;
  for (uint64_t n = 0; n < 60; ++n) {
    const Place from = world.random_place(0, 5, n);
    const bool beyond = from.position.x < 4;
    EXPECT_EQ(std::isfinite(apart.distance(from)), !beyond);
    finder.find(from, goal, path);
    ASSERT_EQ(path.end, PathEnd::kReached);
    EXPECT_LT(both.distance(from), path.cost * 1.1 + 0.05);
    EXPECT_GT(both.distance(from), path.cost * 0.99 - 0.05);
    both.find_path(from, found);
    ASSERT_EQ(found.end, PathEnd::kReached);
    EXPECT_EQ(found.links.size(), path.links.size());
    EXPECT_NEAR(found.cost, path.cost, 0.1 * path.cost);
    if (!beyond) continue;
    EXPECT_EQ(found.links.size(), 1u);
    EXPECT_GE(dear.distance(from), both.distance(from) - 1e-9);
    EXPECT_GT(dear.distance(from), 4 + 3);
    // Step by step, over the link too.
    Place here = from;
    for (int step = 0; step < 100 && here.position.x < 4; ++step) here = both.next(here);
    EXPECT_GT(here.position.x, 4);
    ++compared;
  }
  EXPECT_GT(compared, 15u);
}

// Avatars stop short of a local target, so the end of a link is the next one beside its start, too.
TEST(FlowField, BesideTheStartOfALinkItsEndIsNext) {
  const World world = bake(worlds::doorway(0.2), 0.1);
  const auto at = [&](double x, double z) { return world.find_place(0, {x, 0, z}, 0.5); };
  const auto off = [](const Place& a, const Place& b) {
    return std::hypot(a.position.x - b.position.x, a.position.z - b.position.z);
  };
  // Over the wall, on from where that one ends, and one that costs too much.
  const std::vector<OffMeshLink> links{{at(3.3, 3), at(4.7, 3), 2, false},
                                       {at(4.7, 3), at(7, 1), 0.1, false},
                                       {at(3.3, 5), at(7, 5), 9, true}};
  Edits edits;
  PathFinder finder = finder_of(world, edits);
  for (const OffMeshLink& link : links) ASSERT_TRUE(edits.add_off_mesh_link(link));
  const Place goal = at(7.2, 1);
  FlowField flow = field(finder, {goal});
  EXPECT_LT(off(flow.next(links[0].from), links[0].to), 1e-3);
  EXPECT_LT(off(flow.next(links[0].to), links[1].to), 1e-3) << "on by the second link";
  EXPECT_LT(off(flow.next(links[1].to), goal), 1e-3);
  for (const double dx : {-0.06, 0.0, 0.06}) {
    for (const double dz : {-0.06, 0.0, 0.06}) {
      EXPECT_LT(off(flow.next(at(3.3 + dx, 3 + dz)), links[0].to), 1e-3) << dx << ", " << dz;
    }
  }
  EXPECT_LT(off(flow.next(at(3.3, 3.4)), links[0].from), 1e-3) << "not there yet";
  // One that stops a little before each local target arrives all the same.
  uint64_t crossed = 0;
  for (uint64_t n = 0; n < 40; ++n) {
    Place here = world.random_place(0, 5, n);
    const bool crosses = here.position.x < 4;
    for (int step = 0; step < 60 && off(here, goal) > 0.1; ++step) {
      const Place next = flow.next(here);
      ASSERT_TRUE(next);
      const double far = off(here, next);
      const double t = far > 0.05 ? (far - 0.05) / far : 0;
      const Vec3d to = here.position + (next.position - here.position) * t;
      here = at(to.x, to.z);
      ASSERT_TRUE(here);
    }
    EXPECT_LE(off(here, goal), 0.1) << n;
    crossed += crosses;
  }
  EXPECT_GT(crossed, 10u);
}

TEST(FlowField, StopsWhereAsked) {
  const World world = bake(worlds::flat(30), 0.2);
  const Place goal = world.find_place(0, {3, 0, 3}, 0.5);
  FlowField near = field(finder_of(world), {goal}, 5), far = field(finder_of(world), {goal});
  const Place close = world.find_place(0, {5, 0, 3}, 0.5),
              off = world.find_place(0, {27, 0, 27}, 0.5);
  EXPECT_NEAR(near.distance(close), 2, 1e-3);
  EXPECT_FALSE(std::isfinite(near.distance(off)));
  EXPECT_NEAR(far.distance(off), std::hypot(24, 24), 0.7);
  EXPECT_LT(near.summary().points, far.summary().points);
  FlowField copy = far;
  EXPECT_EQ(copy.distance(off), far.distance(off));
  // Also beside the goal, where nothing but the last stretch is too long.
  const Place beside = world.find_place(0, {9, 0, 3}, 0.5);
  EXPECT_NEAR(far.distance(beside), 6, 0.1);
  EXPECT_FALSE(std::isfinite(near.distance(beside)));
  EXPECT_FALSE(near.next(beside));
  Path path;
  near.find_path(beside, path);
  EXPECT_EQ(path.end, PathEnd::kUnreachable);
}

TEST(FlowField, RefusesNonsense) {
  const World world = bake(worlds::flat(6), 0.2);
  const PathFinder finder = finder_of(world);
  Context context;
  EXPECT_FALSE(FlowField::create(finder, {}, {}, context));
  const std::vector<Place> nowhere(2);
  EXPECT_FALSE(FlowField::create(finder, nowhere, {}, context));
  const std::vector<Place> goals{world.find_place(0, {3, 0, 3}, 0.5)};
  EXPECT_FALSE(FlowField::create(finder, goals, {.max_distance = -1}, context));
  context.cancel = true;
  EXPECT_FALSE(FlowField::create(finder, goals, {}, context));
  context.cancel = false;
  auto flow = FlowField::create(finder, goals, {}, context);
  ASSERT_TRUE(flow);
  EXPECT_FALSE(flow->next({}));
  EXPECT_FALSE(std::isfinite(flow->distance({{1e300, 0, 0}, 1})));
  EXPECT_EQ(flow->next(goals[0]).level1, goals[0].level1);
}

}  // namespace
}  // namespace throng
