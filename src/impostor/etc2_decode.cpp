// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "impostor/etc2_codec.h"
#include "impostor/etc2_tables.h"

// Decodes ETC2 and EAC. Source: [KDF]. A block is two halves with a base colour each; the second
// base may be stored as a difference from the first. If a component of the sum leaves the range of
// five bits, which no encoder of the older ETC1 wrote, the bits mean another mode: red T, green H,
// blue planar.
namespace throng::impostor {
namespace {

using namespace etc2;

void put(ColourBlock& block, size_t texel, const Colour& colour) {
  for (size_t k = 0; k < 3; ++k) block[texel][k] = static_cast<uint8_t>(colour[k]);
}

// `holes`: the format has them; `hole`: this block may.
void put_index(ColourBlock& block, uint64_t word, size_t by_column,
               const std::array<Colour, 4>& colours, bool holes, bool hole) {
  const auto at = static_cast<int32_t>(by_column);
  const auto index = static_cast<size_t>(bits(word, 16 + at, 1) << 1 | bits(word, at, 1));
  const size_t texel = turned(by_column);
  const bool empty = hole && index == 2;
  put(block, texel, empty ? Colour{} : colours[index]);
  if (holes) block[texel][3] = empty ? 0 : 255;
}

void decode_t(uint64_t word, bool holes, bool hole, ColourBlock& block) {
  const Colour a{widen4(bits(word, 59, 2) << 2 | bits(word, 56, 2)), widen4(bits(word, 52, 4)),
                 widen4(bits(word, 48, 4))};
  const Colour b{widen4(bits(word, 44, 4)), widen4(bits(word, 40, 4)), widen4(bits(word, 36, 4))};
  const int32_t distance = kDistances[bits(word, 34, 2) << 1 | bits(word, 32, 1)];
  for (size_t i = 0; i < 16; ++i) {
    put_index(block, word, i, t_colours(a, b, distance), holes, hole);
  }
}

void decode_h(uint64_t word, bool holes, bool hole, ColourBlock& block) {
  const Colour a{bits(word, 59, 4), bits(word, 56, 3) << 1 | bits(word, 52, 1),
                 bits(word, 51, 1) << 3 | bits(word, 47, 3)};
  const Colour b{bits(word, 43, 4), bits(word, 39, 4), bits(word, 35, 4)};
  // The order of the bases gives the distance's last bit.
  const int32_t distance =
      kDistances[bits(word, 34, 1) << 2 | bits(word, 32, 1) << 1 | (a >= b ? 1 : 0)];
  const auto colours = h_colours({widen4(a[0]), widen4(a[1]), widen4(a[2])},
                                 {widen4(b[0]), widen4(b[1]), widen4(b[2])}, distance);
  for (size_t i = 0; i < 16; ++i) put_index(block, word, i, colours, holes, hole);
}

// A slope across the block, which has no indices and no holes.
void decode_planar(uint64_t word, bool holes, ColourBlock& block) {
  const Colour origin{widen6(bits(word, 57, 6)), widen7(bits(word, 56, 1) << 6 | bits(word, 49, 6)),
                      widen6(bits(word, 48, 1) << 5 | bits(word, 43, 2) << 3 | bits(word, 39, 3))};
  const Colour across{widen6(bits(word, 34, 5) << 1 | bits(word, 32, 1)), widen7(bits(word, 25, 7)),
                      widen6(bits(word, 19, 6))};
  const Colour down{widen6(bits(word, 13, 6)), widen7(bits(word, 6, 7)), widen6(bits(word, 0, 6))};
  for (size_t i = 0; i < 16; ++i) {
    put(block, i,
        planar_colour(origin, across, down, static_cast<int32_t>(i % 4),
                      static_cast<int32_t>(i / 4)));
    if (holes) block[i][3] = 255;
  }
}

}  // namespace

void decode_etc2(const Bytes8& bytes, bool holes, ColourBlock& block) {
  const uint64_t word = word_of(bytes);
  const bool flag = bits(word, 33, 1) != 0;  // Of holes: none here; else: bases by difference.
  const bool hole = holes && !flag;
  Colour a{}, b{};
  if (holes || flag) {
    for (int32_t k = 0; k < 3; ++k) {
      const int32_t first = bits(word, 59 - 8 * k, 5);
      const int32_t second = first + signed3(bits(word, 56 - 8 * k, 3));
      if (second < 0 || second > 31) {
        if (k == 0) return decode_t(word, holes, hole, block);
        if (k == 1) return decode_h(word, holes, hole, block);
        return decode_planar(word, holes, block);
      }
      a[static_cast<size_t>(k)] = widen5(first);
      b[static_cast<size_t>(k)] = widen5(second);
    }
  } else {
    for (int32_t k = 0; k < 3; ++k) {
      a[static_cast<size_t>(k)] = widen4(bits(word, 60 - 8 * k, 4));
      b[static_cast<size_t>(k)] = widen4(bits(word, 56 - 8 * k, 4));
    }
  }
  const auto first = half_colours(a, static_cast<size_t>(bits(word, 37, 3)), hole);
  const auto second = half_colours(b, static_cast<size_t>(bits(word, 34, 3)), hole);
  const bool rows = bits(word, 32, 1) != 0;  // One half lies above the other.
  for (size_t i = 0; i < 16; ++i) {
    const bool in_second = rows ? i % 4 >= 2 : i >= 8;
    put_index(block, word, i, in_second ? second : first, holes, hole);
  }
}

}  // namespace throng::impostor
