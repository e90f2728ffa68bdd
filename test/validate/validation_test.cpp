// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <string>

#include "throng/scenario.h"

namespace throng {
namespace {

TEST(Validation, AMeasureIsJudgedByItsBoundsAlone) {
  const double inf = std::numeric_limits<double>::infinity();
  EXPECT_TRUE((ValidationMeasure{.name = "a", .value = 7}).passed());
  EXPECT_FALSE((ValidationMeasure{.name = "a", .value = 7}).is_judged());
  EXPECT_TRUE((ValidationMeasure{.name = "a", .value = 2, .low = 2, .high = 3}).passed());
  EXPECT_FALSE((ValidationMeasure{.name = "a", .value = 1.9, .low = 2, .high = 3}).passed());
  EXPECT_FALSE((ValidationMeasure{.name = "a", .value = 3.1, .low = -inf, .high = 3}).passed());
  EXPECT_FALSE((ValidationMeasure{.name = "a", .value = std::nan(""), .low = 2}).passed());
  ValidationResult result;
  EXPECT_TRUE(result.passed());
  result.faults.overlaps = 1;
  EXPECT_FALSE(result.passed());
}

TEST(Validation, TestsHaveUniqueNamesAndStateTheirMethod) {
  std::set<std::string> names;
  for (const ValidationTest& test : validation_tests()) {
    EXPECT_TRUE(names.insert(test.name).second) << test.name;
    EXPECT_FALSE(test.title.empty() || test.method.empty() || test.source.empty()) << test.name;
  }
  EXPECT_FALSE(names.empty());
}

TEST(Validation, SixTestsOfMotionAreInWork) {
  const std::set<std::string> in_work = {"motion.haste",       "motion.flow",  "motion.narrow",
                                         "motion.counterflow", "motion.mazes", "motion.jams"};
  std::set<std::string> found;
  for (const ValidationTest& test : validation_tests()) {
    if (test.in_work) found.insert(test.name);
  }
  EXPECT_EQ(found, in_work);
  for (const ValidationTest& test : recorded_validation_tests()) {
    EXPECT_FALSE(test.in_work) << test.name;
  }
}

TEST(Validation, AnUnknownTestIsRefusedWithTheListOfTests) {
  Context context;
  const auto result = run_validation("fundamentl", {}, context);
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, Errc::kNotFound);
  EXPECT_NE(result.error().message.find("fundamental"), std::string::npos);
}

TEST(Validation, StopsWhenCancelled) {
  Context context;
  context.cancel = true;
  for (const char* name : {"bottleneck", "motion.rest", "motion.passages", "motion.pillar",
                           "motion.counterflow", "motion.mazes", "motion.jams"}) {
    const auto result = run_validation(name, {.brief = true}, context);
    ASSERT_FALSE(result) << name;
    EXPECT_EQ(result.error().code, Errc::kCancelled) << name;
  }
}

// The slowest: a few seconds.
TEST(Validation, SpeedFallsWithDensityAlikeForAnyWorkers) {
  Context context;
  const auto one = run_validation("fundamental", {.workers = 1, .brief = true}, context);
  const auto two = run_validation("fundamental", {.workers = 2, .brief = true}, context);
  ASSERT_TRUE(one && two);
  EXPECT_EQ(one->faults.overlaps + one->faults.wall_entries, 0);
  EXPECT_GT(one->checks, 0);
  ASSERT_EQ(one->measures.size(), two->measures.size());
  double last = 1.35;
  for (size_t i = 0; i < one->measures.size(); ++i) {
    EXPECT_EQ(one->measures[i].value, two->measures[i].value) << one->measures[i].name;
    if (one->measures[i].unit != "m/s") continue;
    EXPECT_LT(one->measures[i].value, last) << one->measures[i].name;
    last = one->measures[i].value;
  }
  // The curve beside ours, against Weidmann's numbers: 1.06 m/s at 1, 0.61 at 2 /m2.
  const Chart& chart = one->charts.at(0).chart;
  for (size_t i = 0; i < chart.x.size(); ++i) {
    const double around_one = 1.06 + (chart.x[i] - 1) * (1.06 - 1.30) / 0.5;
    if (std::abs(chart.x[i] - 1) < 0.1) {
      EXPECT_NEAR(chart.lines[0].values[i], around_one, 0.02);
    }
  }
}

}  // namespace
}  // namespace throng
