// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "plain_crowd.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/random.h"

namespace throng::test {
namespace {

bool have_arrived(const PlainCrowd& crowd) {
  return std::all_of(crowd.bodies().begin(), crowd.bodies().end(),
                     [](const PlainBody& b) { return b.arrived >= 0; });
}

TEST(PlainCrowd, NoBodyEverTouchesAnotherHoweverDense) {
  for (const uint64_t seed : {1, 2, 3}) {
    PlainConfig config;
    std::vector<PlainBody> bodies = random_bodies(config, 100, 0.9, seed, config.side);
    for (uint32_t i = 0; i < bodies.size(); ++i) {
      bodies[i].radius = config.to_units(0.15 + 0.15 * random_unit(seed, 5, i));
      bodies[i].speed = static_cast<float>(0.5 + 2 * random_unit(seed, 6, i));
    }
    config.seed = seed;
    PlainCrowd crowd(bodies, config);
    double moved = 0;
    for (int step = 0; step < 60; ++step) {
      crowd.step();
      moved += crowd.progress();
      ASSERT_EQ(crowd.overlaps(), 0u) << seed << ", step " << step;
    }
    EXPECT_GT(moved / 60, 0.2);
  }
}

TEST(PlainCrowd, SeesOverTheBordersOfAPlaneThatRepeatsItself) {
  for (const double side : {6.0, 12.0, 18.0}) {  // one, two, three times the sight
    PlainConfig config;
    const auto point_at = [&](double x, double z) {
      return Spot{config.to_units(x), config.to_units(z)};
    };
    std::vector<PlainBody> bodies(4);
    bodies[0].at = point_at(side - 0.4, 1);
    bodies[1].at = point_at(side / 2 + 0.3, side - 0.7);
    bodies[0].goal = point_at(side + 4, 1);
    bodies[1].goal = point_at(side / 2 + 0.3, side + 4);
    bodies[2].at = point_at(0.4, 1);
    bodies[2].goal = point_at(-4, 1);
    bodies[3].at = point_at(side / 2 + 0.3, 0.3);
    bodies[3].goal = point_at(side / 2 + 0.3, -4);
    config.side = config.to_units(side);
    PlainCrowd crowd(bodies, config);
    for (int step = 0; step < 30; ++step) {
      crowd.step();
      ASSERT_EQ(crowd.overlaps(), 0u) << side << ", step " << step;
    }
  }
}

TEST(PlainCrowd, TheCountOfOverlapsSeesThem) {
  std::vector<PlainBody> bodies(3);
  bodies[1].at = {12287, 0};  // two radii less a unit
  bodies[2].at = {12287, 12288};
  EXPECT_EQ(PlainCrowd(bodies, {}).overlaps(), 1u);
}

TEST(PlainCrowd, TwoHeadOnPassOnTheRight) {
  std::vector<PlainBody> bodies(2);
  const PlainConfig config;
  bodies[0].goal = bodies[1].at = {config.to_units(8), 0};
  bodies[1].goal = bodies[0].at;
  PlainCrowd crowd(bodies, config);
  int32_t aside = 0;
  while (!have_arrived(crowd) && crowd.time() < 20) {
    crowd.step();
    ASSERT_EQ(crowd.overlaps(), 0u);
    // Each to its own right. The body that decides first may be the only one that must turn.
    aside = std::max({aside, crowd.bodies()[0].at.z, -crowd.bodies()[1].at.z});
  }
  EXPECT_LT(crowd.time(), 9);
  EXPECT_GT(aside, config.to_units(0.2));  // its own right
}

TEST(PlainCrowd, OfTwoThatHeadToOnePlaceOneArrivesFirst) {
  std::vector<PlainBody> bodies(2);
  const PlainConfig config;
  bodies[0].at = {config.to_units(-4), 0};
  bodies[1].at = {config.to_units(4), 0};
  PlainCrowd crowd(bodies, config);
  for (int step = 0; step < 150; ++step) {
    crowd.step();
    ASSERT_EQ(crowd.overlaps(), 0u);
  }
  const auto near = [&](size_t i) {
    const Spot at = crowd.bodies()[i].at;
    return crowd::nearer_than(at.x, at.z, config.to_units(0.3));
  };
  EXPECT_FALSE(near(0) && near(1));
  EXPECT_TRUE(crowd.bodies()[0].arrived >= 0 || crowd.bodies()[1].arrived >= 0);
}

TEST(PlainCrowd, RingsChangePlacesBecauseBlockedBodiesTurnTogether) {
  double took[2] = {};
  for (const bool deadlock_avoidance : {true, false}) {
    PlainConfig config;
    config.deadlock_avoidance = deadlock_avoidance;
    PlainCrowd crowd(ring_bodies(config, 70, 6), config);
    while (!have_arrived(crowd) && crowd.time() < 60) {
      crowd.step();
      ASSERT_EQ(crowd.overlaps(), 0u);
    }
    took[deadlock_avoidance ? 1 : 0] = crowd.time();
  }
  EXPECT_LT(took[1], 59);
  EXPECT_LT(took[1], took[0]);
}

}  // namespace
}  // namespace throng::test
