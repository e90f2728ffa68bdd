// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

#include "throng/scene.h"

/// Moves and removes triangles with all arrays that a scene keeps by the triangle.
namespace throng::importer {

/// Puts a triangle in the place of another.
inline void move_triangle(Scene& scene, size_t from, size_t to) {
  scene.triangles[to] = scene.triangles[from];
  scene.area[to] = scene.area[from];
  if (!scene.patch_of_triangle.empty()) scene.patch_of_triangle[to] = scene.patch_of_triangle[from];
  if (!scene.patch_part.empty()) scene.patch_part[to] = scene.patch_part[from];
  if (!scene.texture_corners.empty()) scene.texture_corners[to] = scene.texture_corners[from];
}

/// Leaves the first triangles.
inline void keep_triangles(Scene& scene, size_t count) {
  scene.triangles.resize(count);
  scene.area.resize(count);
  if (!scene.patch_of_triangle.empty()) scene.patch_of_triangle.resize(count);
  if (!scene.patch_part.empty()) scene.patch_part.resize(count);
  if (!scene.texture_corners.empty()) scene.texture_corners.resize(count);
}

}  // namespace throng::importer
