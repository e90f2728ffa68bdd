// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "throng/scene.h"

/// Shortest any-angle paths over flat cells, by brute force: independent of meshes and intervals.
namespace throng::test {

/// A point in half cells, so that the middles of cells are whole numbers.
struct HalfPoint {
  int64_t x = 0, z = 0;
};

/// The middle of a cell.
inline HalfPoint middle(int32_t x, int32_t z) { return {2 * int64_t{x} + 1, 2 * int64_t{z} + 1}; }

class GridOracle {
 public:
  explicit GridOracle(const FlatCells& cells) : cells_(cells) {}

  [[nodiscard]] bool is_open(int64_t x, int64_t z) const;
  /// Can a point move straight from a to b? It may slide along walls and touch corners, but not
  /// pass between two blocked cells that touch at a corner. Exact, in integers.
  [[nodiscard]] bool sees(HalfPoint a, HalfPoint b) const;
  /// Length of the shortest path not longer than `limit`, in cells: A* over all corners of blocked
  /// cells, where any two that see each other are joined. Nothing: there is no such path. Source:
  /// [LPW79].
  [[nodiscard]] std::optional<double> shortest(HalfPoint from, HalfPoint to, double limit) const;

 private:
  [[nodiscard]] bool sees_along(HalfPoint a, HalfPoint b) const;
  [[nodiscard]] std::vector<HalfPoint> corners_within(HalfPoint from, HalfPoint to,
                                                      double limit) const;

  const FlatCells& cells_;
};

}  // namespace throng::test
