// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "path/edits/ground_delays.h"
#include "path/ground/mesh.h"
#include "world/tile_grid.h"

/// A part of the ground for a search.
namespace throng::path {

/// Squares of level tiles that a search may enter.
class Corridor {
 public:
  static constexpr int32_t kSide = GroundDelays::kSide;  // of a square [cells]
  static constexpr int32_t kAcross = GroundDelays::kAcross;

  explicit Corridor(size_t levels) : squares_(levels, 0) {}
  void clear() {
    for (const uint32_t level : levels_) squares_[level] = 0;
    levels_.clear();
  }
  void add(uint32_t level, uint32_t square) {
    if (squares_[level] == 0) levels_.push_back(level);
    squares_[level] = static_cast<uint16_t>(squares_[level] | 1u << square);
  }
  /// Does a rectangle of a level share ground with any of them?
  [[nodiscard]] bool holds(uint32_t level, const MeshRect& rect) const {
    const uint32_t squares = squares_[level];
    if (squares == 0) return false;
    const int32_t x = world::in_tile(rect.x), z = world::in_tile(rect.z);
    const int32_t x0 = x / kSide, x1 = (x + rect.width - 1) / kSide;
    const uint32_t row = ((2u << x1) - 1) & ~((1u << x0) - 1);
    for (int32_t r = z / kSide; r <= (z + rect.depth - 1) / kSide; ++r) {
      if ((squares >> (r * kAcross) & row) != 0) return true;
    }
    return false;
  }

 private:
  static_assert(kAcross * kAcross == 16);
  std::vector<uint16_t> squares_;  // by level
  std::vector<uint32_t> levels_;   // with squares
};

}  // namespace throng::path
