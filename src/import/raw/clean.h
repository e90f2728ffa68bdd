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

/// The same for a part of a scene, of which nothing may be left, and whose size says nothing.
[[nodiscard]] Result<void> clean_part(Scene& scene, const std::string& name, Context& context);
/// What clean_scene fails with if nothing is left.
[[nodiscard]] Error nothing_left(const SceneReport& report, const std::string& name);
/// Warns of a size that a model seldom has. [m]
void warn_of_size(SceneReport& report, const std::string& name, double side);

}  // namespace throng::importer
