// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <thread>
#include <vector>

#include "baked.h"
#include "path/air/flight_finder.h"
#include "path/edits/ground_finder.h"
#include "path/overlay/mesh_finder.h"
#include "path/overlay/node_finder.h"
#include "throng/path.h"
#include "throng/world.h"

// Copies of all finders that answer in many threads at once.
namespace throng {
namespace {

using Answers = std::vector<double>;

constexpr uint64_t kPairs = 12;

void add(Answers& answers, const Vec3d& p) {
  for (const double value : {p.x, p.y, p.z}) answers.push_back(value);
}

void add(Answers& answers, const Path& path) {
  answers.push_back(path.length);
  for (const Place& p : path.points) add(answers, p.position);
}

template <class T>
T need(Result<T> made) {
  EXPECT_TRUE(made) << made.error().message;
  return *std::move(made);
}

// Each thread queries its own copy; all share the world, its zones, and what the finders have in
// common.
TEST(Finders, CopiesAnswerTheSameInManyThreadsAtOnce) {
  Context context;
  const Scene scene = test::builtin({.name = "garage", .size = 45, .levels = 2});
  std::vector<AvatarClass> classes = {{.name = "adult"}, flyer_class()};
  const World world = test::bake(scene, 0.25, classes);
  const Nodes nodes = need(Nodes::create(world, scene, {}, context));
  path::MeshFinder search = need(path::MeshFinder::create(world, {}, context));
  path::MeshFinder labels =
      need(path::MeshFinder::create(world, {.speedup = PathSpeedup::kLabels}, context));
  path::GroundFinder live = need(path::GroundFinder::create(world, {}));
  path::NodeFinder over_nodes = need(path::NodeFinder::create(nodes, {}, context));
  path::FlightFinder flight = need(path::FlightFinder::create(world, {.avatar_class = 1}, context));
  const auto from = [&](uint64_t n) { return world.random_place(0, 7, 2 * n); };
  const auto to = [&](uint64_t n) { return world.random_place(0, 7, 2 * n + 1); };
  // The first thread to get here adds a crate to its own copy: the others must not see it.
  const auto ask_all = [&](path::MeshFinder by_search, path::MeshFinder by_labels,
                           path::GroundFinder on_live, path::NodeFinder on_nodes,
                           path::FlightFinder in_air, bool crate) {
    GroundQuery query = need(GroundQuery::create(world, 0));
    Answers answers;
    Path path;
    Path node_path;
    Path flown;
    if (crate) {
      const Vec3d at = from(0).position;
      const Prism box = Prism::box({at.x, at.y + 0.1, at.z}, {at.x + 2, at.y + 2, at.z + 2});
      on_live.add_obstacle({box});
      on_nodes.add_obstacle({box});
      in_air.add_obstacle({box});
    }
    for (uint64_t n = 0; n < kPairs; ++n) {
      by_search.find(from(n), to(n), path);
      add(answers, path);
      by_labels.find(from(n), to(n), path);
      add(answers, path);
      on_live.find(from(n), to(n), path);
      add(answers, path);
      on_nodes.find(on_nodes.find_place(from(n).position, 1),
                    on_nodes.find_place(to(n).position, 1), node_path);
      answers.push_back(node_path.cost);
      for (const NodePlace& p : node_path.node_places) add(answers, p.feet);
      in_air.find({.from = from(n).position, .to = to(n).position}, flown);
      answers.push_back(flown.length);
      for (const Place& p : flown.points) add(answers, p.position);
      add(answers, query.ray(from(n), 3, 2).place.position);
      add(answers, query.slide(from(n), 3, 2).position);
      answers.push_back(query.nearest_wall(from(n), 3).distance);
      add(answers, query.random_place_near(from(n), 4, 5, n).position);
    }
    return answers;
  };
  const Answers alone = ask_all(search, labels, live, over_nodes, flight, false);
  const Answers crated = ask_all(search, labels, live, over_nodes, flight, true);
  EXPECT_NE(alone, crated);
  EXPECT_GT(alone.size(), kPairs * 30);
  constexpr size_t kThreads = 4;
  std::vector<Answers> found(kThreads);
  std::vector<std::thread> threads;
  for (size_t t = 0; t < kThreads; ++t) {
    threads.emplace_back([&, t, by_search = search, by_labels = labels, on_live = live,
                          on_nodes = over_nodes, in_air = flight]() mutable {
      found[t] = ask_all(std::move(by_search), std::move(by_labels), std::move(on_live),
                         std::move(on_nodes), std::move(in_air), t == 0);
    });
  }
  for (std::thread& thread : threads) thread.join();
  for (size_t t = 0; t < kThreads; ++t) EXPECT_EQ(found[t], t == 0 ? crated : alone) << t;
}

// One Path is reused for all finders: what one gives does not show in what the next gives.
TEST(Finders, APathHasTheSameShapeWhicheverFinderGivesIt) {
  Context context;
  const Scene scene = test::builtin({.name = "garage", .size = 45, .levels = 2});
  std::vector<AvatarClass> classes = {{.name = "adult"}, flyer_class()};
  const World world = test::bake(scene, 0.25, classes);
  const Nodes nodes = need(Nodes::create(world, scene, {}, context));
  path::MeshFinder search = need(path::MeshFinder::create(world, {}, context));
  path::GroundFinder live = need(path::GroundFinder::create(world, {}));
  path::NodeFinder over_nodes = need(path::NodeFinder::create(nodes, {}, context));
  path::FlightFinder flight = need(path::FlightFinder::create(world, {.avatar_class = 1}, context));
  Path path;
  uint64_t reached = 0;
  const auto check = [&](const Vec3d& from, const Vec3d& to, double off, bool on_nodes) {
    if (path.end != PathEnd::kReached) return;
    ++reached;
    ASSERT_EQ(path.segments.size() + 1, path.points.size());
    ASSERT_EQ(path.node_places.size(), on_nodes ? path.points.size() : 0);
    EXPECT_EQ(path.corridor.empty(), !on_nodes);
    EXPECT_LT(length(path.points.front().position - from), off);
    EXPECT_LT(length(path.points.back().position - to), off);
    // Over nodes each bump of the ground adds to the length.
    EXPECT_NEAR(path.cost, path.length, (on_nodes ? 1e-2 : 1e-3) * path.length + 1e-9)
        << "nothing costs more here";
    EXPECT_EQ(path.blocked_by, Blocker::kNone);
    EXPECT_EQ(path.spent, SpentBudget::kNone);
    for (size_t i = 0; i < path.points.size(); ++i) {
      EXPECT_NEAR(length(path.up(i)), 1, 1e-9);
      if (!on_nodes) continue;
      EXPECT_EQ(path.points[i].position, path.node_places[i].feet);
    }
  };
  for (uint64_t n = 0; n < kPairs; ++n) {
    const Place from = world.random_place(0, 7, 2 * n), to = world.random_place(0, 7, 2 * n + 1);
    over_nodes.find(over_nodes.find_place(from.position, 1), over_nodes.find_place(to.position, 1),
                    path);
    check(from.position, to.position, 0.1, true);
    search.find(from, to, path);
    check(from.position, to.position, 0.01, false);
    for (const Place& place : path.points) EXPECT_TRUE(place);
    EXPECT_EQ(path.cost, path.length);
    flight.find({.from = from.position, .to = to.position}, path);
    check(from.position, to.position, 0.1, false);
    live.find(from, to, path);
    check(from.position, to.position, 0.01, false);
    EXPECT_TRUE(path.links.empty());
  }
  EXPECT_GT(reached, 3 * kPairs);
}

}  // namespace
}  // namespace throng
