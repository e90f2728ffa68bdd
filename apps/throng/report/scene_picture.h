// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "command.h"
#include "sources.h"
#include "throng/world.h"

/// throng picture --camera: the view from an eye in the world.
namespace throng::app {

struct ScenePictureOptions {
  std::vector<double> camera;        ///< Eye and target. [m]
  std::vector<std::string> atlases;  ///< None: the built-in figure.
  SourceOptions sources;             ///< The model to draw; none: the walkable surface.
  uint32_t crowd = 0;                ///< Avatars to place if no file has positions.
  int32_t height = 0;                ///< 0: nine sixteenths of the width. [px]
  double view_angle = 45;            ///< Top to bottom. [degrees]
  // Set by the command itself.
  std::string avatars;  ///< CSV file, or empty.
  int32_t avatar_class = 0;
  int32_t width = 0;

  /// Is an option set that needs --camera?
  [[nodiscard]] bool needs_camera() const;
};

void add_scene_picture_options(CLI::App* command, ScenePictureOptions& options);

/// Draws and writes the picture; returns the exit code.
int draw_scene_picture(Session& session, const World& world, const ScenePictureOptions& options,
                       const std::string& output);

}  // namespace throng::app
