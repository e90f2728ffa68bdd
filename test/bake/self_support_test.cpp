// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "bake/surface/self_support.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "core/random.h"
#include "patch_nets.h"
#include "throng/scene.h"

namespace throng {
namespace {

// Points of the patch's triangles, from feet anywhere on a part: none rises above the bound.
TEST(SelfSupport, NoTriangleRisesAboveTheBound) {
  size_t seen = 0, known = 0;
  double closest = 0;  // the greatest share of the bound that was reached
  for (uint64_t seed = 1; seed <= 40; ++seed) {
    const Scene scene = test::net_scene({.side = 2,
                                         .cell = 8 + static_cast<double>(seed % 5) * 4,
                                         .relief = static_cast<double>(seed % 9),
                                         .jitter = seed % 3 == 0 ? 0.03 : 0,
                                         .seed = seed});
    for (uint32_t p = 0; p < scene.patches.size(); ++p) {
      const BezierPatch& patch = scene.patches.patches[p];
      const auto from_s = static_cast<uint8_t>(random_below(seed, p, 0, 4) * 64);
      const auto from_t = static_cast<uint8_t>(random_below(seed, p, 1, 4) * 64);
      const bake::SelfSupport own(patch, {from_s, static_cast<uint8_t>(from_s + 63), from_t,
                                          static_cast<uint8_t>(from_t + 63)});
      int32_t span_s = 0, span_t = 0;
      for (size_t t = 0; t < scene.triangles.size(); ++t) {
        const PatchPart& part = scene.patch_part[t];
        if (scene.patch_of_triangle[t] != p || !own.holds(part)) continue;
        span_s = std::max(span_s, part.s1 + 1 - part.s0);
        span_t = std::max(span_t, part.t1 + 1 - part.t0);
      }
      const double deviation = own.deviation(span_s, span_t) + scene.patch_off[p];
      const double radius = 0.2 + 0.1 * static_cast<double>(seed % 4);
      for (uint64_t n = 0; n < 40; ++n) {
        const double s = (from_s + 64 * random_unit(seed, p, 10 + 2 * n)) / 256;
        const double t = (from_t + 64 * random_unit(seed, p, 11 + 2 * n)) / 256;
        const Vec3d feet = patch.at(s, t);
        for (const bool upright : {false, true}) {
          const double max_rise = own.rise(upright, radius, deviation);
          if (!std::isfinite(max_rise)) continue;
          ++known;
          const Vec3d axis = upright ? Vec3d{0, 1, 0} : patch.normal(s, t);
          for (size_t i = 0; i < scene.triangles.size(); ++i) {
            if (scene.patch_of_triangle[i] != p || !own.holds(scene.patch_part[i])) continue;
            const auto& [a, b, c] = scene.triangles[i];
            for (uint64_t k = 0; k < 4; ++k) {
              const double u = std::sqrt(random_unit(seed, i, 4 * n + k));
              const double v = random_unit(seed + 100, i, 4 * n + k);
              const Vec3d at = scene.positions[a] * (1 - u) + scene.positions[b] * (u * (1 - v)) +
                               scene.positions[c] * (u * v);
              const double height = dot(at - feet, axis);
              if (length(at - feet - axis * height) > radius) continue;
              ++seen;
              ASSERT_LE(height, max_rise) << seed << " " << p;
              closest = std::max(closest, height / max_rise);
            }
          }
        }
      }
    }
  }
  EXPECT_GT(seen, 20000u);
  EXPECT_GT(known, 1000u);
  EXPECT_GT(closest, 0.7);  // The bound is no idle one.
}

// For a patch that turns over itself there is no bound.
TEST(SelfSupport, NothingIsKnownOfWhatFolds) {
  BezierPatch patch;
  for (size_t k = 0; k < 16; ++k) {
    const double s = static_cast<double>(k % 4), t = static_cast<double>(k / 4);
    patch.points[k] = {s < 2 ? 4 * s : 4 * (3 - s), s, t};
  }
  const bake::SelfSupport own(patch, {0, 255, 0, 255});
  EXPECT_FALSE(std::isfinite(own.rise(true, 0.3, 0.01)));
  EXPECT_FALSE(std::isfinite(own.rise(false, 0.3, 0.01)));
  const bake::SelfSupport lower(patch, {0, 15, 0, 255});
  EXPECT_TRUE(std::isfinite(lower.rise(false, 0.3, 0.01)));
}

}  // namespace
}  // namespace throng
