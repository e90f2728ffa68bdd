// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "throng/papers.h"

/// Slices as sparse matrices, the future work of [ML06]: tiles of cells, each stored once.
namespace throng::papers {

/// The same answers as DepthSlices. A tile of a slice is all empty, all of one height, or 256
/// heights of 16 bits below its highest; tiles of any slices that have the same heights share them.
/// Most tiles of a slice equal those of the one above, where the cut passes over them.
class SparseSlices {
 public:
  static constexpr int32_t kNone = INT32_MIN;  ///< No surface.
  static constexpr int32_t kSide = 16;         ///< Cells along a tile.

  /// Time: cells x slices.
  explicit SparseSlices(const DepthSlices& slices);

  [[nodiscard]] size_t size() const { return heights_.size(); }
  [[nodiscard]] int32_t height(size_t slice) const { return heights_[slice]; }
  /// The surface in a cell of a slice, or kNone. [mm] Constant time.
  [[nodiscard]] int32_t surface(size_t slice, int32_t x, int32_t z) const {
    const size_t row = slice * static_cast<size_t>(tiles_z_) + static_cast<size_t>(z / kSide);
    const Tile& tile = tiles_[row * static_cast<size_t>(tiles_x_) + static_cast<size_t>(x / kSide)];
    if (tile.first == kConstant) return tile.top;
    const size_t cell = static_cast<size_t>(z % kSide) * kSide + static_cast<size_t>(x % kSide);
    const uint16_t below = depths_[size_t{tile.first} * kCells + cell];
    return below == DepthSlice::kNone ? kNone : tile.top - below;
  }
  [[nodiscard]] uint64_t bytes() const {
    return tiles_.size() * sizeof(Tile) + depths_.size() * sizeof(uint16_t) +
           heights_.size() * sizeof(int32_t);
  }

 private:
  static constexpr size_t kCells = size_t{kSide} * kSide;
  static constexpr uint32_t kConstant = UINT32_MAX;
  struct Tile {
    uint32_t first = kConstant;  // which of the stored tiles
    int32_t top = kNone;         // the highest surface, or of all cells
  };

  int32_t tiles_x_ = 0, tiles_z_ = 0;
  std::vector<int32_t> heights_;
  std::vector<Tile> tiles_;       // by slice, then row by row
  std::vector<uint16_t> depths_;  // of the stored tiles, below their tops
};

}  // namespace throng::papers
