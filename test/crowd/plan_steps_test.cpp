// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "crowd/ground/plan_steps.h"

#include <gtest/gtest.h>

#include <vector>

#include "core/random.h"
#include "simd_targets.h"

namespace throng {
namespace {

constexpr int32_t kLevels = 6;

std::vector<crowd::LevelLine> random_lines() {
  std::vector<crowd::LevelLine> lines(kLevels);
  for (size_t level = 0; level < lines.size(); ++level) {
    for (size_t z = 0; z < 16; ++z) {  // three blocks of four are flat
      const uint64_t bits = random_u64(level, z, 1);
      lines[level].flat[z] = static_cast<uint16_t>(bits | bits >> 16);
    }
  }
  return lines;
}

std::vector<crowd::Avatar> random_avatars(size_t size, uint64_t seed) {
  std::vector<crowd::Avatar> avatars(size);
  for (uint32_t i = 0; i < size; ++i) {
    const auto draw = [&](uint64_t n, uint64_t below) {
      return static_cast<int32_t>(random_below(seed, i, n, below));
    };
    const int32_t longest = (crowd::LevelLine::kBlock << world::kUnitBits) >> (i + seed) % 4;
    avatars[i] = {.x = draw(0, 1 << 20),
                  .z = draw(1, 1 << 20),
                  .vx = draw(2, 2 * longest + 1) - longest,
                  .vz = draw(3, 2 * longest + 1) - longest,
                  .y = draw(4, 1000),
                  .level = static_cast<uint32_t>(draw(5, kLevels)),
                  .id = i};
  }
  return avatars;
}

// The scalar reference, one avatar at a time.
crowd::PlannedSteps plan_one_by_one(const crowd::LevelLine* lines, crowd::PixelGrid grid,
                                    std::vector<crowd::Avatar>& avatars) {
  crowd::PlannedSteps planned;
  for (size_t n = 0; n < avatars.size(); ++n) {
    crowd::Avatar& a = avatars[n];
    const int32_t x0 = a.x >> world::kUnitBits, z0 = a.z >> world::kUnitBits;
    const int32_t x1 = (a.x + a.vx) >> world::kUnitBits, z1 = (a.z + a.vz) >> world::kUnitBits;
    if (!lines[a.level].box_is_flat(x0, z0, x1, z1)) continue;
    const bool stays = grid.pixel(x0) == grid.pixel(x1) && grid.pixel(z0) == grid.pixel(z1);
    (stays ? planned.stays : planned.leaves) |= uint64_t{1} << n;
    a.x += stays ? a.vx : 0;
    a.z += stays ? a.vz : 0;
  }
  return planned;
}

TEST(PlanSteps, AllVectorTargetsAgreeWithOneAtATime) {
  const std::vector<crowd::LevelLine> lines = random_lines();
  test::for_every_simd_target([&](const char* name) {
    uint64_t stays = 0, leaves = 0;
    for (size_t size = 0; size <= 64; ++size) {
      for (const int32_t pixel_cells : {2, 3, 4, 5, 6, 7, 9, 11, 13, 17, 20, 31}) {
        const crowd::PixelGrid grid(pixel_cells);
        ASSERT_TRUE(crowd::can_plan(grid, lines.size()));
        std::vector<crowd::Avatar> avatars = random_avatars(size, size * 16 + pixel_cells);
        std::vector<crowd::Avatar> expected = avatars;
        const crowd::PlannedSteps one = plan_one_by_one(lines.data(), grid, expected);
        const crowd::PlannedSteps planned =
            crowd::plan_steps(lines.data(), grid, avatars.data(), size);
        ASSERT_EQ(planned.stays, one.stays) << name;
        ASSERT_EQ(planned.leaves, one.leaves) << name;
        for (size_t n = 0; n < size; ++n) {
          ASSERT_EQ(avatars[n].x, expected[n].x);
          ASSERT_EQ(avatars[n].z, expected[n].z);
        }
        stays |= one.stays;
        leaves |= one.leaves;
      }
    }
    EXPECT_EQ(stays, ~uint64_t{0});
    EXPECT_EQ(leaves, ~uint64_t{0});
  });
}

}  // namespace
}  // namespace throng
