// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <string>

/// ETC2 and EAC read texel by texel, as their specification words it: slow, and shares nothing with
/// the library, to compare with. Source: [KDF].
namespace throng::test {

struct PlainTexel {
  int red = 0, green = 0, blue = 0, alpha = 0;
  friend bool operator==(const PlainTexel&, const PlainTexel&) = default;
};

/// The texel in column x and row y of a block of 8 bytes; `punch`: with punch-through alpha.
[[nodiscard]] PlainTexel plain_etc2(const std::array<uint8_t, 8>& block, bool punch, int x, int y);
/// "individual", "differential", "T", "H" or "planar".
[[nodiscard]] std::string plain_etc2_mode(const std::array<uint8_t, 8>& block, bool punch);

/// A channel of 8 bits, and one of 11 (0 to 2047).
[[nodiscard]] int plain_eac8(const std::array<uint8_t, 8>& block, int x, int y);
[[nodiscard]] int plain_eac11(const std::array<uint8_t, 8>& block, int x, int y);

}  // namespace throng::test
