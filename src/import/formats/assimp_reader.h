// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "import/raw/raw_scene.h"

/// glTF, GLB, FBX, STL, DAE, IFC and 3DS through assimp, in a process of its own.
namespace throng::importer {

/// Reads a model. Nodes become "parent/child" paths. Fails with kBadFile where assimp refuses, runs
/// out of memory or time, or crashes: none of these reach the caller's process.
[[nodiscard]] Result<RawScene> read_with_assimp(const std::string& path, const ReadOptions& options,
                                                Context& context);

}  // namespace throng::importer
