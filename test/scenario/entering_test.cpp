// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <utility>

#include "throng/scenario.h"

// Sources that are full, and avatars that are fast.
namespace throng {
namespace {

// A hall of 20 by 10 m, with a door of 3 m in a wall across it.
Simulation simulation_of(const std::string& text, double dt) {
  const auto scenario = parse_scenario(fmt::format("dt = {}\n", dt) + R"(seconds = 60
seed = 3
cell = 0.1
[plane]
floor = [[0, 0], [20, 0], [20, 10], [0, 10]]
obstacles = [[[10, 0], [10.2, 0], [10.2, 4], [10, 4]], [[10, 7], [10.2, 7], [10.2, 10], [10, 10]]]
[[area]]
name = "north"
box = [18, 0.5, 19.5, 2.5]
[[area]]
name = "south"
box = [18, 7.5, 19.5, 9.5]
)" + text,
                                       "hall.toml");
  EXPECT_TRUE(scenario) << scenario.error().message;
  Context context;
  const auto world = open_world(*scenario, context);
  EXPECT_TRUE(world) << world.error().message;
  auto simulation = Simulation::create(*world, *scenario, 2, context);
  EXPECT_TRUE(simulation) << simulation.error().message;
  return std::move(*simulation);
}

// A full source costs time by those that get in: ten times as many that wait change nothing. It
// stops no other source.
TEST(Entering, AvatarsThatWaitOutsideTakeNoTime) {
  constexpr uint64_t kSteps = 200, kFrom = 100;
  uint64_t tries[2] = {}, entered[2] = {};
  for (const size_t busy : {0, 1}) {
    Simulation simulation = simulation_of(fmt::format(R"(
[[area]]
name = "cell"
box = [1, 1, 3, 3]
[[journey]]
name = "out"
stages = [{{ leave = "north" }}]
[[source]]
name = "full"
area = "cell"
journey = "out"
rate = {}
[[source]]
name = "south"
area = "south"
journey = "out"
even = true
rate = 1
)",
                                                      busy == 0 ? 300 : 3000),
                                          0.1);
    uint64_t outside = 0, by_south = 0;
    for (uint64_t step = 0; step < kSteps; ++step) {
      const auto report = simulation.step();
      ASSERT_TRUE(report) << report.error().message;
      if (step >= kFrom) tries[busy] += report->entry_tries;
      outside = report->outside;
    }
    for (const Trip& trip : simulation.trips()) {
      if (trip.entered < 0) continue;
      entered[busy] += trip.source == 0 ? 1 : 0;
      by_south += trip.source == 1 ? 1 : 0;
    }
    EXPECT_GT(outside, busy == 0 ? 4000u : 40000u);
    EXPECT_GE(by_south, 18u);
  }
  EXPECT_GT(entered[0], 15u);
  EXPECT_GT(static_cast<double>(entered[1]), 0.6 * static_cast<double>(entered[0]));
  EXPECT_LT(static_cast<double>(tries[1]), 1.5 * static_cast<double>(tries[0]));
  EXPECT_LT(tries[1], (kSteps - kFrom) * 4096 + 256 * entered[1]);
}

// An exit less than 12 m away, and a wall 0.5 m behind it.
TEST(Entering, AvatarsOfAnySpeedLeaveInTime) {
  for (const double speed : {5.0, 20.0, 50.0, 99.0}) {
    for (const double dt : {0.1, 0.5}) {
      SCOPED_TRACE(fmt::format("speed {} dt {}", speed, dt));
      Simulation simulation = simulation_of(fmt::format(R"(
[[area]]
name = "by the door"
box = [8, 4.8, 9, 6.2]
[[area]]
name = "east"
box = [19, 4.5, 19.5, 6.5]
[[profile]]
name = "fast"
speed = {}
[[journey]]
name = "out"
stages = [{{ leave = "east" }}]
[[source]]
name = "all"
area = "by the door"
profile = "fast"
journey = "out"
count = 1
)",
                                                        speed),
                                            dt);
      for (int step = 0; step < (12 / speed + 5) / dt; ++step) {
        ASSERT_TRUE(simulation.step());
        const CrowdCheck found = simulation.crowd().check();
        ASSERT_EQ(found.overlaps + found.wall_entries, 0U) << step;
      }
      EXPECT_TRUE(simulation.is_over());
    }
  }
}

}  // namespace
}  // namespace throng
