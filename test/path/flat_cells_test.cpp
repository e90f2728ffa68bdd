// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "core/random.h"
#include "grid_oracle.h"
#include "path/edits/ground_finder.h"
#include "path/overlay/mesh_finder.h"
#include "throng/bake.h"
#include "throng/path.h"

// Worlds of flat cells, against a brute-force search.
namespace throng {
namespace {

FlatCells random_cells(int32_t width, int32_t depth, uint64_t blocked_percent, uint64_t seed) {
  FlatCells cells{.width = width, .depth = depth, .passable = {}};
  for (uint64_t i = 0; i < static_cast<uint64_t>(width) * static_cast<uint64_t>(depth); ++i) {
    cells.passable.push_back(random_below(seed, 0, i, 100) < blocked_percent ? 0 : 1);
  }
  return cells;
}

World bake(const FlatCells& cells, int32_t workers = 0) {
  auto world = bake_flat_cells(cells, 1, workers);
  EXPECT_TRUE(world) << world.error().message;
  return *world;
}

TEST(FlatCells, ThePointIsLegalOnPassableCellsAndNowhereElse) {
  const FlatCells cells = random_cells(100, 70, 40, 1);
  const World world = bake(cells);
  uint64_t open = 0;
  for (int32_t z = 0; z < cells.depth; ++z) {
    for (int32_t x = 0; x < cells.width; ++x) {
      const bool passable = cells.passable[static_cast<size_t>(z * cells.width + x)] != 0;
      open += passable ? 1 : 0;
      ASSERT_EQ(static_cast<bool>(world.find_place(0, {x + 0.5, 0, z + 0.5}, 0.1)), passable)
          << x << ", " << z;
    }
  }
  EXPECT_EQ(world.summary().walkable_area[0], static_cast<double>(open));
}

// Random maps of any density: the same length as brute force, and unreachable only if nothing leads
// there.
TEST(FlatCells, PathsAreAsShortAsBruteForceFinds) {
  Context context;
  uint64_t compared = 0, unreachable = 0;
  for (uint64_t seed = 0; seed < 24; ++seed) {
    const FlatCells cells = random_cells(24, 24, 5 + 2 * seed, seed);
    const World world = bake(cells);
    auto finder = path::MeshFinder::create(world, {}, context);
    ASSERT_TRUE(finder) << finder.error().message;
    const test::GridOracle oracle(cells);
    Path path;
    for (uint64_t n = 0; n < 40; ++n) {
      int32_t at[4];
      for (uint64_t i = 0; i < 4; ++i)
        at[i] = static_cast<int32_t>(random_below(seed, n + 1, i, 24));
      const Place from = world.find_place(0, {at[0] + 0.5, 0, at[1] + 0.5}, 0.1);
      const Place to = world.find_place(0, {at[2] + 0.5, 0, at[3] + 0.5}, 0.1);
      if (!from || !to) continue;
      finder->find(from, to, path);
      const auto best =
          oracle.shortest(test::middle(at[0], at[1]), test::middle(at[2], at[3]), 1e9);
      ASSERT_EQ(path.end == PathEnd::kReached, best.has_value())
          << "seed " << seed << ", " << at[0] << "," << at[1] << " to " << at[2] << "," << at[3]
          << ": " << static_cast<int>(path.end);
      if (!best) {
        ++unreachable;
        continue;
      }
      ++compared;
      ASSERT_NEAR(path.length, *best, 1e-9) << seed << ", " << n;
    }
  }
  EXPECT_GT(compared, 300u);
  EXPECT_GT(unreachable, 30u);
}

// The cells on which the finder lets an avatar stand now.
FlatCells free_cells(path::GroundFinder& finder, const World& world, const FlatCells& baked) {
  FlatCells now = baked;
  for (int32_t z = 0; z < baked.depth; ++z) {
    for (int32_t x = 0; x < baked.width; ++x) {
      const Place place = world.find_place(0, {x + 0.5, 0, z + 0.5}, 0.1);
      now.passable[static_cast<size_t>(z * baked.width + x)] = finder.is_free(place) ? 1 : 0;
    }
  }
  return now;
}

// Crates come and go around the point where four tiles meet; after each change paths are as short
// as brute force finds them among the cells that are left.
TEST(FlatCells, PathsAroundCratesAreAsShortAsBruteForceFinds) {
  constexpr uint64_t kWidth = 72, kDepth = 70, kFirst = 52;  // tiles have 64
  uint64_t compared = 0, unreachable = 0, longer = 0;
  for (uint64_t seed = 0; seed < 14; ++seed) {
    FlatCells cells = random_cells(kWidth, kDepth, 2 + 3 * seed, seed);
    for (uint64_t c = 0; c < cells.passable.size(); ++c) {
      if (c % kWidth < kFirst || c / kWidth < kFirst) cells.passable[c] = 0;
    }
    const World world = bake(cells);
    auto finder = path::GroundFinder::create(world, {});
    ASSERT_TRUE(finder) << finder.error().message;
    const test::GridOracle baked(cells);
    std::vector<path::ChangeId> crates;
    Path path;
    for (uint64_t n = 0; n < 40; ++n) {
      const auto draw = [&](uint64_t counter, uint64_t first, uint64_t end) {
        return static_cast<int32_t>(first + random_below(seed, 100 + n, counter, end - first));
      };
      if (n % 3 == 2) {
        finder->remove(crates[static_cast<size_t>(draw(0, 0, crates.size()))]);
      } else {
        // Every second one at that point.
        const bool is_there = n % 2 == 0;
        const double x = is_there ? draw(1, 62, 65) : draw(1, kFirst, kWidth);
        const double z = is_there ? draw(2, 62, 65) : draw(2, kFirst, kDepth);
        const double wide = 0.5 + draw(3, 0, 3), deep = 0.5 + draw(4, 0, 3);
        const Prism crate = Prism::box({x, 0, z}, {x + wide, 2, z + deep});
        crates.push_back(finder->add_obstacle({crate}));
      }
      const FlatCells now = free_cells(*finder, world, cells);
      const test::GridOracle oracle(now);
      for (uint64_t q = 0; q < 6; ++q) {
        const uint64_t around = q % 2 == 0 ? 58 : kFirst;
        const int32_t ax = draw(8 * q + 10, around, kWidth), az = draw(8 * q + 11, around, kDepth);
        const int32_t bx = draw(8 * q + 12, around, kWidth), bz = draw(8 * q + 13, around, kDepth);
        if (!oracle.is_open(ax, az) || !oracle.is_open(bx, bz)) continue;
        const Place from = world.find_place(0, {ax + 0.5, 0, az + 0.5}, 0.1);
        finder->find(from, world.find_place(0, {bx + 0.5, 0, bz + 0.5}, 0.1), path);
        const auto a = test::middle(ax, az), b = test::middle(bx, bz);
        const auto best = oracle.shortest(a, b, 1e9);
        ASSERT_EQ(path.end == PathEnd::kReached, best.has_value()) << seed << ", " << n;
        if (!best) {
          ++unreachable;
          continue;
        }
        ++compared;
        ASSERT_NEAR(path.length, *best, 1e-9) << seed << ", " << n << ", " << q;
        if (*best > baked.shortest(a, b, 1e9).value_or(0) + 1e-6) ++longer;
      }
    }
  }
  EXPECT_GT(compared, 1000u);
  EXPECT_GT(unreachable, 10u);
  EXPECT_GT(longer, 100u);  // A crate stood between.
}

TEST(FlatCells, MapsThatDoNotFitAreRefused) {
  for (const FlatCells& cells : {FlatCells{}, FlatCells{.width = 2, .depth = 2, .passable = {1}},
                                 FlatCells{.width = 16001, .depth = 1, .passable = {}}}) {
    const auto world = bake_flat_cells(cells, 1);
    ASSERT_FALSE(world);
    EXPECT_EQ(world.error().code, Errc::kBadInput);
  }
  const FlatCells cells = random_cells(4, 4, 0, 1);
  EXPECT_EQ(bake_flat_cells(cells, 0).error().code, Errc::kBadConfig);
  EXPECT_EQ(bake_flat_cells(cells, 1, -1).error().code, Errc::kBadConfig);
}

TEST(FlatCells, SameWorldForAnyNumberOfWorkers) {
  const FlatCells cells = random_cells(300, 200, 30, 9);
  const World one = bake(cells, 1);
  for (const int32_t workers : {2, 3, 8}) {
    const World other = bake(cells, workers);
    ASSERT_EQ(other.level_tile_count(), one.level_tile_count());
    for (uint32_t i = 0; i < one.level_tile_count(); ++i) {
      const LevelTileContent a = one.level_tile(i), b = other.level_tile(i);
      ASSERT_EQ(a.floor, b.floor);
      ASSERT_EQ(a.clearance, b.clearance);
    }
  }
}

}  // namespace
}  // namespace throng
