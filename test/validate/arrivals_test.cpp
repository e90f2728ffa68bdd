// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "validate/arrivals.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

namespace throng::validate {
namespace {

constexpr double kSpeed = 1.34;  // [m/s] of the default class

World rooms_with_a_door() {
  Context context;
  auto world = bake_plane(two_rooms_plane({.side = 4, .width = 1, .length = 1}), AvatarClass{},
                          {.workers = 1}, context);
  EXPECT_TRUE(world) << world.error().message;
  return world ? *world : World{};
}

Result<Arrivals> walk(const Trips& trips, double limit, ValidationResult& result) {
  Context context;
  return walk_trips(rooms_with_a_door(), trips, limit, {.workers = 1}, result, context);
}

TEST(Arrivals, APersonAloneTakesTheTimeOfItsPath) {
  ValidationResult result;
  const auto run = walk({.starts = {{1, 2}}, .goals = {{7.5, 2}}}, 60, result);
  ASSERT_TRUE(run) << run.error().message;
  EXPECT_EQ(run->arrived, 1U);
  EXPECT_GT(run->last, (6.5 - 0.5) / kSpeed);
  EXPECT_LT(run->last, 6.5 / kSpeed + 2);
  EXPECT_NEAR(result.simulated, run->last, 1e-9);  // It ends when all have arrived.
  EXPECT_EQ(result.faults.overlaps + result.faults.wall_entries, 0U);
}

TEST(Arrivals, NoPersonArrivesAfterTheLimit) {
  ValidationResult result;
  const auto run = walk({.starts = {{1, 2}}, .goals = {{7.5, 2}}}, 2, result);
  ASSERT_TRUE(run) << run.error().message;
  EXPECT_EQ(run->arrived, 0U);
  EXPECT_NEAR(result.simulated, 2, 0.11);
}

// The first would keep the others from the same point if it stayed there.
TEST(Arrivals, PeopleLeaveWhereTheyHaveArrived) {
  ValidationResult result;
  const Trips trips{.starts = {{3, 2}, {2, 2}, {1, 2}}, .goals = {{7, 2}, {7, 2}, {7, 2}}};
  const auto run = walk(trips, 60, result);
  ASSERT_TRUE(run) << run.error().message;
  EXPECT_EQ(run->arrived, 3U);
  EXPECT_GT(run->last, (6 - 0.5) / kSpeed);
}

TEST(Arrivals, TripsWithoutRoomAreRefused) {
  ValidationResult result;
  const Trips in_wall{.starts = {{1, 2}, {4.5, 0.5}}, .goals = {{7, 2}, {7, 2}}};
  const Trips to_wall{.starts = {{1, 2}, {2, 2}}, .goals = {{7, 2}, {4.5, 0.5}}};
  const Trips too_close{.starts = {{1, 2}, {1.3, 2}}, .goals = {{7, 1}, {7, 3}}};
  for (const Trips& trips : {in_wall, to_wall, too_close}) {
    const auto run = walk(trips, 60, result);
    ASSERT_FALSE(run);
    EXPECT_EQ(run.error().code, Errc::kBadConfig);
    EXPECT_NE(run.error().message.find("person 2 of 2"), std::string::npos) << run.error().message;
  }
}

TEST(Arrivals, OnlyAllOfThemPass) {
  ValidationResult result;
  add_arrivals({.arrived = 3, .last = 7}, 3, "all", result);
  add_arrivals({.arrived = 2, .last = 7}, 3, "some", result);
  ASSERT_EQ(result.measures.size(), 4U);
  EXPECT_TRUE(result.measures[0].passed());
  EXPECT_EQ(result.measures[1].value, 7);
  EXPECT_FALSE(result.measures[2].passed());
  EXPECT_TRUE(std::isnan(result.measures[3].value));
}

TEST(Arrivals, NoTwoRunsShareASeed) {
  std::set<uint64_t> seeds;
  for (const uint64_t seed : {1, 2, 3}) {
    for (uint64_t k = 0; k < 5; ++k) {
      EXPECT_TRUE(seeds.insert(config_of_run({.seed = seed}, 5, k).seed).second);
    }
  }
  EXPECT_EQ(config_of_run({.seed = 1}, 5, 0).seed, 1U);
}

}  // namespace
}  // namespace throng::validate
