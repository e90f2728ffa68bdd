// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "throng/scene.h"

#include "core/corner_box.h"

// Adding triangles, and the bounds of a scene.
namespace throng {

void Scene::add_triangle(Vec3d a, Vec3d b, Vec3d c, AreaKind kind) {
  const auto first = static_cast<uint32_t>(positions.size());
  positions.insert(positions.end(), {a, b, c});
  triangles.push_back({first, first + 1, first + 2});
  area.push_back(kind);
}

void Scene::add_quad(Vec3d a, Vec3d b, Vec3d c, Vec3d d, AreaKind kind) {
  const auto first = static_cast<uint32_t>(positions.size());
  positions.insert(positions.end(), {a, b, c, d});
  triangles.push_back({first, first + 1, first + 2});
  triangles.push_back({first, first + 2, first + 3});
  area.insert(area.end(), 2, kind);
}

void Scene::add_box(Vec3d low, Vec3d high, AreaKind kind) {
  const auto first = static_cast<uint32_t>(positions.size());
  for (int corner = 0; corner < 8; ++corner) {  // bit 0: x, bit 1: y, bit 2: z
    positions.push_back({(corner & 1) != 0 ? high.x : low.x, (corner & 2) != 0 ? high.y : low.y,
                         (corner & 4) != 0 ? high.z : low.z});
  }
  constexpr std::array<std::array<uint32_t, 4>, 6> kSides{
      {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}}};
  for (const auto& side : kSides) {
    triangles.push_back({first + side[0], first + side[1], first + side[2]});
    triangles.push_back({first + side[0], first + side[2], first + side[3]});
  }
  area.insert(area.end(), 12, kind);
}

// Through the triangles, not the positions: a corner that no triangle uses is not solid.
Box3d Scene::bounds() const { return corner_box(positions, triangles, 1); }

}  // namespace throng
