// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "path/mesh_ray.h"

#include <algorithm>
#include <cstdlib>

namespace throng {
namespace {

// What lies beyond the border of a rectangle, at a cell counted around it, or at the point before
// that cell. There, both cells beside it must lead to one rectangle, or the cells have to tell.
uint32_t beyond(const PathMesh& mesh, uint32_t rect, int32_t cell, bool at_point) {
  const uint32_t end = mesh.rects[rect + 1].first_portal;
  for (uint32_t p = mesh.rects[rect].first_portal; p < end; ++p) {
    const MeshPortal& portal = mesh.portals[p];
    if (cell < portal.from) break;  // They come in order.
    if (cell >= portal.to) continue;
    return at_point && cell == portal.from ? kUnsure : portal.rect;
  }
  return at_point ? kUnsure : kNoRect;
}

}  // namespace

uint32_t mesh_ray(const PathMesh& mesh, uint32_t rect, GroundPoint from, GroundPoint to) {
  const int64_t dx = std::llabs(to.x - from.x), dz = std::llabs(to.z - from.z);
  const bool east = to.x > from.x, up = to.z > from.z;
  const int32_t end_x = to.cell_x(), end_z = to.cell_z();
  for (;;) {
    const MeshRect& r = mesh.rects[rect];
    const bool in_x = end_x >= r.x && end_x < r.x + r.width;
    const bool in_z = end_z >= r.z && end_z < r.z + r.depth;
    if (in_x && in_z) return rect;
    // Distances to the sides that it may leave by, each times the other axis' length: the smaller
    // one is met first.
    const int64_t to_x = std::llabs((int64_t{east ? r.x + r.width : r.x} << kUnitBits) - from.x);
    const int64_t to_z = std::llabs((int64_t{up ? r.z + r.depth : r.z} << kUnitBits) - from.z);
    const bool by_x = in_z || (!in_x && to_x * dz < to_z * dx);
    if (!in_x && !in_z && to_x * dz == to_z * dx) return kUnsure;
    int32_t cell = 0;  // around the rectangle
    bool at_point = false;
    if (by_x) {
      const int64_t rise = to_x * dz;
      const int64_t z = from.z + (up ? rise / dx : -((rise + dx - 1) / dx));
      at_point = rise % dx == 0 && (z & (kUnitsPerCell - 1)) == 0;
      const auto at = static_cast<int32_t>(z >> kUnitBits) - r.z;
      if (at_point && (at <= 0 || at >= r.depth)) return kUnsure;
      if (at < 0 || at >= r.depth) return kNoRect;
      // Counted the other way, the point before this cell is the one after it.
      cell = east ? r.width + at : 2 * r.width + r.depth + (r.depth - 1 - at) + (at_point ? 1 : 0);
    } else {
      const int64_t rise = to_z * dx;
      const int64_t x = from.x + (east ? rise / dz : -((rise + dz - 1) / dz));
      at_point = rise % dz == 0 && (x & (kUnitsPerCell - 1)) == 0;
      const auto at = static_cast<int32_t>(x >> kUnitBits) - r.x;
      if (at_point && (at <= 0 || at >= r.width)) return kUnsure;
      if (at < 0 || at >= r.width) return kNoRect;
      cell = up ? r.width + r.depth + (r.width - 1 - at) + (at_point ? 1 : 0) : at;
    }
    rect = beyond(mesh, rect, cell, at_point);
    if (rect == kNoRect || rect == kUnsure) return rect;
  }
}

RayEnd ray_to_corner(const PathMesh& mesh, const Stop& from, uint32_t corner) {
  const MeshCorner& at = mesh.corners[corner];
  const uint32_t rect = mesh_ray(mesh, from.rect, from.at, beside(at));
  if (rect == kUnsure) return RayEnd::kTouches;
  const uint32_t* first = mesh.corner_rects.data() + at.first_rect;
  const uint32_t* stop = mesh.corner_rects.data() + mesh.corners[corner + 1].first_rect;
  return std::find(first, stop, rect) != stop ? RayEnd::kArrived : RayEnd::kBlocked;
}

}  // namespace throng
