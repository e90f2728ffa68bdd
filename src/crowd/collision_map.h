// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <cstdlib>
#include <memory>

#include "world/walk.h"

/// The collision map: who is where, on a grid of its own. Source: [TC00] section 3; the bit per
/// cell and level of [ML06] section 3.1.
namespace throng {

/// Pixels are at least two radii wide, so bodies whose pixels do not touch cannot touch. [TC00]
/// adds 1 to nine pixels and asks for a 0; setting bits in one pixel and reading nine is the same,
/// with a ninth of the writes. A pixel's bits are slices of kSlab height, so floors above each
/// other do not see each other. Two bodies whose heights overlap share a slice. Not synchronised:
/// see CrowdStep.
class CollisionMap {
 public:
  static constexpr int32_t kSlab = 250;  // height of a slice, more for bodies over 12 m [mm]

  /// Where a body is: its pixel and its slices, in one word or in two on top of each other.
  struct Mark {
    uint32_t pixel = 0;
    uint32_t plane = 0;
    uint64_t low = 0, high = 0;  // slices in `plane` and in the next
    friend bool operator==(const Mark&, const Mark&) = default;
  };

  /// A grid of width x depth cells with pixels of `pixel_cells` cells, for heights from `low` to
  /// `high`. [mm] Memory is touched only where bodies go.
  CollisionMap(int32_t width, int32_t depth, int32_t pixel_cells, int32_t low, int32_t high,
               int32_t body_height);

  [[nodiscard]] uint32_t pixel_x(int64_t x) const {
    return static_cast<uint32_t>((static_cast<uint64_t>(x) * magic_) >> 52) + 1;
  }
  [[nodiscard]] Mark mark(GroundPoint p, int32_t feet) const {
    Mark m;
    m.pixel = pixel_x(p.z) * stride_ + pixel_x(p.x);
    const uint32_t first = slice(static_cast<uint32_t>(feet - low_));
    const uint32_t last = slice(static_cast<uint32_t>(feet - low_ + body_height_));
    m.plane = first / 64;
    const uint32_t begin = first % 64, count = last - first + 1;
    const uint64_t ones = ~uint64_t{0} >> (64 - count);
    m.low = ones << begin;
    m.high = begin + count > 64 ? ones >> (64 - begin) : 0;
    return m;
  }
  void set(const Mark& m) {
    word(m.plane, m.pixel) |= m.low;
    if (m.high != 0) word(m.plane + 1, m.pixel) |= m.high;
  }
  void clear(const Mark& m) {
    word(m.plane, m.pixel) &= ~m.low;
    if (m.high != 0) word(m.plane + 1, m.pixel) &= ~m.high;
  }
  /// True if nobody's slices overlap the mark's in its pixel and the eight around.
  [[nodiscard]] bool is_free(const Mark& m) const {
    if ((around(m.plane, m.pixel) & m.low) != 0) return false;
    return m.high == 0 || (around(m.plane + 1, m.pixel) & m.high) == 0;
  }
  void prefetch(GroundPoint p) const {
    const uint64_t* w = words_.get() + static_cast<uint64_t>(pixel_x(p.z)) * stride_ + pixel_x(p.x);
    __builtin_prefetch(w - stride_);
    __builtin_prefetch(w);
    __builtin_prefetch(w + stride_);
  }
  [[nodiscard]] uint32_t stride() const { return stride_; }
  [[nodiscard]] uint32_t rows() const { return rows_; }
  [[nodiscard]] uint64_t bytes() const { return size_ * sizeof(uint64_t); }

 private:
  // Rises with the height, which is all that matters: overlapping bodies share a slice.
  [[nodiscard]] uint32_t slice(uint32_t height) const {
    return static_cast<uint32_t>((height * slab_magic_) >> 32);
  }
  [[nodiscard]] uint64_t& word(uint32_t plane, uint32_t pixel) const {
    return words_.get()[plane * plane_size_ + pixel];
  }
  [[nodiscard]] uint64_t around(uint32_t plane, uint32_t pixel) const {
    const uint64_t* w = words_.get() + plane * plane_size_ + pixel;
    const uint64_t* up = w - stride_;
    const uint64_t* down = w + stride_;
    return (up[-1] | up[0] | up[1]) | (w[-1] | w[0] | w[1]) | (down[-1] | down[0] | down[1]);
  }

  struct Free {
    void operator()(uint64_t* p) const { std::free(p); }
  };
  uint64_t magic_;       // 2^52 / units per pixel, rounded up: exact for 31-bit positions
  uint64_t slab_magic_;  // 2^32 / slab
  uint32_t stride_;      // pixels a row, with a rim of one
  uint32_t rows_;
  uint64_t plane_size_;
  uint64_t size_;
  int32_t low_;
  int32_t body_height_;
  std::unique_ptr<uint64_t, Free> words_;
};

}  // namespace throng
