// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>

#include "core/stopwatch.h"
#include "throng/scenario.h"
#include "validate/tests.h"

// The list of tests, and the run of one by its name.
namespace throng {
namespace {

struct RecordedTest {
  ValidationTest about;
  Result<ValidationResult> (*run)(const std::string& folder, const ValidationConfig& config,
                                  Context& context);
};

const RecordedTest kRecorded[] = {
    {{"walkers", "People in streets for 4.8 s, and four predictions of their positions",
      "All people recorded for 0.4 s before and 4.8 s after a start, one each 4.8 s, start with "
      "their recorded position and the velocity of the last 0.4 s; no prediction has destinations "
      "or walls. Errors: distance to the recorded position, mean of 12 positions and last. Min "
      "distances between the people predicted, at the same positions.",
      "scenes of [PESV09], [LCL07]; no target; beside constant velocity, [HM95] and "
      "[CAACD]"},
     validate::walkers},
    {{"laboratory",
      "Corridors, a counter-flow and an entrance gate, beside recordings of these experiments",
      "The same walls; each avatar enters at the time and place of the first recorded position of "
      "one person, with a desired speed of 1.34 m/s. Flow over a line by the time between people, "
      "without the first and the last tenth [SS10]; meanwhile classic density in a box, and speeds "
      "over 0.8 s in it. Paths up to the line, in moves of 0.4 s: length by straight line, turns, "
      "changes of speed, distance walked away from the line. Measured alike in both.",
      "trajectories of [ZKSS11], [ZKSS12], [ABHSS20]; no target"},
     validate::laboratory},
};

template <class Do>
void for_tests(Do act) {
  for (const auto family :
       {validate::density_tests, validate::bottleneck_tests, validate::stream_tests,
        validate::motion_tests, validate::rest_tests, validate::passage_tests,
        validate::crossing_tests, validate::counterflow_tests, validate::maze_tests,
        validate::jam_tests}) {
    for (const validate::Test& test : family()) act(test);
  }
}

}  // namespace

bool ValidationResult::passed() const {
  return faults.overlaps == 0 && faults.wall_entries == 0 && faults.obstacle_entries == 0 &&
         std::ranges::all_of(measures, &ValidationMeasure::passed);
}

std::vector<ValidationTest> validation_tests() {
  std::vector<ValidationTest> tests;
  for_tests([&](const validate::Test& test) { tests.push_back(test.about); });
  return tests;
}

Result<ValidationResult> run_validation(const std::string& name, const ValidationConfig& config,
                                        Context& context) {
  const validate::Test* found = nullptr;
  std::string known;
  for_tests([&](const validate::Test& test) {
    if (test.about.name == name) found = &test;
    known += (known.empty() ? "" : ", ") + test.about.name;
  });
  if (found == nullptr) {
    return Error{Errc::kNotFound, "validate: no test is called " + name + "; choose from " + known};
  }
  const auto start = Clock::now();
  auto result = found->run(config, context);
  if (result) result->seconds = seconds_since(start);
  return result;
}

std::vector<ValidationTest> recorded_validation_tests() {
  std::vector<ValidationTest> tests;
  for (const RecordedTest& test : kRecorded) tests.push_back(test.about);
  return tests;
}

Result<ValidationResult> run_recorded_validation(const std::string& name, const std::string& folder,
                                                 const ValidationConfig& config, Context& context) {
  const auto found = std::ranges::find_if(
      kRecorded, [&](const RecordedTest& test) { return test.about.name == name; });
  if (found == std::end(kRecorded)) {
    return Error{Errc::kNotFound, "validate: no test of recordings is called " + name};
  }
  const auto start = Clock::now();
  auto result = found->run(folder, config, context);
  if (result) result->seconds = seconds_since(start);
  return result;
}

}  // namespace throng
