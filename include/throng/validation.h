// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "throng/avatar_state.h"
#include "throng/base.h"
#include "throng/chart.h"
#include "throng/context.h"
#include "throng/result.h"
#include "throng/steering_model.h"

/// Validation: experiments with crowds whose outcome is known from real people or required by a
/// standard. Each runs on the public `Crowd`, measures by a stated method, and judges the result by
/// a range.
namespace throng {

/// A measured value, and the bounds between which it passes.
struct ValidationMeasure {
  std::string name;
  double value = 0;
  std::string unit = {};
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();

  /// Has it a bound? Without one the value is only reported.
  [[nodiscard]] bool is_judged() const {
    return low > -std::numeric_limits<double>::infinity() ||
           high < std::numeric_limits<double>::infinity();
  }
  [[nodiscard]] bool passed() const { return !is_judged() || (value >= low && value <= high); }
};

/// A chart and the name of its file, without a suffix.
struct ValidationChart {
  std::string name;
  Chart chart;
};

/// One test of the list.
struct ValidationTest {
  std::string name;    ///< The name for run_validation.
  std::string title;   ///< What is tested.
  std::string method;  ///< How it is measured, in sentences.
  std::string source;  ///< Source of the range: keys of docs/references.md.
};

/// Settings for run_validation and run_trial.
struct ValidationConfig {
  uint64_t seed = 1;
  int32_t workers = 0;  ///< Threads, 0 for all cores. Never changes the result. [>= 0]
  bool brief = false;   ///< Fewer points and shorter runs.
  /// The steering model of the crowds. Trials use their own, unless this is not the default.
  SteeringModel model = SteeringModel::kSampled;
};

/// The results of a test.
struct ValidationResult {
  std::vector<ValidationMeasure> measures;
  std::vector<ValidationChart> charts;
  CrowdCheck faults;     ///< Overlaps and wall entries, over all checks.
  uint64_t checks = 0;   ///< Checks of all avatars for these.
  double simulated = 0;  ///< [s]
  double seconds = 0;    ///< Wall clock.

  /// Is every measure within its bounds, without faults?
  [[nodiscard]] THRONG_API bool passed() const;
};

/// All tests, in the order of the tables.
[[nodiscard]] THRONG_API std::vector<ValidationTest> validation_tests();

/// Runs one test. Fails with kNotFound (no such test), kCancelled.
[[nodiscard]] THRONG_API Result<ValidationResult> run_validation(const std::string& name,
                                                                 const ValidationConfig& config,
                                                                 Context& context);

/// The tests that need recordings of real people, which are not part of throng.
[[nodiscard]] THRONG_API std::vector<ValidationTest> recorded_validation_tests();

/// Runs one of these tests with a folder of recordings. Fails with kNotFound (no such test; nothing
/// fits in the folder), kBadFile and the line, kCancelled.
[[nodiscard]] THRONG_API Result<ValidationResult> run_recorded_validation(
    const std::string& name, const std::string& folder, const ValidationConfig& config,
    Context& context);

}  // namespace throng
