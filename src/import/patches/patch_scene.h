// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include "throng/base.h"
#include "throng/scene.h"

/// Patches become triangles of the scene that holds them.
namespace throng::importer {

/// Cuts scene.patches to config.curve_tolerance and adds their triangles behind those that are
/// there, a part for each run, with area kinds by the run and then by config.rules. A scene without
/// patches stays as it is. Fails like tessellate_patches.
[[nodiscard]] Result<void> cut_patches(Scene& scene, const SceneConfig& config, Context& context);

}  // namespace throng::importer
