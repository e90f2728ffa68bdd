// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "throng/base.h"
#include "throng/scene.h"

/// A prism as triangles.
namespace throng::test {

struct PrismShell {
  std::vector<Vec3d> corners;
  std::vector<std::array<uint32_t, 3>> triangles;
};

inline PrismShell shell_of(const Prism& prism) {
  PrismShell shell;
  const auto count = static_cast<uint32_t>(prism.corners.size());
  for (const double y : {prism.low, prism.high}) {
    for (const auto& [x, z] : prism.corners) shell.corners.push_back({x, y, z});
  }
  for (uint32_t k = 0; k < count; ++k) {
    const uint32_t next = (k + 1) % count;
    shell.triangles.push_back({k, next, next + count});
    shell.triangles.push_back({k, next + count, k + count});
    if (k == 0 || k + 1 == count) continue;
    shell.triangles.push_back({0, k, k + 1});
    shell.triangles.push_back({count, count + k, count + k + 1});
  }
  return shell;
}

inline void add_to(Scene& scene, const PrismShell& shell) {
  const auto first = static_cast<uint32_t>(scene.positions.size());
  scene.positions.insert(scene.positions.end(), shell.corners.begin(), shell.corners.end());
  for (const auto& t : shell.triangles) {
    scene.triangles.push_back({first + t[0], first + t[1], first + t[2]});
  }
  scene.area.resize(scene.triangles.size());
}

}  // namespace throng::test
