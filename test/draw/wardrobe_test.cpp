// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "draw/wardrobe.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <set>

namespace throng::draw {
namespace {

TEST(Wardrobe, NearlyAllLooksHaveOutfitsOfTheirOwn) {
  std::set<uint32_t> dressed;  // without the first part, which has one colour
  std::array<std::array<int, kColoursAPart>, kBodyParts> worn{};
  for (uint32_t look = 0; look < kLooks; ++look) {
    const uint32_t outfit = outfit_of(look);
    dressed.insert(outfit >> 4);
    for (uint32_t part = 0; part < kBodyParts; ++part) {
      const uint32_t colour = outfit >> 4 * part & 15;
      ASSERT_LT(colour, static_cast<uint32_t>(kColoursAPart));
      ++worn[part][colour];
    }
  }
  EXPECT_GT(dressed.size(), 2000u);
  for (const auto& colours : worn) {
    EXPECT_GT(*std::min_element(colours.begin(), colours.end()), 120) << "of 171 in the mean";
    EXPECT_LT(*std::max_element(colours.begin(), colours.end()), 220);
  }
}

}  // namespace
}  // namespace throng::draw
