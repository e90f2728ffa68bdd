// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstdint>

#include "core/random.h"
#include "impostor/block_codec.h"

/// Blocks of texels for the tests of codecs.
namespace throng::test {

inline impostor::TexelWeights all_texels() {
  impostor::TexelWeights weights;
  weights.fill(1);
  return weights;
}

inline uint8_t random_byte(uint64_t seed, uint64_t block, uint64_t i) {
  return static_cast<uint8_t>(random_below(seed, block, i, 256));
}

/// `kinds` colours, assigned to texels at random, with some noise.
inline impostor::ColourBlock random_block(uint64_t seed, uint64_t number, uint64_t kinds,
                                          uint64_t noise) {
  impostor::ColourBlock block;
  for (uint64_t i = 0; i < 16; ++i) {
    const uint64_t kind = random_below(seed, number, 100 + i, kinds);
    for (uint64_t c = 0; c < 3; ++c) {
      const int base = random_byte(seed, number, kind * 3 + c);
      const int off = static_cast<int>(random_below(seed, number, 200 + i * 3 + c, noise + 1));
      block[i][c] = static_cast<uint8_t>(std::min(255, base + off));
    }
    block[i][3] = 255;
  }
  return block;
}

}  // namespace throng::test
