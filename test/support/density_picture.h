// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <vector>

#include "throng/base.h"

/// A picture of weights over a box from (0, 0), and what a test reads of it by itself.
namespace throng::test {

struct DensityPicture {
  int32_t width = 0, height = 0;
  double side = 0.5;  // of a pixel [m]
  std::vector<uint8_t> weights;

  /// Of the middle of each pixel. [m]
  DensityPicture(int32_t columns, int32_t rows, double pixel,
                 const std::function<int(double, double)>& weight_at)
      : width(columns), height(rows), side(pixel) {
    for (int32_t z = 0; z < rows; ++z) {
      for (int32_t x = 0; x < columns; ++x) {
        weights.push_back(static_cast<uint8_t>(weight_at((x + 0.5) * pixel, (z + 0.5) * pixel)));
      }
    }
  }

  /// -1: outside of the picture.
  [[nodiscard]] int weight(double x, double z) const {
    const double column = std::floor(x / side), row = std::floor(z / side);
    if (column < 0 || row < 0 || column >= width || row >= height) return -1;
    return weights[static_cast<size_t>(row) * static_cast<size_t>(width) +
                   static_cast<size_t>(column)];
  }
  /// Is weight 0 within a cell of 0.1 m? On such a cell an avatar may still be about to leave it.
  [[nodiscard]] bool is_beside_zero(const Vec3d& at) const {
    constexpr double kCell = 0.1;
    bool found = false;
    for (const double dx : {-kCell, 0.0, kCell}) {
      for (const double dz : {-kCell, 0.0, kCell}) {
        found = found || weight(at.x + dx, at.z + dz) == 0;
      }
    }
    return found;
  }
};

}  // namespace throng::test
