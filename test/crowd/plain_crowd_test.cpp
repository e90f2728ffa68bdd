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

TEST(PlainCrowd, NobodyEverTouchesAnotherHoweverDense) {
  for (const uint64_t seed : {1, 2, 3}) {
    double side = 0;
    std::vector<PlainBody> bodies = random_bodies(100, 0.9, seed, side);
    for (uint32_t i = 0; i < bodies.size(); ++i) {
      bodies[i].radius = 0.15 + 0.15 * random_unit(seed, 5, i);
      bodies[i].speed = 0.5 + 2 * random_unit(seed, 6, i);
    }
    PlainConfig config;
    config.side = side;
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
  for (const double side : {6.0, 12.0, 18.0}) {  // one, two, three times as wide as one sees
    std::vector<PlainBody> bodies(2);
    bodies[0].at = {side - 0.4, 1};
    bodies[1].at = {side / 2 + 0.3, side - 0.7};
    bodies[0].goal = {side + 4, 1};
    bodies[1].goal = {side / 2 + 0.3, side + 4};
    bodies.push_back({.at = {0.4, 1}, .velocity = {}, .goal = {-4, 1}});
    bodies.push_back({.at = {side / 2 + 0.3, 0.3}, .velocity = {}, .goal = {side / 2 + 0.3, -4}});
    PlainConfig config;
    config.side = side;
    PlainCrowd crowd(bodies, config);
    for (int step = 0; step < 30; ++step) {
      crowd.step();
      ASSERT_EQ(crowd.overlaps(), 0u) << side << ", step " << step;
    }
  }
}

TEST(PlainCrowd, TheCountOfOverlapsSeesThem) {
  std::vector<PlainBody> bodies(3);
  bodies[1].at = {0.59, 0};
  bodies[2].at = {0.59, 0.6};
  EXPECT_EQ(PlainCrowd(bodies, {}).overlaps(), 1u);
}

TEST(PlainCrowd, TwoHeadOnPassOnTheRight) {
  std::vector<PlainBody> bodies(2);
  bodies[0].goal = bodies[1].at = {8, 0};
  bodies[1].goal = bodies[0].at;
  PlainCrowd crowd(bodies, {});
  double aside = 0;
  while (!have_arrived(crowd) && crowd.time() < 20) {
    crowd.step();
    ASSERT_EQ(crowd.overlaps(), 0u);
    aside = std::max(aside, crowd.bodies()[0].at.z);
  }
  EXPECT_LT(crowd.time(), 9);
  EXPECT_GT(aside, 0.2);  // its own right
}

TEST(PlainCrowd, OfTwoBoundForOnePlaceOneArrivesFirst) {
  std::vector<PlainBody> bodies(2);
  bodies[0].at = {-4, 0};
  bodies[1].at = {4, 0};
  PlainCrowd crowd(bodies, {});
  for (int step = 0; step < 150; ++step) {
    crowd.step();
    ASSERT_EQ(crowd.overlaps(), 0u);
  }
  const auto near = [&](size_t i) {
    return std::sqrt(crowd.bodies()[i].at.x * crowd.bodies()[i].at.x +
                     crowd.bodies()[i].at.z * crowd.bodies()[i].at.z) < 0.3;
  };
  EXPECT_FALSE(near(0) && near(1));
  EXPECT_TRUE(crowd.bodies()[0].arrived >= 0 || crowd.bodies()[1].arrived >= 0);
}

TEST(PlainCrowd, RingsChangePlacesBecauseTheImpatientTurnTogether) {
  double took[2] = {};
  for (const bool patient : {true, false}) {
    PlainConfig config;
    config.patient = patient;
    PlainCrowd crowd(ring_bodies(70, 6), config);
    while (!have_arrived(crowd) && crowd.time() < 60) {
      crowd.step();
      ASSERT_EQ(crowd.overlaps(), 0u);
    }
    took[patient ? 1 : 0] = crowd.time();
  }
  EXPECT_LT(took[1], 59);
  EXPECT_LT(took[1], took[0]);
}

}  // namespace
}  // namespace throng::test
