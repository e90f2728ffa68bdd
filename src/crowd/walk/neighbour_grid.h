// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/arrays/huge_array.h"
#include "crowd/ground/body.h"
#include "crowd/ground/pixel_grid.h"
#include "crowd/walk/sense_kernel.h"

/// Which bodies are near each other: bodies in order of the square that they stand on.
namespace throng::crowd {

/// The plane in squares, rolled up: square (x, z) is the one of (x mod 2^a, z mod 2^b), so that a
/// table of as many entries as there are bodies is enough for a world of any size. A query also
/// finds bodies from far away, and excludes them by their distance. In the rows of squares around a
/// body no square occurs twice: there are always at least kAround of them.
class NeighbourGrid {
 public:
  static constexpr int32_t kRange = 2;  // squares to each side
  static constexpr int32_t kAround = 2 * kRange + 1;

  /// Squares at least as wide as half of `sight` units, for a world of width x depth cells.
  NeighbourGrid(int32_t width, int32_t depth, int64_t sight, size_t bodies);

  /// Sorts by square; on one square the order stays. `sorted` must be as large as `bodies`.
  void sort(std::span<const Body> bodies, std::span<Body> sorted, int32_t workers);

  /// Bodies of the rows of squares around a body, a row in up to two pieces, none of them empty.
  class Around {
   public:
    [[nodiscard]] std::span<const Entries> pieces() const { return {pieces_.data(), size_}; }
    [[nodiscard]] uint32_t bodies() const { return bodies_; }
    void add(Entries piece) {
      pieces_[size_] = piece;
      size_ += piece.first < piece.last ? 1 : 0;
      bodies_ += piece.last - piece.first;
    }

   private:
    std::array<Entries, 2 * kAround + 1> pieces_{};  // The last is for an empty one beyond all.
    uint32_t size_ = 0, bodies_ = 0;
  };
  /// The bodies in the squares at most `range` (at most kRange) from the square: all that may be
  /// within sight.
  [[nodiscard]] Around around(uint32_t square, uint32_t range = kRange) const;
  /// Of a square. [units]
  [[nodiscard]] float width() const { return static_cast<float>(squares_.units()); }
  [[nodiscard]] uint32_t square(const Body& body) const {
    const auto x = static_cast<uint32_t>(squares_.pixel(body.x >> world::kUnitBits));
    const auto z = static_cast<uint32_t>(squares_.pixel(body.z >> world::kUnitBits));
    return ((z & mask_z_) << bits_x_) | (x & mask_x_);
  }

  /// Coordinates of the sorted bodies, as arrays with padding for one more vector.
  [[nodiscard]] const int32_t* x() const { return x_.data(); }
  [[nodiscard]] const int32_t* z() const { return z_.data(); }
  [[nodiscard]] const int32_t* y() const { return y_.data(); }
  [[nodiscard]] uint64_t bytes() const;

 private:
  PixelGrid squares_;
  uint32_t bits_x_ = 0;
  uint32_t mask_x_ = 0, mask_z_ = 0;
  std::vector<uint32_t> first_;              // of a square; one more than there are
  std::vector<std::vector<uint32_t>> next_;  // of a square, a list for each part of the bodies
  HugeArray<int32_t> x_, z_, y_;
};

}  // namespace throng::crowd
