// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "command.h"
#include "sources.h"
#include "throng/world.h"

/// throng picture --camera: what an eye in the world sees.
namespace throng::app {

struct ScenePictureOptions {
  std::vector<double> camera;        ///< Eye and target. [m]
  std::vector<std::string> atlases;  ///< None: the built-in figure.
  SourceOptions sources;             ///< What to draw; none: where one can walk.
  uint32_t crowd = 0;                ///< Avatars to place, where no file says where they are.
  int32_t height = 0;                ///< 0: nine sixteenths of the width. [px]
  double view_angle = 45;            ///< Top to bottom. [degrees]
  // Set by the command itself.
  std::string avatars;  ///< CSV file, or empty.
  int32_t avatar_class = 0;
  int32_t width = 0;

  /// Is there an option that means nothing without --camera?
  [[nodiscard]] bool needs_camera() const;
};

void add_scene_picture_options(CLI::App* command, ScenePictureOptions& options);

/// Draws and writes the picture; returns the exit code.
int draw_scene_picture(Session& session, const World& world, const ScenePictureOptions& options,
                       const std::string& output);

}  // namespace throng::app
