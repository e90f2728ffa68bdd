// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "import/patches/patch_scene.h"

#include <algorithm>
#include <array>
#include <functional>
#include <utility>

#include "core/parallel.h"
#include "import/raw/area_rules.h"

// Cuts the patches of a scene and appends their triangles. Linear in the triangles.
namespace throng::importer {

Result<void> cut_patches(Scene& scene, const SceneConfig& config, Context& context) {
  if (scene.patches.empty()) return {};
  auto mesh = tessellate_patches(scene.patches, {.tolerance = config.curve_tolerance}, context);
  if (!mesh) return mesh.error();
  if (uint64_t{scene.positions.size()} + mesh->positions.size() >= UINT32_MAX ||
      uint64_t{scene.triangles.size()} + mesh->triangles.size() >= UINT32_MAX) {
    return Error{Errc::kLimit, "scene: more than 4.29 thousand million vertices; bake it in parts"};
  }

  // First as a separate scene, so that rules see these parts alone.
  Scene cut;
  cut.triangles = std::move(mesh->triangles);
  cut.patch_part = std::move(mesh->parts);
  for (const PatchRun& run : scene.patches.runs) {
    const uint32_t first = mesh->first[run.first_patch];
    const uint32_t last = mesh->first[run.first_patch + run.patch_count];
    cut.parts.push_back({.file = run.file,
                         .node = run.node,
                         .material = run.material,
                         .first_triangle = first,
                         .triangle_count = last - first});
  }
  // In parallel: most of the cost is the first touch of so much memory.
  const std::array<std::function<void()>, 2> fills{
      [&] {
        cut.area.reserve(cut.triangles.size());
        for (size_t i = 0; i < cut.parts.size(); ++i) {
          cut.area.insert(cut.area.end(), cut.parts[i].triangle_count, scene.patches.runs[i].kind);
        }
      },
      [&] {
        cut.patch_of_triangle.reserve(cut.triangles.size());
        for (const PatchRun& run : scene.patches.runs) {
          for (uint32_t p = run.first_patch; p < run.first_patch + run.patch_count; ++p) {
            const uint32_t count = mesh->first[p + 1] - mesh->first[p];
            cut.patch_of_triangle.insert(cut.patch_of_triangle.end(), count, p);
          }
        }
      }};
  parallel_for(fills.size(), 0, [&](size_t i) { fills[i](); });
  scene.report.triangles_read += cut.triangles.size();
  apply_rules(cut, config.rules);
  scene.report.ignored += cut.report.ignored;

  const auto first_vertex = static_cast<uint32_t>(scene.positions.size());
  const auto first_triangle = static_cast<uint32_t>(scene.triangles.size());
  if (first_vertex == 0 && first_triangle == 0) {  // Moved: a large landscape fits in memory once.
    scene.positions = std::move(mesh->positions);
    scene.triangles = std::move(cut.triangles);
    scene.area = std::move(cut.area);
    scene.patch_of_triangle = std::move(cut.patch_of_triangle);
    scene.patch_part = std::move(cut.patch_part);
  } else {
    scene.positions.insert(scene.positions.end(), mesh->positions.begin(), mesh->positions.end());
    scene.triangles.reserve(scene.triangles.size() + cut.triangles.size());
    for (const auto& [a, b, c] : cut.triangles) {
      scene.triangles.push_back({first_vertex + a, first_vertex + b, first_vertex + c});
    }
    scene.area.insert(scene.area.end(), cut.area.begin(), cut.area.end());
    scene.patch_of_triangle.resize(first_triangle, kNoPatch);
    scene.patch_of_triangle.insert(scene.patch_of_triangle.end(), cut.patch_of_triangle.begin(),
                                   cut.patch_of_triangle.end());
    scene.patch_part.resize(first_triangle);
    scene.patch_part.insert(scene.patch_part.end(), cut.patch_part.begin(), cut.patch_part.end());
  }
  scene.patch_off = std::move(mesh->off);
  if (!scene.texture_corners.empty()) scene.texture_corners.resize(scene.triangles.size());
  for (ScenePart& part : cut.parts) {
    part.first_triangle += first_triangle;
    scene.parts.push_back(std::move(part));
  }
  return {};
}

}  // namespace throng::importer
