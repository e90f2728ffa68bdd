// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

/// Whole numbers in files, in as few bytes as they take: 7 bits a byte, the lowest first, the high
/// bit set in all but the last (LEB128).
namespace throng {

inline void put_number(std::vector<uint8_t>& bytes, uint64_t value) {
  for (; value > 0x7f; value >>= 7) bytes.push_back(static_cast<uint8_t>(value | 0x80));
  bytes.push_back(static_cast<uint8_t>(value));
}

/// The number at `at`, which moves on behind it; none if the bytes end within it, if it takes more
/// than 64 bits, or more bytes than it needs.
inline std::optional<uint64_t> take_number(std::span<const uint8_t> bytes, size_t& at) {
  uint64_t value = 0;
  for (uint32_t shift = 0; shift < 64 && at < bytes.size(); shift += 7) {
    const uint8_t byte = bytes[at++];
    if (shift == 63 && byte > 1) return std::nullopt;
    value |= uint64_t{byte & 0x7fU} << shift;
    if (byte > 0x7f) continue;
    if (byte == 0 && shift > 0) return std::nullopt;
    return value;
  }
  return std::nullopt;
}

/// A difference as a number: small ones of either sign are small.
inline uint64_t folded(int64_t difference) {
  return static_cast<uint64_t>(difference) << 1 ^ static_cast<uint64_t>(difference >> 63);
}
inline int64_t unfolded(uint64_t number) {
  return static_cast<int64_t>(number >> 1 ^ (0 - (number & 1)));
}

}  // namespace throng
