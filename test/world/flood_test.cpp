// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "flood.h"

#include <gtest/gtest.h>

#include "throng/bake.h"
#include "throng/scene.h"
#include "worlds.h"

// On foot through baked worlds: what is joined by stairs and ramps is reached, what is not is not.
namespace throng {
namespace {

World bake(const Scene& scene, double cell = 0.1) {
  Context context;
  const auto world = bake_world(scene, {.cell = cell, .classes = {AvatarClass{}}}, context);
  EXPECT_TRUE(world) << world.error().message;
  return world ? *world : World{};
}

World bake(const BuiltinWorldConfig& config, double cell = 0.1) {
  const auto scene = create_builtin_world(config);
  EXPECT_TRUE(scene) << scene.error().message;
  return scene ? bake(*scene, cell) : World{};
}

struct Storey {
  double height;
  double area;  // At least so much of it is reached. [m^2]
};

// Floods `world` from `start` by climbs and descents of at most a step.
void expect_reached(const World& world, Vec3d start, std::initializer_list<Storey> storeys) {
  const Flood flood = flood_from(world, 0, start);
  EXPECT_LE(flood.steepest, 0.4 + 1e-9);
  for (const Storey& storey : storeys) {
    EXPECT_GT(flood.around(storey.height), storey.area) << "at " << storey.height << " m";
  }
}

TEST(Flood, SmallWorldsAreJoinedWhereTheirNamesSayAndOnlyThere) {
  expect_reached(bake(worlds::two_floors()), {1, 0, 4}, {{0, 20}, {3, 18}});
  expect_reached(bake(worlds::steps(0.17, 0.3, 10)), {1, 0, 1.5}, {{0, 4}, {1.7, 4}});
  expect_reached(bake(worlds::ramp(20, 4)), {1, 0, 1.5}, {{0, 4}, {1.456, 4}});
  EXPECT_EQ(flood_from(bake(worlds::steps(0.5, 0.5, 4)), 0, {1, 0, 1.5}).around(2), 0);
  EXPECT_EQ(flood_from(bake(worlds::ramp(50, 4)), 0, {1, 0, 1.5}).around(4.767), 0);
  EXPECT_GT(flood_from(bake(worlds::doorway(1.0)), 0, {1, 0, 3}).area, 30);
  EXPECT_LT(flood_from(bake(worlds::doorway(0.45)), 0, {1, 0, 3}).area, 20);
  EXPECT_GT(flood_from(bake(worlds::low_ceiling(2.0)), 0, {1, 0, 2}).area, 30);
  EXPECT_LT(flood_from(bake(worlds::low_ceiling(1.7)), 0, {1, 0, 2}).area, 14);
}

TEST(Flood, EveryFloorOfTheGarageIsReachedFromTheGate) {
  const World garage = bake({.name = "garage"});
  expect_reached(garage, {14, 0, 8}, {{0, 1400}, {2.9, 1400}, {5.8, 1400}, {8.7, 1600}});
}

TEST(Flood, BothTerracesAreReachedByTheStairsAndRampsMadeForIt) {
  expect_reached(bake({.name = "stairs"}), {-3, 0, 3}, {{0, 1300}, {3.06, 300}, {6.12, 200}});
}

TEST(Flood, TheBridgeIsReachedFromTheRoadBelowItAndFromItsEnds) {
  expect_reached(bake({.name = "bridge"}), {3, 0, 30}, {{0, 6000}, {5.21, 200}});
}

TEST(Flood, GalleriesLoftAndTowerOfTheChurchAreReached) {
  expect_reached(bake({.name = "church"}), {-4, 0, 0},
                 {{0, 1000}, {0.34, 80}, {5.2, 200}, {10.4, 30}, {15.6, 3}});
}

TEST(Flood, EveryFloorOfThePowerplantIsReached) {
  expect_reached(bake({.name = "powerplant", .size = 24, .levels = 5}), {-3, 0, -3},
                 {{0, 900}, {3.5, 300}, {7, 300}, {10.5, 300}, {14, 300}, {17.5, 300}});
}

TEST(Flood, EveryLevelOfTheMazeIsReached) {
  expect_reached(bake({.name = "maze", .size = 30, .levels = 4}), {1, 0, 1},
                 {{0, 300}, {3.06, 200}, {6.12, 200}, {9.18, 200}});
}

// Houses have storeys at 0.15, 3.32, 6.52 and 9.72 m, the canal a towpath at -2.6 m; the underpass
// is 2.88 m deep.
TEST(Flood, HousesTowpathAndUnderpassOfTheCityAreReachedFromTheStreet) {
  expect_reached(bake({.name = "city", .size = 375}, 0.15), {1.5, 0, 1.5},
                 {{0, 5000},
                  {0.12, 50000},
                  {0.15, 9000},
                  {3.32, 6000},
                  {6.52, 2000},
                  {9.72, 500},
                  {-2.6, 500},
                  {-2.88, 10}});
}

}  // namespace
}  // namespace throng
