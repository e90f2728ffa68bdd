// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include "throng/base.h"
#include "throng/scene.h"

/// Built-in worlds of patches, before these are cut into triangles.
namespace throng::importer::builtin {

struct PatchWorld {
  PatchSet patches;      ///< Empty: a world of triangles.
  double tolerance = 0;  ///< At which they are to be cut. [m]
};

/// Fails as create_builtin_world does.
[[nodiscard]] Result<PatchWorld> create_patch_world(const BuiltinWorldConfig& config);

}  // namespace throng::importer::builtin
