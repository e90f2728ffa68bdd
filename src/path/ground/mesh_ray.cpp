// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "path/ground/mesh_ray.h"

#include <algorithm>
#include <cstdlib>

// A ray from rectangle to rectangle: constant time each, in whole units, so it agrees with walk()
// over cells.
namespace throng::path {
namespace {

// What lies beyond the border of a rectangle at a cell counted around it.
uint32_t beyond(const PathMesh& mesh, uint32_t rect, int32_t cell) {
  for (const MeshPortal& portal : mesh.portals_of(rect)) {
    if (cell < portal.from) break;  // They come in order.
    if (cell < portal.to) return portal.rect;
  }
  return kNoRect;
}

// What lies beyond the border on the east or the west in row `at`, on the north or the south in
// column `at`.
uint32_t beyond_x(const PathMesh& mesh, uint32_t rect, bool east, int32_t at) {
  const MeshRect& r = mesh.rects[rect];
  return beyond(mesh, rect, east ? r.width + (at - r.z) : 2 * (r.width + r.depth) - 1 - (at - r.z));
}
uint32_t beyond_z(const PathMesh& mesh, uint32_t rect, bool north, int32_t at) {
  const MeshRect& r = mesh.rects[rect];
  return beyond(mesh, rect, north ? 2 * r.width + r.depth - 1 - (at - r.x) : at - r.x);
}

// The rectangle that the step from cell (x, z) of `rect` to the neighbouring one (nx, nz) leads to.
uint32_t neighbour(const PathMesh& mesh, uint32_t rect, int32_t x, int32_t z, int32_t nx,
                   int32_t nz) {
  const MeshRect& r = mesh.rects[rect];
  if (nx < r.x || nx >= r.x + r.width) return beyond_x(mesh, rect, nx > x, z);
  if (nz < r.z || nz >= r.z + r.depth) return beyond_z(mesh, rect, nz > z, x);
  return rect;
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

uint32_t mesh_ray(const PathMesh& mesh, uint32_t rect, world::GroundPoint from,
                  world::GroundPoint to) {
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
    const int64_t to_x =
        std::llabs((int64_t{east ? r.x + r.width : r.x} << world::kUnitBits) - from.x);
    const int64_t to_z =
        std::llabs((int64_t{up ? r.z + r.depth : r.z} << world::kUnitBits) - from.z);
    if (!in_x && !in_z && to_x * dz == to_z * dx) {
      const int32_t x = east ? r.x + r.width - 1 : r.x, z = up ? r.z + r.depth - 1 : r.z;
      rect = diagonal(mesh, rect, x, z, x + step_x, z + step_z);
    } else if (in_z || (!in_x && to_x * dz < to_z * dx)) {
      const int64_t rise = to_x * dz;
      const int64_t at = from.z + (up ? rise / dx : -((rise + dx - 1) / dx));
      auto z = static_cast<int32_t>(at >> world::kUnitBits);
      // The point lies before the cell: then the ray goes from one row into the next, if it gets
      // that far.
      if ((at & (world::kUnitsPerCell - 1)) == 0 && rise % dx == 0 && (rise > 0 || !up)) {
        if (up) --z;
        if (z != end_z) {
          const int32_t x = east ? r.x + r.width - 1 : r.x;
          rect = diagonal(mesh, rect, x, z, x + step_x, z + step_z);
          continue;
        }
      }
      if (z < r.z || z >= r.z + r.depth) return kNoRect;
      rect = beyond_x(mesh, rect, east, z);
    } else {
      const int64_t rise = to_z * dx;
      const int64_t at = from.x + (east ? rise / dz : -((rise + dz - 1) / dz));
      auto x = static_cast<int32_t>(at >> world::kUnitBits);
      if ((at & (world::kUnitsPerCell - 1)) == 0 && rise % dz == 0 && (rise > 0 || !east)) {
        if (east) --x;
        if (x != end_x) {
          const int32_t z = up ? r.z + r.depth - 1 : r.z;
          rect = diagonal(mesh, rect, x, z, x + step_x, z + step_z);
          continue;
        }
      }
      if (x < r.x || x >= r.x + r.width) return kNoRect;
      rect = beyond_z(mesh, rect, up, x);
    }
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

}  // namespace throng::path
