// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "import/raw/raw_scene.h"
#include "throng/base.h"
#include "throng/scene.h"

/// The files of a scene, one by one.
namespace throng::importer {

/// Fails with kBadConfig: no source, or numbers that cannot be.
[[nodiscard]] Result<void> check_config(const SceneConfig& config);

/// A folder stands for the landscape zones in it, in order of their names. Fails with kIo or
/// kBadFile.
[[nodiscard]] Result<std::vector<SceneSource>> open_folders(
    const std::vector<SceneSource>& sources);

/// Reads one file: in metres, with Y up, placed, area kinds by the rules. Fails with kBadFile,
/// kBadInput or kCancelled.
[[nodiscard]] Result<RawScene> read_placed(const SceneSource& source, const SceneConfig& config,
                                           Context& context);

}  // namespace throng::importer
