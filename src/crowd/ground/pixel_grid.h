// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "world/walk.h"

/// The squares of the collision map, without the map.
namespace throng::crowd {

/// Pixels are a whole number of cells wide: at least two radii, so that bodies whose pixels do not
/// touch cannot touch.
class PixelGrid {
 public:
  explicit PixelGrid(int32_t pixel_cells)
      : cells_(pixel_cells),
        magic_(((uint64_t{1} << 32) + static_cast<uint64_t>(pixel_cells) - 1) /
               static_cast<uint64_t>(pixel_cells)) {}

  /// Pixel of a cell that is not negative. A multiplication replaces the division: it is exact for
  /// all cells that 31 bits of units can name, and pixels of up to 4096 cells.
  [[nodiscard]] int32_t pixel(int32_t cell) const {
    return static_cast<int32_t>((static_cast<uint64_t>(static_cast<uint32_t>(cell)) * magic_) >>
                                32);
  }
  [[nodiscard]] int32_t cells() const { return cells_; }
  [[nodiscard]] uint64_t magic() const { return magic_; }
  [[nodiscard]] int64_t units() const { return int64_t{cells_} << world::kUnitBits; }

 private:
  int32_t cells_;
  uint64_t magic_;  // 2^32 / cells, rounded up
};

}  // namespace throng::crowd
