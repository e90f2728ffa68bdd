// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "validate/statistics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace throng::validate {
namespace {

using Kind = Distribution::Kind;

TEST(Statistics, SharesBelowAreThoseOfTheBooks) {
  const Distribution uniform{Kind::kUniform, 10, 100};
  EXPECT_DOUBLE_EQ(share_below(uniform, 10), 0);
  EXPECT_DOUBLE_EQ(share_below(uniform, 55), 0.5);
  EXPECT_DOUBLE_EQ(share_below(uniform, 200), 1);
  const Distribution normal{Kind::kNormal, 1.2, 0.2};
  EXPECT_DOUBLE_EQ(share_below(normal, 1.2), 0.5);
  EXPECT_NEAR(share_below(normal, 1.4), 0.841345, 1e-6);
  EXPECT_NEAR(share_below(normal, 0.8), 0.022750, 1e-6);
  // 0.682689 of all lie within one deviation: (0.691462 - 0.158655) / 0.682689.
  const Distribution cut{Kind::kNormal, 0, 1, -1, 1};
  EXPECT_NEAR(share_below(cut, 0.5), 0.780454, 1e-5);
  EXPECT_DOUBLE_EQ(share_below(cut, 1), 1);
  EXPECT_DOUBLE_EQ(share_below(cut, -1), 0);
  const Distribution exponential{Kind::kExponential, 2, 0};
  EXPECT_NEAR(share_below(exponential, 2), 1 - std::exp(-1), 1e-12);
  const Distribution fixed = Distribution::fixed(3);
  EXPECT_EQ(share_below(fixed, 2.9), 0);
  EXPECT_EQ(share_below(fixed, 3), 1);
}

TEST(Statistics, KolmogorovsDistanceIsTheLargestStepAside) {
  const auto share = [](double x) { return x; };
  // Steps at .1, .4, .7 up to 1/3, 2/3, 1: the largest is 1 - .7.
  EXPECT_NEAR(ks_distance({0.7, 0.1, 0.4}, share), 0.3, 1e-12);
  EXPECT_NEAR(ks_distance({0.5}, share), 0.5, 1e-12);
  EXPECT_NEAR(ks_distance({0.9}, share), 0.9, 1e-12);  // before the step, not after it
}

TEST(Statistics, LikelihoodsAreThoseOfTheTables) {
  // 1.358 is the 5 % point and 1.628 the 1 % point of Kolmogorov's distribution.
  const double n = 10000, scale = 100 + 0.12 + 0.11 / 100;
  EXPECT_NEAR(ks_likelihood(1.358 / scale, 10000), 0.050, 2e-4);
  EXPECT_NEAR(ks_likelihood(1.628 / scale, 10000), 0.010, 2e-4);
  // [Stephens70] is good down to five: 0.563 is the 5 % point there.
  EXPECT_NEAR(ks_likelihood(0.563, 5), 0.05, 0.004);
  EXPECT_EQ(ks_likelihood(0, 100), 1);
  EXPECT_LT(ks_likelihood(1, 1000), 1e-12);
  double last = 1;
  for (double d = 0; d < 0.1; d += 0.0005) {
    const double p = ks_likelihood(d, static_cast<size_t>(n));
    EXPECT_LE(p, last + 1e-9) << d;
    last = p;
  }
}

TEST(Statistics, WeidmannsSpeedsAreThoseOfTheTable) {
  EXPECT_NEAR(weidmann(0.5), 1.30, 0.005);
  EXPECT_NEAR(weidmann(1), 1.06, 0.005);
  EXPECT_NEAR(weidmann(2), 0.61, 0.005);
  EXPECT_NEAR(weidmann(4), 0.16, 0.005);
  EXPECT_EQ(weidmann(6), 0);
}

TEST(Statistics, FlowLeavesOutTheFirstAndTheLastTenth) {
  std::vector<double> times;
  for (int i = 0; i < 20; ++i) times.push_back(0.5 * i);
  EXPECT_DOUBLE_EQ(flow_rate(times), 2);
  times.front() = -100;
  times.back() = 1000;
  EXPECT_DOUBLE_EQ(flow_rate(times), 2);
  times.pop_back();
  EXPECT_EQ(flow_rate(times), 0);
}

TEST(Statistics, ALineThroughTheOriginIsFittedAsByHand) {
  const std::vector<double> x{1, 2, 3};
  const ProportionalFit exact = fit_proportional(x, std::vector<double>{2, 4, 6});
  EXPECT_DOUBLE_EQ(exact.slope, 2);
  EXPECT_DOUBLE_EQ(exact.explained, 1);
  // (1 + 4 + 12) / 14; off by 3/14, 6/14 and 5/14 from the values 1, 2, 4, whose mean is 7/3.
  const ProportionalFit bent = fit_proportional(x, std::vector<double>{1, 2, 4});
  EXPECT_DOUBLE_EQ(bent.slope, 17.0 / 14);
  EXPECT_NEAR(bent.explained, 1 - (9.0 + 36 + 25) / 196 / (14.0 / 3), 1e-12);
  // A line through the origin is no better than the mean for values that do not rise with x.
  EXPECT_LT(fit_proportional(x, std::vector<double>{3, 2, 1}).explained, 0);
}

}  // namespace
}  // namespace throng::validate
