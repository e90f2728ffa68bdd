// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "core/files/config_file.h"
#include "throng/scene.h"

/// The scene file: its models, their placement and the area kinds of their surfaces.
namespace throng::importer {

/// The settings of a parsed scene file; relative paths begin at `folder`. Fails with kBadFile, line
/// and key.
[[nodiscard]] Result<SceneConfig> read_scene_config(const ConfigNode& root, const std::string& name,
                                                    const std::string& folder);

}  // namespace throng::importer
