// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "crowd/ground/body.h"

/// The bodies near those that the engine of flyers or of climbers moves.
namespace throng::crowd {

/// Cubes half as wide as the sight, in a table rolled up along all three axes: so it is as large as
/// the crowd, not as the world. Of the walkers it holds only those that a flyer could see.
class FlyerGrid {
 public:
  /// What is needed to find neighbours.
  struct Entry {
    int32_t x, z, y;
    uint32_t body;
    int32_t radius, height;  // [units, mm]
  };

  /// Cubes of this width [units] and height [mm].
  void fit(int32_t width, int32_t height);
  /// `flyers`: all bodies for which `is_flyer` is true. They may be climbers.
  void build(std::span<const Body> bodies, std::span<const uint32_t> flyers,
             bool (*is_flyer)(const Body& body));

  /// Calls visit(entry) for all in the 27 cubes around a place: all bodies within a cube's width.
  template <class Visit>
  void for_near(int32_t x, int32_t z, int32_t y, Visit visit) const {
    const Cube c = cube(x, z, y);
    for_columns(1, [&](int32_t dx, int32_t dz) { column(c, dx, dz, -1, 1, visit); });
  }
  /// The same for the 98 cubes around those: all other bodies within two cubes' widths. Skips
  /// columns of cubes whose squared distance exceeds limit(), in units.
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
  static void for_columns(int32_t range, Visit visit) {
    constexpr int32_t kInside[] = {0, -1, 1, -2, 2};  // the nearest first
    for (int32_t z = 0; z <= 2 * range; ++z) {
      for (int32_t x = 0; x <= 2 * range; ++x) visit(kInside[x], kInside[z]);
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
  uint32_t bits_xz_ = 3, bits_y_ = 3;  // five adjacent cubes are different entries
  std::vector<uint32_t> first_;        // of a cube; one more than there are
  std::vector<uint8_t> wanted_;        // a flyer is in it or beside it
  std::vector<uint32_t> walkers_;
  std::vector<Entry> entries_;
};

}  // namespace throng::crowd
