// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "crowd/body.h"

/// Who is near a flyer.
namespace throng {

/// Cubes as wide as one sees, in a table rolled up along all three axes: so it is as large as the
/// crowd, not as the world. Of those who walk only those are in it whom a flyer could see.
class FlyerGrid {
 public:
  struct Entry {
    int32_t x, z, y;
    uint32_t body;
  };

  /// Cubes so many units wide and millimetres high.
  void fit(int32_t width, int32_t height);
  void build(std::span<const Body> bodies, std::span<const uint32_t> flyers);

  /// Of the 27 cubes around a place, no entry twice.
  static constexpr size_t kAround = 27;
  using Around = std::array<std::span<const Entry>, kAround>;
  [[nodiscard]] Around around(int32_t x, int32_t z, int32_t y) const;
  [[nodiscard]] uint64_t bytes() const;

 private:
  struct Cube {
    int32_t x, z, y;
  };
  [[nodiscard]] Cube cube(int32_t x, int32_t z, int32_t y) const;
  [[nodiscard]] uint32_t number(Cube c) const;
  template <class Visit>
  void for_around(Cube middle, Visit visit) const;

  int32_t width_ = 1, height_ = 1;
  uint32_t bits_xz_ = 2, bits_y_ = 2;
  std::vector<uint32_t> first_;  // of a cube; one more than there are
  std::vector<uint8_t> wanted_;  // a flyer is in it or beside it
  std::vector<uint32_t> walkers_;
  std::vector<Entry> entries_;
};

}  // namespace throng
