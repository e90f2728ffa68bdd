// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "command.h"
#include "run/caacd_options.h"
#include "sources.h"
#include "throng_view/viewer.h"

/// What throng view and throng film show: a baked world, a scenario, a recording, or a model
/// that is baked now.
namespace throng::app {

struct ViewTarget {
  std::string path;                          ///< World, scenario, recording, model, builtin:NAME.
  std::string world;                         ///< Of a recording, if it is not where it was.
  SourceOptions sources;                     ///< The model to draw; none: the walkable surface.
  std::vector<std::string> atlases;          ///< Characters; none: the built-in figure.
  std::vector<std::string> characters = {};  ///< The same as files with a skeleton.
  double cell = 0.1;                         ///< To bake models with. [m]
  bool crowd = true;                         ///< Start one in a world.
  std::optional<uint64_t> seed;              ///< Of a scenario, in place of its own.
  CrowdStart start;
  std::string density = {};              ///< A picture: check_options reads it into `start`.
  std::vector<double> density_box = {};  ///< Its corners x0, z0, x1, z1; empty: the world's. [m]
  CurveWords curves = {};  ///< check_options reads them into `start`, or `experiment`.
  ExperimentStart experiment = {};
};

/// The target that is no model: the experiment of [CAACD] section V.
inline constexpr const char* kExperiment = "builtin:caacd";

/// Options of simulated avatars and their look: --only-seen, --sight, --density, --density-box,
/// --region, --coarse-far, --atlas, --character, and --world.
void add_people_options(CLI::App* command, ViewTarget& target);
/// --model, --set, --order and --axes.
void add_curve_options(CLI::App* command, ViewTarget& target);

/// Fails with kBadConfig: an option that the target does not obey, as one of simulated avatars for
/// a scenario or recording, which have their own. What is dropped into a window later needs no
/// check: there they are left out. Fills in what the options of [CAACD] say.
[[nodiscard]] Result<void> check_options(const CLI::App& command, ViewTarget& target);

/// How to load it. Errors are reported on loading.
[[nodiscard]] LoadStage stage_of(const ViewTarget& target);

/// Last part of a path, for titles.
[[nodiscard]] std::string short_name(const std::string& path);

}  // namespace throng::app
