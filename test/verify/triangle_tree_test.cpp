// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "verify/triangle_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "core/random.h"

namespace throng::verify {
namespace {

// Small triangles, some degenerate, some 10 km long, some far from the origin.
Scene random_soup(size_t count, uint64_t seed, double offset) {
  Scene scene;
  for (size_t i = 0; i < count; ++i) {
    uint64_t counter = 0;
    const auto random = [&](double size) { return size * (random_unit(seed, i, counter++) - 0.5); };
    const Vec3d centre{offset + random(20), random(6), offset + random(20)};
    const double size = i % 37 == 0 ? 1e4 : i % 5 == 0 ? 4 : 0.3;
    Corners t;
    for (Vec3d& p : t) p = centre + Vec3d{random(size), random(size), random(size)};
    if (i % 11 == 0) t[2] = t[1];
    if (i % 13 == 0) t[1] = t[2] = t[0];
    scene.add_triangle(t[0], t[1], t[2]);
  }
  return scene;
}

std::vector<uint32_t> found(const TriangleTree& tree, const Cylinder& body) {
  std::vector<uint32_t> list;
  tree.find(body.bounds(), [&](uint32_t triangle, const Corners& corners) {
    if (meets(body, corners)) list.push_back(triangle);
    return false;
  });
  std::sort(list.begin(), list.end());
  return list;
}

TEST(TriangleTree, FindsWhatATestOfEveryTriangleFinds) {
  for (const size_t count : {1u, 2u, 5u, 9u, 64u, 1000u, 3333u}) {
    for (const double offset : {0.0, 5000.0, -99000.0}) {
      const Scene scene = random_soup(count, count, offset);
      const TriangleTree tree(scene, 0);
      size_t hits = 0;
      for (uint64_t n = 0; n < 150; ++n) {
        const auto random = [&](uint64_t k) { return random_unit(3, n, k) - 0.5; };
        const double low = 6 * random(2);
        const Cylinder body{.x = offset + 20 * random(0),
                            .z = offset + 20 * random(1),
                            .low = low,
                            .high = low + 1.5,
                            .radius = 0.6 + random(3)};
        std::vector<uint32_t> expected;
        for (uint32_t t = 0; t < count; ++t) {
          if (meets(body, tree.corners(t))) expected.push_back(t);
        }
        EXPECT_EQ(found(tree, body), expected) << count << " triangles, body " << n;
        hits += expected.size();
      }
      EXPECT_TRUE(count < 64 || hits > 10);
    }
  }
}

TEST(TriangleTree, StopsAtTheFirstTriangleThatIsAccepted) {
  const Scene scene = random_soup(500, 4, 0);
  const TriangleTree tree(scene, 0);
  Box3d all;
  all.add({-1e5, -1e5, -1e5});
  all.add({1e5, 1e5, 1e5});
  size_t calls = 0;
  EXPECT_TRUE(tree.find(all, [&](uint32_t, const Corners&) { return ++calls == 3; }));
  EXPECT_EQ(calls, 3u);
  calls = 0;
  EXPECT_FALSE(tree.find(all, [&](uint32_t, const Corners&) { return ++calls == 0; }));
  EXPECT_EQ(calls, 500u);
}

TEST(TriangleTree, OrderIsTheSameForAnyNumberOfWorkers) {
  const Scene scene = random_soup(5000, 5, 0);
  Box3d all;
  all.add({-1e5, -1e5, -1e5});
  all.add({1e5, 1e5, 1e5});
  const auto order = [&](int32_t workers) {
    std::vector<uint32_t> list;
    TriangleTree(scene, workers).find(all, [&](uint32_t t, const Corners&) {
      list.push_back(t);
      return false;
    });
    return list;
  };
  const auto expected = order(1);
  EXPECT_EQ(expected.size(), 5000u);
  EXPECT_EQ(order(2), expected);
  EXPECT_EQ(order(7), expected);
}

}  // namespace
}  // namespace throng::verify
