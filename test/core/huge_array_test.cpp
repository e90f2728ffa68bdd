// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "core/arrays/huge_array.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>

namespace throng {
namespace {

TEST(HugeArray, StartsAsZerosAndKeepsWhatIsWritten) {
  for (const Pages pages : {Pages::kSmall, Pages::kHuge}) {
    for (const size_t size : {size_t{1}, size_t{1000}, size_t{3} << 20}) {
      HugeArray<uint32_t> array(size, pages);
      ASSERT_EQ(array.span().size(), size);
      EXPECT_TRUE(std::ranges::all_of(array.span(), [](uint32_t v) { return v == 0; }));
      array[size - 1] = 7;
      HugeArray<uint32_t> moved = std::move(array);
      EXPECT_EQ(moved[size - 1], 7u);
    }
  }
}

TEST(HugeArray, MayBeEmpty) {
  EXPECT_EQ(HugeArray<int>().span().size(), 0u);
  EXPECT_EQ(HugeArray<int>(0).span().size(), 0u);
}

}  // namespace
}  // namespace throng
