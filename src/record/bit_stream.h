// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <span>
#include <vector>

/// Numbers as runs of bits, the lowest bit of a byte first.
namespace throng::record {

/// Small numbers of either sign as small numbers: 0, -1, 1, -2 ... are 0, 1, 2, 3 ...
constexpr uint32_t zigzag(int32_t v) {
  return (static_cast<uint32_t>(v) << 1) ^ static_cast<uint32_t>(v >> 31);
}
constexpr int32_t unzigzag(uint32_t u) { return static_cast<int32_t>((u >> 1) ^ (0u - (u & 1))); }

/// Golomb-Rice codes have at most so many ones in front; then a gamma code says how many more.
inline constexpr uint32_t kMaxOnes = 4;

/// Appends to a buffer that keeps its memory.
class BitWriter {
 public:
  explicit BitWriter(std::vector<uint8_t>& bytes) : bytes_(bytes) {}

  void put(uint64_t value, uint32_t bits) {  // bits <= 32, value < 2^bits
    word_ |= value << used_;
    used_ += bits;
    while (used_ >= 8) {
      bytes_.push_back(static_cast<uint8_t>(word_));
      word_ >>= 8;
      used_ -= 8;
    }
  }
  void put64(uint64_t value) {
    put(value & 0xffffffff, 32);
    put(value >> 32, 32);
  }
  /// Any number, 2 log2(value + 1) + 1 bits. [value < 2^64 - 1] Source: [Eli75], gamma code.
  void put_gamma(uint64_t value) {
    const auto bits = static_cast<uint32_t>(std::bit_width(value + 1)) - 1;
    for (uint32_t left = bits; left > 0;) {
      const uint32_t now = std::min(left, 32u);
      put(0, now);
      left -= now;
    }
    put(1, 1);
    const uint64_t rest = (value + 1) & ((uint64_t{1} << bits) - 1);
    put(rest & 0xffffffff, std::min(bits, 32u));
    if (bits > 32) put(rest >> 32, bits - 32);
  }
  /// A number expected to be about 2^k. [k <= 31] Source: [Ric79].
  void put_rice(uint32_t value, uint32_t k) {
    const uint32_t ones = value >> k;
    if (ones < kMaxOnes) {
      put((uint64_t{1} << ones) - 1, ones + 1);
    } else {
      put((uint64_t{1} << kMaxOnes) - 1, kMaxOnes);
      put_gamma(ones - kMaxOnes);
    }
    put(value & ((uint64_t{1} << k) - 1), k);
  }
  void align() {
    if (used_ > 0) put(0, 8 - used_);
  }

 private:
  std::vector<uint8_t>& bytes_;
  uint64_t word_ = 0;
  uint32_t used_ = 0;
};

/// Reads what BitWriter wrote. Past the end everything is 0 and ok() is false.
class BitReader {
 public:
  explicit BitReader(std::span<const uint8_t> bytes) : bytes_(bytes) {}

  [[nodiscard]] bool ok() const { return at_ <= bytes_.size() * 8; }
  [[nodiscard]] uint64_t left() const { return ok() ? bytes_.size() * 8 - at_ : 0; }

  uint64_t get(uint32_t bits) {  // bits <= 32
    const uint64_t value = peek() & ((uint64_t{1} << bits) - 1);
    at_ += bits;
    return value;
  }
  uint64_t get64() {
    const uint64_t low = get(32);
    return low | get(32) << 32;
  }
  uint64_t get_gamma() {
    uint32_t bits = 0;
    for (; ok() && get(1) == 0; ++bits) {
    }
    if (bits > 63 || !ok()) {
      at_ = ~uint64_t{0} >> 1;
      return 0;
    }
    uint64_t value = get(std::min(bits, 32u));
    if (bits > 32) value |= get(bits - 32) << 32;
    return ((uint64_t{1} << bits) | value) - 1;
  }
  uint32_t get_rice(uint32_t k) {
    auto ones = std::min(static_cast<uint32_t>(std::countr_one(peek())), kMaxOnes);
    if (ones < kMaxOnes) {
      at_ += ones + 1;
    } else {
      at_ += kMaxOnes;
      ones += static_cast<uint32_t>(get_gamma());
    }
    return ones << k | static_cast<uint32_t>(get(k));
  }

 private:
  // At least 57 bits from here on, zeros behind the end.
  [[nodiscard]] uint64_t peek() const {
    const uint64_t byte = at_ >> 3;
    uint64_t word = 0;
    const uint64_t count = byte < bytes_.size() ? std::min<uint64_t>(8, bytes_.size() - byte) : 0;
    for (uint64_t i = 0; i < count; ++i) word |= uint64_t{bytes_[byte + i]} << (8 * i);
    return word >> (at_ & 7);
  }

  std::span<const uint8_t> bytes_;
  uint64_t at_ = 0;  // bits
};

}  // namespace throng::record
