// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "crowd/walk/crowd_blocks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "core/random.h"

namespace throng {
namespace {

constexpr int32_t kPixelCells = 5;
constexpr int32_t kBlockPixels = 4;
constexpr int32_t kBlockUnits = (kPixelCells * kBlockPixels) << world::kUnitBits;

HugeArray<crowd::Avatar> scattered(uint32_t count, int32_t width, int32_t depth) {
  HugeArray<crowd::Avatar> avatars(count);
  for (uint32_t i = 0; i < count; ++i) {
    avatars[i].x = static_cast<int32_t>(
        random_below(1, i, 0, static_cast<uint64_t>(width) << world::kUnitBits));
    avatars[i].z = static_cast<int32_t>(
        random_below(1, i, 1, static_cast<uint64_t>(depth) << world::kUnitBits));
    avatars[i].level = static_cast<uint32_t>(random_below(1, i, 2, 3));
    avatars[i].id = i;
  }
  return avatars;
}

TEST(CrowdBlocks, BlocksOfOneColourLieABlockApartAndHoldAllAvatars) {
  constexpr int32_t kWidth = 333, kDepth = 170;
  crowd::CrowdBlocks blocks(kWidth, kDepth, crowd::PixelGrid(kPixelCells), kBlockPixels);
  HugeArray<crowd::Avatar> avatars = scattered(2000, kWidth, kDepth), scratch(2000);
  blocks.sort(avatars, scratch, 2);
  std::vector<int> seen(2000, 0);
  for (uint32_t colour = 0; colour < crowd::CrowdBlocks::kColours; ++colour) {
    std::vector<std::pair<int32_t, int32_t>> corners;
    for (const auto& run : blocks.runs(colour)) {
      ASSERT_LT(run.first, run.last);
      const crowd::Avatar& first = avatars[run.first];
      corners.emplace_back(first.x / kBlockUnits, first.z / kBlockUnits);
      for (uint32_t i = run.first; i < run.last; ++i) {
        EXPECT_EQ(std::pair(avatars[i].x / kBlockUnits, avatars[i].z / kBlockUnits),
                  corners.back());
        EXPECT_GE(avatars[i].level, avatars[std::max(i, run.first + 1) - 1].level);
        ++seen[avatars[i].id];
      }
    }
    for (const auto& a : corners) {
      for (const auto& b : corners) {
        const int32_t apart = std::max(std::abs(a.first - b.first), std::abs(a.second - b.second));
        EXPECT_TRUE(apart == 0 || apart >= 2);
      }
    }
  }
  EXPECT_TRUE(std::ranges::all_of(seen, [](int n) { return n == 1; }));
}

TEST(CrowdBlocks, TheOrderDoesNotDependOnTheThreads) {
  crowd::CrowdBlocks one(500, 500, crowd::PixelGrid(kPixelCells), kBlockPixels);
  crowd::CrowdBlocks many(500, 500, crowd::PixelGrid(kPixelCells), kBlockPixels);
  HugeArray<crowd::Avatar> a = scattered(5000, 500, 500), b = scattered(5000, 500, 500),
                           scratch(5000);
  one.sort(a, scratch, 1);
  many.sort(b, scratch, 8);
  EXPECT_TRUE(std::ranges::equal(
      a.span(), b.span(),
      [](const crowd::Avatar& p, const crowd::Avatar& q) { return p.id == q.id; }));
}

}  // namespace
}  // namespace throng
