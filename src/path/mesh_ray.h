// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "path/mesh.h"

/// Straight lines over a mesh, rectangle by rectangle.
namespace throng {

/// A ray that passes the corner of a rectangle so exactly that only the cells can tell.
inline constexpr uint32_t kUnsure = UINT32_MAX - 1;

/// The rectangle in which the move from `from`, which lies in `rect`, to `to` ends; kNoRect if it
/// leaves the mesh, or kUnsure. Exact: what it lets pass, walk() lets pass to the same level.
uint32_t mesh_ray(const PathMesh& mesh, uint32_t rect, GroundPoint from, GroundPoint to);

enum class RayEnd { kArrived, kBlocked, kTouches };

/// Does a ray reach the point beside a corner, on the corner's own storey? kTouches: as kUnsure.
RayEnd ray_to_corner(const PathMesh& mesh, const Stop& from, uint32_t corner);

}  // namespace throng
