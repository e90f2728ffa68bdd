// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "throng/picture.h"
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

// All limits, not only of brief runs.
TEST(Motion, QueuesPassAllLimits) {
  for (const char* name : {"motion.door", "motion.rest", "motion.passages", "motion.square",
                           "motion.roundabout", "fundamental"}) {
    Context context;
    const auto result = run_validation(name, {.workers = 2}, context);
    ASSERT_TRUE(result) << result.error().message;
    expect_no_faults(*result);
    for (const ValidationMeasure& m : result->measures) {
      EXPECT_TRUE(m.passed()) << name << ": " << m.name << " is " << m.value;
    }
  }
}

// Four streams around a pillar, in brief: all of them takes minutes.
TEST(Motion, QueuesPassAPillarInBrief) {
  Context context;
  const auto result = run_validation("motion.pillar", {.workers = 2, .brief = true}, context);
  ASSERT_TRUE(result) << result.error().message;
  expect_no_faults(*result);
  EXPECT_TRUE(result->passed());
}

// None is left behind at doors of 0.8 m and more, and the flow is near that of experiments.
TEST(Motion, QueuesLeaveNoneBehind) {
  Context context;
  const auto result = run_validation("bottleneck", {.workers = 2}, context);
  ASSERT_TRUE(result) << result.error().message;
  expect_no_faults(*result);
  int flows = 0;
  for (const ValidationMeasure& m : result->measures) {
    if (m.name.starts_with("left behind")) {
      EXPECT_EQ(m.value, 0) << m.name;
    }
    if (!m.name.starts_with("flow by width")) continue;
    ++flows;
    EXPECT_GT(m.value, 1.5) << m.name;
    EXPECT_LT(m.value, 2.3) << m.name;
  }
  EXPECT_GT(flows, 5);
}

// Those that follow test what is measured, not whether it passes.
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
  EXPECT_NEAR(result.simulated, 9 * 33, 1);
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

// The number of those that arrived, of `people`, and the time, if it was all of them.
void expect_arrivals(const ValidationResult& result, const std::string& at, double people,
                     double shortest, double longest) {
  const double arrived = value_of(result, "arrived, " + at);
  const double time = value_of(result, "time until all arrived, " + at);
  EXPECT_GT(arrived, 0) << at;
  EXPECT_LE(arrived, people) << at;
  EXPECT_EQ(std::isnan(time), arrived < people) << at;
  if (!std::isnan(time)) {
    EXPECT_GT(time, shortest) << at;
    EXPECT_LE(time, longest + 0.11) << at;
  }
  for (const ValidationMeasure& m : result.measures) {
    if (m.name != "arrived, " + at) continue;
    EXPECT_EQ(m.low, people) << at;
    EXPECT_EQ(m.passed(), arrived == people) << at;
  }
}

// None is faster than its desired speed of 1.34 m/s, and arrives half a metre early at most. Groups
// of 20 begin in four rows: straight on it is 49.4 m past the pillar and 63.4 m over the
// square. To the next street of the roundabout it is more than 43.4 m.
TEST(Motion, FourStreamsAreCountedWhereTheyArrive) {
  const std::pair<const char*, double> paths[] = {
      {"motion.pillar", 49.4}, {"motion.square", 63.4}, {"motion.roundabout", 43.4}};
  for (const auto& [name, path] : paths) {
    const ValidationResult result = run_brief(name, 1);
    expect_no_faults(result);
    ASSERT_EQ(result.measures.size(), 2U) << name;
    expect_arrivals(result, "run 1", 80, (path - 0.5) / 1.34, 400);
  }
}

TEST(Motion, CounterflowIsCountedInAllThreePlaces) {
  const ValidationResult result = run_brief("motion.counterflow", 1);
  expect_no_faults(result);
  ASSERT_EQ(result.measures.size(), 7U);
  expect_arrivals(result, "door of 0.8 m, run 1", 10, 0, 300);
  // Five rows of 1.3 m, and 20 m between the groups.
  expect_arrivals(result, "corridor of 4 m", 40, (5 * 1.3 + 20 - 0.5) / 1.34, 1000);
  // Two people a second from each side for 10 s; the last come after 9.5 s, and walk 25.5 m.
  expect_arrivals(result, "corridor of 2.4 m, fed", 40, 9.5 + (25.5 - 0.5) / 1.34, 10 + 60);
  EXPECT_LE(value_of(result, "max waiting for room to enter, corridor of 2.4 m"), 40);
}

TEST(Motion, MazesAreCountedWithAllThere) {
  const ValidationResult result = run_brief("motion.mazes", 1);
  expect_no_faults(result);
  const double mazes = value_of(result, "mazes with all there");
  const double arrived = value_of(result, "arrived");
  EXPECT_EQ(mazes, 3);
  EXPECT_GE(arrived, 100 * mazes / 3 - 1e-9);
  EXPECT_EQ(mazes == 3, arrived > 100 - 1e-9);
  EXPECT_EQ(mazes == 3, std::isnan(value_of(result, "seed of the first other maze")));
  EXPECT_EQ(result.passed(), mazes == 3);
}

TEST(Motion, JamsAreMeasuredByTheSpeedAndTheRoutesThatChange) {
  const ValidationResult result = run_brief("motion.jams", 1);
  expect_no_faults(result);
  const double speed =
      value_of(result, "speed towards the next corner, of the desired speed, at the end");
  EXPECT_GT(speed, 0.5);
  EXPECT_LE(speed, 1);
  EXPECT_GT(value_of(result, "goals reached"), 0);
  const double changed = value_of(result, "routes changed, of an avatar");
  EXPECT_GE(value_of(result, "searches for other routes, of an avatar"), changed);
  EXPECT_EQ(result.passed(), speed >= 0.85);
}

// Two at the posts of a door of 0.65 or 0.7 m would hold each other for good.
TEST(Motion, NarrowDoorsLeaveNoneBehind) {
  for (const uint64_t seed : {1, 2, 3}) {
    Context context;
    const auto result = run_validation("motion.narrow", {.seed = seed, .workers = 2}, context);
    ASSERT_TRUE(result) << result.error().message;
    expect_no_faults(*result);
    for (const ValidationMeasure& m : result->measures) {
      if (!m.name.starts_with("left behind")) continue;
      EXPECT_EQ(m.value, 0) << m.name << ", seed " << seed;
    }
  }
}

TEST(Motion, NarrowDoorsAreComparedWithRecordedPeople) {
  const ValidationResult result = run_brief("motion.narrow", 1);
  expect_no_faults(result);
  for (const char* at : {", 0.5 m", ", 0.7 m"}) {
    const std::string what = std::string("flow") + at;
    const double flow = value_of(result, what);
    EXPECT_GT(flow, 0.5);
    EXPECT_DOUBLE_EQ(value_of(result, std::string("flow by width") + at),
                     flow / (std::string(at) == ", 0.5 m" ? 0.5 : 0.7));
    EXPECT_EQ(value_of(result, std::string("left behind") + at), 0);
    const double real = value_of(result, what + ", people recorded");
    for (const ValidationMeasure& m : result.measures) {
      if (m.name != what) continue;
      EXPECT_TRUE(m.low < real && real < m.high) << m.name;
    }
  }
}

TEST(Motion, FlowIsMeasuredFromSlowToFast) {
  const ValidationResult result = run_brief("motion.flow", 1);
  expect_no_faults(result);
  const double slow = value_of(result, "flow by width, 1.0 m, 0.5 m/s");
  const double walk = value_of(result, "flow by width, 1.0 m, 1.34 m/s");
  EXPECT_GT(slow, 0);
  EXPECT_DOUBLE_EQ(value_of(result, "flow at the speed of a walk by flow at 0.5 m/s"), walk / slow);
  int limited = 0;
  for (const ValidationMeasure& m : result.measures) limited += m.high == 2.6 ? 1 : 0;
  EXPECT_EQ(limited, 3);  // at each speed
  for (const char* at : {", 1.0 m, 0.5 m/s", ", 1.0 m, 1.34 m/s", ", 1.0 m, 5 m/s"}) {
    const double left_behind = value_of(result, std::string("left behind") + at);
    EXPECT_EQ(std::isnan(value_of(result, std::string("time to empty") + at)), left_behind > 0);
  }
  for (const ValidationChart& chart : result.charts) EXPECT_TRUE(draw_chart(chart.chart));
}

}  // namespace
}  // namespace throng
