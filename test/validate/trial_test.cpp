// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "core/random.h"
#include "throng/scenario.h"

namespace throng {
namespace {

// One person walks 10 m at 1 m/s, then through a slow area of 5 m at 0.5 m/s, then 4 m on.
const std::string kWalk = R"(seconds = 60
cell = 0.05
[trial]
name = "walk"
title = "One walks"
source = "by hand"
[plane]
floor = [[0, 0], [22, 0], [22, 2], [0, 2]]
[[class]]
name = "walker"
radius = 0.19
[[area]]
name = "begin"
box = [0.9, 0.9, 1.1, 1.1]
[[area]]
name = "slow"
box = [11, 0, 16, 2]
speed_factor = 0.5
[[area]]
name = "end"
box = [20, 0, 22, 2]
[[profile]]
name = "one"
speed = 1
[[journey]]
name = "walk"
stages = [{ leave = "end" }]
[[source]]
name = "source"
area = "begin"
journey = "walk"
profile = "one"
count = 1
premovement = 3
)";

// Measures m0, m1, ...
std::string measures(const std::vector<std::string>& bodies) {
  std::string text;
  for (size_t n = 0; n < bodies.size(); ++n) {
    text += "[[measure]]\nname = \"m" + std::to_string(n) + "\"\n" + bodies[n] + "\n";
  }
  return text;
}

ValidationResult run(const std::string& text, int32_t workers = 1) {
  const auto trial = parse_trial(text, "walk.toml");
  EXPECT_TRUE(trial) << trial.error().message;
  Context context;
  auto result = run_trial(*trial, {.workers = workers}, context);
  EXPECT_TRUE(result) << result.error().message;
  return *result;
}

TEST(Trial, MeasuresAreThoseOfOneWalkWorkedOutByHand) {
  const auto result = run(
      kWalk +
      measures({"of = \"time\"", "of = \"left\"", "of = \"premovement\"", "of = \"delay\"",
                "of = \"desired_speed\"", "of = \"speed\"\narea = \"slow\"",
                "of = \"speed\"\nfrom = 4\nuntil = 11", "of = \"people\"", "of = \"stayed\"",
                "of = \"people\"\nexit = \"slow\"", "of = \"passed\"\nline = [[10, 0], [10, 2]]",
                "of = \"passed\"\nline = [[10, 1.5], [10, 2]]",
                "of = \"density\"\narea = \"slow\"\nfrom = 14\nuntil = 22",
                "of = \"density\"\narea = \"slow\"\nstatistic = \"max\"",
                "of = \"ratio\"\nothers = [\"m0\", \"m2\"]",
                "of = \"difference\"\nothers = [\"m1\", \"m0\"]",
                "of = \"rise\"\nothers = [\"m2\", \"m0\", \"m1\"]"}));
  const double time = 10 + 10 + 4;
  const std::vector<std::pair<double, double>> expected = {
      {time, 0.4}, {time + 3, 0.4}, {3, 1e-9},        {0.1, 0.101}, {1, 1e-9}, {0.5, 0.005},
      {1, 0.005},  {1, 0},          {0, 0},           {0, 0},       {1, 0},    {0, 0},
      {0.1, 1e-9}, {0.1, 1e-9},     {time / 3, 0.15}, {3, 1e-9},    {3, 1e-9},
  };
  ASSERT_EQ(result.measures.size(), expected.size());
  for (size_t i = 0; i < expected.size(); ++i) {
    EXPECT_NEAR(result.measures[i].value, expected[i].first, expected[i].second) << "m" << i;
  }
  EXPECT_EQ(result.checks, static_cast<uint64_t>(std::lround(result.measures[1].value / 0.1)));
  EXPECT_TRUE(result.passed());
}

TEST(Trial, AFitIsLikelyForWhatIsDrawnSoAndNotForWhatIsNot) {
  std::string text = kWalk;
  const auto put = [&](const std::string& from, const std::string& to) {
    text.replace(text.find(from), from.size(), to);
  };
  put("count = 1", "count = 60\nplaces = \"rows\"");
  put("box = [0.9, 0.9, 1.1, 1.1]", "box = [0.3, 0.3, 10, 1.7]");
  put("speed = 1", "speed = { normal = [1.2, 0.2], within = [0.6, 1.8] }");
  put("seconds = 60", "seconds = 30");
  text +=
      "[[measure]]\nname = \"desired\"\nof = \"desired_speed\"\nprofile = \"one\"\nstatistic = "
      "\"fit\"\n";
  // In a corridor for two abreast no avatar walks at its desired speed.
  text +=
      "[[measure]]\nname = \"walked\"\nof = \"speed\"\nprofile = \"one\"\nstatistic = \"fit\"\n"
      "area = \"slow\"\n";
  const auto one = run(text, 1);
  EXPECT_GT(one.measures[0].value, 0.05);
  EXPECT_LT(one.measures[1].value, 1e-6);
  for (const int32_t workers : {2, 4}) {
    const auto other = run(text, workers);
    EXPECT_EQ(other.measures[0].value, one.measures[0].value);
    EXPECT_EQ(other.measures[1].value, one.measures[1].value);
  }
}

TEST(Trial, ANumberThatNothingGaveIsNoneAndFails) {
  const auto result = run(kWalk + measures({"of = \"left\"\nexit = \"slow\"\nlow = 0",
                                            "of = \"rise\"\nothers = [\"m0\", \"m0\"]\nlow = -1"}));
  for (const ValidationMeasure& m : result.measures) {
    EXPECT_TRUE(std::isnan(m.value)) << m.name;
    EXPECT_FALSE(m.passed()) << m.name;
  }
}

TEST(Trial, NamesOfFormerVersionsMeanTheSame) {
  const std::pair<const char*, const char*> cases[] = {
      {"of = \"desired_speed\"", "of = \"wish\""},
      {"of = \"time\"\nstatistic = \"mean\"", "of = \"time\"\ntake = \"mean\""},
      {"of = \"time\"\nstatistic = \"min\"", "of = \"time\"\ntake = \"least\""},
      {"of = \"left\"\nstatistic = \"max\"", "of = \"left\"\ntake = \"most\""},
      {"of = \"left\"\nstatistic = \"range\"", "of = \"left\"\nstatistic = \"spread\""},
  };
  for (const auto& [present, former] : cases) {
    const auto expected = parse_trial(kWalk + measures({present}), "present.toml");
    const auto found = parse_trial(kWalk + measures({former}), "former.toml");
    ASSERT_TRUE(expected) << expected.error().message;
    ASSERT_TRUE(found) << found.error().message;
    EXPECT_EQ(found->measures[0].of, expected->measures[0].of) << former;
    EXPECT_EQ(found->measures[0].statistic, expected->measures[0].statistic) << former;
  }
}

TEST(Trial, WhatIsWrongIsRefusedInOneSentence) {
  const std::pair<std::string, std::string> cases[] = {
      {"of = \"weight\"", "of must be one of: time, left"},
      {"of = \"time\"\nnonsense = 1", "unknown key 'nonsense'"},
      {"of = \"time\"\nsource = \"other\"", "source: there is no 'other'; there are: source"},
      {"of = \"time\"\nstatistic = \"overall\"", "only a speed"},
      {"of = \"time\"\nstatistic = \"fit\"", "can fit"},
      {"of = \"desired_speed\"\nstatistic = \"fit\"", "a fit needs one source"},
      {"of = \"time\"\nstatistic = \"total\"", "statistic must be one of: mean, min, max, range"},
      {"of = \"time\"\nstatistic = \"min\"\ntake = \"max\"", "unknown key 'take'"},
      {"of = \"time\"\nline = [[0, 0], [1, 1]]", "only flow and passed"},
      {"of = \"flow\"", "line = [[x, z], [x, z]]"},
      {"of = \"flow\"\nline = [[1, 1], [1, 1]]", "two different"},
      {"of = \"flow\"\nline = [[1, 1], [1, 2]]\nstatistic = \"mean\"", "one number only"},
      {"of = \"density\"", "needs an area"},
      {"of = \"people\"\narea = \"end\"", "only a speed or a density"},
      {"of = \"speed\"\nfrom = 5\nuntil = 5", "until must be after from"},
      {"of = \"time\"\nlow = 5\nhigh = 4", "low must not be above high"},
      {"of = \"ratio\"\nothers = [\"x\", \"y\"]", "others: there is no 'x'"},
      {"of = \"ratio\"", "others"},
      {"of = \"time\"\nby = \"width\"", "only a flow"},
  };
  for (const auto& [rest, why] : cases) {
    const auto trial = parse_trial(kWalk + "[[measure]]\nname = \"bad\"\n" + rest, "bad.toml");
    ASSERT_FALSE(trial) << rest;
    EXPECT_EQ(trial.error().code, Errc::kBadFile) << rest;
    EXPECT_EQ(trial.error().message.find("bad.toml"), 0U) << trial.error().message;
    EXPECT_NE(trial.error().message.find(why), std::string::npos) << trial.error().message;
  }
  const auto nothing = parse_trial(kWalk, "walk.toml");
  ASSERT_FALSE(nothing);
  EXPECT_NE(nothing.error().message.find("nothing is measured"), std::string::npos);
  EXPECT_FALSE(load_trial("/no/such/file.toml"));
  EXPECT_FALSE(load_trials("/no/such/folder"));
}

// Any file is either read or refused with the place of the fault.
TEST(Trial, DamagedFilesNeverDoHarm) {
  const std::string good =
      kWalk +
      measures({"of = \"flow\"\nline = [[10, 0], [10, 2]]\nby = \"width\"\nlow = 1\nhigh = 2",
                "of = \"speed\"\nstatistic = \"fit\"\nprofile = \"one\"\narea = \"slow\"\nfrom = 1",
                "of = \"ratio\"\nothers = [\"m0\", \"m1\"]"});
  ASSERT_TRUE(parse_trial(good, "good.toml"));
  const std::string bytes = "0123456789.-\"[]{}=,\n #\xff";
  int read = 0, refused = 0;
  for (uint64_t seed = 0; seed < 2000; ++seed) {
    std::string text = good;
    for (uint64_t k = 0; k < 1; ++k) {
      const uint64_t at = random_below(seed, 1, k, text.size());
      text[at] = bytes[random_below(seed, 2, k, bytes.size())];
    }
    const auto trial = parse_trial(text, "bad.toml");
    ++(trial ? read : refused);
    if (!trial) {
      EXPECT_EQ(trial.error().message.find("bad.toml"), 0U) << trial.error().message;
    }
  }
  EXPECT_GT(read, 50);
  EXPECT_GT(refused, 100);
}

TEST(Trial, WhatIsNotModelledIsNotRun) {
  const auto trial = parse_trial("[trial]\nname = \"smoke\"\nlacks = \"no smoke\"\n", "smoke.toml");
  ASSERT_TRUE(trial) << trial.error().message;
  EXPECT_EQ(trial->about.name, "smoke");
  Context context;
  const auto result = run_trial(*trial, {}, context);
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().message, "smoke: cannot be run: no smoke");
}

}  // namespace
}  // namespace throng
