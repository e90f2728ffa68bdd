// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "baked.h"
#include "crowds.h"
#include "throng/crowd.h"
#include "worlds.h"

// Targets: what they accept, and the places inside. How avatars get there: simulation_test.cpp.
namespace throng {
namespace {

// A floor of 20 m with a crate on it.
const World& floor_with_crate() {
  static const World world = [] {
    Scene scene = worlds::flat(20);
    scene.add_box({4, 0, 4}, {6, 2, 6});
    return test::bake(scene, 0.1);
  }();
  return world;
}

TargetId target_of(Crowd& crowd, const std::vector<Prism>& areas) {
  Context context;
  const auto target = crowd.add_target(areas, context);
  EXPECT_TRUE(target) << target.error().message;
  return target ? *target : TargetId{};
}

std::vector<Place> places_of(Crowd& crowd, TargetId target, size_t max_count) {
  Context context;
  auto places = crowd.places(target, 0, max_count, context);
  EXPECT_TRUE(places) << places.error().message;
  return places ? *places : std::vector<Place>();
}

bool stands(const World& world, const Place& place) {
  const Place found = world.find_place(0, place.position, 0.01);
  return found && found.level1 == place.level1;
}

TEST(CrowdTargets, PlacesLieInsideWhereTheClassCanStandAndAreEvenlySpread) {
  const World& world = floor_with_crate();
  Crowd crowd = made(world);
  const Prism area = Prism::box({2, -0.5, 2}, {12, 1, 8});
  const TargetId target = target_of(crowd, {area});
  for (const size_t max_count : {1, 10, 100, 1000, 100000}) {
    const std::vector<Place> places = places_of(crowd, target, max_count);
    EXPECT_GE(places.size(), 1u);
    EXPECT_LE(places.size(), 2 * max_count + 2) << max_count;
    for (const Place& place : places) {
      EXPECT_TRUE(area.contains(place.position)) << place.position.x << ' ' << place.position.z;
      EXPECT_TRUE(stands(world, place)) << place.position.x << ' ' << place.position.z;
      EXPECT_NEAR(place.position.y, 0, 0.002);
    }
    if (max_count < 10) continue;
    const double spacing = std::max(0.1, std::sqrt(60.0 / static_cast<double>(max_count)));
    for (double x = 2.05; x < 12; x += 0.2) {
      for (double z = 2.05; z < 8; z += 0.2) {
        if (!world.find_place(0, {x, 0, z}, 0.1)) continue;
        double nearest = 1e9;
        for (const Place& p : places) {
          nearest = std::min(nearest, std::hypot(p.position.x - x, p.position.z - z));
        }
        EXPECT_LE(nearest, 2 * spacing) << max_count << ": " << x << ' ' << z;
      }
    }
  }
}

TEST(CrowdTargets, PlacesAreNotWhereAnObstacleIsUp) {
  Edits edits;
  Crowd crowd = made(floor_with_crate(), {.edits = edits});
  const TargetId target = target_of(crowd, {Prism::box({8, -0.5, 8}, {18, 1, 18})});
  ASSERT_FALSE(places_of(crowd, target, 400).empty());
  put_up(crowd, edits, Prism::box({12, 0, 8}, {20, 1, 18}));
  const std::vector<Place> left = places_of(crowd, target, 400);
  EXPECT_GT(left.size(), 50u);
  for (const Place& place : left) EXPECT_LT(place.position.x, 12);
}

TEST(CrowdTargets, PlacesOfPrismsThatOverlapAreThoseOfTheirUnion) {
  Crowd crowd = made(floor_with_crate());
  const Prism one = Prism::box({8, -0.5, 8}, {12, 1, 12}),
              two = Prism::box({9, -0.5, 9}, {13, 1, 13});
  const TargetId target = target_of(crowd, {one, two, one});
  for (const size_t max_count : {20, 500, 100000}) {
    const std::vector<Place> places = places_of(crowd, target, max_count);
    std::set<std::pair<double, double>> distinct;
    for (const Place& p : places) distinct.emplace(p.position.x, p.position.z);
    EXPECT_EQ(distinct.size(), places.size()) << max_count;
    const auto is_in = [&](const Prism& prism) {
      return [&prism](const Place& p) { return prism.contains(p.position); };
    };
    EXPECT_TRUE(std::any_of(places.begin(), places.end(), is_in(one)));
    EXPECT_TRUE(std::any_of(places.begin(), places.end(), is_in(two)));
  }
}

// A coarse raster may miss a line: one cell wide, 17 m long.
TEST(CrowdTargets, PlacesOfANarrowTargetAreAsFewAsThoseOfOthers) {
  Crowd crowd = made(floor_with_crate());
  for (int32_t row = 0; row < 12; ++row) {
    const double z = 12 + 0.1 * row;
    const TargetId target = target_of(crowd, {Prism::box({2, -0.5, z + 0.01}, {19, 1, z + 0.11})});
    for (const size_t max_count : {5, 10, 20}) {
      const std::vector<Place> places = places_of(crowd, target, max_count);
      EXPECT_GE(places.size(), 1u) << row;
      EXPECT_LE(places.size(), 2 * max_count + 2) << row;
      double from = 1e9, to = -1e9;
      for (const Place& p : places) {
        from = std::min(from, p.position.x);
        to = std::max(to, p.position.x);
      }
      if (max_count < 10) continue;
      EXPECT_LT(from, 6) << row << ", " << max_count;  // From one end to the other.
      EXPECT_GT(to, 15) << row << ", " << max_count;
    }
  }
}

TEST(CrowdTargets, PlacesOfAClassThatTheWorldDoesNotHaveAreRefused) {
  Crowd crowd = made(floor_with_crate());
  const TargetId target = target_of(crowd, {Prism::box({8, -0.5, 8}, {12, 1, 12})});
  Context context;
  for (const int32_t bad : {-1, 99}) {
    const auto places = crowd.places(target, bad, 10, context);
    ASSERT_FALSE(places);
    EXPECT_EQ(places.error().code, Errc::kNotFound) << places.error().message;
    const AvatarSpawn spawn{.place = {}, .avatar_class = bad};
    EXPECT_EQ(crowd.add({&spawn, 1}, context).error().code, Errc::kNotFound) << "as add() does";
    EXPECT_EQ(crowd.scatter(1, spawn, context).error().code, Errc::kNotFound);
  }
  context.cancel = true;
  const auto cancelled = crowd.places(target, 0, 10, context);
  ASSERT_FALSE(cancelled);
  EXPECT_EQ(cancelled.error().code, Errc::kCancelled);
  EXPECT_FALSE(places_of(crowd, target, 10).empty()) << "the next call reads the ground";
  EXPECT_FALSE(places_of(crowd, target, 0).empty());
  // Beside the floor, and above it.
  EXPECT_TRUE(
      places_of(crowd, target_of(crowd, {Prism::box({50, 0, 50}, {60, 1, 60})}), 9).empty());
  EXPECT_TRUE(places_of(crowd, target_of(crowd, {Prism::box({8, 1, 8}, {12, 2, 12})}), 9).empty());
}

TEST(CrowdTargets, BadPrismsAreRefused) {
  Crowd crowd = made(floor_with_crate());
  const Prism good = Prism::box({8, -0.5, 8}, {12, 1, 12});
  Context context;
  const auto refused = [&](const std::vector<Prism>& areas) {
    const auto target = crowd.add_target(areas, context);
    EXPECT_FALSE(target);
    return target ? Errc::kOk : target.error().code;
  };
  Prism flat = good, line = good, dented = good, nowhere = good;
  flat.high = flat.low;
  line.corners.resize(2);
  dented.corners = {{0, 0}, {4, 0}, {1, 1}, {0, 4}};
  nowhere.corners[1][0] = NAN;
  for (const Prism& bad : {flat, line, dented, nowhere, Prism{}}) {
    EXPECT_EQ(refused({bad}), Errc::kBadInput);
    EXPECT_EQ(refused({good, bad}), Errc::kBadInput);
  }
  EXPECT_EQ(refused({}), Errc::kBadInput) << "a region of nothing";
  EXPECT_EQ(target_of(crowd, {good}), 1) << "none of these was added";
}

TEST(CrowdTargets, StraightRoutingHasNone) {
  Crowd crowd = made(floor_with_crate(), {.routing = Routing::kStraight});
  const Prism area = Prism::box({8, -0.5, 8}, {12, 1, 12});
  Context context;
  const auto target = crowd.add_target({&area, 1}, context);
  ASSERT_FALSE(target);
  EXPECT_EQ(target.error().code, Errc::kBadConfig);
}

TEST(CrowdTargets, ACancelledOneIsNotAddedAndTheCrowdGoesOn) {
  const World& world = floor_with_crate();
  Crowd crowd = made(world);
  const AvatarId id = added(crowd, world.find_place(0, {2, 0, 2}, 0.1));
  const TargetId first = target_of(crowd, {Prism::box({8, -0.5, 8}, {12, 1, 12})});
  const Prism area = Prism::box({15, -0.5, 15}, {18, 1, 18});
  Context context;
  context.cancel = true;
  const auto cancelled = crowd.add_target({&area, 1}, context);
  ASSERT_FALSE(cancelled);
  EXPECT_EQ(cancelled.error().code, Errc::kCancelled);
  context.cancel = false;
  const auto second = crowd.add_target({&area, 1}, context);
  ASSERT_TRUE(second) << second.error().message;
  EXPECT_EQ(*second, first + 1);
  EXPECT_GT(crowd.distance(id, *second), crowd.distance(id, first) + 5);
  crowd.set_targets({&id, 1}, *second);
  for (int step = 0; step < 300 && crowd.arrived().empty(); ++step) crowd.step();
  const Vec3d end = crowd.read(id)->position;
  EXPECT_TRUE(Prism::box({14.7, -0.5, 14.7}, {18, 1, 18}).contains(end)) << end.x << ' ' << end.z;
}

TEST(CrowdTargets, MoreThan65535AreRefused) {
  Crowd crowd = made(floor_with_crate());
  const Prism area = Prism::box({8, -0.5, 8}, {12, 1, 12});
  Context context;
  for (int32_t n = 1; n <= 65535; ++n) {
    const auto target = crowd.add_target({&area, 1}, context);
    ASSERT_TRUE(target) << n << ": " << target.error().message;
    ASSERT_EQ(*target, n);
  }
  const auto refused = crowd.add_target({&area, 1}, context);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Errc::kLimit);
  EXPECT_NE(refused.error().message.find("65535"), std::string::npos) << refused.error().message;
}

// Before: a step read beyond the flow fields.
TEST(CrowdTargets, ThoseThatTheCrowdDoesNotHaveChangeNothing) {
  const World& world = floor_with_crate();
  Crowd crowd = made(world), twin = made(world);
  const auto ids = scattered(crowd, 20);
  ASSERT_EQ(scattered(twin, 20), ids);
  std::vector<Place> goals;
  for (uint64_t n = 0; n < 20; ++n) goals.push_back(world.random_place(0, 3, n));
  for (Crowd* one : {&crowd, &twin}) {
    EXPECT_EQ(target_of(*one, {Prism::box({12, -0.5, 12}, {16, 1, 16})}), 1);
    one->set_goals(ids, goals);
  }
  Context context;
  for (const TargetId unknown : {TargetId{0}, TargetId{2}, TargetId{77}, TargetId{UINT16_MAX}}) {
    crowd.set_targets(ids, unknown);
    EXPECT_TRUE(std::isinf(crowd.distance(ids[0], unknown))) << unknown;
    const auto places = crowd.places(unknown, 0, 10, context);
    ASSERT_FALSE(places) << unknown;
    EXPECT_EQ(places.error().code, Errc::kNotFound);
    for (int step = 0; step < 5; ++step) {
      crowd.step();
      twin.step();
      ASSERT_EQ(crowd.state_hash(), twin.state_hash()) << unknown;
    }
  }
  EXPECT_LT(crowd.distance(ids[0], 1), 40);
  crowd.set_targets(ids, 1);
  EXPECT_NE(crowd.state_hash(), twin.state_hash());
}

}  // namespace
}  // namespace throng
