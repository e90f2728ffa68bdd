// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "graph/node_links.h"
#include "throng/base.h"
#include "world/tile_grid.h"

/// How far around its middle nothing is more restrictive than a node: the seed's cylinder width.
namespace throng::graph {

/// The middle of a cell, from an origin close enough for floats, and the radius around it that
/// holds the cell, for floods.
struct CellShape {
  float x = 0, y = 0, z = 0;
  float radius = 0;
  float area = 0;

  [[nodiscard]] Vec3d middle(Vec3d origin) const {
    return {origin.x + x, origin.y + y, origin.z + z};
  }
};

/// A cell as a ball that holds it. Distances along the ground are at least those between balls.
struct CellBall {
  double x = 0, y = 0, z = 0, radius = 0;
};

/// The cells of one patch as balls: listed, or those of a level tile seen from above, which can
/// only be nearer.
struct CellBalls {
  std::span<const CellShape> listed;
  Vec3d origin;         ///< Of those listed.
  double x = 0, z = 0;  ///< Else: the first of 64 x 64 cells, of all there are.
  double side = 0;      ///< Of these. [m]

  [[nodiscard]] CellBall operator[](uint32_t cell) const {
    if (!listed.empty()) {
      const CellShape& shape = listed[cell];
      const Vec3d middle = shape.middle(origin);
      return {middle.x, middle.y, middle.z, shape.radius};
    }
    return {(x + world::x_of_cell(cell) + 0.5) * side, 0, (z + world::z_of_cell(cell) + 0.5) * side,
            side * 0.7072};
  }
};

/// Cells beside each other over the borders of patches, found from either side.
class CrossCells {
 public:
  /// [pairs name patches below `patches`]
  CrossCells(std::span<const CellPair> pairs, size_t patches, int32_t workers);

  struct Cell {
    uint32_t patch = 0, cell = 0;
    uint16_t classes = 0;  ///< Classes that can step there.
    uint8_t side = 0;      ///< Of the cell in question.
  };
  [[nodiscard]] std::span<const Cell> beside(uint32_t patch, uint32_t cell) const;

 private:
  std::vector<uint32_t> first_;  // of each patch, and the end
  std::vector<uint32_t> key_;    // cell, ascending in each patch
  std::vector<Cell> cell_;
};

/// Widths of the nodes of one patch, by a flood over cells from each node's middle that ends
/// at `max_width`. `balls` are those of every patch. [m]
[[nodiscard]] std::vector<double> node_widths(const NodeForest& forest, uint32_t patch,
                                              const CrossCells& cross, double max_width,
                                              std::span<const CellBalls> balls);

}  // namespace throng::graph
