// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "path/ground/mesh.h"

/// Straight lines over a mesh, rectangle by rectangle.
namespace throng::path {

/// The rectangle in which the move from `from`, which lies in `rect`, to `to` ends; kNoRect if it
/// leaves the mesh. Exact, also through points that four cells share: what it lets pass, walk()
/// lets pass to the same level; what it blocks, walk() lets pass only over one-way steps.
uint32_t mesh_ray(const PathMesh& mesh, uint32_t rect, world::GroundPoint from,
                  world::GroundPoint to);

/// Does a ray reach the point beside a corner, on the corner's own level?
bool sees_corner(const PathMesh& mesh, const Stop& from, uint32_t corner);

}  // namespace throng::path
