// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "throng/base.h"
#include "throng/recording.h"

/// Recordings as the SQLite files that JuPedSim writes. Not in the library, which does
/// not need SQLite.
namespace throng::app {

/// Was the program built with SQLite?
[[nodiscard]] bool has_sqlite();

/// Writes version 2 of JuPedSim's tables: trajectory_data, metadata, geometry, frame_data. `wkt` is
/// the walkable area, or empty for a file without one. Fails with kBadConfig (built without
/// SQLite), kBadFile, kIo, kCancelled; then nothing is left behind.
[[nodiscard]] Result<void> export_sqlite(Replay& replay, const std::string& wkt,
                                         const std::string& path, const ExportConfig& config,
                                         Context& context);

}  // namespace throng::app
