// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "throng/papers.h"

namespace throng::caacd {
namespace {

Study studied(const StudyConfig& config) {
  Context context;
  auto study = run_study(config, context);
  EXPECT_TRUE(study) << study.error().message;
  return *std::move(study);
}

TEST(CaacdStudy, SameBytesForAnyNumberOfWorkers) {
  for (const int32_t workers : {1, 2, 3, 8, 0}) {
    const Study study =
        studied({.avatars = {5, 20}, .seeds = 4, .frames = 700, .workers = workers});
    EXPECT_EQ(study.hash, 8866256567397039511u) << "workers = " << workers;
  }
}

TEST(CaacdStudy, TheSummaryIsThatOfItsRuns) {
  StudyConfig config{.sets = {{1, 1, 0.06}}, .avatars = {40}, .seeds = 5, .frames = 400};
  config.space.seed = 11;
  const StudyCell cell = studied(config).at(0, 0);
  const Model model{.mass = 1, .max_speed = 1, .max_force = 0.06};
  double sum = 0, squares = 0, walked = 0;
  int64_t least = 1 << 30, most = 0;
  for (uint64_t seed = 11; seed < 16; ++seed) {
    auto space = random_space({.avatars = 40, .seed = seed}, model);
    ASSERT_TRUE(space);
    auto run = Simulation::create(*space, model);
    ASSERT_TRUE(run);
    while (run->counts().frames < 400 && !run->finished()) run->step();
    const auto found = static_cast<double>(run->counts().collisions);
    sum += found;
    squares += found * found;
    walked += run->counts().walked / 40;
    least = std::min(least, run->counts().collisions);
    most = std::max(most, run->counts().collisions);
  }
  EXPECT_NEAR(cell.mean, sum / 5, 1e-9);
  EXPECT_NEAR(cell.deviation, std::sqrt((squares - sum * sum / 5) / 4), 1e-9);
  EXPECT_EQ(cell.min_collisions, least);
  EXPECT_EQ(cell.max_collisions, most);
  EXPECT_GT(most, 0);
  EXPECT_NEAR(cell.walked, walked / 5, 1e-9);
}

TEST(CaacdStudy, TheNamedSetsComeOutInThePapersOrder) {
  const Study study = studied({.avatars = {60}, .seeds = 8, .frames = 1500});
  EXPECT_GT(study.at(0, 0).mean, study.at(1, 0).mean);  // 1.0/1.0/0.06
  EXPECT_GT(study.at(1, 0).mean, study.at(2, 0).mean);  // 1.0/0.8/0.06 and 2.0/0.4/0.06
  // Avoiding is what keeps it low.
  StudyConfig blind{.sets = {named_sets()[2]}, .avatars = {60}, .seeds = 8, .frames = 1500};
  blind.model.trigger = Trigger::kNever;
  EXPECT_GT(studied(blind).at(0, 0).mean, 4 * study.at(2, 0).mean);
}

TEST(CaacdStudy, AModelWithASetDiffersInItsThreeNumbersOnly) {
  Model model;
  model.mass = 7;
  model.trigger = Trigger::kNever;
  const Model made = with_set(model, {1.5, 0.8, 0.1});
  EXPECT_EQ(made.mass, 1.5);
  EXPECT_EQ(made.max_speed, 0.8);
  EXPECT_EQ(made.max_force, 0.1);
  EXPECT_EQ(made.trigger, Trigger::kNever);
}

TEST(CaacdStudy, SetsAreNamedAsThePaperDoes) {
  EXPECT_EQ(name_of({2, 0.4, 0.06}), "2.0/0.4/0.06");
  EXPECT_EQ(name_of({1, 1, 0.2}), "1.0/1.0/0.20");
  EXPECT_EQ(name_of({1.25, 0.45, 0.125}), "1.25/0.45/0.125");
  const auto grid = grid_sets();
  EXPECT_EQ(grid.size(), 60u);
  for (const ParameterSet& set : named_sets()) {
    EXPECT_EQ(std::ranges::count(grid, set), 1) << name_of(set);
  }
  for (const ParameterSet& set : grid) {
    EXPECT_TRUE(set.mass >= 1 && set.mass <= 2 && set.max_speed >= 0.4 && set.max_speed <= 1.2 &&
                set.max_force >= 0.02 && set.max_force <= 0.2);
  }
}

TEST(CaacdStudy, ThePapersNumbers) {
  const auto expect = [](int32_t avatars, int32_t bad, int32_t others) {
    EXPECT_EQ(reported_collisions(avatars).bad, bad) << avatars;
    EXPECT_EQ(reported_collisions(avatars).others, others) << avatars;
  };
  expect(5, 2, 2);
  expect(10, 2, 2);
  expect(15, 4, 4);
  expect(30, 4, 4);
  expect(35, 8, 6);
  expect(50, 11, 7);
  expect(55, 109, 23);
  expect(100, 109, 23);
}

TEST(CaacdStudy, BadStudiesAreRefusedAndACancelledOneStops) {
  Context context;
  const auto refused = [&](const StudyConfig& config) {
    const auto study = run_study(config, context);
    return study ? Errc::kOk : study.error().code;
  };
  EXPECT_EQ(refused({}), Errc::kBadConfig);
  EXPECT_EQ(refused({.sets = {}, .avatars = {5}}), Errc::kBadConfig);
  EXPECT_EQ(refused({.avatars = {5, 0}}), Errc::kBadConfig);
  EXPECT_EQ(refused({.avatars = {5}, .seeds = 0}), Errc::kBadConfig);
  EXPECT_EQ(refused({.avatars = {5}, .frames = 0}), Errc::kBadConfig);
  EXPECT_EQ(refused({.avatars = {5}, .workers = -1}), Errc::kBadConfig);
  const auto bad_set = run_study({.sets = {{1, 0, 1}}, .avatars = {5}}, context);
  ASSERT_FALSE(bad_set);
  EXPECT_EQ(bad_set.error().message,
            "caacd: max_speed must be above 0 and finite, in the set 1.0/0.0/1.00");
  StudyConfig full{.avatars = {50}};
  full.space.side = 100;
  EXPECT_EQ(refused(full), Errc::kLimit);
  context.cancel = true;
  EXPECT_EQ(refused({.avatars = {5}}), Errc::kCancelled);
}

}  // namespace
}  // namespace throng::caacd
