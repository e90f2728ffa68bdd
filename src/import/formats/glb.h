// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>

#include "import/raw/raw_scene.h"

/// Binary glTF 2.0, read without assimp for builds that lack it: triangles at rest, placed by their
/// nodes; no skins, no compression.
namespace throng::importer {

/// Nodes become "parent/child" paths; an "area" among a node's extras is the area kind of all below
/// it, as write_glb writes it. Fails with kBadFile and the feature of the file that is not
/// supported.
[[nodiscard]] Result<RawScene> read_glb(std::string_view bytes, const ReadOptions& options,
                                        Context& context);

}  // namespace throng::importer
