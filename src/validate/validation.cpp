// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "throng/validation.h"

#include <algorithm>

#include "core/stopwatch.h"
#include "validate/tests.h"

namespace throng {
namespace {

template <class Do>
void for_tests(Do act) {
  for (const auto family : {validate::density_tests, validate::bottleneck_tests}) {
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

}  // namespace throng
