// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "impostor/block_codec.h"

/// The tables of ETC2, and how its colours widen to 8 bits. Source: [KDF].
namespace throng::impostor::etc2 {

using Colour = std::array<int32_t, 3>;

/// How far the four colours of half a block lie from its base: +first, +second, -first, -second.
inline constexpr int32_t kSteps[8][2] = {{2, 8},   {5, 17},  {9, 29},   {13, 42},
                                         {18, 60}, {24, 80}, {33, 106}, {47, 183}};
/// How far the colours of the modes T and H lie from their bases.
inline constexpr int32_t kDistances[8] = {3, 6, 11, 16, 23, 32, 41, 64};
/// The lower four steps of EAC; the upper are -1 - these.
inline constexpr int32_t kChannelSteps[16][4] = {
    {-3, -6, -9, -15}, {-3, -7, -10, -13}, {-2, -5, -8, -13}, {-2, -4, -6, -13},
    {-3, -6, -8, -12}, {-3, -7, -9, -11},  {-4, -7, -8, -11}, {-3, -5, -8, -11},
    {-2, -6, -8, -10}, {-2, -5, -8, -10},  {-2, -4, -8, -10}, {-2, -5, -7, -10},
    {-3, -4, -7, -10}, {-1, -2, -3, -10},  {-4, -6, -8, -9},  {-3, -5, -7, -9}};

/// A texel by column of that by row, and back.
inline constexpr size_t turned(size_t texel) { return texel % 4 * 4 + texel / 4; }

inline int32_t byte_of(int32_t value) { return std::clamp(value, 0, 255); }
inline int32_t widen4(int32_t v) { return v * 17; }
inline int32_t widen5(int32_t v) { return v << 3 | v >> 2; }
inline int32_t widen6(int32_t v) { return v << 2 | v >> 4; }
inline int32_t widen7(int32_t v) { return v << 1 | v >> 6; }

inline Colour shifted(const Colour& colour, int32_t by) {
  return {byte_of(colour[0] + by), byte_of(colour[1] + by), byte_of(colour[2] + by)};
}

/// A step of EAC by its index.
inline int32_t channel_step(size_t table, size_t index) {
  const int32_t low = kChannelSteps[table][index % 4];
  return index < 4 ? low : -1 - low;
}

/// The colours of half a block, by index. With `hole`, index 2 is one.
inline std::array<Colour, 4> half_colours(const Colour& base, size_t table, bool hole) {
  const int32_t near = hole ? 0 : kSteps[table][0], far = kSteps[table][1];
  return {shifted(base, near), shifted(base, far), shifted(base, -near), shifted(base, -far)};
}

/// The colours of the modes T and H, by index; bases are wide.
inline std::array<Colour, 4> t_colours(const Colour& a, const Colour& b, int32_t distance) {
  return {a, shifted(b, distance), b, shifted(b, -distance)};
}
inline std::array<Colour, 4> h_colours(const Colour& a, const Colour& b, int32_t distance) {
  return {shifted(a, distance), shifted(a, -distance), shifted(b, distance), shifted(b, -distance)};
}

/// A planar block at (x, y); `origin`, `across` and `down` are wide.
inline Colour planar_colour(const Colour& origin, const Colour& across, const Colour& down,
                            int32_t x, int32_t y) {
  Colour out{};
  for (size_t k = 0; k < 3; ++k) {
    const int32_t four = x * (across[k] - origin[k]) + y * (down[k] - origin[k]) + 4 * origin[k];
    out[k] = byte_of((four + 2) >> 2);
  }
  return out;
}

/// A block as one number: its first byte is the highest.
inline uint64_t word_of(const Bytes8& bytes) {
  uint64_t word = 0;
  for (const uint8_t byte : bytes) word = word << 8 | byte;
  return word;
}
inline Bytes8 bytes_of(uint64_t word) {
  Bytes8 out;
  for (size_t i = 0; i < 8; ++i) out[i] = static_cast<uint8_t>(word >> (56 - 8 * i));
  return out;
}

/// Bits `low` to `low` + `count` - 1.
inline int32_t bits(uint64_t word, int32_t low, int32_t count) {
  return static_cast<int32_t>(word >> low & ((uint64_t{1} << count) - 1));
}
inline int32_t signed3(int32_t three) { return three < 4 ? three : three - 8; }

}  // namespace throng::impostor::etc2
