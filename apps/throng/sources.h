// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "command.h"
#include "throng/base.h"
#include "throng/scene.h"

/// Turns the FILE arguments that several commands share into one Scene.
namespace throng::app {

/// FILE... --up --scale --scene. A FILE is a model, or `builtin:NAME[,size=..][,levels=..]
/// [,triangles=..][,seed=..]`.
struct SourceOptions {
  std::vector<std::string> files;
  std::string up;     ///< "y", "z" or empty: the format's own. Files only.
  double scale = 0;   ///< Metres per unit, 0: the format's own. Files only.
  std::string scene;  ///< A scene file: more sources, and rules for area kinds of all files.
};

/// Adds the options; `name` is "FILE" for positionals or an option such as "--source".
void add_source_options(CLI::App* command, SourceOptions& options,
                        const std::string& name = "FILE");

/// Reads "builtin:garage,size=60,seed=3". Fails with kBadConfig and the word that is wrong.
Result<BuiltinWorldConfig> parse_builtin(const std::string& text);

/// Fails with kBadConfig if --up or --scale is given and no file that it is of.
Result<void> check_units(const SourceOptions& options);

/// Reads everything that the options name: the scene file's sources, then the files, then the
/// built-in worlds. Prints the report's warnings as notes.
Result<Scene> read_sources(const SourceOptions& options, Context& context,
                           SceneMaterials materials = SceneMaterials::kLeaveOut);

/// The same, to be taken district by district; `folder` is for a temporary file.
Result<std::unique_ptr<SceneRegions>> read_regions(const SourceOptions& options,
                                                   const std::string& folder, Context& context);

/// Prints a note if a model to draw or test with a world has another position or size than it: as
/// one read in other units, or with another axis up. [world: WorldSummary::bounds]
void note_if_elsewhere(const Scene& scene, const Box3d& world);

/// The report of an import as JSON: counts that are not zero, and the warnings.
Json report_json(const SceneReport& report);

}  // namespace throng::app
