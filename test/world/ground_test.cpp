// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "world/ground.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "baked.h"
#include "core/access.h"

namespace throng {
namespace {

TEST(Ground, FloorsLieWithinTheRangeOfTheirBlocks) {
  size_t far_apart = 0, wide = 0, levels = 0;
  for (const char* name : {"church", "garage", "landscape", "stairs"}) {
    BuiltinWorldConfig config{.name = name};
    if (config.name == "landscape") config.size = 80;
    if (config.name == "garage") config.levels = 2;
    const World world = test::bake(test::builtin(config), 0.25);
    const world::WorldData& data = *data_of(world);
    int32_t lowest = INT32_MAX;
    for (uint32_t l = 0; l < data.level_count; ++l) {
      const world::LevelView view = world::ground_level(data, l, 0).view;
      const world::FloorRange range = world::floor_range(view);
      int32_t low = INT32_MAX, high = INT32_MIN;
      for (int32_t cell = 0; cell < 4096; ++cell) {
        if (!view.has(cell % 64, cell / 64)) continue;
        low = std::min(low, view.sample(cell % 64, cell / 64));
        high = std::max(high, view.sample(cell % 64, cell / 64));
      }
      ASSERT_LE(range.low, low) << name << ", level " << l;
      ASSERT_GE(range.high, high) << name << ", level " << l;
      ++levels;
      wide += range.high - range.low > 2 * (high - low) + 500 ? 1 : 0;
      lowest = std::min(lowest, low);
      far_apart += range.low > lowest + 2000 ? 1 : 0;
    }
  }
  EXPECT_GT(levels, 100u);
  EXPECT_LT(wide, levels / 10);  // It is of use.
  EXPECT_GT(far_apart, 10u);
}

TEST(Ground, RangesAreNearIfAStepLeadsFromOneToTheOther) {
  const world::FloorRange a{100, 200};
  EXPECT_TRUE(a.is_near({150, 160}, 0));
  EXPECT_TRUE(a.is_near({250, 300}, 50));
  EXPECT_FALSE(a.is_near({251, 300}, 50));
  EXPECT_TRUE(a.is_near({0, 50}, 50));
  EXPECT_FALSE(a.is_near({0, 49}, 50));
  EXPECT_FALSE(
      (world::FloorRange{INT32_MIN, INT32_MIN}.is_near({INT32_MAX, INT32_MAX}, INT32_MAX)));
}

}  // namespace
}  // namespace throng
