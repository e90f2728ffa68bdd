// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "steer/sampled.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

#include "core/random.h"
#include "simd_targets.h"
#include "steer/sampled_kernel.h"

namespace throng::steer {
namespace {

// Seconds until discs touch; -1 if never.
float time_to_touch(Plane at, Plane velocity, float radii) {
  NearSet near;
  near.add({.gap = 0}, {at, velocity, radii});
  const float s = soonness(at, velocity, near.apart[0]);
  return s > 0 ? 1 / s : -1;
}

Situation situation(Plane velocity, Plane preferred, const std::vector<Neighbour>& others = {},
                    float fastest = 1.3f) {
  Situation s{.velocity = velocity,
              .preferred = preferred,
              .fastest = fastest,
              .near = {},
              .free_distance = {}};
  for (const Neighbour& other : others) s.near.add({}, other);
  return s;
}

Plane best(const Situation& s) { return choose_velocity({}, s)[0]; }

TEST(SampledSteering, TimesToTouchAreThoseOfDiscs) {
  EXPECT_NEAR(time_to_touch({3, 0}, {-1, 0}, 1), 2, 1e-6);
  EXPECT_NEAR(time_to_touch({5, 3}, {-1, 0}, 5), 1, 1e-6);  // 4, 3, 5
  EXPECT_NEAR(time_to_touch({0, -6}, {0, 4}, 2), 1, 1e-6);
  EXPECT_EQ(time_to_touch({3, 2}, {-1, 0}, 1), -1);            // passes
  EXPECT_EQ(time_to_touch({3, 1.001f}, {-1, 0}, 1), -1);       // all but grazes
  EXPECT_EQ(time_to_touch({3, 0}, {1, 0}, 1), -1);             // goes away
  EXPECT_EQ(time_to_touch({3, 0}, {0, 0}, 1), -1);             // alike
  EXPECT_NEAR(time_to_touch({0.5f, 0}, {-1, 0}, 1), 0, 2e-6);  // touches and approaches
  EXPECT_EQ(time_to_touch({0.5f, 0}, {1, 0}, 1), -1);          // touches and leaves
  EXPECT_EQ(time_to_touch({0, 0}, {1, 0}, 1), -1);             // coincident
}

TEST(SampledSteering, NearnessCountsFromTheSoonest) {
  EXPECT_NEAR(nearness(0.5f), 1 / 2.1, 1e-6);
  EXPECT_NEAR(nearness(1e6f), 10, 1e-3);
  EXPECT_EQ(nearness(0), 0);
}

TEST(SampledSteering, NearnessOfAWallIsThatOfTheTimeToReachIt) {
  EXPECT_NEAR(nearness_of_wall(1, 0.5f), 1 / 2.1, 1e-6);
  EXPECT_NEAR(nearness_of_wall(0, 0.5f), 10, 1e-4);
  EXPECT_EQ(nearness_of_wall(0, 0), 0);
}

TEST(SampledSteering, AloneItTakesThePreferredVelocity) {
  const Plane preferred = best(situation({0.3f, 0.9f}, {1.1f, -0.2f}));
  EXPECT_EQ(preferred.x, 1.1f);
  EXPECT_EQ(preferred.z, -0.2f);
  EXPECT_EQ(size_of(best(situation({0, 0}, {0, 0}))), 0);
  EXPECT_TRUE(preferred_is_open({}, situation({0.3f, 0.9f}, {1.1f, -0.2f})));
}

TEST(SampledSteering, HeadOnItPassesOnTheRight) {
  const Situation ahead = situation({1.3f, 0}, {1.3f, 0}, {{{1.6f, 0}, {-1.3f, 0}, 0.6f}});
  EXPECT_FALSE(preferred_is_open({}, ahead));
  EXPECT_GT(best(ahead).z, 0.1f);
  EXPECT_GT(best(ahead).x, 0);
  // Turned by 90 degrees, so is the answer.
  const Plane turned = best(situation({0, 1.3f}, {0, 1.3f}, {{{0, 1.6f}, {0, -1.3f}, 0.6f}}));
  EXPECT_NEAR(turned.x, -best(ahead).z, 1e-6);
  EXPECT_NEAR(turned.z, best(ahead).x, 1e-6);
}

TEST(SampledSteering, OvertakesSlowerOnesAndFollowsEqualOnes) {
  const Plane v{1.3f, 0};
  EXPECT_GT(std::fabs(best(situation(v, v, {{{0.9f, 0}, {0.4f, 0}, 0.6f}})).z), 0.1f);
  EXPECT_EQ(best(situation(v, v, {{{0.9f, 0}, {1.3f, 0}, 0.6f}})).z, 0);
  EXPECT_EQ(best(situation(v, v, {{{0, 1}, {1.3f, 0}, 0.6f}})).x, 1.3f);
}

// The speed limit at a spacing [m], by an equivalent formula.
double speed_for(double spacing, double fastest) {
  const double u = spacing / (SampledSettings{}.headway * fastest);
  return 1.1 * fastest * (u + u * u / 2 + u * u * u / 2) / (1 + u + u * u / 2 + u * u * u / 2);
}

TEST(SampledSteering, FollowsNoFasterThanTheSpacingAllows) {
  const Plane preferred{1.3f, 0};
  const auto speed = [&](const Neighbour& other) {
    return following({}, situation({}, preferred, {other}));
  };
  // 0.8 m apart, of which 0.4 m are bodies however wide they are.
  EXPECT_NEAR(speed({{0.8f, 0}, {}, 0.6f, preferred}).x, speed_for(0.4, 1.3), 1e-5);
  EXPECT_NEAR(speed({{0.8f, 0}, {}, 0.5f, preferred}).x, speed_for(0.4, 1.3), 1e-5);
  EXPECT_NEAR(speed({{0.8f, 0}, {}, 0.28f, preferred}).x, speed_for(0.5, 1.3),
              1e-5);  // and the gap
  EXPECT_EQ(speed({{0.4f, 0}, {}, 0.38f, preferred}).x, 0);
  EXPECT_EQ(speed({{3, 0}, {}, 0.5f, preferred}).x, 1.3f);
  // A faster leader raises the limit by a share of the difference.
  const double limit = speed_for(0.2, 1.3), foresight = SampledSettings{}.foresight;
  EXPECT_NEAR(speed({{0.6f, 0}, {1.2f, 0.4f}, 0.5f, preferred}).x,
              limit + foresight * (1.2 - limit), 1e-5);
  EXPECT_NEAR(speed({{0.6f, 0}, {0.1f, 0}, 0.5f, preferred}).x, limit, 1e-5);
  // Behind, beside, in another direction, or without a preferred velocity: no leader.
  EXPECT_EQ(speed({{-0.8f, 0}, {}, 0.6f, preferred}).x, 1.3f);
  EXPECT_EQ(speed({{0.5f, 0.6f}, {}, 0.6f, preferred}).x, 1.3f);
  EXPECT_EQ(speed({{0.8f, 0}, {}, 0.6f, {0, 1.3f}}).x, 1.3f);
  EXPECT_EQ(speed({{0.8f, 0}, {}, 0.6f, {-1.3f, 0}}).x, 1.3f);
  EXPECT_EQ(speed({{0.8f, 0}, {}, 0.6f, {1, 0.8f}}).x,
            1.3f);  // 39 degrees; up to 37 is the same direction
  EXPECT_LT(speed({{0.8f, 0}, {}, 0.6f, {1, 0.7f}}).x, 1.3f);  // 35
  EXPECT_EQ(speed({{0.8f, 0}, {}, 0.6f, {}}).x, 1.3f);
  // The nearest of several counts, and the direction stays.
  const Situation many =
      situation({}, {0, -1}, {{{0, -2}, {}, 0.6f, {0, -1}}, {{0, -0.7f}, {}, 0.6f, {0, -1}}});
  EXPECT_NEAR(following({}, many).z, -speed_for(0.3, 1.3), 1e-5);
  EXPECT_EQ(following({}, many).x, 0);
}

TEST(SampledSteering, TurnsAwayFromAWallAheadAndStopsInADeadEnd) {
  Situation s = situation({1.3f, 0}, {1.3f, 0});
  s.has_walls = true;
  s.free_distance.fill(5);
  EXPECT_EQ(best(s).x, 1.3f);
  for (const size_t k : {0, 1, 2, 22, 23}) s.free_distance[k] = 0.2f;
  EXPECT_FALSE(preferred_is_open({}, s));
  const Plane aside = best(s);
  EXPECT_GT(std::fabs(aside.z), 0.5f);
  EXPECT_GT(aside.x, 0);
  s.free_distance.fill(0);
  EXPECT_EQ(size_of(best(s)), 0);
}

// Situations of all kinds: crowded, coincident, without a preferred velocity, beside walls.
Situation random_situation(uint64_t seed, uint64_t n) {
  uint64_t k = 0;
  const auto number = [&](double max) {
    return static_cast<float>(max * (2 * random_unit(seed, n, k++) - 1));
  };
  const float fastest = 0.2f + std::fabs(number(2));
  Situation s = situation({number(1), number(1)}, {number(1), number(1)}, {}, fastest);
  const float size = size_of(s.preferred);
  if (size > fastest)
    s.preferred = {s.preferred.x * fastest / size, s.preferred.z * fastest / size};
  if (n % 11 == 0) s.preferred = {};
  const uint64_t others = random_below(seed, n, k++, kMaxNear + 1);
  for (uint64_t i = 0; i < others; ++i) {
    const Plane at = i == 3 && n % 7 == 0 ? Plane{} : Plane{number(3), number(3)};
    const float radii = 0.1f + static_cast<float>(n % 5) / 4;
    const Plane heading = n % 2 == 0 ? s.preferred : Plane{number(1), number(1)};
    s.near.add({}, {at, {number(2), number(2)}, radii, heading});
  }
  s.has_walls = n % 3 == 0;
  for (float& distance : s.free_distance) distance = std::max(number(1), 0.0f);
  return s;
}

TEST(SampledSteering, ChoicesAreFiniteAndNeverFasterThanTheBody) {
  for (uint64_t n = 0; n < 500; ++n) {
    const Situation s = random_situation(7, n);
    for (const Plane& v : choose_velocity({}, s)) {
      ASSERT_TRUE(size_of(v) <= s.fastest * (1 + 1e-6f)) << n;
    }
  }
}

TEST(SampledSteering, VectorsFindTheSameBits) {
  test::for_every_simd_target([&](const char* name) {
    for (uint64_t n = 0; n < 2000; ++n) {
      const Situation s = random_situation(9, n);
      const Plane limited = following_fast({}, s), expected_limit = following({}, s);
      ASSERT_EQ(std::memcmp(&limited, &expected_limit, sizeof limited), 0) << name << ' ' << n;
      ASSERT_EQ(preferred_is_open_fast({}, s), preferred_is_open({}, s)) << name << ' ' << n;
      for (const int32_t opposers : {0, 1, 2, 3}) {
        const LaneSettings lanes{.opposers = opposers};
        ASSERT_EQ(is_opposed_fast(lanes, s), is_opposed(lanes, s)) << name << ' ' << n;
      }
      const Trials expected_trials = trials_of(s);
      const Costs expected = costs_of({}, s, expected_trials);
      Trials trials;
      Costs costs;
      costs_of_fast({}, s, trials, costs);
      ASSERT_EQ(std::memcmp(&expected_trials, &trials, sizeof trials), 0) << name << ' ' << n;
      ASSERT_EQ(std::memcmp(&expected, &costs, sizeof costs), 0) << name << ' ' << n;
      const Plane best = best_fast({}, s);
      const Plane first = best_of(expected, expected_trials)[0];
      ASSERT_EQ(std::memcmp(&best, &first, sizeof best), 0) << name << ' ' << n;
      for (const Plane& choice : best_of(expected, expected_trials)) {
        const Plane next = take_best_fast(trials, costs);
        ASSERT_EQ(std::memcmp(&next, &choice, sizeof choice), 0) << name << ' ' << n;
      }
    }
  });
}

TEST(SampledSteering, WithoutProgressItTurnsRightAndReturnsWithProgress) {
  const DeadlockAvoidance settings;
  float angle = 0;
  for (int i = 0; i < 5; ++i) angle = next_detour_angle(settings, angle, 0.1f, 0.1f, 0.1f);
  EXPECT_NEAR(angle, 5 * 0.1 * settings.rate, 1e-6);
  angle = next_detour_angle(settings, settings.side_angle, 0.9f, 0, 0.1f);
  EXPECT_NEAR(angle, settings.side_angle - 0.1 * settings.return_rate, 1e-6);
  for (int i = 0; i < 100; ++i) angle = next_detour_angle(settings, angle, 1, 1, 0.1f);
  EXPECT_EQ(angle, 0);
}

TEST(SampledSteering, ABlockedAvatarTurnsAwaySlowlyUntilItWalks) {
  const DeadlockAvoidance settings;
  float angle = settings.side_angle;
  for (int i = 0; i < 10; ++i) angle = next_detour_angle(settings, angle, 0, 0, 0.1f);
  EXPECT_NEAR(angle, settings.side_angle + settings.slow_rate, 1e-5);
  // It walks away from its goal: the angle decreases until it can head to the goal again.
  EXPECT_NEAR(next_detour_angle(settings, angle, -0.2f, 0.9f, 0.1f),
              angle - 0.1 * settings.return_rate, 1e-6);
  // In a corner no angle helps: it starts again at 0.
  float largest = 0;
  int steps = 0;
  for (; angle > 0; ++steps) {
    angle = next_detour_angle(settings, angle, -0.1f, 0.2f, 0.1f);
    largest = std::max(largest, angle);
  }
  EXPECT_NEAR(largest, settings.max_angle, 0.1 * settings.slow_rate + 1e-5);
  EXPECT_NEAR(steps * 0.1, (settings.max_angle - settings.side_angle) / settings.slow_rate - 1,
              0.5);
  // Below side_angle only progress towards the goal counts.
  EXPECT_GT(next_detour_angle(settings, 0.3f, 0.2f, 0.9f, 0.1f), 0.3f);
}

TEST(SampledSteering, DetourAnglesAreToTheRight) {
  const Plane right = turned_right({1, 0}, 1);  // 2 atan(1): a right angle
  EXPECT_NEAR(right.x, 0, 1e-6);
  EXPECT_NEAR(right.z, 1, 1e-6);
}

}  // namespace
}  // namespace throng::steer
