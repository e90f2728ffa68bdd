// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <vector>

/// Places in arrays whose parts come and go.
namespace throng::path {

/// Gives out blocks of consecutive indices and takes them back: a block has room for a power of
/// two, and is used again for another that needs as much.
class IndexBlocks {
 public:
  /// The first index of a block for `count` elements. [count > 0]
  uint32_t take(uint32_t count) {
    std::vector<uint32_t>& free = free_[size_class(count)];
    if (free.empty()) {
      const uint32_t first = end_;
      end_ += uint32_t{1} << size_class(count);
      return first;
    }
    const uint32_t first = free.back();
    free.pop_back();
    return first;
  }
  void give_back(uint32_t first, uint32_t count) { free_[size_class(count)].push_back(first); }
  /// All indices are below it.
  [[nodiscard]] uint32_t end() const { return end_; }

 private:
  static size_t size_class(uint32_t count) {
    return static_cast<size_t>(std::bit_width(count - 1));
  }

  std::array<std::vector<uint32_t>, 33> free_;
  uint32_t end_ = 0;
};

}  // namespace throng::path
