// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "view/density_brush.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "core/random.h"

// Pixels of painted maps, and how often points are drawn.
namespace throng {
namespace {

const Box3d kBounds{{-10, 0, -4}, {30, 9, 16}};

TEST(DensityBrush, PaintsADiscOfPixelsAndWipesItAway) {
  std::vector<DensityMap> maps;
  DensityMap& map = view::map_at(maps, kBounds, 3);
  EXPECT_TRUE(view::paint(map, {5, 3, 6}, 3, 200));
  EXPECT_FALSE(view::paint(map, {5, 3, 6}, 3, 200));  // No change.
  size_t painted = 0;
  for (const uint8_t weight : map.weights) painted += weight == 200 ? 1 : 0;
  const double area = (map.x1 - map.x0) / map.width * (map.z1 - map.z0) / map.height;
  EXPECT_NEAR(static_cast<double>(painted) * area, 3.14159 * 9, 1.5);
  EXPECT_FALSE(view::paint(map, {5, 6, 6}, 3, 0));  // Another storey.
  EXPECT_TRUE(view::paint(map, {5, 3, 6}, 4, 0));
  EXPECT_TRUE(view::WeightedPlaces(maps).empty());
  EXPECT_FALSE(view::paint(map, {200, 3, 6}, 4, 90));  // Beside the map.
}

TEST(DensityBrush, ASmallBrushPaintsThePixelItIsOn) {
  DensityMap map{.name = "m",
                 .x0 = 0,
                 .z0 = 0,
                 .x1 = 100,
                 .z1 = 100,
                 .width = 10,
                 .height = 10,
                 .weights = {}};
  map.weights.assign(100, 0);
  EXPECT_TRUE(view::paint(map, {34, 0, 76}, 0.1, 7));
  EXPECT_EQ(map.weights[73], 7);
}

TEST(DensityBrush, StoreysHaveMapsOfTheirOwn) {
  std::vector<DensityMap> maps;
  view::paint(view::map_at(maps, kBounds, 0), {0, 0, 0}, 1, 9);
  view::paint(view::map_at(maps, kBounds, 3), {0, 3, 0}, 1, 90);
  view::paint(view::map_at(maps, kBounds, 3.4), {9, 3.4, 9}, 1, 90);
  view::paint(view::map_at(maps, kBounds, 1.5), {9, 1.5, 9}, 1,
              50);  // Between the two: no overlap.
  ASSERT_EQ(maps.size(), 3U);
  const view::WeightedPlaces places(maps);
  EXPECT_EQ(places.weight_at({0, 0.2, 0}), 9);
  EXPECT_EQ(places.weight_at({0, 3, 0}), 90);
  EXPECT_EQ(places.weight_at({9, 1.5, 9}), 50);
  EXPECT_EQ(places.weight_at({9, 0, 9}), 0);
  EXPECT_EQ(places.weight_at({500, 0, 0}), 0);
}

TEST(DensityBrush, PlacesAreDrawnAsOftenAsTheirWeightsSay) {
  std::vector<DensityMap> maps(2);
  maps[0] = {.name = "a",
             .x0 = 0,
             .z0 = 0,
             .x1 = 3,
             .z1 = 1,
             .low = 0,
             .high = 2,
             .width = 3,
             .height = 1,
             .weights = {}};
  maps[0].weights = {1, 0, 3};
  maps[1] = {.name = "b",
             .x0 = 0,
             .z0 = 0,
             .x1 = 1,
             .z1 = 2,
             .low = 4,
             .high = 6,
             .width = 1,
             .height = 2,
             .weights = {}};
  maps[1].weights = {0, 4};
  const view::WeightedPlaces places(maps);
  std::map<std::array<int, 3>, int> seen;
  constexpr int kDraws = 80000;
  for (uint64_t n = 0; n < kDraws; ++n) {
    const auto p = places.draw(random_unit(3, 0, n), random_unit(3, 1, n), random_unit(3, 2, n));
    EXPECT_EQ(p.vertical_tolerance, 1);
    ++seen[{static_cast<int>(p.at.x), static_cast<int>(p.at.y), static_cast<int>(p.at.z)}];
  }
  ASSERT_EQ(seen.size(), 3U);
  // Within four standard deviations.
  const auto near = [&](std::array<int, 3> where, double share) {
    EXPECT_NEAR(seen[where], share * kDraws, 4 * std::sqrt(share * (1 - share) * kDraws));
  };
  near({0, 1, 0}, 1.0 / 8);
  near({2, 1, 0}, 3.0 / 8);
  near({0, 5, 1}, 4.0 / 8);
}

}  // namespace
}  // namespace throng
