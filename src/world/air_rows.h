// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "world/air_tree.h"

/// A box of air cells as bits, while a tree is made: set bits are free cells.
namespace throng::world {

/// Cells [0, width) x [0, height) x [0, depth); rows along x, 64 cells a word.
struct AirRows {
  int32_t width = 0, height = 0, depth = 0;
  int32_t words = 0;  // a row
  std::vector<uint64_t> bits;

  AirRows() = default;
  AirRows(int32_t w, int32_t h, int32_t d, bool free);

  [[nodiscard]] uint64_t* row(int32_t y, int32_t z) {
    return &bits[(static_cast<size_t>(y) * static_cast<size_t>(depth) + static_cast<size_t>(z)) *
                 static_cast<size_t>(words)];
  }
  [[nodiscard]] const uint64_t* row(int32_t y, int32_t z) const {
    return const_cast<AirRows*>(this)->row(y, z);
  }
  [[nodiscard]] bool is_free(int32_t x, int32_t y, int32_t z) const {
    return (row(y, z)[x >> 6] >> (x & 63) & 1) != 0;
  }
  /// Sets or clears the cells [x0, x1) of a row; what lies outside the box is left out.
  void fill(int32_t x0, int32_t x1, int32_t y, int32_t z, bool free);
  /// The 64 cells of the block of 4 x 4 x 4 at (x, y, z), multiples of 4 within the box.
  [[nodiscard]] uint64_t block(int32_t x, int32_t y, int32_t z) const;
};

/// What a tree is built from: the cells [x, x + side) x [0, height) x [z, z + side) of some rows.
/// Layers of the rows count from `base`; x, z, base and the rows' height are multiples of 4.
struct AirTreeSource {
  const AirRows* rows = nullptr;
  int32_t x = 0, z = 0;
  int32_t side = 0;          // cells of the zone along x and z, a multiple of 4
  int32_t width = 0;         // cells of it along x, and
  int32_t depth = 0;         // along z, that are the world's: nothing is free beside them
  int32_t base = 0;          // layer of the rows' first
  int32_t largest = 0;       // side of the largest free cube [power of two, >= 4]
  bool free_beyond = false;  // over and under the rows
};

/// Free cubes get the number 0. Linear in the cells / 64.
AirTreeData build_air_tree(const AirTreeSource& source);

}  // namespace throng::world
