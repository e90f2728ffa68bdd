// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "bake/surface/body_sweep.h"
#include "core/random.h"

namespace throng {
namespace {

// Triangles in runs as a tessellation has them, or all over the place and so far apart that their
// cubes cannot be numbered.
Scene soup(double size, double spread, uint64_t seed) {
  Scene scene;
  constexpr uint32_t kCount = 5000;
  for (uint32_t i = 0; i < kCount; ++i) {
    const auto dice = [&](uint64_t k) { return random_unit(seed, i, k) - 0.5; };
    const double row = i / 70 * 0.4, column = i % 70 * 0.4;
    const Vec3d at{column + spread * dice(0), spread * dice(1), row + spread * dice(2)};
    for (uint64_t c = 0; c < 3; ++c) {
      scene.positions.push_back(at +
                                Vec3d{dice(3 + 3 * c), dice(4 + 3 * c), dice(5 + 3 * c)} * size);
    }
    scene.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    scene.area.push_back(0);
    if (seed % 2 == 1) scene.patch_of_triangle.push_back(i % 9 == 0 ? kNoPatch : i / 500);
  }
  return scene;
}

TEST(TriangleSquares, FindEachTriangleWhoseBoxOverlapsOnceWhateverTheOrder) {
  for (const auto& [spread, seed] : {std::pair{0.2, 1}, {0.2, 2}, {900.0, 3}, {900.0, 4}}) {
    const Scene scene = soup(0.9, spread, static_cast<uint64_t>(seed));
    const bake::TriangleSquares triangles(scene, 2);
    std::vector<uint32_t> found;
    for (uint64_t round = 0; round < 60; ++round) {
      const auto dice = [&](uint64_t k) { return random_unit(8, round, k); };
      const double reach = spread > 1 ? 100 * dice(3) : 3 * dice(3);
      const Vec3d at{28 * dice(0), spread * (dice(1) - 0.5), 28 * dice(2)};
      const Vec3d half{reach, reach, reach};
      const Box3d box{at - half, at + half};
      found.clear();
      triangles.find(box, found);
      std::sort(found.begin(), found.end());
      EXPECT_EQ(std::adjacent_find(found.begin(), found.end()), found.end());
      for (uint32_t t = 0; t < scene.triangles.size(); ++t) {
        Box3d around;
        for (const Vec3d& corner : triangles.corners(t)) around.add(corner);
        const bool apart = around.min.x > box.max.x || around.max.x < box.min.x ||
                           around.min.y > box.max.y || around.max.y < box.min.y ||
                           around.min.z > box.max.z || around.max.z < box.min.z;
        if (apart) continue;
        EXPECT_TRUE(std::binary_search(found.begin(), found.end(), t)) << t;
      }
    }
  }
}

TEST(TriangleSquares, OfNoTrianglesFindNone) {
  const Scene scene;
  const bake::TriangleSquares triangles(scene, 2);
  std::vector<uint32_t> found;
  triangles.find({{-1e7, -1e7, -1e7}, {1e7, 1e7, 1e7}}, found);
  EXPECT_TRUE(found.empty());
}

}  // namespace
}  // namespace throng
