// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "crowd/ground/ground_slope.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>
#include <vector>

#include "baked.h"
#include "core/access.h"
#include "crowd/ground/crowd_ground.h"
#include "world/place.h"
#include "worlds.h"

namespace throng {
namespace {

using crowd::CrowdGround;
using crowd::GroundSlope;
using crowd::slope_of;
using crowd::SlopeRange;

constexpr double kCell = 0.05;  // [m]

TEST(GroundSlope, OfHeightsIsTheirRiseDividedByTheRun) {
  const std::vector<int32_t> up{0, 8, 17, 25, 33}, none{1000, 1001, 999, 1002, 1000}, one{7};
  EXPECT_FLOAT_EQ(slope_of(up, 0.1f).gradient, 0.033f / 0.4f);
  EXPECT_FALSE(slope_of(up, 0.1f).has_treads);
  const std::vector<int32_t> down(up.rbegin(), up.rend());
  EXPECT_FLOAT_EQ(slope_of(down, 0.1f).gradient, -0.033f / 0.4f);
  EXPECT_EQ(slope_of(none, 0.1f).gradient, 0);
  EXPECT_EQ(slope_of(one, 0.1f).gradient, 0);
  EXPECT_EQ(slope_of({}, 0.1f).gradient, 0);
}

TEST(GroundSlope, TwoRisersBetweenTreadsAreStairs) {
  const auto has_treads = [](const std::vector<int32_t>& heights) {
    const std::vector<int32_t> back(heights.rbegin(), heights.rend());
    const bool up = slope_of(heights, 0.1f).has_treads, down = slope_of(back, 0.1f).has_treads;
    EXPECT_EQ(up, down);
    return up;
  };
  EXPECT_TRUE(has_treads({0, 0, 0, 170, 170, 170, 340, 340}));
  EXPECT_TRUE(has_treads({0, 120, 120, 121, 119, 240}));
  EXPECT_TRUE(has_treads({0, 0, 80, 170, 170, 260, 340, 340})) << "edges over two heights";
  EXPECT_TRUE(has_treads({0, 170, 340, 340})) << "treads as narrow as the heights are apart";
  EXPECT_FALSE(has_treads({0, 0, 0, 150, 150, 150, 150})) << "a kerb";
  EXPECT_FALSE(has_treads({0, 0, 60, 120, 180, 240, 300, 300})) << "a steep ramp";
  EXPECT_FALSE(has_treads({0, 150, 150, 150, 0, 0})) << "up and down again";
  EXPECT_FALSE(has_treads({0, 0, 30, 30, 60, 60})) << "roughness";
}

// Over the middle of its cell.
GroundSlope slope_at(const World& world, const CrowdGround& ground, Vec3d at,
                     steer::Plane direction) {
  const Place place = world.find_place(0, at, 0.5);
  const auto point = world::ground_point(*data_of(world), place);
  EXPECT_TRUE(point);
  return ground.slope_along(place.level1 - 1, *point, direction);
}

bool is_level_around(const World& world, const CrowdGround& ground, Vec3d at) {
  const Place place = world.find_place(0, at, 0.5);
  return ground.is_level_around(place.level1 - 1, *world::ground_point(*data_of(world), place));
}

CrowdGround ground_of(const World& world) {
  auto ground = CrowdGround::create(*data_of(world), 0, 400);
  EXPECT_TRUE(ground) << ground.error().message;
  return std::move(*ground);
}

TEST(GroundSlope, OfARampIsThatOfTheDirection) {
  const double degrees = std::atan(1 / 12.0) * 180 / M_PI;
  const World world = test::bake(worlds::ramp(degrees, 12), kCell, {AvatarClass{}});
  const CrowdGround ground = ground_of(world);
  for (double x = 4; x < 14; x += 0.37) {  // over edges of tiles, too
    const Vec3d at{x, (x - 3) / 12, 1.5};
    EXPECT_NEAR(slope_at(world, ground, at, {1, 0}).gradient, 1 / 12.0, 0.003) << x;
    EXPECT_NEAR(slope_at(world, ground, at, {-1, 0}).gradient, -1 / 12.0, 0.003) << x;
    EXPECT_NEAR(slope_at(world, ground, at, {0, 1}).gradient, 0, 0.003) << x;
    EXPECT_NEAR(slope_at(world, ground, at, {0.6f, 0.8f}).gradient, 0.6 / 12, 0.01) << x;
    EXPECT_FALSE(slope_at(world, ground, at, {1, 0}).has_treads) << x;
    EXPECT_FALSE(is_level_around(world, ground, at)) << x;
  }
}

TEST(GroundSlope, OfStairsHasTreadsWhereverABodyIsOnThem) {
  for (const double cell : {0.05, 0.1}) {
    const World world = test::bake(worlds::steps(0.17, 0.29, 20), cell, {AvatarClass{}});
    const CrowdGround ground = ground_of(world);
    for (int step = 1; step < 19; ++step) {
      const Vec3d at{3 + (step + 0.5) * 0.29, (step + 1) * 0.17, 1.5};
      for (const float aside : {0.0f, 0.4f, -0.7f}) {
        const float along = std::sqrt(1 - aside * aside);
        const GroundSlope up = slope_at(world, ground, at, {along, aside});
        const GroundSlope down = slope_at(world, ground, at, {-along, aside});
        EXPECT_TRUE(up.has_treads && down.has_treads) << cell << " m, step " << step;
        EXPECT_GT(up.gradient, 0.2f);
        EXPECT_LT(down.gradient, -0.2f);
      }
      EXPECT_FALSE(slope_at(world, ground, at, {0, 1}).has_treads) << "along a tread";
    }
  }
}

// The quick test says "level" only where no direction has a slope, and says so on most of it.
TEST(GroundSlope, GroundThatIsLevelAroundHasNoSlopeInAnyDirection) {
  const steer::Plane directions[] = {{1, 0},  {0, 1},  {0.6f, 0.8f},  {0.6f, -0.8f},
                                     {-1, 0}, {0, -1}, {-0.6f, 0.8f}, {-0.6f, -0.8f}};
  for (const Scene& scene :
       {worlds::steps(0.17, 0.3, 12), worlds::ramp(20, 8), worlds::two_floors()}) {
    const World world = test::bake(scene, 0.1, {AvatarClass{}});
    const CrowdGround ground = ground_of(world);
    int level = 0, uneven = 0;
    for (uint64_t n = 0; n < 2000; ++n) {
      const Place place = world.random_place(0, /*seed=*/1, n);
      if (!is_level_around(world, ground, place.position)) {
        ++uneven;
        continue;
      }
      ++level;
      for (const steer::Plane& direction : directions) {
        EXPECT_EQ(slope_at(world, ground, place.position, direction).gradient, 0);
      }
    }
    EXPECT_GT(level, 10);
    EXPECT_GT(uneven, 10);
  }
  const World flat = test::bake(worlds::flat(20), 0.1, {AvatarClass{}});
  const CrowdGround ground = ground_of(flat);
  for (uint64_t n = 0; n < 400; ++n) {
    EXPECT_TRUE(is_level_around(flat, ground, flat.random_place(0, 1, n).position));
  }
}

// About a metre, for all cells that worlds are baked with.
TEST(GroundSlope, TheRangeIsAboutAMetreForCellsOfAnySize) {
  for (const double cell : {0.02, 0.025, 0.05, 0.067, 0.08, 0.1, 0.15, 0.2, 0.25}) {
    const SlopeRange range = SlopeRange::of_cell(cell);
    EXPECT_LE(range.count, SlopeRange::kMaxCount);
    EXPECT_NEAR(range.spacing * cell, range.metres, 1e-6);
    EXPECT_NEAR(2.0 * range.count * range.metres, 1, 0.21) << cell;
  }
  EXPECT_EQ(SlopeRange::of_cell(5).count, 1);
}

}  // namespace
}  // namespace throng
