// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "crowd/ground/level_line.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "core/random.h"

namespace throng {
namespace {

using Rows = std::array<uint64_t, 64>;

// All set but for a few cells.
Rows rows_with_holes(uint64_t seed, int holes) {
  Rows rows;
  rows.fill(~uint64_t{0});
  for (int i = 0; i < holes; ++i) {
    const uint64_t cell = random_below(seed, 1, static_cast<uint64_t>(i), 4096);
    rows[cell / 64] &= ~(uint64_t{1} << (cell % 64));
  }
  return rows;
}

bool is_set(const Rows& rows, int32_t x, int32_t z) {
  return ((rows[static_cast<size_t>(z)] >> x) & 1) != 0;
}

TEST(LevelLine, ABlockIsFullIfItsSixteenCellsAre) {
  for (uint64_t seed = 0; seed < 20; ++seed) {
    const Rows rows = rows_with_holes(seed, 40);
    const auto blocks = crowd::full_blocks(rows.data());
    for (int32_t block = 0; block < 256; ++block) {
      bool full = true;
      for (int32_t cell = 0; cell < 16; ++cell) {
        full &= is_set(rows, block % 16 * 4 + cell % 4, block / 16 * 4 + cell / 4);
      }
      EXPECT_EQ(((blocks[static_cast<size_t>(block / 16)] >> (block % 16)) & 1) != 0, full);
    }
  }
}

TEST(LevelLine, AllCellsOfAFlatBoxAreSetWhereverItsTileLies) {
  int flat = 0;
  for (uint64_t seed = 0; seed < 50; ++seed) {
    const Rows rows = rows_with_holes(seed, 30);
    crowd::LevelLine line;
    line.flat = crowd::full_blocks(rows.data());
    const auto draw = [&](uint64_t n, uint64_t below) {
      return static_cast<int32_t>(random_below(seed, 2, n, below));
    };
    for (uint64_t n = 0; n < 20000; n += 4) {
      const int32_t x0 = draw(n, 64), z0 = draw(n + 1, 64);
      const int32_t x1 = x0 + draw(n + 2, 9) - 4, z1 = z0 + draw(n + 3, 9) - 4;
      if (!line.box_is_flat(640 + x0, 64 + z0, 640 + x1, 64 + z1)) continue;
      ++flat;
      for (int32_t z = std::min(z0, z1); z <= std::max(z0, z1); ++z) {
        for (int32_t x = std::min(x0, x1); x <= std::max(x0, x1); ++x) {
          ASSERT_TRUE(x >= 0 && x < 64 && z >= 0 && z < 64 && is_set(rows, x, z));
        }
      }
    }
  }
  EXPECT_GT(flat, 10000);
}

TEST(LevelLine, CrossesOneSideWhereBothBlocksAreJoined) {
  crowd::LevelLine line;
  line.beyond = {10, 11, 12, 13};
  line.joined = {0b0110, 0b0110, 0b0110, 0b0110};  // blocks 1 and 2: cells 4 to 11
  EXPECT_EQ(line.cross(64, 64 + 5, 63, 64 + 8), 10u);
  EXPECT_EQ(line.cross(127, 64 + 11, 128, 64 + 9), 11u);
  EXPECT_EQ(line.cross(64 + 4, 64, 64 + 4, 62), 12u);
  EXPECT_EQ(line.cross(64 + 4, 127, 64 + 7, 129), 13u);
  EXPECT_EQ(line.cross(64, 64 + 11, 63, 64 + 12),
            crowd::LevelLine::kNone);                                      // block 3 is not joined
  EXPECT_EQ(line.cross(64, 64 + 3, 63, 64 + 4), crowd::LevelLine::kNone);  // nor is block 0
  EXPECT_EQ(line.cross(64, 64, 63, 63), crowd::LevelLine::kNone);          // two sides at once
  EXPECT_EQ(line.cross(70, 70, 71, 71), crowd::LevelLine::kNone);          // none
}

}  // namespace
}  // namespace throng
