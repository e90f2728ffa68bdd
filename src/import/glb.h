// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>

#include "import/raw_scene.h"

/// Binary glTF 2.0 by ourselves, for builds without assimp: triangles at rest, where their nodes
/// put them; no skins, no compression.
namespace throng {

/// Nodes become "parent/child" paths; an "area" among a node's extras is the area kind of all below
/// it, as write_glb writes it. Fails with kBadFile and what the file uses that is not read.
[[nodiscard]] Result<RawScene> read_glb(std::string_view bytes, const ReadOptions& options,
                                        Context& context);

}  // namespace throng
