// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "throng/base.h"
#include "throng/context.h"
#include "throng/result.h"
#include "throng/scene.h"
#include "throng/world.h"

/// Where a class can stand, as triangles for other programs.
namespace throng {

/// The floor under all legal cells of a class, as the feet follow it: level cells and planes merged
/// into rectangles, true to 2 mm at the middle of each cell. One part a storey, material "floor".
/// Borders of the triangles are borders of cells: where the middle of a body may be. Reads every
/// zone. Fails with kBadConfig (no such class), kBadFile (a zone cannot be used), kCancelled.
[[nodiscard]] THRONG_API Result<Scene> walkable_surface(const World& world, int32_t avatar_class,
                                                        Context& context);

}  // namespace throng
