// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "throng/avatar.h"
#include "throng/scene.h"

/// What tests of nodes make them of.
namespace throng::test {

/// Walkers, one of which drops.
inline std::vector<AvatarClass> walkers() {
  std::vector<AvatarClass> classes = {{.name = "adult"}, {.name = "diver"}};
  classes[1].max_drop = 3;
  return classes;
}

/// These and climbers.
inline std::vector<AvatarClass> climbers() {
  std::vector<AvatarClass> classes = walkers();
  classes.push_back({.name = "gecko", .height = 0.5, .radius = 0.15, .step_height = 0.2});
  classes.back().climb_slope = 180;
  classes.push_back({.name = "spider", .height = 1, .radius = 0.5, .step_height = 0.3});
  classes.back().climb_slope = 100;
  classes.back().max_drop = 2;
  return classes;
}

/// A box that is no part of a patch.
inline void add_solid(Scene& scene, Vec3d low, Vec3d size) {
  const bool parts = scene.patch_part.size() == scene.triangles.size();
  scene.add_box(low, low + size);
  if (scene.patches.empty()) return;
  scene.patch_of_triangle.resize(scene.triangles.size(), kNoPatch);
  if (parts) scene.patch_part.resize(scene.triangles.size());
}

}  // namespace throng::test
