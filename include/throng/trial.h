// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "throng/base.h"
#include "throng/context.h"
#include "throng/result.h"
#include "throng/scenario.h"
#include "throng/validation.h"

/// Trials: scenario files that state what their run must measure (tables [trial] and [[measure]],
/// docs/validation.md), such as the tests of the standards.
namespace throng {

/// The quantity that is measured.
enum class Observed : uint8_t {
  kTime,          ///< From the end of the premovement to leaving, per avatar. [s]
  kLeft,          ///< Time of leaving, per avatar. [s]
  kPremovement,   ///< From entering to the end of the premovement, per avatar. [s]
  kDelay,         ///< From the end of the premovement to the first move, per avatar. [s]
  kDesiredSpeed,  ///< Desired speed, per avatar. [m/s]
  kSpeed,       ///< Distance walked by time, per avatar, in an area or since the premovement. [m/s]
  kPeople,      ///< Number of avatars that left.
  kStayed,      ///< Number of avatars that entered and have not left.
  kDensity,     ///< People in an area by its size, at each step. [1/m2]
  kFlow,        ///< People per second over a line, or by its length. [p/s, p/(m s)]
  kPassed,      ///< Number of avatars that crossed a line.
  kRatio,       ///< Of two earlier measures.
  kDifference,  ///< Of two earlier measures.
  /// Minimum difference from one to the next of some earlier measures: 0 or more if they never
  /// fall.
  kRise,
};

/// How many numbers become one.
enum class Statistic : uint8_t {
  kMean,
  kMin,
  kMax,
  kRange,    ///< kMax - kMin.
  kOverall,  ///< Of kSpeed: all distances by all times.
  kFit,      ///< Likelihood that they were drawn from the scenario's distribution [Stephens70].
};

/// A measure: which quantity of which avatars, and the bounds between which it passes.
struct TrialMeasure {
  std::string name;
  Observed of = Observed::kTime;
  Statistic statistic = Statistic::kMean;
  std::vector<int32_t> sources, profiles, journeys;  ///< Only these; empty: all.
  std::vector<int32_t> exits;  ///< Only avatars that left by these areas; empty: all.
  int32_t area = -1;           ///< kSpeed, kDensity.
  std::array<std::array<double, 2>, 2> line = {};  ///< kFlow, kPassed. [x, z, m]
  bool by_width = false;                           ///< kFlow: by the line's length.
  double from = 0;                                 ///< kSpeed, kDensity, kFlow, kPassed. [s]
  double until = std::numeric_limits<double>::infinity();  ///< [s]
  std::vector<size_t> others;                              ///< Indices of earlier measures.
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
};

/// A trial: a scenario and its measures.
struct Trial {
  ValidationTest about;
  std::string note;  ///< What differs from the source.
  /// What the simulation cannot do yet, so that the trial does not run; empty: nothing.
  std::string lacks;
  Scenario scenario;  ///< Empty if something is lacking.
  std::vector<TrialMeasure> measures;
};

/// Reads a trial. Fails as load_scenario does, and with kBadFile if it has no measures.
[[nodiscard]] THRONG_API Result<Trial> load_trial(const std::string& path);
/// The same for a text; `name` is used in messages.
[[nodiscard]] THRONG_API Result<Trial> parse_trial(const std::string& text,
                                                   const std::string& name);
/// Reads all trials below a folder, sorted by name. Fails with kNotFound (no folder), and as
/// load_trial does.
[[nodiscard]] THRONG_API Result<std::vector<Trial>> load_trials(const std::string& folder);

/// Runs a trial's scenario until its time is over or all avatars have left, and checks every step
/// for overlaps and wall entries. config.seed counts from the scenario's own seed: 1 is that one.
/// Fails with kBadConfig (something is lacking), and as open_world and Simulation::make do.
[[nodiscard]] THRONG_API Result<ValidationResult> run_trial(const Trial& trial,
                                                            const ValidationConfig& config,
                                                            Context& context);

}  // namespace throng
