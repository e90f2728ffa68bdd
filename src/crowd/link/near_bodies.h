// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "crowd/ground/body.h"

/// The bodies near a few points of the plane: one pass over all bodies.
namespace throng::crowd {

class NearBodies {
 public:
  /// Squares `width` units wide; begins again.
  void begin(int32_t width) {
    width_ = width;
    squares_.clear();
    found_.clear();
  }
  /// Asks for the bodies within `width` of a point. Before `find`.
  void add_point(int32_t x, int32_t z) {
    for (int32_t dz = -1; dz <= 1; ++dz) {
      for (int32_t dx = -1; dx <= 1; ++dx) squares_.push_back(key(x, z, dx, dz));
    }
  }
  void find(std::span<const Body> bodies) {
    std::sort(squares_.begin(), squares_.end());
    squares_.erase(std::unique(squares_.begin(), squares_.end()), squares_.end());
    for (uint32_t i = 0; i < bodies.size(); ++i) {
      const uint64_t square = key(bodies[i].x, bodies[i].z, 0, 0);
      if (std::binary_search(squares_.begin(), squares_.end(), square)) {
        found_.emplace_back(square, i);
      }
    }
    std::sort(found_.begin(), found_.end());
  }
  /// Does a test of the index of a body hold for one that was within `width` of a point?
  template <class Test>
  [[nodiscard]] bool any_near(int32_t x, int32_t z, Test test) const {
    for (int32_t dz = -1; dz <= 1; ++dz) {
      for (int32_t dx = -1; dx <= 1; ++dx) {
        const uint64_t square = key(x, z, dx, dz);
        auto at = std::lower_bound(found_.begin(), found_.end(), std::pair(square, uint32_t{0}));
        for (; at != found_.end() && at->first == square; ++at) {
          if (test(at->second)) return true;
        }
      }
    }
    return false;
  }
  [[nodiscard]] uint64_t bytes() const {
    return squares_.capacity() * sizeof(squares_[0]) + found_.capacity() * sizeof(found_[0]);
  }

 private:
  [[nodiscard]] uint64_t key(int32_t x, int32_t z, int32_t dx, int32_t dz) const {
    const auto number = [&](int32_t at, int32_t more) {
      return static_cast<uint32_t>(at / width_ + more + 1);
    };
    return uint64_t{number(z, dz)} << 32 | number(x, dx);
  }

  int32_t width_ = 1;
  std::vector<uint64_t> squares_;                     // that were asked for
  std::vector<std::pair<uint64_t, uint32_t>> found_;  // (square, body), in order
};

}  // namespace throng::crowd
