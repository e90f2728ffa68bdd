// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <utility>
#include <vector>

#include "core/access.h"
#include "core/random.h"
#include "path/air/air_view.h"
#include "path/air/flight_endpoints.h"
#include "path/air/flight_finder.h"
#include "path/air/flight_space.h"
#include "path/ground/circle_flood.h"
#include "throng/bake.h"
#include "throng/path.h"
#include "throng/scene.h"
#include "throng/verify.h"
#include "voxel_oracle.h"
#include "worlds.h"

// Flight paths over built-in worlds and voxels, against an oracle of triangles.
namespace throng {
namespace {

World bake(const Scene& scene, double cell = 0.1) {
  Context context;
  auto world = bake_world(scene, {.cell = cell, .classes = {flyer_class()}}, context);
  EXPECT_TRUE(world) << world.error().message;
  return *world;
}

path::FlightFinder finder(const World& world) {
  Context context;
  auto made = path::FlightFinder::create(world, {}, context);
  EXPECT_TRUE(made) << made.error().message;
  return *std::move(made);
}

// Two floors 20 m apart, both 8 m wide: no path on foot joins them.
Scene two_floors() {
  Scene scene;
  scene.add_quad({0, 0, 0}, {0, 0, 8}, {8, 0, 8}, {8, 0, 0});
  scene.add_quad({28, 3, 0}, {28, 3, 8}, {36, 3, 8}, {36, 3, 0});
  return scene;
}

TEST(Flight, LeadsFromTheGroundThroughTheAirToTheGround) {
  const World world = bake(two_floors());
  path::FlightFinder flight = finder(world);
  Path path;
  flight.find({.from = {4, 0, 4}, .to = {32, 3, 4}}, path);
  ASSERT_EQ(path.end, PathEnd::kReached);
  ASSERT_GE(path.segments.size(), 3u);
  EXPECT_EQ(path.segments.front(), SegmentKind::kTakeOff);
  EXPECT_EQ(path.segments.back(), SegmentKind::kLand);
  for (size_t i = 1; i + 1 < path.segments.size(); ++i)
    EXPECT_EQ(path.segments[i], SegmentKind::kFly);
  EXPECT_EQ(path.points.size(), path.segments.size() + 1);
  EXPECT_NEAR(path.points.front().position.y, 0, 1e-6);
  EXPECT_NEAR(path.points.back().position.y, 3, 1e-6);
  EXPECT_LT(path.length, 1.1 * std::hypot(28, 3));
}

TEST(Flight, WalksWhereThatIsShorter) {
  const World world = bake(two_floors());
  path::FlightFinder flight = finder(world);
  Path path;
  flight.find({.from = {2, 0, 4}, .to = {6, 0, 4}}, path);
  ASSERT_EQ(path.end, PathEnd::kReached);
  EXPECT_EQ(path.segments, (std::vector<SegmentKind>{SegmentKind::kWalk}));
  EXPECT_NEAR(path.length, 4, 1e-3);
}

// Under a table 2 m high one stands but does not take off.
TEST(Flight, WalksToATakeOff) {
  Scene scene = two_floors();
  scene.add_box({1, 1.9, 1}, {7, 2.5, 7});
  const World world = bake(scene);
  path::FlightFinder flight = finder(world);
  EXPECT_FALSE(flight.take_off(world.find_place(0, {4, 0, 4}, 0.1)));
  Path path;
  flight.find({.from = {4, 0, 4}, .to = {32, 3, 4}}, path);
  ASSERT_EQ(path.end, PathEnd::kReached);
  EXPECT_EQ(path.segments.front(), SegmentKind::kWalk);
  EXPECT_EQ(path.segments.back(), SegmentKind::kLand);
}

// A hall with a door that one walks through and cannot fly through: the nearest take-off leads
// nowhere, the one outside does.
TEST(Flight, LeavesAClosedIslandOfAirOnFoot) {
  Scene scene = two_floors();
  scene.add_box({1, -0.1, 1}, {7, 6, 1.2});
  scene.add_box({1, -0.1, 6.8}, {7, 6, 7});
  scene.add_box({1, -0.1, 1}, {1.2, 6, 7});
  scene.add_box({6.8, -0.1, 1}, {7, 6, 3.45});
  scene.add_box({6.8, -0.1, 4.55}, {7, 6, 7});
  scene.add_box({6.8, 2, 3}, {7, 6, 5});
  scene.add_box({1, 5.8, 1}, {7, 6, 7});
  const World world = bake(scene);
  path::FlightFinder flight = finder(world);
  const Vec3d inside{3, 0, 3}, beyond{32, 3, 4}, above{32, 6, 4};
  ASSERT_TRUE(flight.take_off(world.find_place(0, inside, 0.1)));
  ASSERT_TRUE(flight.is_legal(above));
  const auto find = [&](Vec3d from, Vec3d to) {
    Path path;
    flight.find({.from = from, .to = to}, path);
    EXPECT_EQ(path.end, PathEnd::kReached);
    return path.segments.empty() ? std::vector<SegmentKind>{SegmentKind::kFly} : path.segments;
  };
  for (const Vec3d there : {beyond, above}) {
    const std::vector<SegmentKind> out = find(inside, there), in = find(there, inside);
    EXPECT_EQ(out.front(), SegmentKind::kWalk);
    EXPECT_EQ(in.back(), SegmentKind::kWalk);
    EXPECT_NE(std::find(out.begin(), out.end(), SegmentKind::kTakeOff), out.end());
  }
}

// Which places have a path from the ground to the air: flooded cell by cell, without a limit.
TEST(Flight, KnowsWhichGroundLeadsIntoWhichAir) {
  uint64_t reached = 0, parted = 0;
  Scene yards = two_floors();  // and two rooms without a window
  yards.add_box({10, 0, 0}, {20, 4, 8});
  yards.add_box({40, 0, 0}, {50, 4, 8});
  yards.add_quad({38, 0, -2}, {52, 0, -2}, {52, 0, 10}, {38, 0, 10});
  const Scene church = *create_builtin_world({.name = "church"});
  for (const bool yard : {true, false}) {
    const World world = bake(yard ? yards : church, 0.2);
    path::FlightFinder flight = finder(world);
    const path::FlightEndpoints ends(*data_of(world), flight.space(), 0);
    path::CircleFlood flood;
    Path path;
    std::vector<uint32_t> over;
    for (uint64_t n = 0; n < 60; ++n) {
      const Place place = world.random_place(0, 5, n);
      const auto point = flight.random_point(5, n);
      ASSERT_TRUE(place && point);
      const auto air = ends.in_air(*point);
      ASSERT_TRUE(air);
      EXPECT_FALSE(ends.components_over(place, UINT64_MAX, flood, over));
      const uint32_t of_air = flight.space().component[flight.space().box_at(*air)];
      const bool together = std::find(over.begin(), over.end(), of_air) != over.end();
      (together ? reached : parted) += 1;
      const PathEnd expected = together ? PathEnd::kReached : PathEnd::kUnreachable;
      flight.find({.from = place.position, .to = *point, .vertical_tolerance = 0.05}, path);
      EXPECT_EQ(path.end, expected) << "pair " << n;
      flight.find({.from = *point, .to = place.position, .vertical_tolerance = 0.05}, path);
      EXPECT_EQ(path.end, expected) << "pair " << n << ", back";
    }
  }
  EXPECT_GT(reached, 20u);
  EXPECT_GT(parted, 10u);
}

TEST(Flight, LandsOnTheMostOpenGroundBelow) {
  const World world = bake(two_floors());
  const path::FlightFinder flight = finder(world);
  const Place place = flight.landing({4, 6, 4});
  ASSERT_TRUE(place);
  EXPECT_NEAR(place.position.y, 0, 1e-6);
  EXPECT_TRUE(flight.take_off(place));
  EXPECT_FALSE(flight.landing({18, 6, 4}));  // over nothing
  EXPECT_FALSE(flight.landing({4, -5, 4}));
}

TEST(Flight, EndsInSolidsOrOutsideOrNowhereAreNoPlaces) {
  Scene scene = two_floors();
  scene.add_box({3, 0, 3}, {5, 4, 5});
  const World world = bake(scene);
  path::FlightFinder flight = finder(world);
  Path path;
  const Vec3d good{32, 6, 4};
  for (const Vec3d bad :
       {Vec3d{4, 2, 4}, Vec3d{2.9, 2, 4}, Vec3d{-5, 3, 4}, Vec3d{1e30, 3, 4}, Vec3d{4, 1e6, 4},
        Vec3d{4, -20, 4}, Vec3d{NAN, 3, 4}, Vec3d{4, INFINITY, 4}}) {
    EXPECT_FALSE(flight.is_legal(bad));
    flight.find({.from = good, .to = bad}, path);
    EXPECT_EQ(path.end, PathEnd::kNoPlace);
    flight.find({.from = bad, .to = good}, path);
    EXPECT_EQ(path.end, PathEnd::kNoPlace);
    EXPECT_TRUE(path.points.empty());
  }
}

TEST(Flight, ReportsUnreachableGoalsAndKeepsToItsBudget) {
  Scene scene = two_floors();
  scene.add_box({10, 0, 0}, {20, 8, 8});  // hollow: inside is air, too
  const World world = bake(scene);
  path::FlightFinder flight = finder(world);
  Path path;
  ASSERT_TRUE(flight.is_legal({15, 4, 4}));
  flight.find({.from = {15, 4, 4}, .to = {32, 6, 4}}, path);
  EXPECT_EQ(path.end, PathEnd::kUnreachable);
  flight.find({.from = {5, 5, 4}, .to = {32, 5, 4}, .budget = 3}, path);
  EXPECT_EQ(path.end, PathEnd::kBudgetExhausted);
  flight.find({.from = {5, 5, 4}, .to = {32, 5, 4}}, path);
  EXPECT_EQ(path.end, PathEnd::kReached);
  EXPECT_GT(path.nodes, 3u);
}

// Two halls with no opening in the roof: only a door for walkers leads from one to the other.
Scene two_halls(bool door) {
  Scene scene;
  scene.add_quad({0, 0, 0}, {0, 0, 8}, {20, 0, 8}, {20, 0, 0});
  for (const double x : {0.0, 9.8, 19.8}) {
    if (x != 9.8 || !door) {
      scene.add_box({x, -0.1, 0}, {x + 0.2, 6, 8});
      continue;
    }
    scene.add_box({x, -0.1, 0}, {x + 0.2, 6, 3.45});
    scene.add_box({x, -0.1, 4.55}, {x + 0.2, 6, 8});
    scene.add_box({x, 2, 3}, {x + 0.2, 6, 5});
  }
  scene.add_box({0, -0.1, 0}, {20, 6, 0.2});
  scene.add_box({0, -0.1, 7.8}, {20, 6, 8});
  scene.add_box({0, 5.8, 0}, {20, 6, 8});
  return scene;
}

TEST(Flight, LandsAndTakesOffAgainWhereOnlyTheGroundLeadsFromAirToAir) {
  const Scene scene = two_halls(true);
  const World world = bake(scene);
  path::FlightFinder flight = finder(world);
  const Vec3d here{3, 2, 4}, there{16, 3, 3};
  const path::FlightEndpoints ends(*data_of(world), flight.space(), 0);
  ASSERT_TRUE(ends.in_air(here) && ends.in_air(there));
  ASSERT_FALSE(
      path::AirView(flight.space()).same_component(*ends.in_air(here), *ends.in_air(there)));
  Path path;
  flight.find({.from = here, .to = there}, path);
  ASSERT_EQ(path.end, PathEnd::kReached);
  ASSERT_EQ(path.points.size(), path.segments.size() + 1);
  std::vector<SegmentKind> kinds = path.segments;
  kinds.erase(std::unique(kinds.begin(), kinds.end()), kinds.end());
  EXPECT_EQ(kinds, (std::vector{SegmentKind::kFly, SegmentKind::kLand, SegmentKind::kWalk,
                                SegmentKind::kTakeOff, SegmentKind::kFly}));
  EXPECT_NEAR(length(path.points.front().position - here), 0, 0.01);
  EXPECT_NEAR(length(path.points.back().position - there), 0, 0.01);
  double sum = 0;
  for (size_t i = 1; i < path.points.size(); ++i)
    sum += length(path.points[i].position - path.points[i - 1].position);
  EXPECT_NEAR(path.length, sum, 1e-9);
  // Without the nearest point, or with too small a budget for it.
  flight.find({.from = here, .to = there, .by_turns = false, .nearest = false}, path);
  EXPECT_EQ(path.end, PathEnd::kUnreachable);
  EXPECT_TRUE(path.points.empty());
  flight.find({.from = here, .to = there, .budget = 1}, path);
  EXPECT_NE(path.end, PathEnd::kReached);
}

TEST(Flight, ReportsHowNearItComesAndTheBlocker) {
  const Scene scene = two_halls(false);
  const World world = bake(scene);
  path::FlightFinder flight = finder(world);
  Path path;
  const Vec3d there{16, 3, 3};
  for (const Vec3d here : {Vec3d{3, 2, 4}, Vec3d{3, 0, 6}}) {
    flight.find({.from = here, .to = there}, path);
    ASSERT_EQ(path.end, PathEnd::kUnreachable);
    EXPECT_EQ(path.blocked_by, Blocker::kNarrow);
    ASSERT_GE(path.points.size(), 2u);
    EXPECT_EQ(path.points.size(), path.segments.size() + 1);
    EXPECT_NEAR(length(path.points.front().position - here), 0, 0.01);
    // As near as the air comes, of all boxes, by many points of each.
    double least = INFINITY;
    const path::FlightEndpoints ends(*data_of(world), flight.space(), 0);
    const uint32_t part = flight.space().component[flight.space().box_at(*ends.in_air({3, 2, 4}))];
    for (size_t b = 0; b < flight.space().boxes.size(); ++b) {
      if (flight.space().component[b] != part) continue;
      const world::AirCube& box = flight.space().boxes[b];
      for (int i = 0; i < 27; ++i) {
        const auto at = [&](int32_t low, int k) { return low + box.side * (0.01 + 0.49 * k); };
        const Vec3d p = ends.to_metres({at(box.x, i % 3), at(box.y, i / 3 % 3), at(box.z, i / 9)});
        least = std::min(least, length(p - there));
      }
    }
    const double far = length(path.points.back().position - there);
    EXPECT_LE(far, least + 1e-6);
    EXPECT_GT(far, 6.2);  // The wall, and half of the body, are in between.
    EXPECT_TRUE(flight.is_legal(path.points.back().position));
  }
  // Under a ceiling that leaves no room to take off.
  Scene low = two_floors();
  low.add_quad({0, 1.85, 0}, {8, 1.85, 0}, {8, 1.85, 8}, {0, 1.85, 8});
  const World cellar = bake(low);
  path::FlightFinder in_cellar = finder(cellar);
  in_cellar.find({.from = {2, 0, 4}, .to = {32, 3, 4}}, path);
  if (path.end == PathEnd::kUnreachable) {
    EXPECT_EQ(path.blocked_by, Blocker::kLow);
    ASSERT_FALSE(path.points.empty());
    EXPECT_GT(path.points.back().position.x, 6.5);
    EXPECT_NEAR(path.points.back().position.y, 0, 0.01);
  } else {
    ADD_FAILURE() << "it takes off";
  }
}

// Two halls with a hole in the wall between: as wide as the wall, or as high.
TEST(Flight, DistinguishesHolesThatAreTooLowFromTooNarrow) {
  for (const bool is_low : {true, false}) {
    Scene scene;
    scene.add_quad({0, 0, 0}, {0, 0, 8}, {20, 0, 8}, {20, 0, 0});
    for (const double x : {0.0, 19.8}) scene.add_box({x, -0.1, 0}, {x + 0.2, 6, 8});
    for (const double z : {0.0, 7.8}) scene.add_box({0, -0.1, z}, {20, 6, z + 0.2});
    scene.add_box({0, 5.8, 0}, {20, 6, 8});
    if (is_low) {
      scene.add_box({9.8, -0.1, 0}, {10, 2, 8});
      scene.add_box({9.8, 3, 0}, {10, 6, 8});
    } else {
      scene.add_box({9.8, -0.1, 0}, {10, 6, 3.8});
      scene.add_box({9.8, -0.1, 4.2}, {10, 6, 8});
    }
    const World world = bake(scene);
    path::FlightFinder flight = finder(world);
    Path path;
    for (const double from : {3.0, 17.0}) {
      flight.find({.from = {from, 2.5, 4}, .to = {20 - from, 2.25, 4}}, path);
      ASSERT_EQ(path.end, PathEnd::kUnreachable);
      EXPECT_EQ(path.blocked_by, is_low ? Blocker::kLow : Blocker::kNarrow);
      ASSERT_FALSE(path.points.empty());
      EXPECT_NEAR(path.points.back().position.x, from < 10 ? 9.3 : 10.5, 0.8);
    }
  }
}

// Under a roof that nothing takes off from, walked to behind a wall.
TEST(Flight, AnExhaustedBudgetOnFootIsNoProofThatNoPathExists) {
  Scene scene;
  scene.add_quad({0, 0, 0}, {0, 0, 8}, {12, 0, 8}, {12, 0, 0});
  scene.add_box({-2, 1.9, -2}, {14, 2.5, 10});
  scene.add_box({5, 0, -1}, {5.5, 1.9, 6});
  scene.add_box({7, 0, 2}, {7.5, 1.9, 9});
  const World world = bake(scene);
  path::FlightFinder flight = finder(world);
  Path path;
  path::FlightQuery query{.from = {2, 0, 2}, .to = {10, 0, 4}};
  ASSERT_FALSE(flight.take_off(world.find_place(0, query.from, 0.1)));
  flight.find(query, path);
  ASSERT_EQ(path.end, PathEnd::kReached);
  ASSERT_EQ(path.segments.back(), SegmentKind::kWalk);
  query.budget.max_nodes = 1;
  flight.find(query, path);
  EXPECT_EQ(path.end, PathEnd::kBudgetExhausted);
  query.budget.max_nodes = UINT64_MAX;
  const std::atomic<bool> cancel = true;
  query.budget.cancel = &cancel;
  flight.find(query, path);
  EXPECT_EQ(path.end, PathEnd::kBudgetExhausted);
}

// A hall with a wall in it, and one that nothing leads to.
Scene hall_with_a_corner() {
  Scene scene = two_halls(false);
  scene.add_box({5, -0.1, 0}, {5.3, 6, 4.5});
  return scene;
}

TEST(Flight, ACancelledSearchFindsNothing) {
  const World world = bake(hall_with_a_corner());
  path::FlightFinder flight = finder(world);
  Path path;
  // Straight, around a corner, on foot, and to a goal that cannot be reached.
  const std::vector<std::pair<Vec3d, Vec3d>> queries{{{3, 2, 2}, {4, 2, 5}},
                                                     {{3, 2, 2}, {8, 3, 2}},
                                                     {{3, 0, 6}, {4, 0, 2}},
                                                     {{3, 2, 2}, {16, 3, 3}},
                                                     {{3, 0, 2}, {16, 3, 3}}};
  uint64_t stopped = 0;
  for (const auto& [from, to] : queries) {
    std::atomic<bool> cancel = false;
    const path::FlightQuery query{.from = from, .to = to, .budget = {UINT64_MAX, &cancel}};
    flight.find(query, path);
    ASSERT_FALSE(path.points.empty());
    const uint64_t whole = path.nodes;
    for (uint64_t after = 0; after < std::min<uint64_t>(whole, 20) || after == 0; ++after) {
      cancel = false;
      flight.begin(query);
      if (after > 0) {
        path::Slice slice{after};
        ASSERT_FALSE(flight.advance(slice, path)) << after << " of " << whole;
      }
      cancel = true;
      path::Slice slice{1000};
      ASSERT_TRUE(flight.advance(slice, path));
      EXPECT_EQ(path.end, PathEnd::kBudgetExhausted);
      EXPECT_EQ(path.spent, SpentBudget::kCancelled);
      EXPECT_EQ(path.nodes, after);
      EXPECT_TRUE(path.points.empty());
      ++stopped;
    }
  }
  EXPECT_GT(stopped, queries.size() + 5);
}

// The budget is also that of the path to the nearest point.
TEST(Flight, ABudgetThatIsExhaustedBeforeTheNearestPointIsReported) {
  const World world = bake(hall_with_a_corner());
  path::FlightFinder flight = finder(world);
  Path path;
  path::FlightQuery query{.from = {3, 0, 2}, .to = {16, 3, 3}};
  flight.find(query, path);
  ASSERT_EQ(path.end, PathEnd::kUnreachable);
  ASSERT_FALSE(path.points.empty());
  const uint64_t whole = path.nodes;
  ASSERT_GT(whole, 2u);
  query.budget.max_nodes = whole + 1;
  flight.find(query, path);
  EXPECT_EQ(path.end, PathEnd::kUnreachable);
  EXPECT_EQ(path.nodes, whole);
  query.budget.max_nodes = whole - 1;
  flight.find(query, path);
  EXPECT_EQ(path.end, PathEnd::kBudgetExhausted);
  EXPECT_EQ(path.spent, SpentBudget::kNodes);
  EXPECT_TRUE(path.points.empty());
  EXPECT_LE(path.nodes, whole - 1);
}

TEST(Flight, NeedsAirAndAClassThatFlies) {
  Context context;
  const Scene scene = two_floors();
  const auto ground = bake_world(scene, {.cell = 0.2}, context);
  EXPECT_EQ(path::FlightFinder::create(*ground, {}, context).error().code, Errc::kNotFound);
  const auto air = bake_world(scene, {.cell = 0.2, .air = 0.4}, context);
  EXPECT_EQ(path::FlightFinder::create(*air, {}, context).error().code, Errc::kBadConfig);
  EXPECT_EQ(path::FlightFinder::create(*air, {.avatar_class = 9}, context).error().code,
            Errc::kBadConfig);
}

TEST(Flight, CopiesAndSecondQueriesFindTheSame) {
  const World world = bake(two_floors());
  path::FlightFinder a = finder(world), b = a;
  Path first, second;
  for (uint64_t n = 0; n < 20; ++n) {
    const auto from = a.random_point(1, 2 * n), to = a.random_point(1, 2 * n + 1);
    ASSERT_TRUE(from && to && a.is_legal(*from) && a.is_legal(*to));
    a.find({.from = *from, .to = *to}, first);
    b.find({.from = *from, .to = *to}, second);
    ASSERT_EQ(first.points.size(), second.points.size());
    ASSERT_EQ(first.length, second.length);
  }
}

// The oracle: no body on any path meets a triangle.
TEST(Flight, NoBodyOnAnyPathTouchesABuiltInWorld) {
  Context context;
  uint64_t pairs = 0, bodies = 0;
  for (const char* name : {"stairs", "garage", "church", "cube"}) {
    const auto scene = create_builtin_world({.name = name});
    ASSERT_TRUE(scene) << scene.error().message;
    const World world = bake(*scene, 0.2);
    const auto report = verify_flight(world, *scene, {.samples = 1500}, context);
    ASSERT_TRUE(report) << report.error().message;
    EXPECT_EQ(report->entered, 0u) << name;
    EXPECT_GT(report->reached, 50u) << name;
    pairs += report->pairs;
    bodies += report->positions;
  }
  EXPECT_EQ(pairs, 600u);
  EXPECT_GT(bodies, 5000u);
}

// If the oracle's triangles are taken away from under the world, it must fail.
TEST(Flight, TheOracleSeesAWallThatTheBakeDidNot) {
  Context context;
  Scene scene = two_floors();
  const World world = bake(scene);
  scene.add_box({12, -3, -1}, {24, 12, 9});
  const auto report = verify_flight(world, scene, {.samples = 5000}, context);
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_EQ(report->points, 5000u);
  EXPECT_GT(report->entered, 200u);
  EXPECT_EQ(verify_flight(world, scene, {.samples = 0}, context).error().code, Errc::kBadConfig);
  scene.triangles.push_back({0, 1, 4'000'000'000});
  scene.area.push_back(kAreaWalkable);
  EXPECT_EQ(verify_flight(world, scene, {.samples = 50}, context).error().code, Errc::kBadInput);
}

VoxelCells random_voxels(uint64_t seed, uint64_t percent) {
  VoxelCells cells{.width = 14, .height = 11, .depth = 13, .filled = {}};
  uint64_t n = 0;
  for (int32_t z = 0; z < cells.depth; ++z) {
    for (int32_t y = 0; y < cells.height; ++y) {
      for (int32_t x = 0; x < cells.width; ++x) {
        if (random_below(seed, 0, n++, 100) < percent) cells.filled.push_back({x, y, z});
      }
    }
  }
  return cells;
}

TEST(VoxelCells, PathsAreLegalAndNotMuchLongerThanBruteForceFinds) {
  Context context;
  double ratios = 0, worst = 0;
  uint64_t compared = 0, unreachable = 0;
  for (uint64_t seed = 0; seed < 10; ++seed) {
    const VoxelCells cells = random_voxels(seed, 4 + 7 * seed);
    const auto world = bake_voxel_cells(cells, 1);
    ASSERT_TRUE(world) << world.error().message;
    path::FlightFinder flight = finder(*world);
    const test::VoxelOracle oracle(cells);
    Path path;
    for (uint64_t n = 0; n < 12; ++n) {
      int32_t at[6];
      const int32_t side[3] = {cells.width, cells.height, cells.depth};
      for (uint64_t i = 0; i < 6; ++i) {
        at[i] =
            static_cast<int32_t>(random_below(seed, n + 1, i, static_cast<uint64_t>(side[i % 3])));
      }
      const bool open = oracle.is_open(at[0], at[1], at[2]) && oracle.is_open(at[3], at[4], at[5]);
      flight.find({.from = {at[0] + 0.5, at[1] + 0.5, at[2] + 0.5},
                   .to = {at[3] + 0.5, at[4] + 0.5, at[5] + 0.5}},
                  path);
      if (!open) {
        ASSERT_EQ(path.end, PathEnd::kNoPlace);
        continue;
      }
      const auto best = oracle.shortest(test::middle(at[0], at[1], at[2]),
                                        test::middle(at[3], at[4], at[5]), 60, 100000);
      ASSERT_EQ(path.end == PathEnd::kReached, best.length.has_value()) << seed << ", " << n;
      if (!best.length) {
        ++unreachable;
        continue;
      }
      for (size_t i = 1; i < path.points.size(); ++i) {
        ASSERT_TRUE(oracle.is_clear(path.points[i - 1].position, path.points[i].position))
            << seed << ", " << n;
      }
      ++compared;
      const double ratio = *best.length > 0 ? path.length / *best.length : 1;
      ratios += ratio;
      worst = std::max(worst, ratio);
    }
  }
  EXPECT_GT(compared, 50u);
  EXPECT_GT(unreachable, 0u);
  EXPECT_LT(ratios / static_cast<double>(compared), 1.02);
  EXPECT_LT(worst, 1.25);
}

// Walls across a long hall, each with a hole somewhere: of `least` voxels a side or a few more.
VoxelCells hall_of_walls(uint64_t seed, int32_t least) {
  VoxelCells cells{.width = 352, .height = 14, .depth = 32, .filled = {}};
  for (int32_t x = 48; x < cells.width - 48; x += 64) {
    const auto n = static_cast<uint64_t>(x);
    const auto side = least + static_cast<int32_t>(random_below(seed, n, 0, 4));
    const auto from = [&](uint64_t which, int32_t size) {
      return static_cast<int32_t>(random_below(seed, n, which, static_cast<uint64_t>(size - side)));
    };
    const int32_t y0 = from(1, cells.height), z0 = from(2, cells.depth);
    for (int32_t y = 0; y < cells.height; ++y) {
      for (int32_t z = 0; z < cells.depth; ++z) {
        const bool hole = y >= y0 && y < y0 + side && z >= z0 && z < z0 + side;
        if (!hole) cells.filled.push_back({x, y, z});
      }
    }
  }
  return cells;
}

TEST(VoxelCells, FarEndsAreFoundThroughLargeBoxesOrAroundThem) {
  // Holes that only boxes of one or two voxels fit through, and holes for larger ones.
  for (const int32_t least : {1, 9}) {
    double ratios = 0;
    for (uint64_t seed = 0; seed < 3; ++seed) {
      const VoxelCells cells = hall_of_walls(seed, least);
      const auto world = bake_voxel_cells(cells, 1);
      ASSERT_TRUE(world) << world.error().message;
      path::FlightFinder flight = finder(*world);
      const test::VoxelOracle oracle(cells);
      Path path;
      flight.find({.from = {3.5, 2.5, 28.5}, .to = {340.5, 12.5, 4.5}}, path);
      ASSERT_EQ(path.end, PathEnd::kReached);
      for (size_t i = 1; i < path.points.size(); ++i) {
        ASSERT_TRUE(oracle.is_clear(path.points[i - 1].position, path.points[i].position)) << seed;
      }
      const auto best =
          oracle.shortest(test::middle(3, 2, 28), test::middle(340, 12, 4), 2000, 100000);
      ASSERT_TRUE(best.length);
      EXPECT_LT(path.length, 1.05 * *best.length) << seed << ", holes of " << least;
      ratios += path.length / *best.length;
    }
    EXPECT_LT(ratios / 3, 1.02) << least;
  }
}

TEST(VoxelCells, MapsThatDoNotFitAreRefused) {
  EXPECT_EQ(bake_voxel_cells({}, 1).error().code, Errc::kBadInput);
  VoxelCells cells{.width = 4, .height = 4, .depth = 4, .filled = {{4, 0, 0}}};
  EXPECT_EQ(bake_voxel_cells(cells, 1).error().code, Errc::kBadInput);
  cells.filled.clear();
  EXPECT_EQ(bake_voxel_cells(cells, 0).error().code, Errc::kBadConfig);
  EXPECT_TRUE(bake_voxel_cells(cells, 1));
  // The whole box is at most 500 MB of bits, whatever its shape: a plate takes 8.
  EXPECT_TRUE(bake_voxel_cells({.width = 4096, .height = 4096, .depth = 1, .filled = {}}, 1));
}

}  // namespace
}  // namespace throng
