// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "throng/base.h"
#include "throng/picture.h"
#include "throng/result.h"

/// A quantity over the plan as a picture: densities, waiting times.
namespace throng {

/// Cells row by row, x to the right, z down: cell (i, k) begins at x0 + i * cell, z0 + k * cell.
struct HeatMap {
  std::string title = {};
  std::vector<std::string> notes = {};  ///< Under the title, each in one line.
  std::string unit = {};                ///< Of the values.
  double x0 = 0, z0 = 0;                ///< [m]
  double cell = 0.5;                    ///< [m, > 0]
  int32_t width = 0, depth = 0;         ///< [cells, 1 to 1000000]
  std::vector<double> values = {};      ///< width * depth. [finite, >= 0; 0 stays paper]
  double max = 0;                ///< Value of the darkest colour, 0: the largest. Above: the same.
  int32_t picture_width = 1200;  ///< [px, 400 to 8000]
};

/// Draws a map, cells larger than a pixel as squares, smaller ones averaged. Fails with kBadConfig.
[[nodiscard]] THRONG_API Result<Image> draw_heat_map(const HeatMap& map);

}  // namespace throng
