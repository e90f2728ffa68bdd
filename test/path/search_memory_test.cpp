// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <atomic>
#include <vector>

#include "baked.h"
#include "core/random.h"
#include "path/edits/ground_finder.h"
#include "path/ground/mesh.h"
#include "path/ground/search.h"
#include "path/overlay/mesh_finder.h"
#include "throng/crowd.h"
#include "throng/path.h"

// Memory budgets of searches.
namespace throng {
namespace {

// A square full of thin slabs askew: a search over intervals meets many that lead nowhere.
const World& maze() {
  constexpr double kSide = 60;
  constexpr uint64_t kSlabs = 220;
  static const World world = [] {
    Scene scene;
    const auto quad = [&](Vec3d a, Vec3d b, Vec3d c, Vec3d d) {
      const auto first = static_cast<uint32_t>(scene.positions.size());
      scene.positions.insert(scene.positions.end(), {a, b, c, d});
      scene.triangles.push_back({first, first + 1, first + 2});
      scene.triangles.push_back({first, first + 2, first + 3});
    };
    quad({0, 0, 0}, {0, 0, kSide}, {kSide, 0, kSide}, {kSide, 0, 0});
    for (uint64_t n = 0; n < kSlabs; ++n) {
      const double x = 3 + (kSide - 6) * random_unit(1, 0, n);
      const double z = 3 + (kSide - 6) * random_unit(1, 1, n);
      const double dx = 8 * random_unit(1, 2, n) - 4, dz = 8 * random_unit(1, 3, n) - 4;
      quad({x, 0, z}, {x + dx, 0, z + dz}, {x + dx, 2, z + dz}, {x, 2, z});
    }
    return test::bake(scene, 0.1, {AvatarClass{}});
  }();
  return world;
}

path::MeshFinder finder() {
  Context context;
  auto made = path::MeshFinder::create(maze(), {}, context);
  EXPECT_TRUE(made);
  return *std::move(made);
}

// The middle of a random rectangle.
path::Stop random_stop(const path::PathMesh& mesh, uint64_t n) {
  const auto r = static_cast<uint32_t>(random_below(3, 1, n, mesh.rects.size() - 1));
  const path::MeshRect& rect = mesh.rects[r];
  const auto middle = [](int64_t first, int64_t cells) {
    return (2 * first + cells) << (world::kUnitBits - 1);
  };
  path::Stop stop;
  stop.at = {middle(rect.x, rect.width), middle(rect.z, rect.depth)};
  stop.rect = r;
  return stop;
}

TEST(SearchMemory, APathIsTheSameWhateverMemoryIsLeftAsLongAsItIsEnough) {
  path::MeshFinder paths = finder();
  Path whole, path;
  uint64_t found = 0, budget_exhausted = 0;
  for (uint64_t n = 0; n < 60; ++n) {
    SCOPED_TRACE(testing::Message() << "pair " << n);
    const Place from = maze().random_place(0, 5, 2 * n), to = maze().random_place(0, 5, 2 * n + 1);
    paths.find(from, to, whole);
    ASSERT_EQ(whole.spent, SpentBudget::kNone);
    if (whole.end != PathEnd::kReached) continue;
    for (uint64_t bytes = uint64_t{1} << 10; bytes <= uint64_t{1} << 24; bytes *= 2) {
      paths.find(from, to, path, {UINT64_MAX, nullptr, bytes});
      if (path.end == PathEnd::kBudgetExhausted) {
        EXPECT_EQ(path.spent, SpentBudget::kMemory);
        EXPECT_TRUE(path.points.empty());
        ++budget_exhausted;
        continue;
      }
      ASSERT_EQ(path.end, PathEnd::kReached);
      EXPECT_EQ(path.spent, SpentBudget::kNone);
      EXPECT_EQ(path.length, whole.length);
      EXPECT_EQ(path.nodes, whole.nodes);
      ++found;
    }
  }
  EXPECT_GT(found, 100u);
  EXPECT_GT(budget_exhausted, 20u);
}

TEST(SearchMemory, WhatIsAllocatedKeepsToTheBudget) {
  const path::MeshFinder paths = finder();
  const path::PathMesh& mesh = paths.mesh();
  path::PathSearch search;
  std::vector<uint32_t> corners;
  double length = 0;
  uint64_t most = 0, stopped = 0;
  for (uint64_t n = 0; n < 100; ++n) {
    const path::Stop from = random_stop(mesh, 2 * n), to = random_stop(mesh, 2 * n + 1);
    if (mesh.rects[from.rect].component != mesh.rects[to.rect].component) continue;
    const uint64_t bytes = uint64_t{1} << (12 + n % 8);
    path::PathSearch rebuilt;
    const path::SearchResult result =
        rebuilt.find(mesh, from, to, {UINT64_MAX, nullptr, bytes}, corners, length);
    stopped += result == path::SearchResult::kBudget ? 1 : 0;
    // Chunks of 1024 roots and nodes, and what one expansion adds.
    EXPECT_LT(rebuilt.allocated_bytes(), bytes + (uint64_t{1} << 18)) << n;
    search.find(mesh, from, to, {}, corners, length);
    most = std::max(most, search.allocated_bytes());
    EXPECT_LE(search.allocated_bytes(), path::PathSearch::kKeptBytes);
  }
  EXPECT_GT(stopped, 5u);
  EXPECT_GT(most, 0u);
}

TEST(SearchMemory, GroundWithEditsSaysThatItHadTooLittle) {
  auto ground = path::GroundFinder::create(maze(), {});
  ASSERT_TRUE(ground);
  Path path, whole;
  uint64_t budget_exhausted = 0;
  for (uint64_t n = 0; n < 20; ++n) {
    const Place from = maze().random_place(0, 5, 2 * n), to = maze().random_place(0, 5, 2 * n + 1);
    ground->find(from, to, whole);
    EXPECT_EQ(whole.spent, SpentBudget::kNone);
    ground->find(from, to, path, {UINT64_MAX, nullptr, 1 << 12});
    if (path.end == PathEnd::kBudgetExhausted) {
      EXPECT_EQ(path.spent, SpentBudget::kMemory);
      ++budget_exhausted;
    } else {
      EXPECT_EQ(path.end, whole.end);
      EXPECT_EQ(path.length, whole.length);
    }
    ground->find(from, to, path, 1);
    if (path.end == PathEnd::kBudgetExhausted) {
      EXPECT_EQ(path.spent, SpentBudget::kNodes);
    }
    std::atomic<bool> stop{true};
    ground->find(from, to, path, {UINT64_MAX, &stop});
    EXPECT_EQ(path.end, PathEnd::kBudgetExhausted);
    EXPECT_EQ(path.spent, SpentBudget::kCancelled);
  }
  EXPECT_GT(budget_exhausted, 5u);
}

TEST(SearchMemory, GroundThatIsMadeOnDemandCountsIfAsked) {
  const auto make = [](bool counts) {
    Context context;
    auto made = PathFinder::create(
        maze(), {.speedup = PathSpeedup::kOnDemand, .counts_ground = counts}, context);
    EXPECT_TRUE(made);
    return *std::move(made);
  };
  PathFinder plain = make(false), counted = make(true);
  int lacked = 0, found = 0;
  for (uint64_t n = 0; n < 60; ++n) {
    const Place from = maze().random_place(0, 5, 2 * n), to = maze().random_place(0, 5, 2 * n + 1);
    Path all, path;
    plain.find({.from = from, .to = to, .nearest = true}, all);
    // Each budget is asked of the same finder, so what it has made is forgotten in between.
    for (const uint64_t bytes : {uint64_t{20} << 10, uint64_t{200} << 10, uint64_t{64} << 20}) {
      counted.find(
          {.from = from, .to = to, .nearest = true, .budget = {UINT64_MAX, nullptr, bytes}}, path);
      if (path.end == PathEnd::kBudgetExhausted) {
        EXPECT_EQ(path.spent, SpentBudget::kMemory);
        EXPECT_LT(bytes, uint64_t{64} << 20);
        ++lacked;
        continue;
      }
      EXPECT_EQ(path.end, all.end);
      if (bytes == uint64_t{64} << 20) {
        EXPECT_EQ(path.length, all.length);
        ++found;
      } else {  // Over points, which takes less memory, it may be a little longer.
        EXPECT_LE(path.length, all.length * 1.05 + 0.01);
      }
    }
  }
  EXPECT_EQ(found, 60);
  EXPECT_GT(lacked, 30);
}

TEST(SearchMemory, AQueryInPartsBeginsWithoutTheGroundOfThoseBefore) {
  const auto make = [] {
    Context context;
    auto made = PathFinder::create(
        maze(), {.speedup = PathSpeedup::kOnDemand, .counts_ground = true}, context);
    EXPECT_TRUE(made);
    return *std::move(made);
  };
  const auto find_in_parts = [](PathFinder& finder, const Place& from, const Place& to,
                                uint64_t bytes) {
    Path path;
    finder.begin({.from = from, .to = to, .budget = {UINT64_MAX, nullptr, bytes}});
    while (!finder.advance(100, path)) {
    }
    return path;
  };
  int near = 0;
  PathFinder used = make();
  for (uint64_t n = 0; n < 40; ++n) {
    const Place from = maze().random_place(0, 9, n), far = maze().random_place(0, 10, n);
    const Place to = maze().move(0, from, 1, 1).place;
    PathFinder fresh = make();
    constexpr uint64_t kLittle = uint64_t{200} << 10;
    const Path alone = find_in_parts(fresh, from, to, kLittle);
    if (alone.end != PathEnd::kReached) continue;
    ++near;
    Path path;
    used.find({.from = from, .to = far, .budget = {UINT64_MAX, nullptr, uint64_t{64} << 20}}, path);
    const Path after = find_in_parts(used, from, to, kLittle);
    EXPECT_EQ(after.end, PathEnd::kReached);
    EXPECT_EQ(after.length, alone.length);
  }
  EXPECT_GT(near, 20);
}

TEST(SearchMemory, ACrowdRefusesLessThanOneMebibyteAndCountsWhatItLacked) {
  auto refused = Crowd::create(maze(), {.search_bytes = 1000});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().message, "crowd: search_bytes must be 1048576 (1 MiB) or more");
  auto crowd = Crowd::create(maze(), {.search_bytes = uint64_t{1} << 20});
  ASSERT_TRUE(crowd);
  Context context;
  const auto ids = crowd->scatter(20, {}, context);
  ASSERT_TRUE(ids) << ids.error().message;
  std::vector<Place> goals;
  for (uint64_t n = 0; n < ids->size(); ++n) goals.push_back(maze().random_place(0, 1, n));
  crowd->set_goals(*ids, goals);
  const CrowdReport report = crowd->step();
  EXPECT_GT(report.planned, 0u);
  EXPECT_LE(report.out_of_memory, report.planned);
  const double parts = report.seconds_plan + report.seconds_sort + report.seconds_steer +
                       report.seconds_commit + report.seconds_settle + report.seconds_obstacles +
                       report.seconds_events;
  EXPECT_LE(parts, report.seconds_total);
  EXPECT_GT(parts, 0.5 * report.seconds_total);
}

}  // namespace
}  // namespace throng
