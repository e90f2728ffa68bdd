// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "baked.h"
#include "core/random.h"
#include "throng/scene.h"
#include "worlds.h"

namespace throng {
namespace {

std::map<int, double> area_by_kind(const Scene& scene) {
  std::map<int, double> sum;
  for (size_t t = 0; t < scene.triangles.size(); ++t) {
    const auto& c = scene.triangles[t];
    sum[scene.area[t]] += length(cross(scene.positions[c[1]] - scene.positions[c[0]],
                                       scene.positions[c[2]] - scene.positions[c[0]])) /
                          2;
  }
  return sum;
}

// Is a point inside a convex prism, by the side of each of its edges?
bool holds(const Prism& prism, const Vec3d& p, double margin) {
  if (p.y < prism.low - margin || p.y > prism.high + margin) return false;
  bool left = true, right = true;
  for (size_t i = 0; i < prism.corners.size(); ++i) {
    const auto& a = prism.corners[i];
    const auto& b = prism.corners[(i + 1) % prism.corners.size()];
    const double side = ((b[0] - a[0]) * (p.z - a[1]) - (b[1] - a[1]) * (p.x - a[0])) /
                        std::hypot(b[0] - a[0], b[1] - a[1]);
    if (side < -margin) left = false;
    if (side > margin) right = false;
  }
  return left || right;
}

TEST(MarkVolume, CutsTrianglesExactlyAtItsSides) {
  uint64_t inside = 0, outside = 0;
  for (uint64_t seed = 0; seed < 30; ++seed) {
    Scene scene = worlds::random_soup(seed, 60, 8);
    const Scene before = scene;
    AreaVolume volume;
    volume.kind = 9;
    const auto real = [&](uint64_t n, double low, double high) {
      return low + (high - low) * static_cast<double>(random_below(seed, 99, n, 1000)) / 1000;
    };
    const double x = real(0, 1, 7), z = real(1, 1, 7), turn = real(2, 0, 6), size = real(3, 1, 4);
    const int corners = 3 + static_cast<int>(seed % 5);
    for (int i = 0; i < corners; ++i) {
      const double angle = turn + (seed % 2 == 0 ? 1 : -1) * 6.283185307179586 * i / corners;
      volume.prism.corners.push_back({x + size * std::cos(angle), z + size * std::sin(angle)});
    }
    volume.prism.low = real(4, -1, 4);
    volume.prism.high = volume.prism.low + real(5, 0.5, 5);
    ASSERT_TRUE(mark_volume(scene, volume));
    double sum_before = 0, sum_after = 0;
    for (const auto& [kind, area] : area_by_kind(before)) sum_before += area;
    for (const auto& [kind, area] : area_by_kind(scene)) sum_after += area;
    EXPECT_NEAR(sum_after, sum_before, 1e-9 * sum_before);
    for (size_t t = 0; t < scene.triangles.size(); ++t) {
      // Every corner of a marked piece lies inside; the middle of every other one outside.
      const auto& c = scene.triangles[t];
      const Vec3d middle =
          (scene.positions[c[0]] + scene.positions[c[1]] + scene.positions[c[2]]) * (1.0 / 3);
      if (scene.area[t] == 9) {
        ++inside;
        for (const uint32_t corner : c)
          EXPECT_TRUE(holds(volume.prism, scene.positions[corner], 1e-9));
      } else {
        ++outside;
        EXPECT_FALSE(holds(volume.prism, middle, -1e-9));
      }
    }
  }
  EXPECT_GT(inside, 500u);
  EXPECT_GT(outside, 500u);
}

TEST(MarkVolume, BakesToAreasOfThatKindAndSize) {
  Scene scene = worlds::flat(12);
  ASSERT_TRUE(mark_volume(scene, {Prism::box({3, -1, 2}, {7, 1, 5}), 5}));
  const World world = test::bake(scene, 0.1);
  double marked = 0, plain = 0;
  for (uint32_t l = 0; l < world.level_tile_count(); ++l) {
    const LevelTileContent tile = world.level_tile(l);
    for (size_t c = 0; c < tile.area.size(); ++c) {
      if (tile.clearance[0][c] != 0) (tile.area[c] == 5 ? marked : plain) += 0.01;
    }
  }
  EXPECT_NEAR(marked, 12, 0.8);
  EXPECT_NEAR(marked + plain, world.summary().walkable_area[0], 1e-6);
  // Blocked: no avatar stands there, nor so near that its body would be inside.
  ASSERT_TRUE(mark_volume(scene, {Prism::box({3, -1, 2}, {7, 1, 5}), kAreaBlocked}));
  const World blocked = test::bake(scene, 0.1);
  EXPECT_FALSE(blocked.find_place(0, {5, 0, 3.5}, 1));
  EXPECT_TRUE(blocked.find_place(0, {9, 0, 3.5}, 1));
  // Ignored: a hole.
  ASSERT_TRUE(mark_volume(scene, {Prism::box({3, -1, 2}, {7, 1, 5}), kAreaIgnored}));
  EXPECT_NEAR(area_by_kind(scene)[kAreaWalkable], 144 - 12, 1e-9);
}

TEST(MarkVolume, KeepsPartsTogether) {
  Scene scene = worlds::flat(4);
  const auto first = static_cast<uint32_t>(scene.triangles.size());
  scene.add_box({1, 0, 1}, {2, 1, 2});
  const auto all = static_cast<uint32_t>(scene.triangles.size());
  scene.parts = {
      {.file = "f", .node = "floor", .material = "", .first_triangle = 0, .triangle_count = first},
      {.file = "f",
       .node = "box",
       .material = "",
       .first_triangle = first,
       .triangle_count = all - first}};
  ASSERT_TRUE(mark_volume(scene, {Prism::box({1.5, -1, -1}, {9, 9, 9}), 3}));
  ASSERT_EQ(scene.parts.size(), 2u);
  EXPECT_EQ(scene.parts[1].first_triangle, scene.parts[0].triangle_count);
  EXPECT_EQ(scene.parts[1].first_triangle + scene.parts[1].triangle_count, scene.triangles.size());
  for (uint32_t t = scene.parts[1].first_triangle; t < scene.triangles.size(); ++t) {
    for (const uint32_t c : scene.triangles[t]) {
      EXPECT_GE(scene.positions[c].x, 1);
      EXPECT_LE(scene.positions[c].x, 2);
    }
  }
}

// Volumes come before broken triangles are dropped: such triangles must stay as they were.
TEST(MarkVolume, LeavesBrokenTrianglesUnchanged) {
  Scene scene = worlds::flat(4);
  const auto corners = static_cast<uint32_t>(scene.positions.size());
  scene.positions.push_back({std::numeric_limits<double>::quiet_NaN(), 0, 1});
  // The second names the first corner that a cut will add.
  for (const uint32_t bad : {corners, corners + 1, UINT32_MAX}) {
    scene.triangles.push_back({0, 1, bad});
    scene.area.push_back(kAreaWalkable);
  }
  for (const double x : {1.0, 2.0}) {
    ASSERT_TRUE(mark_volume(scene, {Prism::box({x, -1, 1}, {x + 0.5, 1, 3}), 7}));
  }
  EXPECT_GT(std::count(scene.area.begin(), scene.area.end(), 7), 0);
  size_t missing = 0, not_finite = 0;
  for (const auto& triangle : scene.triangles) {
    for (const uint32_t corner : triangle) {
      missing += corner >= scene.positions.size();
      not_finite += corner < scene.positions.size() && std::isnan(scene.positions[corner].x);
    }
  }
  EXPECT_EQ(missing, 2u);
  EXPECT_EQ(not_finite, 1u);
}

TEST(MarkVolume, KeepsTrianglesThatNoPartNames) {
  Scene scene = worlds::flat(4);
  const auto first = static_cast<uint32_t>(scene.triangles.size());
  scene.add_box({1, 0, 1}, {2, 1, 2});
  const auto last = static_cast<uint32_t>(scene.triangles.size());
  scene.add_box({3, 0, 3}, {3.5, 1, 3.5});
  scene.parts = {{.file = "f",
                  .node = "box",
                  .material = "",
                  .first_triangle = first,
                  .triangle_count = last - first}};
  const auto before = scene.triangles.size();
  ASSERT_TRUE(mark_volume(scene, {Prism::box({8, 0, 8}, {9, 1, 9}), 3}));  // outside all triangles
  EXPECT_EQ(scene.triangles.size(), before);
  ASSERT_EQ(scene.parts.size(), 1u);
  EXPECT_EQ(scene.parts[0].first_triangle, first);
  EXPECT_EQ(scene.parts[0].triangle_count, last - first);
}

TEST(MarkVolume, RefusesNonsense) {
  Scene scene = worlds::flat(4);
  EXPECT_FALSE(mark_volume(scene, {Prism{}, 3}));
  EXPECT_FALSE(mark_volume(scene, {Prism::box({0, 0, 0}, {1, 1, 1}), 64}));
  EXPECT_FALSE(mark_volume(scene, {Prism::box({0, 2, 0}, {1, 1, 1}), 3}));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(mark_volume(scene, {Prism::box({0, 0, 0}, {nan, 1, 1}), 3}));
  EXPECT_EQ(scene.triangles.size(), worlds::flat(4).triangles.size());
}

}  // namespace
}  // namespace throng
