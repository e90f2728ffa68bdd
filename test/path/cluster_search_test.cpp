// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "path/edits/cluster_search.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <vector>

#include "baked.h"
#include "core/access.h"
#include "core/random.h"
#include "path/edits/ground_finder.h"
#include "world/zone_data.h"

// Corridors of clusters. The oracles are the exact search, and cells one by one.
namespace throng::path {
namespace {

constexpr uint64_t kNoLimit = UINT64_MAX;

TEST(Corridor, HoldsARectangleThatSharesASquare) {
  for (uint64_t n = 0; n < 2000; ++n) {
    const auto draw = [&](uint64_t k, uint64_t below) {
      return static_cast<int32_t>(random_below(3, n, k, below));
    };
    Corridor corridor(2);
    const auto square = static_cast<uint32_t>(draw(0, 16));
    corridor.add(1, square);
    const int32_t x = draw(1, kTileCells), z = draw(2, kTileCells);
    const int32_t width = 1 + draw(3, static_cast<uint64_t>(kTileCells - x));
    const int32_t depth = 1 + draw(4, static_cast<uint64_t>(kTileCells - z));
    bool shares = false;
    for (int32_t cz = z; cz < z + depth; ++cz) {
      for (int32_t cx = x; cx < x + width; ++cx) {
        shares = shares || static_cast<uint32_t>(cz / Corridor::kSide * Corridor::kAcross +
                                                 cx / Corridor::kSide) == square;
      }
    }
    const MeshRect rect{1, -5 * kTileCells + x, 3 * kTileCells + z, width, depth};
    EXPECT_EQ(corridor.holds(1, rect), shares) << n;
    EXPECT_FALSE(corridor.holds(0, rect));
    corridor.clear();
    EXPECT_FALSE(corridor.holds(1, rect));
  }
}

// Walls, pillars and platforms with ramps, at random.
Scene random_rooms(uint64_t seed) {
  Scene scene;
  scene.add_box({0, -0.5, 0}, {24, 0, 24});
  for (uint64_t n = 0; n < 40; ++n) {
    const auto draw = [&](uint64_t k, double low, double high) {
      return low + (high - low) * static_cast<double>(random_below(seed, n, k, 1000)) / 1000;
    };
    const double x = draw(0, 0, 22), z = draw(1, 0, 22);
    const bool along_x = random_below(seed, n, 2, 2) == 0;
    const double length = draw(3, 0.5, 7), high = n % 5 == 0 ? 0.3 : 2.5;
    scene.add_box({x, 0, z}, {x + (along_x ? length : 0.3), high, z + (along_x ? 0.3 : length)});
  }
  scene.add_box({3, 3, 3}, {20, 3.2, 20});  // another storey, without stairs
  return scene;
}

TEST(ClusterSearch, FindsACorridorWhereAPathIsAndTheShortestIsHardlyShorter) {
  size_t found = 0, none = 0;
  double worst = 1, sum = 0;
  for (uint64_t seed = 1; seed <= 6; ++seed) {
    const World world = test::bake(random_rooms(seed), 0.1, {AvatarClass{}});
    auto finder = GroundFinder::create(world, {});
    ASSERT_TRUE(finder) << finder.error().message;
    const GroundDelays delays(data_of(world)->level_count);
    Path shortest, path;
    for (uint64_t n = 0; n < 200; ++n) {
      const Place from = world.random_place(0, seed, 2 * n);
      const Place to = world.random_place(0, seed, 2 * n + 1);
      finder->find(from, to, shortest);
      const bool is_found = finder->find_by_delays(
          from, to, {.delays = &delays, .max_cost = 1e6, .max_clusters = kNoLimit, .budget = {}},
          path);
      ASSERT_EQ(is_found, shortest.end == PathEnd::kReached) << seed << " " << n;
      if (!is_found) {
        ++none;
        continue;
      }
      ++found;
      const double ratio = shortest.length > 1 ? path.length / shortest.length : 1;
      sum += ratio;
      worst = std::max(worst, ratio);
      EXPECT_GE(path.length, shortest.length * 0.999) << seed << " " << n;
      EXPECT_EQ(path.points.back().level1, to.level1);
    }
  }
  EXPECT_GT(found, 600u);
  EXPECT_GT(none, 50u);
  EXPECT_LT(sum / static_cast<double>(found), 1.01);
  EXPECT_LT(worst, 1.25);
}

TEST(ClusterSearch, GoesByTheGroundAsItIsNow) {
  Scene scene;  // two doors in a wall across X, at z = 2 and z = 8
  scene.add_box({0, -0.5, 0}, {10, 0, 10});
  scene.add_box({4.9, 0, 0}, {5.1, 3, 1.5});
  scene.add_box({4.9, 0, 2.5}, {5.1, 3, 7.5});
  scene.add_box({4.9, 0, 8.5}, {5.1, 3, 10});
  const World world = test::bake(scene, 0.1, {AvatarClass{}});
  auto finder = GroundFinder::create(world, {});
  ASSERT_TRUE(finder) << finder.error().message;
  const GroundDelays delays(data_of(world)->level_count);
  const Place from = world.find_place(0, {3, 0, 2}, 0.5), to = world.find_place(0, {8, 0, 2}, 0.5);
  Path path;
  const auto length = [&]() -> double {
    const bool is_found = finder->find_by_delays(
        from, to, {.delays = &delays, .max_cost = 1e6, .max_clusters = kNoLimit, .budget = {}},
        path);
    return is_found ? path.length : -1;
  };
  EXPECT_NEAR(length(), 5, 0.1);
  Solid crate;
  crate.prism = Prism::box({4.5, 0, 1}, {5.5, 1, 3});
  const ChangeId first = finder->add_obstacle(crate);
  const double around = length();
  EXPECT_GT(around, 10);
  crate.prism = Prism::box({4.5, 0, 7}, {5.5, 1, 9});
  const ChangeId second = finder->add_obstacle(crate);
  EXPECT_EQ(length(), -1);
  EXPECT_TRUE(finder->set_active(first, false));
  EXPECT_NEAR(length(), 5, 0.1);
  EXPECT_TRUE(finder->remove(second));
  EXPECT_TRUE(finder->set_active(first, true));
  EXPECT_EQ(length(), around);
  // An area that costs infinity is closed, too.
  const auto area = finder->add_area(Prism::box({4.5, -1, 7}, {5.5, 1, 9}), 7);
  ASSERT_TRUE(area);
  ASSERT_TRUE(finder->set_area_cost(7, INFINITY));
  EXPECT_EQ(length(), -1);
  ASSERT_TRUE(finder->set_area_cost(7, 1));
  EXPECT_EQ(length(), around);
}

// Two doors, and a crowd's place before the first: around it leads a path to the same door.
TEST(SameSide, PathsThroughTheSameDoorCanBeMovedOntoEachOther) {
  Scene scene;
  scene.add_box({0, -0.5, 0}, {10, 0, 10});
  scene.add_box({4.9, 0, 0}, {5.1, 3, 1.5});
  scene.add_box({4.9, 0, 2.5}, {5.1, 3, 3.5});
  scene.add_box({4.9, 0, 4.5}, {5.1, 3, 10});
  const World world = test::bake(scene, 0.1, {AvatarClass{}});
  auto finder = GroundFinder::create(world, {});
  ASSERT_TRUE(finder) << finder.error().message;
  const auto path = [&](std::initializer_list<Vec3d> points) {
    std::vector<Place> places;
    for (const Vec3d& point : points) places.push_back(world.find_place(0, point, 0.5));
    return places;
  };
  const Vec3d from{2, 0, 3}, to{8, 0, 2}, door{5, 0, 2}, other_door{5, 0, 4};
  const auto straight = path({from, door, to});
  const auto around = path({from, {1, 0, 9}, {3.5, 0, 8}, {3.5, 0, 2}, door, {6, 0, 1}, to});
  const auto other = path({from, other_door, to});
  EXPECT_TRUE(finder->is_same_side(straight, straight, true));
  EXPECT_TRUE(finder->is_same_side(straight, around, true));
  EXPECT_TRUE(finder->is_same_side(around, straight, true));
  EXPECT_FALSE(finder->is_same_side(straight, other, true));
  EXPECT_FALSE(finder->is_same_side(other, around, true));
  // A part of it, which the other goes on from.
  const auto part = path({from, door});
  EXPECT_TRUE(finder->is_same_side(part, around, false));
  EXPECT_FALSE(finder->is_same_side(part, other, false));
  EXPECT_FALSE(finder->is_same_side(path({from, other_door}), around, false));
  // No legal path is the same as none.
  EXPECT_FALSE(finder->is_same_side(path({from, to}), straight, true));
  EXPECT_FALSE(finder->is_same_side(straight, path({from, to}), true));
}

TEST(ClusterSearch, StopsAtItsBudgetAndItsHighestCost) {
  const World world = test::bake(random_rooms(1), 0.1, {AvatarClass{}});
  auto finder = GroundFinder::create(world, {});
  ASSERT_TRUE(finder) << finder.error().message;
  const GroundDelays delays(data_of(world)->level_count);
  Path path;
  size_t tried = 0;
  for (uint64_t n = 0; n < 50; ++n) {
    const Place from = world.random_place(0, 5, 2 * n), to = world.random_place(0, 5, 2 * n + 1);
    GroundFinder::DelayedSearch search{
        .delays = &delays, .max_cost = 1e6, .max_clusters = kNoLimit, .budget = {}};
    if (!finder->find_by_delays(from, to, search, path) || path.length < 8) continue;
    ++tried;
    search.max_cost = path.cost * 0.7;
    EXPECT_FALSE(finder->find_by_delays(from, to, search, path));
    EXPECT_EQ(path.end, PathEnd::kUnreachable);
    search.max_cost = 1e6;
    search.max_clusters = 2;
    EXPECT_FALSE(finder->find_by_delays(from, to, search, path));
    EXPECT_EQ(path.end, PathEnd::kBudgetExhausted);
    EXPECT_EQ(path.spent, SpentBudget::kNodes);
  }
  EXPECT_GT(tried, 10u);
}

}  // namespace
}  // namespace throng::path
