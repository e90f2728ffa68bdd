// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include "throng/base.h"
#include "throng/scene.h"

/// Turns any triangles into triangles that a bake can rely on.
namespace throng::importer {

/// Drops triangles with bad indices or non-finite corners, drops unused vertices, counts
/// degenerate, coincident and spike triangles, and warns of suspicious sizes. Fails with kBadInput
/// if nothing is left or the scene is larger than a world can be. `name` is for messages.
[[nodiscard]] Result<void> clean_scene(Scene& scene, const std::string& name, Context& context);

}  // namespace throng::importer
