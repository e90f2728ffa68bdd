// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "steer/sampled.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "core/random.h"

namespace throng::steer {
namespace {

double size_of(Plane p) { return std::sqrt(p.x * p.x + p.z * p.z); }

TEST(SampledSteering, TimesToTouchAreThoseOfDiscs) {
  constexpr double kNever = std::numeric_limits<double>::infinity();
  EXPECT_DOUBLE_EQ(time_to_touch({3, 0}, {-1, 0}, 1), 2);
  EXPECT_DOUBLE_EQ(time_to_touch({5, 3}, {-1, 0}, 5), 1);  // 4, 3, 5
  EXPECT_DOUBLE_EQ(time_to_touch({0, -6}, {0, 4}, 2), 1);
  EXPECT_EQ(time_to_touch({3, 2}, {-1, 0}, 1), kNever);   // passes
  EXPECT_EQ(time_to_touch({3, 1}, {-1, 0}, 1), kNever);   // grazes
  EXPECT_EQ(time_to_touch({3, 0}, {1, 0}, 1), kNever);    // goes away
  EXPECT_EQ(time_to_touch({3, 0}, {0, 0}, 1), kNever);    // alike
  EXPECT_EQ(time_to_touch({0.5, 0}, {-1, 0}, 1), 0);      // touches and approaches
  EXPECT_EQ(time_to_touch({0.5, 0}, {1, 0}, 1), kNever);  // touches and leaves
  EXPECT_EQ(time_to_touch({0, 0}, {1, 0}, 1), kNever);    // coincident
}

TEST(SampledSteering, AloneItDoesWhatItWishes) {
  const Choices choices = choose_velocity({}, {0.3, 0.9}, {1.1, -0.2}, 1.3, {});
  EXPECT_EQ(choices[0].x, 1.1);
  EXPECT_EQ(choices[0].z, -0.2);
  const Choices still = choose_velocity({}, {0, 0}, {0, 0}, 1.3, {});
  EXPECT_EQ(size_of(still[0]), 0);
}

TEST(SampledSteering, HeadOnItGoesToTheRight) {
  const std::vector<Neighbour> other{{{1.6, 0}, {-1.3, 0}, 0.6}};
  const Choices choices = choose_velocity({}, {1.3, 0}, {1.3, 0}, 1.3, other);
  EXPECT_GT(choices[0].z, 0.1);
  EXPECT_GT(choices[0].x, 0);
  // Turned by 90 degrees, so is the answer.
  const std::vector<Neighbour> below{{{0, 1.6}, {0, -1.3}, 0.6}};
  const Choices turned = choose_velocity({}, {0, 1.3}, {0, 1.3}, 1.3, below);
  EXPECT_NEAR(turned[0].x, -choices[0].z, 1e-9);
  EXPECT_NEAR(turned[0].z, choices[0].x, 1e-9);
}

TEST(SampledSteering, OvertakesAndLetsThoseAheadBe) {
  const std::vector<Neighbour> slow{{{0.9, 0}, {0.4, 0}, 0.6}};
  EXPECT_GT(std::fabs(choose_velocity({}, {1.3, 0}, {1.3, 0}, 1.3, slow)[0].z), 0.1);
  const std::vector<Neighbour> fast{{{0.9, 0}, {1.3, 0}, 0.6}};
  EXPECT_EQ(choose_velocity({}, {1.3, 0}, {1.3, 0}, 1.3, fast)[0].z, 0);
  const std::vector<Neighbour> beside{{{0, 1}, {1.3, 0}, 0.6}};
  EXPECT_EQ(choose_velocity({}, {1.3, 0}, {1.3, 0}, 1.3, beside)[0].x, 1.3);
}

TEST(SampledSteering, ChoicesAreFiniteAndNeverFasterThanTheBody) {
  for (uint64_t n = 0; n < 500; ++n) {
    uint64_t k = 0;
    const auto number = [&](double most) { return most * (2 * random_unit(7, n, k++) - 1); };
    std::vector<Neighbour> others(random_below(7, n, k++, 15));
    for (Neighbour& o : others)
      o = {{number(3), number(3)}, {number(2), number(2)}, 0.1 + static_cast<double>(n % 5)};
    if (n % 7 == 0) others.push_back({{0, 0}, {0, 0}, 0.6});
    const double fastest = 0.2 + std::fabs(number(2));
    Plane wish{number(1), number(1)};
    const double size = size_of(wish);
    if (size > fastest) wish = {wish.x * fastest / size, wish.z * fastest / size};
    for (const Plane& v : choose_velocity({}, {number(1), number(1)}, wish, fastest, others)) {
      ASSERT_TRUE(size_of(v) <= fastest * (1 + 1e-12)) << n;
    }
  }
}

TEST(SampledSteering, PatienceTurnsRightWhileOneDoesNotGetOn) {
  const Patience patience;
  double turn = 0;
  for (int i = 0; i < 5; ++i) turn = next_turn(patience, turn, 0.1, 0.1);
  EXPECT_NEAR(turn, 5 * 0.1 * patience.rate, 1e-12);
  for (int i = 0; i < 100; ++i) turn = next_turn(patience, turn, -1, 0.1);
  EXPECT_EQ(turn, patience.most);
  turn = next_turn(patience, turn, 0.9, 0.1);
  EXPECT_NEAR(turn, patience.most - 0.1 * patience.back, 1e-12);
  for (int i = 0; i < 100; ++i) turn = next_turn(patience, turn, 1, 0.1);
  EXPECT_EQ(turn, 0);
  const Plane right = turned_right({1, 0}, 1);  // 2 atan(1): a right angle
  EXPECT_NEAR(right.x, 0, 1e-12);
  EXPECT_NEAR(right.z, 1, 1e-12);
}

}  // namespace
}  // namespace throng::steer
