// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "command.h"
#include "run/run_sinks.h"
#include "throng/scenario.h"

/// throng run with a scenario file.
namespace throng::app {

struct ScenarioRun {
  std::string file;
  std::string text;                    // content of the file
  std::optional<uint64_t> steps;       // instead of the scenario's seconds
  std::optional<uint64_t> seed;        // instead of the scenario's
  std::optional<SteeringModel> model;  // instead of the scenario's
  bool full_speed = false;             // stairs and slopes slow none, whatever the scenario says
  bool ignore_jams = false;            // none takes another route, whatever the scenario says
  bool pushing = false;                // none queues or is limited in its acceleration
  uint64_t check_every = 0;            // 0: ten times a run
  int32_t workers = 0;
  std::string trips;      // CSV of all trips; empty: none
  std::string obstacles;  // CSV of when obstacles were requested and up; empty: none
  SinkOptions sinks;
};

/// Is it the name of a scenario file, not of a world's folder?
[[nodiscard]] bool is_scenario_file(const std::string& name);

/// Runs it and prints the result. Returns the exit code.
int run_scenario(Session& session, ScenarioRun& run);

inline constexpr const char* kScenarioModel = "scenario";

/// The scenario of a recording's settings. Fails with kBadFile.
[[nodiscard]] Result<Scenario> recorded_scenario(const Json& settings);

}  // namespace throng::app
