// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "draw/wardrobe.h"

#include <cmath>
#include <cstddef>
#include <cstdint>

#include "core/random.h"

namespace throng::draw {
namespace {

// As a screen shows them, red, green, blue in hexadecimal.
constexpr uint32_t kColours[kBodyParts][kColoursAPart] = {
    {0x808080, 0x808080, 0x808080, 0x808080, 0x808080, 0x808080, 0x808080, 0x808080, 0x808080,
     0x808080, 0x808080, 0x808080},
    {0xf2d3bd, 0xe8beac, 0xdfb190, 0xd4a27c, 0xc68f68, 0xb07b55, 0x9a6743, 0x835237, 0x6a402b,
     0x523122, 0xe3b79a, 0xcf9b76},
    {0x1c1714, 0x2a1f1a, 0x3b2a20, 0x4e3626, 0x6b4a2f, 0x8a6239, 0xb08850, 0xd0b07a, 0x7d3f22,
     0x9c9791, 0xc8c4be, 0x17161a},
    {0xe9e6df, 0xc9cdd2, 0x23262c, 0x2f3f5c, 0x3e6a9e, 0x8fb3d1, 0xa8322d, 0xd9683c, 0xe0b13f,
     0x4d7a53, 0x6d4c7d, 0x8c6f55},
    {0x2b3a55, 0x3a5075, 0x1e2126, 0x3c3f45, 0x5b5e63, 0x7d7565, 0xa3957c, 0x4a3c32, 0x26323f,
     0x5c6b7a, 0x394235, 0xc9c0ae},
    {0x17181a, 0x2a2522, 0x4a3426, 0x6d4f38, 0xe2e0db, 0x8c8f94, 0x2c3444, 0x141414, 0x7a2a26,
     0x3a3a3a, 0xb9b3a6, 0x232323}};

// One of twelve colours for each of `count` things, in four bits each.
uint32_t colours_of(uint64_t seed, uint32_t look, uint32_t count) {
  uint32_t colours = 0;
  for (uint32_t thing = 0; thing < count; ++thing) {
    colours |= static_cast<uint32_t>(random_below(seed, look, thing, kColoursAPart)) << 4 * thing;
  }
  return colours;
}

}  // namespace

std::array<float, 3 * kColoursAPart * kBodyParts> wardrobe() {
  std::array<float, 3 * kColoursAPart * kBodyParts> out{};
  for (size_t i = 0; i < out.size() / 3; ++i) {
    const uint32_t colour = kColours[i / kColoursAPart][i % kColoursAPart];
    for (size_t c = 0; c < 3; ++c) {
      const float shown = static_cast<float>(colour >> (16 - 8 * c) & 255) / 255;
      out[i * 3 + c] = shown * shown;
    }
  }
  return out;
}

uint32_t outfit_of(uint32_t look) { return colours_of(0x6f7574666974, look, kBodyParts); }

uint32_t worn_colours_of(uint32_t look) { return colours_of(0x776f726e, look, kWornKinds); }

double worn_ahead(WornKind kind) {
  switch (kind) {
    case WornKind::kHair:
    case WornKind::kSkirt:
      return 0.02;
    case WornKind::kCoat:
      return 0.04;
    default:
      return 0.06;
  }
}

}  // namespace throng::draw
