// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "path/mesh_ray.h"

#include <algorithm>
#include <cstdlib>

namespace throng {
namespace {

// The rectangle that the step from cell (x, z) of `rect` to the neighbouring one (nx, nz) leads to.
uint32_t neighbour(const PathMesh& mesh, uint32_t rect, int32_t x, int32_t z, int32_t nx,
                   int32_t nz) {
  const MeshRect& r = mesh.rects[rect];
  int32_t cell = 0;  // of the border, counted around the rectangle
  if (nz < r.z) {
    cell = x - r.x;
  } else if (nx >= r.x + r.width) {
    cell = r.width + (z - r.z);
  } else if (nz >= r.z + r.depth) {
    cell = 2 * r.width + r.depth - 1 - (x - r.x);
  } else if (nx < r.x) {
    cell = 2 * (r.width + r.depth) - 1 - (z - r.z);
  } else {
    return rect;
  }
  const uint32_t end = mesh.rects[rect + 1].first_portal;
  for (uint32_t p = r.first_portal; p < end; ++p) {
    const MeshPortal& portal = mesh.portals[p];
    if (cell < portal.from) break;  // They come in order.
    if (cell < portal.to) return portal.rect;
  }
  return kNoRect;
}

// The same through the point that the two cells share, as walk() does it: both cells beside that
// point must let the ray pass, and to one rectangle.
uint32_t diagonal(const PathMesh& mesh, uint32_t rect, int32_t x, int32_t z, int32_t nx,
                  int32_t nz) {
  const uint32_t beside_x = neighbour(mesh, rect, x, z, nx, z);
  const uint32_t beside_z = neighbour(mesh, rect, x, z, x, nz);
  if (beside_x == kNoRect || beside_z == kNoRect) return kNoRect;
  const uint32_t over_x = neighbour(mesh, beside_x, nx, z, nx, nz);
  return over_x == neighbour(mesh, beside_z, x, nz, nx, nz) ? over_x : kNoRect;
}

}  // namespace

uint32_t mesh_ray(const PathMesh& mesh, uint32_t rect, GroundPoint from, GroundPoint to) {
  const int64_t dx = std::llabs(to.x - from.x), dz = std::llabs(to.z - from.z);
  const bool east = to.x > from.x, up = to.z > from.z;
  const int32_t step_x = east ? 1 : -1, step_z = up ? 1 : -1;
  const int32_t end_x = to.cell_x(), end_z = to.cell_z();
  while (rect != kNoRect) {
    const MeshRect& r = mesh.rects[rect];
    const bool in_x = end_x >= r.x && end_x < r.x + r.width;
    const bool in_z = end_z >= r.z && end_z < r.z + r.depth;
    if (in_x && in_z) return rect;
    // Distances to the sides that it may leave by, each times the other axis' length: the smaller
    // one is met first.
    const int64_t to_x = std::llabs((int64_t{east ? r.x + r.width : r.x} << kUnitBits) - from.x);
    const int64_t to_z = std::llabs((int64_t{up ? r.z + r.depth : r.z} << kUnitBits) - from.z);
    const bool by_x = in_z || (!in_x && to_x * dz < to_z * dx);
    int32_t x = east ? r.x + r.width - 1 : r.x, z = up ? r.z + r.depth - 1 : r.z;
    bool at_point = !in_x && !in_z && to_x * dz == to_z * dx;  // of four cells
    if (!at_point && by_x) {
      const int64_t rise = to_x * dz;
      const int64_t at = from.z + (up ? rise / dx : -((rise + dx - 1) / dx));
      at_point = rise % dx == 0 && (at & (kUnitsPerCell - 1)) == 0 && (rise > 0 || !up);
      z = static_cast<int32_t>(at >> kUnitBits) - (at_point && up ? 1 : 0);
      if (z < r.z || z >= r.z + r.depth) return kNoRect;
      at_point = at_point && z != end_z;
    } else if (!at_point) {
      const int64_t rise = to_z * dx;
      const int64_t at = from.x + (east ? rise / dz : -((rise + dz - 1) / dz));
      at_point = rise % dz == 0 && (at & (kUnitsPerCell - 1)) == 0 && (rise > 0 || !east);
      x = static_cast<int32_t>(at >> kUnitBits) - (at_point && east ? 1 : 0);
      if (x < r.x || x >= r.x + r.width) return kNoRect;
      at_point = at_point && x != end_x;
    }
    rect = at_point ? diagonal(mesh, rect, x, z, x + step_x, z + step_z)
                    : neighbour(mesh, rect, x, z, by_x ? x + step_x : x, by_x ? z : z + step_z);
  }
  return kNoRect;
}

bool sees_corner(const PathMesh& mesh, const Stop& from, uint32_t corner) {
  const MeshCorner& at = mesh.corners[corner];
  const uint32_t rect = mesh_ray(mesh, from.rect, from.at, beside(at));
  const uint32_t* first = mesh.corner_rects.data() + at.first_rect;
  const uint32_t* stop = mesh.corner_rects.data() + mesh.corners[corner + 1].first_rect;
  return std::find(first, stop, rect) != stop;
}

}  // namespace throng
