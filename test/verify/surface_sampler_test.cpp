// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "verify/surface_sampler.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace throng::verify {
namespace {

TEST(SurfaceSampler, DrawsPointsUniformlyByArea) {
  Scene scene;
  scene.add_quad({0, 1, 0}, {1, 1, 0}, {1, 1, 1}, {0, 1, 1});
  scene.add_quad({10, 2, 0}, {13, 2, 0}, {13, 2, 1}, {10, 2, 1});
  const SurfaceSampler sampler(scene, 0.7);
  EXPECT_NEAR(sampler.area(), 4, 1e-12);
  constexpr int kPoints = 40000;
  std::array<int, 8> counts{};  // Quarters of a metre squared: 2 columns and 6, lower half in z.
  int lower = 0;
  for (uint64_t n = 0; n < kPoints; ++n) {
    const auto [p, triangle] = sampler.point(3, n);
    const bool first = p.x <= 1;
    EXPECT_NEAR(p.y, first ? 1 : 2, 1e-12);
    EXPECT_EQ(triangle / 2, first ? 0u : 1u);
    EXPECT_TRUE(p.z >= 0 && p.z <= 1);
    const double column = first ? p.x * 2 : 2 + (p.x - 10) * 2;
    ++counts[static_cast<size_t>(std::fmin(column, 7))];
    lower += p.z < 0.5;
  }
  for (const int count : counts) EXPECT_NEAR(count, kPoints / 8, 5 * std::sqrt(kPoints / 8));
  EXPECT_NEAR(lower, kPoints / 2, 5 * std::sqrt(kPoints / 4));
  EXPECT_NE(sampler.point(3, 7).position, sampler.point(4, 7).position);
}

TEST(SurfaceSampler, LeavesOutBlockedSteepAndDegenerateTrianglesButNotUndersides) {
  Scene scene;
  scene.add_triangle({0, 0, 0}, {1, 0, 0}, {0, 0, 1}, kAreaBlocked);
  scene.add_triangle({0, 0, 0}, {1, 2, 0}, {0, 0, 1});
  scene.add_triangle({0, 0, 0}, {1, 0, 0}, {1, 0, 0});
  const SurfaceSampler none(scene, 0.7);
  EXPECT_EQ(none.area(), 0);
  scene.add_triangle({5, 0, 0}, {5, 0, 1}, {6, 0, 0}, 7);
  scene.add_triangle({5, 0, 0}, {6, 0, 0}, {5, 0, 1}, 7);
  const SurfaceSampler both(scene, 0.7);
  EXPECT_NEAR(both.area(), 1, 1e-12);
  for (uint64_t n = 0; n < 100; ++n) EXPECT_GE(both.point(1, n).triangle, 3u);
}

}  // namespace
}  // namespace throng::verify
