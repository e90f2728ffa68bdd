// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "bake/surface/surface_bound.h"

#include <gtest/gtest.h>

#include <vector>

#include "core/random.h"
#include "simd_targets.h"

namespace throng {
namespace {

// Patches like those of a landscape, some of them upright or upside down, folded or collapsed.
std::vector<BezierPatch> patches(size_t count) {
  std::vector<BezierPatch> all(count);
  for (size_t p = 0; p < count; ++p) {
    const double rough = p % 3 == 0 ? 0.1 : p % 3 == 1 ? 0.2 : 2.5;
    for (size_t k = 0; k < 16; ++k) {
      const auto off = [&](uint64_t axis) {
        return rough * (random_unit(5, p, 3 * k + axis) - 0.5);
      };
      Vec3d at{static_cast<double>(k % 4) + off(0), off(1), static_cast<double>(k / 4) + off(2)};
      if (p % 5 == 1) at = {at.y, at.x, at.z};
      if (p % 5 == 2) at = {at.x, at.z, at.y};
      if (p % 7 == 3) at = {2, 1, 3};
      all[p].points[k] = at;
    }
  }
  return all;
}

bake::PatchParts side_by_side(const std::vector<BezierPatch>& patches) {
  bake::PatchParts parts;
  parts.resize(patches.size());
  for (size_t p = 0; p < patches.size(); ++p) parts.set(p, patches[p]);
  return parts;
}

void expect_same(const bake::SurfaceBound& a, const bake::SurfaceBound& b) {
  EXPECT_EQ(a.frame.centre, b.frame.centre);
  EXPECT_EQ(a.frame.side, b.frame.side);
  EXPECT_EQ(a.frame.front, b.frame.front);
  EXPECT_EQ(a.frame.up, b.frame.up);
  EXPECT_EQ(a.sine, b.sine);
  EXPECT_EQ(a.cosine, b.cosine);
  EXPECT_EQ(a.radius, b.radius);
  EXPECT_EQ(a.low, b.low);
  EXPECT_EQ(a.high, b.high);
  EXPECT_EQ(a.area, b.area);
}

TEST(SurfaceBound, ManyAtOnceHaveTheSameBitsAsOneByOne) {
  test::for_every_simd_target([](const char* target) {
    SCOPED_TRACE(target);
    const std::vector<BezierPatch> parts = patches(1003);
    std::vector<bake::CellBounds> bounds(parts.size());
    bake::bound_cells_of(side_by_side(parts), bounds);
    size_t valid = 0;
    for (size_t p = 0; p < parts.size(); ++p) {
      const auto along = bake::bound_surface(parts[p]);
      ASSERT_EQ(bounds[p].valid, along.has_value()) << p;
      if (!along) continue;
      ++valid;
      expect_same(bounds[p].along, *along);
      expect_same(bounds[p].upright, bake::upright_bound(parts[p], *along));
    }
    EXPECT_GT(valid, 300u);
    EXPECT_LT(valid, 950u);
  });
}

TEST(SurfaceBound, QuartersOfManyHaveTheSameBitsAsHalvesOfHalves) {
  test::for_every_simd_target([](const char* target) {
    SCOPED_TRACE(target);
    for (const size_t count : {1u, 4u, 7u, 203u}) {
      const std::vector<BezierPatch> whole = patches(count);
      bake::PatchParts quarters;
      bake::quarter_parts(side_by_side(whole), quarters);
      ASSERT_EQ(quarters.count, 4 * count);
      for (size_t p = 0; p < count; ++p) {
        for (size_t i = 0; i < 2; ++i) {
          const auto halves = split_t(split_s(whole[p], 0.5)[i], 0.5);
          for (size_t j = 0; j < 2; ++j) {
            EXPECT_EQ(quarters.patch(4 * p + 2 * i + j).points, halves[j].points) << p;
          }
        }
      }
    }
  });
}

}  // namespace
}  // namespace throng
