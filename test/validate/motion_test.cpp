// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "throng/scenario.h"

namespace throng {
namespace {

double value_of(const ValidationResult& result, const std::string& name) {
  for (const ValidationMeasure& m : result.measures) {
    if (m.name == name) return m.value;
  }
  ADD_FAILURE() << name;
  return std::nan("");
}

void expect_no_faults(const ValidationResult& result) {
  EXPECT_EQ(result.faults.overlaps + result.faults.wall_entries, 0U);
  EXPECT_GT(result.checks, 0U);
}

ValidationResult run_brief(const std::string& name, int32_t workers) {
  Context context;
  auto result = run_validation(name, {.workers = workers, .brief = true}, context);
  EXPECT_TRUE(result) << result.error().message;
  return result ? *std::move(result) : ValidationResult{};
}

// The crowd misses most limits today, so these test what is measured, not whether it passes.
TEST(Motion, MeasuresAreTheSameForAnyWorkers) {
  for (const char* name : {"motion.door", "motion.rest"}) {
    const ValidationResult one = run_brief(name, 1), two = run_brief(name, 2);
    ASSERT_EQ(one.measures.size(), two.measures.size()) << name;
    for (size_t i = 0; i < one.measures.size(); ++i) {
      EXPECT_EQ(one.measures[i].value, two.measures[i].value) << one.measures[i].name;
    }
  }
}

// The gate of the recorded people is narrower, so their paths are longer than the limit.
TEST(Motion, RecordedPeopleTurnAndChangeSpeedLessThanTheLimits) {
  const ValidationResult result = run_brief("motion.door", 1);
  expect_no_faults(result);
  int compared = 0;
  for (const ValidationMeasure& m : result.measures) {
    if (!m.name.ends_with(", run 1") || m.name.starts_with("flow")) continue;
    EXPECT_TRUE(m.is_judged()) << m.name;
    EXPECT_GE(m.value, 0) << m.name;
    if (m.unit != "%" && m.unit != "m/s" && m.unit != "m") continue;
    const std::string what = m.name.substr(0, m.name.find(','));
    EXPECT_LT(value_of(result, what + ", people recorded"), m.high) << m.name;
    ++compared;
  }
  EXPECT_EQ(compared, 3);
  EXPECT_GE(value_of(result, "path by straight line, run 1"), 1);
  EXPECT_GT(value_of(result, "turning rate of orientations, run 1"), 0);
  EXPECT_LT(value_of(result, "turning rate of orientations, run 1"), 90);
}

TEST(Motion, HasteIsMeasuredAtEachDesiredSpeed) {
  const ValidationResult result = run_brief("motion.haste", 1);
  expect_no_faults(result);
  EXPECT_EQ(value_of(result, "left behind, 2.4 m, 1 m/s"), 0);
  // 80 people begin up to 3.9 m before the door.
  const double slow = value_of(result, "time to empty, 2.4 m, 1 m/s");
  EXPECT_GT(slow, 3.9);
  EXPECT_LT(slow, 60);
  EXPECT_NE(value_of(result, "time to empty, 2.4 m, 5 m/s"), slow);
  // The flow leaves out the begin and the end, when fewer pass.
  EXPECT_GT(2.4 * value_of(result, "flow by width, 2.4 m, 1 m/s"), 0.8 * 80 / slow);
}

// However long the steps are, the same time goes by: 33 s, with three steps and two crowds.
TEST(Motion, RestIsMeasuredAfterTheSameTimeWithAnyStep) {
  const ValidationResult result = run_brief("motion.rest", 1);
  expect_no_faults(result);
  EXPECT_NEAR(result.simulated, 6 * 33, 1);
  for (const char* step : {"0.02", "0.10", "0.20"}) {
    const std::string at = std::string("nine people at 0.6 m, dt ") + step + " s: ";
    const double mean = value_of(result, at + "mean speed");
    EXPECT_GE(mean, 0);
    EXPECT_LE(mean, value_of(result, at + "speed of the fastest"));
    EXPECT_LT(value_of(result, at + "speed of the fastest"), 1.5);
    EXPECT_LT(value_of(result, at + "distance from the goals"), 2);
  }
}

TEST(Motion, PassagesCountTheSeedsWithAllThere) {
  const ValidationResult result = run_brief("motion.passages", 1);
  expect_no_faults(result);
  ASSERT_EQ(result.measures.size(), 8U);  // two for each of four corridors
  double best = 0;
  for (size_t i = 0; i < result.measures.size(); i += 2) {
    const ValidationMeasure &seeds = result.measures[i], &arrived = result.measures[i + 1];
    EXPECT_TRUE(seeds.is_judged()) << seeds.name;
    EXPECT_EQ(seeds.unit, "of " + std::to_string(static_cast<int>(seeds.low))) << seeds.name;
    EXPECT_LE(seeds.value, seeds.low) << seeds.name;
    EXPECT_LE(arrived.value, 100 + 1e-9) << arrived.name;
    EXPECT_GE(arrived.value, 100 * seeds.value / seeds.low - 1e-9) << arrived.name;
    EXPECT_EQ(seeds.value == seeds.low, arrived.value > 100 - 1e-9) << arrived.name;
    best = std::max(best, arrived.value);
  }
  EXPECT_GT(best, 0);
}

}  // namespace
}  // namespace throng
