// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>

#include "import/raw/raw_scene.h"

/// Quake 3 levels (IBSP, version 46), curved patches included.
namespace throng::importer {

/// Reads the drawn faces that are solid: polygons and meshes as triangles, curved pieces as patches
/// of raised degree that are neighbours where their borders are the same numbers. Water, sky, fog,
/// triggers and what the map calls non-solid are left out; billboards are
/// counted. The node is the class of the entity that owns the face ("worldspawn", "func_door" ...),
/// the material its texture. Fails with kBadFile and the lump.
[[nodiscard]] Result<RawScene> read_bsp(std::string_view bytes, const ReadOptions& options,
                                        Context& context);

}  // namespace throng::importer
