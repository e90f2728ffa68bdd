// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "papers/slices/slice_move.h"
#include "throng/papers.h"

/// [ML06] algorithm 1 for bodies wider than a cell, on slices with 16 bits a cell, and the bits of
/// the cells in which bodies are.
namespace throng::papers {

/// Cells of a body, all included.
struct CellBox {
  int32_t x0 = 0, z0 = 0, x1 = 0, z1 = 0;
  bool operator==(const CellBox&) const = default;
};

/// The smallest box that holds both.
[[nodiscard]] CellBox box_of(const CellBox& a, const CellBox& b);

/// Slices, and one bit for each cell of each: a body is in it.
class SliceGround {
 public:
  explicit SliceGround(DepthSlices slices);

  [[nodiscard]] const DepthSlices& slices() const { return slices_; }
  [[nodiscard]] bool holds(const CellBox& box) const {
    return box.x0 >= 0 && box.z0 >= 0 && box.x1 < slices_.width && box.z1 < slices_.depth;
  }
  [[nodiscard]] size_t cell(int32_t x, int32_t z) const {
    return static_cast<size_t>(z) * static_cast<size_t>(slices_.width) + static_cast<size_t>(x);
  }
  /// The slice that a head at `head` reads: the lowest at or above it, or the first. [mm]
  [[nodiscard]] size_t slice_above(int32_t head) const;

  /// A body with its feet at `feet` moves so that it covers `to`; `swept` are all cells that it
  /// touches meanwhile. Its feet after the move, or nothing if algorithm 1 forbids it. `swept` lies
  /// in the grid. Printed, the algorithm compares two cells; here each cell of `swept` must pass:
  /// its surface within less than a step of the feet, and free up to the head. [mm]
  [[nodiscard]] std::optional<int32_t> feet_after(int32_t feet, const CellBox& swept,
                                                  const CellBox& to, const SliceBody& body) const;

  /// Are these cells free, for a body that reads `slice`?
  [[nodiscard]] bool is_free(size_t slice, const CellBox& box) const;
  void set(size_t slice, const CellBox& box, bool is_taken);
  [[nodiscard]] uint64_t bytes() const { return slices_.bytes() + taken_.size(); }

 private:
  // The byte of a cell's bit: in the lowest slice that shows its surface, so that bodies on one
  // surface meet whichever slices they read.
  [[nodiscard]] size_t byte_of(size_t slice, int32_t x, int32_t z) const;

  DepthSlices slices_;
  std::vector<int32_t> heights_;  // [mm]
  size_t stride_ = 0;             // bytes a row
  std::vector<uint8_t> taken_;    // by slice, row, eight cells
};

}  // namespace throng::papers
