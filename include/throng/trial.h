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

/// Trials: scenario files that say what is expected of their run (tables [trial] and [[measure]],
/// docs/validation.md), such as those of the standards.
namespace throng {

/// What is looked at.
enum class Observed : uint8_t {
  kTime,          ///< From setting off to leaving, of each. [s]
  kLeft,          ///< When each left. [s]
  kPremovement,   ///< From coming to setting off, of each. [s]
  kDelay,         ///< From setting off to the first step, of each. [s]
  kDesiredSpeed,  ///< Speed that each wishes for. [m/s]
  kSpeed,         ///< Way by time, of each, in an area or since he set off. [m/s]
  kPeople,        ///< How many left.
  kStayed,        ///< How many came and have not left.
  kDensity,       ///< People in an area by its size, at each step. [1/m2]
  kFlow,          ///< People a second over a line, or by its length. [p/s, p/(m s)]
  kPassed,        ///< How many came over a line.
  kRatio,         ///< Of two measures before this one.
  kDifference,    ///< Of two measures before this one.
  kRise,  ///< The least step up from one to the next of some measures before this one: 0 or more
          ///< if none falls.
};

/// What is made of many numbers.
enum class Statistic : uint8_t {
  kMean,
  kMin,
  kMax,
  kRange,    ///< kMax - kMin.
  kOverall,  ///< Of kSpeed: all ways by all times.
  kFit,      ///< Likelihood that they were drawn from what the scenario says [Stephens70].
};

struct TrialMeasure {
  std::string name;
  Observed of = Observed::kTime;
  Statistic statistic = Statistic::kMean;
  std::vector<int32_t> sources, profiles, journeys;  ///< Only these; empty: all.
  std::vector<int32_t> exits;                        ///< Only who left by these areas; empty: all.
  int32_t area = -1;                                 ///< kSpeed, kDensity.
  std::array<std::array<double, 2>, 2> line = {};    ///< kFlow, kPassed. [x, z, m]
  bool by_width = false;                             ///< kFlow: by the line's length.
  double from = 0;                                   ///< kSpeed, kDensity, kFlow, kPassed. [s]
  double until = std::numeric_limits<double>::infinity();  ///< [s]
  std::vector<size_t> others;                              ///< Measures before this one.
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
};

struct Trial {
  ValidationTest about;
  std::string note;   ///< What is other than the source has it.
  std::string lacks;  ///< What the simulation cannot do yet, so nothing is run; empty: it can.
  Scenario scenario;  ///< Empty where something lacks.
  std::vector<TrialMeasure> measures;
};

/// Reads a trial. Fails as load_scenario does, and with kBadFile where nothing is measured.
[[nodiscard]] THRONG_API Result<Trial> load_trial(const std::string& path);
/// The same for a text; `name` stands in messages.
[[nodiscard]] THRONG_API Result<Trial> parse_trial(const std::string& text,
                                                   const std::string& name);
/// All trials below a folder, by name. Fails with kNotFound (no folder), and as load_trial does.
[[nodiscard]] THRONG_API Result<std::vector<Trial>> load_trials(const std::string& folder);

/// Runs a trial's scenario until its time is over or everybody has left, looking at every step for
/// overlaps and walls entered. The seed counts on from the scenario's own: 1 is that. Fails with
/// kBadConfig (something lacks), and as open_world and Simulation::make do.
[[nodiscard]] THRONG_API Result<ValidationResult> run_trial(const Trial& trial,
                                                            const ValidationConfig& config,
                                                            Context& context);

}  // namespace throng
