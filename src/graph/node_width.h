// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "graph/node_links.h"

/// How far around its middle nothing is more restrictive than a node: the seed's cylinder width.
namespace throng {

/// A cell as a ball that holds it. Distances along the ground are at least those between balls.
struct CellBall {
  double x = 0, y = 0, z = 0, radius = 0;
};

/// Cells beside each other over the borders of patches, found from either side.
class CrossCells {
 public:
  explicit CrossCells(std::span<const CellPair> pairs);

  struct Cell {
    uint32_t patch = 0, cell = 0;
    uint16_t classes = 0;  ///< Who can step there.
    uint8_t side = 0;      ///< Of the cell that was asked about.
  };
  [[nodiscard]] std::span<const Cell> beside(uint32_t patch, uint32_t cell) const;

 private:
  std::vector<uint64_t> key_;  // patch and cell, ascending
  std::vector<Cell> cell_;
};

/// Widths of the nodes of one patch, by a flood over cells from each node's middle that ends
/// at `most`. [m]
[[nodiscard]] std::vector<double> node_widths(
    const NodeForest& forest, uint32_t patch, const CrossCells& cross, double most,
    const std::function<CellBall(uint32_t patch, uint32_t cell)>& ball);

}  // namespace throng
