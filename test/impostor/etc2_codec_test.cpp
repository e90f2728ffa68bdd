// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "impostor/etc2_codec.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "core/hash.h"
#include "core/random.h"
#include "plain_etc2.h"
#include "texel_blocks.h"

namespace throng {
namespace {

constexpr uint64_t kSeed = 23;

// Any bits at all, or bytes of which many are extreme.
impostor::Bytes8 random_bytes(uint64_t number) {
  constexpr uint8_t kExtreme[] = {0x00, 0xff, 0x80, 0x7f, 0xf8, 0x07, 0x04, 0xfb};
  impostor::Bytes8 bytes;
  for (uint64_t i = 0; i < 8; ++i) {
    bytes[i] = test::random_byte(kSeed, number, i);
    if (number % 4 == 0 && bytes[i] % 2 == 0) bytes[i] = kExtreme[bytes[i] / 32];
  }
  return bytes;
}

double mean_square(const impostor::ColourBlock& a, const impostor::ColourBlock& b) {
  double sum = 0;
  for (size_t i = 0; i < 16; ++i) {
    for (size_t c = 0; c < 3; ++c) sum += (a[i][c] - b[i][c]) * (a[i][c] - b[i][c]);
  }
  return sum / 48;
}

impostor::ColourBlock there_and_back(const impostor::ColourBlock& block) {
  impostor::ColourBlock back = block;
  impostor::decode_etc2(impostor::encode_etc2(block, test::all_texels(), false), false, back);
  return back;
}

TEST(Etc2Codec, ReadsEveryBlockAsAPlainReaderOfTheStandardDoes) {
  std::map<std::string, int> modes;
  for (uint64_t number = 0; number < 60000; ++number) {
    const impostor::Bytes8 bytes = random_bytes(number);
    for (const bool holes : {false, true}) {
      ++modes[test::plain_etc2_mode(bytes, holes) + (holes ? " with holes" : "")];
      impostor::ColourBlock block;
      for (auto& texel : block) texel[3] = 77;
      impostor::decode_etc2(bytes, holes, block);
      for (int i = 0; i < 16; ++i) {
        test::PlainTexel asked = test::plain_etc2(bytes, holes, i % 4, i / 4);
        if (!holes) asked.alpha = 77;  // Left as it was.
        const auto& texel = block[static_cast<size_t>(i)];
        const test::PlainTexel read{texel[0], texel[1], texel[2], texel[3]};
        ASSERT_TRUE(read == asked) << "block " << number << " texel " << i;
      }
    }
  }
  EXPECT_EQ(modes.size(), 9U);  // No individual bases with holes.
  for (const auto& [mode, count] : modes) EXPECT_GT(count, 1000) << mode;
}

TEST(Etc2Codec, ReadsEveryChannelAsAPlainReaderOfTheStandardDoes) {
  for (uint64_t number = 0; number < 20000; ++number) {
    impostor::Bytes8 bytes = random_bytes(number);
    bytes[1] = static_cast<uint8_t>(number);  // All factors and tables.
    impostor::ChannelBlock eight;
    impostor::WideChannelBlock eleven;
    impostor::decode_eac(bytes, eight);
    impostor::decode_eac11(bytes, eleven);
    for (int i = 0; i < 16; ++i) {
      const auto at = static_cast<size_t>(i);
      ASSERT_EQ(eight[at], test::plain_eac8(bytes, i % 4, i / 4)) << number;
      ASSERT_EQ(eleven[at], test::plain_eac11(bytes, i % 4, i / 4)) << number;
    }
  }
}

// Shades of one colour or of two side by side, a slope, a few colours: each has a mode made for it.
TEST(Etc2Codec, WritesAllModesAndEachWhereItFits) {
  std::map<std::string, int> modes;
  for (uint64_t number = 0; number < 3000; ++number) {
    const bool holes = number % 3 == 0;
    impostor::ColourBlock block = test::random_block(kSeed, number, 1 + number % 5, number % 30);
    for (uint64_t i = 0; i < 16 && number % 5 < 2; ++i) {
      const auto x = static_cast<int>(i % 4), y = static_cast<int>(i / 4);
      const int shade = test::random_byte(kSeed, number, 50 + i) / 8;
      for (uint64_t c = 0; c < 3; ++c) {
        const int first = test::random_byte(kSeed, number, c),
                  second = test::random_byte(kSeed, number, 3 + c);
        const int half = shade + (x < 2 ? first : second) * 3 / 4;
        block[i][c] =
            static_cast<uint8_t>(number % 5 == 0 ? 40 + (x * first + y * second) / 8 : half);
      }
    }
    if (number % 2 == 0) {
      for (uint64_t i = 0; i < 16; ++i) block[i][3] = test::random_byte(kSeed, number, 300 + i / 3);
    }
    ++modes[test::plain_etc2_mode(impostor::encode_etc2(block, test::all_texels(), holes), holes)];
  }
  EXPECT_EQ(modes.size(), 5U);
  for (const auto& [mode, count] : modes) EXPECT_GT(count, 50) << mode;
}

TEST(Etc2Codec, ASlopeIsKeptToThreeSteps) {
  for (uint64_t number = 0; number < 200; ++number) {
    impostor::ColourBlock block;
    for (uint64_t i = 0; i < 16; ++i) {
      for (uint64_t c = 0; c < 3; ++c) {
        const int across = test::random_byte(kSeed, number, c),
                  down = test::random_byte(kSeed, number, 3 + c);
        const auto x = static_cast<int>(i % 4), y = static_cast<int>(i / 4);
        block[i][c] = static_cast<uint8_t>(100 + (across * x - down * y) / 16);
      }
      block[i][3] = 255;
    }
    const impostor::ColourBlock back = there_and_back(block);
    for (size_t i = 0; i < 16; ++i) {
      for (size_t c = 0; c < 3; ++c) EXPECT_NEAR(back[i][c], block[i][c], 3) << number;
    }
  }
}

TEST(Etc2Codec, KeepsColoursWithinItsLimits) {
  // Mean squares of 8 bits, by how many colours a block has: one colour has more bits in planar
  // mode, two have T and H, and sixteen at random are too many for any.
  const std::map<uint64_t, double> limits{{1, 5}, {2, 18}, {3, 460}, {16, 1700}};
  for (const auto& [kinds, limit] : limits) {
    double sum = 0;
    for (uint64_t number = 0; number < 400; ++number) {
      const impostor::ColourBlock block = test::random_block(kSeed, number * 7 + kinds, kinds, 6);
      sum += mean_square(block, there_and_back(block)) / 400;
    }
    EXPECT_LE(sum, limit) << kinds << " kinds of colour";
    RecordProperty("mean_square_" + std::to_string(kinds), std::to_string(sum));
  }
}

TEST(Etc2Codec, TexelsWithoutWeightCostNothing) {
  for (uint64_t number = 0; number < 100; ++number) {
    impostor::ColourBlock block = test::random_block(kSeed, number, 1, 0);
    impostor::TexelWeights weights = test::all_texels();
    for (size_t i = 0; i < 16; ++i) {
      if ((number + i * 7) % 16 < 8) continue;
      weights[i] = 0;
      block[i] = {255, 0, 255, 0};
    }
    impostor::ColourBlock back = block;
    impostor::decode_etc2(impostor::encode_etc2(block, weights, false), false, back);
    for (size_t i = 0; i < 16; ++i) {
      if (weights[i] == 0) continue;
      for (size_t c = 0; c < 3; ++c) EXPECT_NEAR(back[i][c], block[i][c], 2) << number;
    }
  }
}

TEST(Etc2Codec, HeavyTexelsAreKeptBetterThanLightOnes) {
  double with = 0, without = 0;
  for (uint64_t number = 0; number < 300; ++number) {
    const impostor::ColourBlock block = test::random_block(kSeed, number, 4, 10);
    impostor::TexelWeights weights = test::all_texels();
    for (size_t i = 0; i < 16; ++i) weights[i] = i * 7 % 16 < 8 ? 255 : 1;
    const auto heavy_error = [&](const impostor::TexelWeights& given) {
      impostor::ColourBlock back = block;
      impostor::decode_etc2(impostor::encode_etc2(block, given, false), false, back);
      for (size_t i = 0; i < 16; ++i) {
        if (weights[i] == 1) back[i] = block[i];
      }
      return mean_square(block, back);
    };
    with += heavy_error(weights);
    without += heavy_error(test::all_texels());
  }
  EXPECT_LT(with, 0.9 * without);
  RecordProperty("share", std::to_string(with / without));
}

TEST(Etc2Codec, HolesStayHolesAndNothingElseBecomesOne) {
  for (uint64_t number = 0; number < 1000; ++number) {
    impostor::ColourBlock block = test::random_block(kSeed, number, 1 + number % 16, 40);
    for (uint64_t i = 0; i < 16; ++i) block[i][3] = test::random_byte(kSeed, number, 300 + i);
    if (number % 5 == 0) {
      for (auto& texel : block) texel[3] = number % 2 == 0 ? 255 : 0;
    }
    impostor::TexelWeights weights = test::all_texels();
    if (number % 7 == 0) weights.fill(0);
    impostor::ColourBlock back;
    impostor::decode_etc2(impostor::encode_etc2(block, weights, true), true, back);
    for (size_t i = 0; i < 16; ++i) {
      // A block of which no texel counts keeps its holes; its colour is not visible.
      EXPECT_EQ(back[i][3], block[i][3] < 128 ? 0 : 255) << number;
    }
  }
}

TEST(Etc2Codec, AlphaOfFewValuesIsKeptNearlyExactly) {
  for (uint64_t number = 0; number < 500; ++number) {
    impostor::ChannelBlock block;
    const uint8_t one = test::random_byte(kSeed, number, 0);
    const uint8_t few[] = {0, 255, one};
    const uint64_t kinds = 1 + number % 3;
    for (uint64_t i = 0; i < 16; ++i) block[i] = few[2 - random_below(kSeed, number, i + 1, kinds)];
    const impostor::Bytes8 bytes = impostor::encode_eac(block, test::all_texels());
    EXPECT_NE(bytes[1] >> 4, 0) << "encoders must not write a factor of zero";
    impostor::ChannelBlock back;
    impostor::decode_eac(bytes, back);
    for (size_t i = 0; i < 16; ++i) {
      EXPECT_NEAR(back[i], block[i], kinds == 1 ? 0 : kinds == 2 ? 2 : 12) << number;
    }
  }
}

TEST(Etc2Codec, AChannelIsNeverFurtherOffThanHalfAStepOfItsRange) {
  for (uint64_t number = 0; number < 500; ++number) {
    impostor::ChannelBlock block;
    const uint64_t range = 1 + random_below(kSeed, number, 99, 255);
    int low = 255, high = 0;
    for (uint64_t i = 0; i < 16; ++i) {
      block[i] = static_cast<uint8_t>(random_below(kSeed, number, i, range));
      low = std::min<int>(low, block[i]), high = std::max<int>(high, block[i]);
    }
    impostor::ChannelBlock eight;
    impostor::WideChannelBlock eleven;
    impostor::decode_eac(impostor::encode_eac(block, test::all_texels()), eight);
    impostor::decode_eac11(impostor::encode_eac11(block, test::all_texels()), eleven);
    double of_eight = 0, of_eleven = 0;
    for (size_t i = 0; i < 16; ++i) {
      of_eight += std::pow(eight[i] - block[i], 2);
      of_eleven += std::pow(eleven[i] * 255.0 / 2047 - block[i], 2);
    }
    const double half_step = (high - low) / 14.0 + 1;
    EXPECT_LE(of_eight, 16 * half_step * half_step) << number;
    EXPECT_LE(of_eleven, 16 * half_step * half_step) << number;
  }
}

TEST(Etc2Codec, TheSameBytesEverywhere) {
  uint64_t sum = 0;
  for (uint64_t number = 0; number < 2000; ++number) {
    impostor::ColourBlock block = test::random_block(kSeed, number, 1 + number % 6, number % 50);
    impostor::TexelWeights weights;
    impostor::ChannelBlock channel;
    for (uint64_t i = 0; i < 16; ++i) {
      weights[i] = channel[i] = block[i][3] = test::random_byte(kSeed, number, 300 + i);
    }
    for (const impostor::Bytes8& bytes :
         {impostor::encode_etc2(block, weights, false), impostor::encode_etc2(block, weights, true),
          impostor::encode_eac(channel, test::all_texels()),
          impostor::encode_eac11(channel, weights)}) {
      sum = hash_bytes(bytes.data(), bytes.size(), sum);
    }
  }
  EXPECT_EQ(sum, 12124889960328117420ULL);
}

}  // namespace
}  // namespace throng
