// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "throng/scene.h"

#include "core/corner_box.h"

// Adding triangles and whole scenes, and the bounds of a scene.
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

void Scene::append(const Scene& other) {
  const auto first_vertex = static_cast<uint32_t>(positions.size());
  const auto first_triangle = static_cast<uint32_t>(triangles.size());
  positions.insert(positions.end(), other.positions.begin(), other.positions.end());
  triangles.reserve(triangles.size() + other.triangles.size());
  for (const auto& [a, b, c] : other.triangles) {
    triangles.push_back({first_vertex + a, first_vertex + b, first_vertex + c});
  }
  area.insert(area.end(), other.area.begin(), other.area.end());
  for (ScenePart part : other.parts) {
    part.first_triangle += first_triangle;
    if (part.material1 != 0) part.material1 += static_cast<uint32_t>(materials.size());
    parts.push_back(std::move(part));
  }
  for (Material material : other.materials) {
    if (material.texture1 != 0) material.texture1 += static_cast<uint32_t>(textures.size());
    materials.push_back(std::move(material));
  }
  textures.insert(textures.end(), other.textures.begin(), other.textures.end());
  if (!texture_corners.empty() || !other.texture_corners.empty()) {
    texture_corners.resize(first_triangle);
    texture_corners.insert(texture_corners.end(), other.texture_corners.begin(),
                           other.texture_corners.end());
    texture_corners.resize(triangles.size());
  }
  if (!patches.empty() || !other.patches.empty()) {
    const auto first_patch = static_cast<uint32_t>(patches.size());
    patch_of_triangle.resize(first_triangle, kNoPatch);
    for (const uint32_t patch : other.patch_of_triangle) {
      patch_of_triangle.push_back(patch == kNoPatch ? kNoPatch : first_patch + patch);
    }
    patch_of_triangle.resize(triangles.size(), kNoPatch);
    const bool known =
        patch_off.size() == patches.size() && other.patch_off.size() == other.patches.size();
    patches.append(other.patches);
    if (known) {
      patch_part.resize(first_triangle);
      patch_part.insert(patch_part.end(), other.patch_part.begin(), other.patch_part.end());
      patch_part.resize(triangles.size());
      patch_off.insert(patch_off.end(), other.patch_off.begin(), other.patch_off.end());
    } else {
      patch_part.clear();
      patch_off.clear();
    }
  }
  report.triangles_read += other.report.triangles_read;
  report.non_finite += other.report.non_finite;
  report.bad_index += other.report.bad_index;
  report.degenerate += other.report.degenerate;
  report.duplicate += other.report.duplicate;
  report.ignored += other.report.ignored;
  report.spikes += other.report.spikes;
  report.warnings.insert(report.warnings.end(), other.report.warnings.begin(),
                         other.report.warnings.end());
}

// Through the triangles, not the positions: a corner that no triangle uses is not solid.
Box3d Scene::bounds() const { return corner_box(positions, triangles, 1); }

SceneRegions::~SceneRegions() = default;

}  // namespace throng
