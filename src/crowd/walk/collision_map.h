// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>

#include "core/arrays/huge_array.h"
#include "core/arrays/prefetch.h"
#include "crowd/ground/pixel_grid.h"

/// The collision map: where bodies are, on a grid of its own. Source: [TC00] section 3; the bit per
/// cell and level of [ML06] section 3.1.
namespace throng::crowd {

/// [TC00] adds 1 to nine pixels and requires a 0; setting bits in one pixel and reading nine is the
/// same, with a ninth of the writes. A pixel's bits are slices of kSlab height, so bodies on
/// different floors do not collide. Two bodies whose heights overlap share a slice. Not
/// synchronised: see CrowdBlocks.
class CollisionMap {
 public:
  static constexpr int32_t kSlab = 250;  // height of a slice, more for bodies over 12 m [mm]

  /// The slices that a body fills, in one plane of words or in two on top of each other.
  struct Slices {
    uint32_t plane = 0;
    uint64_t low = 0, high = 0;  // in `plane` and in the next
    friend bool operator==(const Slices&, const Slices&) = default;
  };
  /// Where a body is: its pixel and its slices.
  struct Mark {
    uint32_t pixel = 0;
    Slices slices;
    friend bool operator==(const Mark&, const Mark&) = default;
  };

  /// A grid of width x depth cells for feet from `low` to `high`, and bodies up to `body_height`.
  /// [mm]
  CollisionMap(int32_t width, int32_t depth, PixelGrid grid, int32_t low, int32_t high,
               int32_t body_height, Pages pages = Pages::kSmall);

  [[nodiscard]] Mark mark(world::GroundPoint p, int32_t feet, int32_t body_height) const {
    return {pixels().number(grid_.pixel(p.cell_x()), grid_.pixel(p.cell_z())),
            slices(feet, body_height)};
  }
  /// How the pixels of the map are numbered, as a value that a loop keeps in registers.
  struct Pixels {
    PixelGrid grid;
    uint32_t stride;  // pixels a row, with a rim of one
    [[nodiscard]] uint32_t number(int32_t x, int32_t z) const {
      return static_cast<uint32_t>(z + 1) * stride + static_cast<uint32_t>(x + 1);
    }
  };
  [[nodiscard]] Pixels pixels() const { return {grid_, stride_}; }
  [[nodiscard]] Slices slices(int32_t feet, int32_t body_height) const {
    const uint32_t first = slice(static_cast<uint32_t>(feet - low_));
    const uint32_t last = slice(static_cast<uint32_t>(feet - low_ + body_height));
    const uint32_t begin = first % 64, count = last - first + 1;
    const uint64_t ones = ~uint64_t{0} >> (64 - count);
    return {first / 64, ones << begin, begin + count > 64 ? ones >> (64 - begin) : 0};
  }
  void set(const Mark& m) {
    word(m.slices.plane, m.pixel) |= m.slices.low;
    if (m.slices.high != 0) word(m.slices.plane + 1, m.pixel) |= m.slices.high;
  }
  void clear(const Mark& m) {
    word(m.slices.plane, m.pixel) &= ~m.slices.low;
    if (m.slices.high != 0) word(m.slices.plane + 1, m.pixel) &= ~m.slices.high;
  }
  /// True if no body's slices overlap the mark's in its pixel and the eight around.
  [[nodiscard]] bool is_free(const Mark& m) const {
    if ((around(m.slices.plane, m.pixel) & m.slices.low) != 0) return false;
    return m.slices.high == 0 || (around(m.slices.plane + 1, m.pixel) & m.slices.high) == 0;
  }

  /// Index of one of the eight neighbour pixels: dx and dz are -1, 0 or 1, and not both 0.
  [[nodiscard]] static constexpr uint32_t direction_index(int32_t dx, int32_t dz) {
    return static_cast<uint32_t>(dz * 3 + dx + 4);
  }
  /// Prefetches the words that move_by_one will read.
  void prefetch(const Slices& s, uint32_t from, uint32_t direction_index) const {
    const Ring& ring = rings_[direction_index];
    const uint64_t* w = &word(s.plane, from);
    throng::prefetch(w);
    throng::prefetch(w + ring.ahead[0]);
    throng::prefetch(w + ring.ahead[2]);
    throng::prefetch(w + ring.ahead[4]);
  }
  /// Prefetches the words that is_free will read around a point.
  void prefetch(world::GroundPoint p, int32_t feet) const {
    const Mark m = mark(p, feet, 0);
    const uint64_t* w = &word(m.slices.plane, m.pixel);
    throng::prefetch(w - stride_);
    throng::prefetch(w);
    throng::prefetch(w + stride_);
  }
  /// Moves a body that is alone around `from` one pixel along `direction_index`, if it is alone
  /// there too. Only the pixels around the new and not around the old one are read.
  bool move_by_one(const Slices& s, uint32_t from, uint32_t direction_index) {
    const Ring& ring = rings_[direction_index];
    uint64_t* w = &word(s.plane, from);
    uint64_t occupied = ahead(w, ring) & s.low;
    if (s.high != 0) occupied |= ahead(w + plane_size_, ring) & s.high;
    const bool is_free = occupied == 0;
    // Without a branch: whether the pixels are free cannot be predicted.
    const uint64_t low = is_free ? s.low : 0;
    w[0] ^= low;
    w[ring.to] ^= low;
    if (s.high != 0) {
      const uint64_t high = is_free ? s.high : 0;
      w[plane_size_] ^= high;
      (w + plane_size_)[ring.to] ^= high;
    }
    return is_free;
  }
  [[nodiscard]] const PixelGrid& grid() const { return grid_; }
  [[nodiscard]] uint64_t bytes() const { return words_.size() * sizeof(uint64_t); }

 private:
  // The pixel that a direction leads to, and which pixels to read: as offsets from its start. A
  // straight move has three new pixels and lists some of them twice, so that all moves run the same
  // code.
  struct Ring {
    int64_t to = 0;
    std::array<int64_t, 5> ahead{};
  };

  // Rises with the height, which is all that matters: overlapping bodies share a slice.
  [[nodiscard]] uint32_t slice(uint32_t height) const {
    return static_cast<uint32_t>((height * slab_magic_) >> 32);
  }
  [[nodiscard]] uint64_t& word(uint32_t plane, uint32_t pixel) const {
    return words_.data()[plane * plane_size_ + pixel];
  }
  [[nodiscard]] static uint64_t ahead(const uint64_t* w, const Ring& ring) {
    const auto& at = ring.ahead;
    return (w[at[0]] | w[at[1]]) | (w[at[2]] | w[at[3]]) | w[at[4]];
  }
  [[nodiscard]] uint64_t around(uint32_t plane, uint32_t pixel) const {
    const uint64_t* w = &word(plane, pixel);
    const uint64_t* up = w - stride_;
    const uint64_t* down = w + stride_;
    return (up[-1] | up[0] | up[1]) | (w[-1] | w[0] | w[1]) | (down[-1] | down[0] | down[1]);
  }

  PixelGrid grid_;
  uint64_t slab_magic_;  // 2^32 / slab
  uint32_t stride_;      // pixels a row, with a rim of one
  uint64_t plane_size_;
  int32_t low_;
  std::array<Ring, 9> rings_{};
  HugeArray<uint64_t> words_;
};

}  // namespace throng::crowd
