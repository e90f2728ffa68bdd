// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "core/math/logarithm.h"
#include "core/random.h"
#include "scenario/spawn_times.h"
#include "throng/scenario.h"

namespace throng {
namespace {

// Largest distance between the share of numbers up to x and its law [Kolmogorov].
double distance_to_law(const Distribution& d, const std::function<double(double)>& law) {
  constexpr size_t kCount = 20000;
  std::vector<double> numbers;
  for (size_t n = 0; n < kCount; ++n) numbers.push_back(draw(d, 5, 6, n));
  std::sort(numbers.begin(), numbers.end());
  double most = 0;
  for (size_t n = 0; n < kCount; ++n) {
    const double share = (static_cast<double>(n) + 0.5) / kCount;
    most = std::max(most, std::fabs(share - law(numbers[n])));
  }
  return most;
}

// 1.36 / sqrt(n) is exceeded by chance once in twenty; the numbers are fixed, so never here.
constexpr double kMax = 0.0096;

TEST(Distribution, FollowsItsLaw) {
  EXPECT_LT(distance_to_law({Distribution::Kind::kUniform, 2, 5, 2, 5},
                            [](double x) { return (x - 2) / 3; }),
            kMax);
  EXPECT_LT(
      distance_to_law({Distribution::Kind::kNormal, 1.34, 0.26},
                      [](double x) { return std::erfc(-(x - 1.34) / 0.26 / std::sqrt(2)) / 2; }),
      kMax);
  EXPECT_LT(distance_to_law({Distribution::Kind::kExponential, 4, 0},
                            [](double x) { return 1 - std::exp(-x / 4); }),
            kMax);
}

TEST(Distribution, KeepsWithinItsLimits) {
  const Distribution d{Distribution::Kind::kNormal, 1.3, 1, 1, 1.4};
  for (uint64_t n = 0; n < 10000; ++n) {
    const double value = draw(d, 1, 2, n);
    EXPECT_TRUE(value >= 1 && value <= 1.4) << value;
  }
  EXPECT_EQ(draw(Distribution::fixed(3), 1, 2, 3), 3);
}

TEST(Distribution, HasALogarithmOfItsOwn) {
  for (uint64_t n = 0; n < 100000; ++n) {
    const double x = std::ldexp(random_unit(1, 2, n) + 1e-9, static_cast<int>(n % 200) - 100);
    EXPECT_NEAR(log_of(x), std::log(x), 1e-15 * std::max(1.0, std::fabs(std::log(x))) * 4) << x;
  }
  EXPECT_EQ(log_of(1), 0);
}

TEST(SpawnTimes, FollowTheRates) {
  Source source;
  source.group = Distribution::fixed(1);
  source.rates = {{10, 2}, {20, 0}, {30, 5}};
  source.end = 40;
  scenario::SpawnTimes arrivals(source, 1, 0);
  int before = 0, early = 0, pause = 0, late = 0;
  for (int step = 0; step <= 1000; ++step) {
    const double time = step * 0.1;
    while (arrivals.next_due(time) > 0) {
      ++(time < 10 ? before : time < 20.05 ? early : time < 30 ? pause : late);
    }
  }
  EXPECT_TRUE(arrivals.is_over());
  EXPECT_EQ(before, 0);
  EXPECT_NEAR(early, 20, 3 * std::sqrt(20.0));
  EXPECT_EQ(pause, 0);
  EXPECT_NEAR(late, 50, 3 * std::sqrt(50.0));
}

TEST(SpawnTimes, AreEvenOrAtOnceUpToTheCount) {
  Source source;
  source.group = Distribution::fixed(1);
  source.rates = {{0, 4}};
  source.pattern = SpawnPattern::kEven;
  source.count = 10;
  scenario::SpawnTimes even(source, 1, 0);
  std::vector<int> at;
  for (int step = 0; step < 100; ++step) {
    while (even.next_due(step * 0.125) > 0) at.push_back(step);
  }
  EXPECT_EQ(at, (std::vector<int>{2, 4, 6, 8, 10, 12, 14, 16, 18, 20}));

  source.rates.clear();
  source.begin = 5;
  source.group = Distribution::fixed(4);
  scenario::SpawnTimes once(source, 1, 0);
  EXPECT_EQ(once.next_due(4.9), 0U);
  EXPECT_EQ(once.next_due(5), 4U);
  EXPECT_EQ(once.next_due(5), 4U);
  EXPECT_EQ(once.next_due(5), 2U);
  EXPECT_EQ(once.next_due(5), 0U);
}

}  // namespace
}  // namespace throng
