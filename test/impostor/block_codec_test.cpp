// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "impostor/block_codec.h"

#include <gtest/gtest.h>

#include "core/random.h"
#include "texel_blocks.h"

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wunused-function"
#define STB_DXT_STATIC
#define STB_DXT_IMPLEMENTATION
#include <stb/stb_dxt.h>
#pragma GCC diagnostic pop

namespace throng {
namespace {

constexpr uint64_t kSeed = 11;

int64_t square_error(const impostor::ColourBlock& a, const impostor::ColourBlock& b) {
  int64_t sum = 0;
  for (size_t i = 0; i < 16; ++i) {
    for (size_t c = 0; c < 3; ++c) sum += (a[i][c] - b[i][c]) * (a[i][c] - b[i][c]);
  }
  return sum;
}

TEST(BlockCodec, ReadsABlockAsTheStandardDefinesIt) {
  // Red 255 and blue 255 as ends, red above: red, blue, two thirds red, one third red.
  const impostor::Bytes8 four{0x00, 0xf8, 0x1f, 0x00, 0xe4, 0xe4, 0xe4, 0xe4};
  impostor::ColourBlock block;
  impostor::decode_bc1(four, true, block);
  EXPECT_EQ(block[0], (std::array<uint8_t, 4>{255, 0, 0, 255}));
  EXPECT_EQ(block[1], (std::array<uint8_t, 4>{0, 0, 255, 255}));
  EXPECT_EQ(block[2], (std::array<uint8_t, 4>{170, 0, 85, 255}));
  EXPECT_EQ(block[15], (std::array<uint8_t, 4>{85, 0, 170, 255}));
  // The ends in reverse order: a half, and a hole.
  const impostor::Bytes8 three{0x1f, 0x00, 0x00, 0xf8, 0xe4, 0xe4, 0xe4, 0xe4};
  impostor::decode_bc1(three, true, block);
  EXPECT_EQ(block[2], (std::array<uint8_t, 4>{127, 0, 127, 255}));
  EXPECT_EQ(block[3][3], 0);
  // BC4: 200, 100, and six between; then with the ends exchanged four between, 0 and 255.
  impostor::ChannelBlock values;
  impostor::decode_bc4({200, 100, 0b10001000, 0b11000110, 0b11111010, 0, 0, 0}, values);
  EXPECT_EQ(values[0], 200);
  EXPECT_EQ(values[1], 100);
  EXPECT_EQ(values[2], (6 * 200 + 100) / 7);
  EXPECT_EQ(values[7], (200 + 6 * 100) / 7);
  impostor::decode_bc4({100, 200, 0b10001000, 0b11000110, 0b11111010, 0, 0, 0}, values);
  EXPECT_EQ(values[6], 0);
  EXPECT_EQ(values[7], 255);
}

TEST(BlockCodec, KeepsColoursBetterThanAWellKnownEncoder) {
  for (const uint64_t kinds : {1, 2, 3, 4, 16}) {
    int64_t ours = 0, theirs = 0;
    for (uint64_t number = 0; number < 400; ++number) {
      const impostor::ColourBlock block = test::random_block(kSeed, number * 7 + kinds, kinds, 20);
      impostor::ColourBlock back = block;
      impostor::decode_bc1(impostor::encode_bc1(block, test::all_texels(), false), false, back);
      ours += square_error(block, back);
      impostor::Bytes8 other;
      stb_compress_dxt_block(other.data(), block[0].data(), 0, STB_DXT_HIGHQUAL);
      impostor::decode_bc1(other, false, back);
      theirs += square_error(block, back);
    }
    EXPECT_LE(ours, theirs) << kinds << " kinds of colour";
  }
}

TEST(BlockCodec, TexelsWithoutWeightCostNothing) {
  for (uint64_t number = 0; number < 100; ++number) {
    impostor::ColourBlock block = test::random_block(kSeed, number, 1, 0);
    impostor::TexelWeights weights = test::all_texels();
    for (size_t i = 8; i < 16; ++i) {
      weights[i] = 0;
      block[i] = {255, 0, 255, 0};
    }
    impostor::ColourBlock back = block;
    impostor::decode_bc1(impostor::encode_bc1(block, weights, false), false, back);
    for (size_t i = 0; i < 8; ++i) {
      for (size_t c = 0; c < 3; ++c) EXPECT_NEAR(back[i][c], block[i][c], 3) << number;
    }
  }
}

TEST(BlockCodec, HolesStayHolesAndNothingElseBecomesOne) {
  for (uint64_t number = 0; number < 500; ++number) {
    impostor::ColourBlock block = test::random_block(kSeed, number, 1 + number % 16, 40);
    for (uint64_t i = 0; i < 16; ++i) block[i][3] = test::random_byte(kSeed, number, 300 + i);
    if (number % 5 == 0) {
      for (auto& texel : block) texel[3] = number % 2 == 0 ? 255 : 0;
    }
    impostor::ColourBlock back;
    impostor::decode_bc1(impostor::encode_bc1(block, test::all_texels(), true), true, back);
    for (size_t i = 0; i < 16; ++i) EXPECT_EQ(back[i][3], block[i][3] < 128 ? 0 : 255) << number;
  }
}

TEST(BlockCodec, AChannelOfFewValuesIsKeptExactly) {
  for (uint64_t number = 0; number < 500; ++number) {
    impostor::ChannelBlock block;
    const uint8_t one = test::random_byte(kSeed, number, 0);
    const uint8_t few[] = {0, 255, one};
    for (uint64_t i = 0; i < 16; ++i) block[i] = few[random_below(kSeed, number, i + 1, 3)];
    impostor::ChannelBlock back;
    impostor::decode_bc4(impostor::encode_bc4(block, test::all_texels()), back);
    EXPECT_EQ(back, block) << number;
  }
}

TEST(BlockCodec, AChannelIsNeverFurtherOffThanHalfAStepOfItsRange) {
  for (uint64_t number = 0; number < 500; ++number) {
    impostor::ChannelBlock block;
    const uint64_t range = 1 + random_below(kSeed, number, 99, 255);
    int low = 255, high = 0;
    for (uint64_t i = 0; i < 16; ++i) {
      block[i] = static_cast<uint8_t>(random_below(kSeed, number, i, range));
      low = std::min<int>(low, block[i]), high = std::max<int>(high, block[i]);
    }
    impostor::ChannelBlock back;
    impostor::decode_bc4(impostor::encode_bc4(block, test::all_texels()), back);
    int64_t error = 0;
    for (size_t i = 0; i < 16; ++i) error += (back[i] - block[i]) * (back[i] - block[i]);
    const double half_step = (high - low) / 14.0 + 1;
    EXPECT_LE(error, 16 * half_step * half_step) << number;
  }
}

}  // namespace
}  // namespace throng
