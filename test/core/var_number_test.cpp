// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "core/files/var_number.h"

#include <gtest/gtest.h>

#include "core/random.h"

namespace throng {
namespace {

TEST(VarNumber, ComesBackInAsFewBytesAsItTakes) {
  std::vector<uint64_t> values{0, 1, 0x7f, 0x80, 0x3fff, 0x4000, UINT32_MAX, UINT64_MAX};
  for (uint64_t n = 0; n < 1000; ++n) values.push_back(random_u64(1, n, 0) >> (n % 64));
  std::vector<uint8_t> bytes;
  for (const uint64_t value : values) {
    const size_t before = bytes.size();
    put_number(bytes, value);
    size_t needed = 1;
    for (uint64_t rest = value >> 7; rest != 0; rest >>= 7) ++needed;
    EXPECT_EQ(bytes.size() - before, needed);
  }
  size_t at = 0;
  for (const uint64_t value : values) EXPECT_EQ(take_number(bytes, at), value);
  EXPECT_EQ(at, bytes.size());
  EXPECT_EQ(take_number(bytes, at), std::nullopt);
}

TEST(VarNumber, RefusesWhatEndsEarlyOrIsTooLong) {
  const std::vector<std::vector<uint8_t>> bad{
      {},
      {0x80},
      {0xff, 0xff},
      {0x80, 0x00},                                                  // 0 in two bytes
      {0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0x02},  // 65 bits
      {0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0x81, 0x00}};
  for (const std::vector<uint8_t>& bytes : bad) {
    size_t at = 0;
    EXPECT_EQ(take_number(bytes, at), std::nullopt);
    EXPECT_LE(at, bytes.size());
  }
}

TEST(VarNumber, SmallDifferencesOfEitherSignAreSmall) {
  EXPECT_EQ(folded(0), 0u);
  EXPECT_EQ(folded(-1), 1u);
  EXPECT_EQ(folded(1), 2u);
  for (const int64_t value : {INT64_MIN, INT64_MAX, int64_t{-64}, int64_t{63}, int64_t{0}}) {
    EXPECT_EQ(unfolded(folded(value)), value);
  }
}

}  // namespace
}  // namespace throng
