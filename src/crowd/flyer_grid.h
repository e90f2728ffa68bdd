// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "crowd/body.h"

/// Who is near those whom an engine of its own moves: who flies, or who climbs.
namespace throng {

/// Cubes half as wide as one sees, in a table rolled up along all three axes: so it is as large as
/// the crowd, not as the world. Of those who walk only those are in it whom a flyer could see.
class FlyerGrid {
 public:
  /// Enough to know who is near.
  struct Entry {
    int32_t x, z, y;
    uint32_t body;
    int32_t radius, height;  // [units, mm]
  };

  /// Cubes so many units wide and millimetres high.
  void fit(int32_t width, int32_t height);
  /// `flyers`: all of whom `is_flyer` is true. They may be climbers.
  void build(std::span<const Body> bodies, std::span<const uint32_t> flyers,
             bool (*is_flyer)(const Body& body));

  /// Calls visit(entry) for all in the 27 cubes around a place: everybody within a cube's width.
  template <class Visit>
  void for_near(int32_t x, int32_t z, int32_t y, Visit visit) const {
    const Cube c = cube(x, z, y);
    for_columns(1, [&](int32_t dx, int32_t dz) { column(c, dx, dz, -1, 1, visit); });
  }
  /// The same for the 98 cubes around those: everybody else within two cubes' widths. Leaves out
  /// columns of cubes the square of whose distance is over limit(), in units.
  template <class Limit, class Visit>
  void for_far(int32_t x, int32_t z, int32_t y, Limit limit, Visit visit) const {
    const Cube c = cube(x, z, y);
    const auto off = [&](int32_t at, int32_t middle, int32_t d) {
      const int32_t in = at - middle * width_;
      return static_cast<float>(d > 0 ? d * width_ - in : d < 0 ? in - (d + 1) * width_ : 0);
    };
    for_columns(2, [&](int32_t dx, int32_t dz) {
      const float far_x = off(x, c.x, dx), far_z = off(z, c.z, dz);
      if (far_x * far_x + far_z * far_z > limit()) return;
      const bool is_inner = dx >= -1 && dx <= 1 && dz >= -1 && dz <= 1;
      if (!is_inner) return column(c, dx, dz, -2, 2, visit);
      column(c, dx, dz, -2, -2, visit);
      column(c, dx, dz, 2, 2, visit);
    });
  }
  [[nodiscard]] uint64_t bytes() const;

 private:
  struct Cube {
    int32_t x, z, y;
  };
  [[nodiscard]] Cube cube(int32_t x, int32_t z, int32_t y) const;
  [[nodiscard]] uint32_t number(Cube c) const {
    const uint32_t mask = (1u << bits_xz_) - 1, mask_y = (1u << bits_y_) - 1;
    return ((static_cast<uint32_t>(c.z) & mask) << bits_xz_ | (static_cast<uint32_t>(c.x) & mask))
               << bits_y_ |
           (static_cast<uint32_t>(c.y) & mask_y);
  }
  template <class Visit>
  static void for_columns(int32_t reach, Visit visit) {
    constexpr int32_t kInside[] = {0, -1, 1, -2, 2};  // the nearest first
    for (int32_t z = 0; z <= 2 * reach; ++z) {
      for (int32_t x = 0; x <= 2 * reach; ++x) visit(kInside[x], kInside[z]);
    }
  }
  template <class Visit>
  void column(Cube c, int32_t dx, int32_t dz, int32_t low, int32_t high, Visit& visit) const {
    for (int32_t dy = low; dy <= high; ++dy) {
      const uint32_t n = number({c.x + dx, c.z + dz, c.y + dy});
      for (uint32_t e = first_[n]; e < first_[n + 1]; ++e) visit(entries_[e]);
    }
  }

  int32_t width_ = 1, height_ = 1;
  uint32_t bits_xz_ = 3, bits_y_ = 3;  // five cubes beside each other are five
  std::vector<uint32_t> first_;        // of a cube; one more than there are
  std::vector<uint8_t> wanted_;        // a flyer is in it or beside it
  std::vector<uint32_t> walkers_;
  std::vector<Entry> entries_;
};

}  // namespace throng
