// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "crowd/ground/body.h"

/// Where bodies stand, to place more.
namespace throng::crowd {

/// Squares as wide as the widest body, hashed into a table; a list each.
class StandingMap {
 public:
  /// With these bodies, none wider than `widest` units, and capacity for `more`; it grows.
  StandingMap(std::span<const Body> bodies, int32_t widest, size_t more);
  /// No body that is added is wider. [units]
  [[nodiscard]] int32_t widest() const { return static_cast<int32_t>(width_ / 2); }
  /// Does it touch none?
  [[nodiscard]] bool is_clear(const Body& body) const;
  /// Adds a body if it touches no other.
  bool add_if_clear(const Body& body);

 private:
  static constexpr uint32_t kEnd = UINT32_MAX;
  struct Entry {
    int32_t x, z, y, radius;
    uint16_t height;
    uint32_t next;
  };
  [[nodiscard]] size_t square(int64_t x, int64_t z) const;
  void add(const Body& body);
  void grow();

  int64_t width_;
  std::vector<uint32_t> first_;
  std::vector<Entry> entries_;
};

}  // namespace throng::crowd
