// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "steer/lanes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/random.h"

// Expected values by hand: X is ahead, Z to the right.
namespace throng::steer {
namespace {

constexpr Plane kAhead{1.2f, 0}, kBack{-1, 0};

Situation in_counterflow(const std::vector<Plane>& places, Plane preferred) {
  Situation s;
  s.preferred = kAhead;
  for (const Plane& at : places) {
    s.near.add({}, {.at = at, .velocity = preferred, .radii = 0.5f, .preferred = preferred});
  }
  return s;
}

TEST(Lanes, ThreeThatComeTowardsItAreACounterFlow) {
  const LaneSettings settings;
  EXPECT_TRUE(is_opposed(settings, in_counterflow({{2, 0}, {2, 1}, {3, -1}}, kBack)));
  EXPECT_FALSE(is_opposed(settings, in_counterflow({{2, 0}, {2, 1}}, kBack)));
  EXPECT_FALSE(is_opposed(settings, in_counterflow({{2, 0}, {2, 1}, {-3, -1}}, kBack)))
      << "one has passed";
  EXPECT_FALSE(is_opposed(settings, in_counterflow({{2, 0}, {2, 1}, {3, -1}}, {0, 1})))
      << "they cross";
  EXPECT_FALSE(is_opposed(settings, in_counterflow({{2, 0}, {2, 1}, {3, -1}}, {0, 0})))
      << "they stand";
  // The cosine of 0.8 is that of 3 : 4 : 5.
  EXPECT_TRUE(is_opposed(settings, in_counterflow({{2, 0}, {2, 1}, {3, -1}}, {-0.81f, 0.6f})));
  EXPECT_FALSE(is_opposed(settings, in_counterflow({{2, 0}, {2, 1}, {3, -1}}, {-0.79f, 0.6f})));
}

TEST(Lanes, WithoutOthersTheRightmostLaneIsTheBest) {
  // 0.15 a metre aside, less 0.2 on the right: the rightmost lane, 1.2 m off, 1.5 m ahead.
  const Plane preferred = Lanes({}, kAhead).preferred();
  const float size = std::sqrt(1.5f * 1.5f + 1.2f * 1.2f);
  EXPECT_NEAR(preferred.x, 1.2f * 1.5f / size, 1e-5f);
  EXPECT_NEAR(preferred.z, 1.2f * 1.2f / size, 1e-5f);
  LaneSettings straight;
  straight.right = 0.1f;
  const Plane own = Lanes(straight, kAhead).preferred();
  EXPECT_FLOAT_EQ(own.x, 1.2f);
  EXPECT_FLOAT_EQ(own.z, 0);
}

TEST(Lanes, ItWalksBehindItsOwnDirectionAndBesideTheOther) {
  LaneSettings settings;
  settings.right = 0;
  Lanes lanes(settings, kAhead);
  for (const float z : {-0.8f, -0.4f, 0.0f, 0.4f}) lanes.add({1, z}, kBack);
  for (const float z : {0.8f}) lanes.add({1, z}, kAhead);
  const Plane preferred = lanes.preferred();
  // The lane 0.8 m to the right: (1.5, 0.8) / 1.7 of the speed.
  EXPECT_NEAR(preferred.x, 1.2f * 1.5f / 1.7f, 1e-5f);
  EXPECT_NEAR(preferred.z, 1.2f * 0.8f / 1.7f, 1e-5f);
}

TEST(Lanes, AvatarsBehindOrFarAwayDoNotCount) {
  LaneSettings settings;
  settings.right = 0;
  Lanes lanes(settings, kAhead);
  for (const float x : {-0.1f, 5.1f, 80.0f}) lanes.add({x, 0}, kBack);
  lanes.add({1, 0.6f}, kBack);  // more than half a metre aside of its own lane
  EXPECT_FLOAT_EQ(lanes.preferred().z, 0);
}

TEST(Lanes, TheOrderDoesNotMatterAndTheSpeedStays) {
  for (uint64_t seed = 1; seed <= 200; ++seed) {
    const auto draw = [&](uint64_t n, float max) {
      return max * static_cast<float>(2 * random_unit(seed, 1, n) - 1);
    };
    const Plane preferred{draw(0, 1), draw(1, 1)};
    std::vector<std::pair<Plane, Plane>> others;
    for (uint64_t n = 1; n <= 30; ++n) {
      others.push_back(
          {{draw(4 * n, 6), draw(4 * n + 1, 6)}, {draw(4 * n + 2, 2), draw(4 * n + 3, 2)}});
    }
    Lanes one({}, preferred), other({}, preferred);
    for (const auto& [at, heading] : others) one.add(at, heading);
    for (auto it = others.rbegin(); it != others.rend(); ++it) other.add(it->first, it->second);
    const Plane a = one.preferred(), b = other.preferred();
    EXPECT_EQ(a.x, b.x);
    EXPECT_EQ(a.z, b.z);
    EXPECT_NEAR(std::hypot(a.x, a.z), std::hypot(preferred.x, preferred.z), 1e-5f);
    EXPECT_GT(a.x * preferred.x + a.z * preferred.z, 0);
  }
}

TEST(Spacing, LeadsAwayFromOthersThatAreTooClose) {
  Situation s;
  EXPECT_EQ(keep_spacing({}, s).x, 0);
  const SampledSettings settings;  // bodies count 0.02 m larger
  const auto add = [&](Plane at) {
    s.near.add(settings, {.at = at, .velocity = {}, .radii = 0.5f});
  };
  add({2, 0});
  EXPECT_EQ(keep_spacing({}, s).x, 0);
  add({0.54f, 0});  // 0.02 m off: 0.04 m are missing, 3 times as much a second
  EXPECT_NEAR(keep_spacing({}, s).x, -0.12f, 1e-3f);
  EXPECT_EQ(keep_spacing({}, s).z, 0);
  add({0, -0.5f});  // touching: 0.06 m
  EXPECT_NEAR(keep_spacing({}, s).z, 0.18f, 1e-3f);
  add({-0.54f, 0});
  EXPECT_NEAR(keep_spacing({}, s).x, 0, 1e-3f) << "between two it stays";
}

}  // namespace
}  // namespace throng::steer
