// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "path/edits/density_cells.h"

#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "baked.h"
#include "core/random.h"
#include "density_picture.h"
#include "path/edits/ground_finder.h"
#include "throng/path.h"
#include "worlds.h"

// Ground as a density map makes it, beside the map's own pixels.
namespace throng {
namespace {

using path::DensityCells;
using path::GroundFinder;
using test::DensityPicture;

// Blots of random weights, a third of them 0.
DensityPicture blots(uint64_t seed) {
  return {30, 30, 1, [&](double x, double z) {
            const auto blot = static_cast<uint64_t>(x / 3) * 16 + static_cast<uint64_t>(z / 3);
            const double number = random_unit(seed, 1, blot);
            return number < 0.33 ? 0 : static_cast<int>(number * 255);
          }};
}

std::shared_ptr<const DensityCells> cells_of(const DensityPicture& picture) {
  return std::make_shared<const DensityCells>(DensityGrid{.x0 = 0,
                                                          .z0 = 0,
                                                          .x1 = 30,
                                                          .z1 = 30,
                                                          .width = picture.width,
                                                          .height = picture.height,
                                                          .weights = picture.weights});
}

World crates() {
  Scene scene = worlds::flat(30);
  scene.add_box({8, 0, 8}, {12, 2, 10});
  scene.add_box({20, 0, 3}, {21, 2, 18});
  return test::bake(scene, 0.1);
}

GroundFinder finder_of(const World& world) {
  auto made = GroundFinder::create(world, {.avatar_class = 0});
  EXPECT_TRUE(made) << made.error().message;
  return *std::move(made);
}

TEST(DensityCells, GroundIsFreeWhereNoPixelOfWeight0TouchesTheCell) {
  const World world = crates();
  for (uint64_t seed = 1; seed <= 3; ++seed) {
    const DensityPicture picture = blots(seed);
    GroundFinder finder = finder_of(world);
    finder.set_density(cells_of(picture));
    int open = 0, shut = 0;
    for (uint64_t n = 0; n < 2000; ++n) {
      const Place place = world.random_place(0, seed, n);
      const Vec3d& at = place.position;
      const bool is_free = finder.is_free(place);
      if (picture.weight(at.x, at.z) == 0) {
        ASSERT_FALSE(is_free) << at.x << " " << at.z;
      } else if (!picture.is_beside_zero(at)) {
        ASSERT_TRUE(is_free) << at.x << " " << at.z;
      }
      ++(is_free ? open : shut);
    }
    EXPECT_GT(open, 500);
    EXPECT_GT(shut, 300);
  }
}

TEST(DensityCells, AMapThatChangesGivesThePathsOfANewFinder) {
  const World world = crates();
  GroundFinder finder = finder_of(world);
  Path path, expected;
  for (uint64_t seed = 1; seed <= 8; ++seed) {
    DensityPicture picture = blots(seed / 2);
    // Every other time only a corner changes.
    if (seed % 2 == 1) {
      for (size_t i = 0; i < 95; ++i) picture.weights[i] = 200;
    }
    const auto cells = seed == 8 ? nullptr : cells_of(picture);
    finder.set_density(cells);
    GroundFinder fresh = finder_of(world);
    fresh.set_density(cells);
    int reached = 0;
    for (uint64_t n = 0; n < 60; ++n) {
      const Place from = world.random_place(0, seed, 2 * n),
                  to = world.random_place(0, seed, 2 * n + 1);
      finder.find(from, to, path);
      fresh.find(from, to, expected);
      ASSERT_EQ(path.end, expected.end) << "map " << seed << ", path " << n;
      ASSERT_EQ(path.cost, expected.cost) << "map " << seed << ", path " << n;
      ASSERT_EQ(path.points.size(), expected.points.size());
      reached += path.end == PathEnd::kReached ? 1 : 0;
    }
    GroundFinder copy = finder;
    copy.find(world.random_place(0, seed, 0), world.random_place(0, seed, 1), path);
    fresh.find(world.random_place(0, seed, 0), world.random_place(0, seed, 1), expected);
    EXPECT_EQ(path.cost, expected.cost) << "a copy";
    EXPECT_GT(reached, 5);
  }
}

TEST(DensityCells, AMetreCostsHalfAMetreMoreEachTimeThatTheWeightIsHalved) {
  const World world = test::bake(worlds::flat(12), 0.1);
  for (const auto& [given, cost] : {std::pair{160, 1.0},
                                    {81, 1.0},
                                    {80, 1.5},
                                    {41, 1.5},
                                    {40, 2.0},
                                    {20, 2.5},
                                    {10, 3.0},
                                    {1, 3.0}}) {
    const int weight = given;
    GroundFinder finder = finder_of(world);
    finder.set_density(cells_of(
        DensityPicture(30, 30, 1, [&](double x, double) { return x > 11 ? 160 : weight; })));
    Path path;
    finder.find(world.find_place(0, {2, 0, 6}, 0.5), world.find_place(0, {9, 0, 6}, 0.5), path);
    ASSERT_EQ(path.end, PathEnd::kReached);
    EXPECT_NEAR(path.cost, cost * path.length, 1e-6) << weight;
  }
}

}  // namespace
}  // namespace throng
