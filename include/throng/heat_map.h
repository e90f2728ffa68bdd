// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "throng/base.h"
#include "throng/picture.h"
#include "throng/result.h"

/// Heat maps: a quantity over the plan as a picture, such as density or waiting time.
namespace throng {

/// A heat map. Cells are row by row, x to the right, z down: cell (i, k) begins at x0 + i * cell,
/// z0 + k * cell.
struct HeatMap {
  std::string title = {};
  std::vector<std::string> notes = {};  ///< Under the title, one line each.
  std::string unit = {};                ///< Of the values.
  double x0 = 0, z0 = 0;                ///< [m]
  double cell = 0.5;                    ///< [m, > 0]
  int32_t width = 0, depth = 0;         ///< [cells, 1 to 1000000]
  std::vector<double> values = {};      ///< width * depth. [finite, >= 0; 0 stays paper]
  double max = 0;  ///< Value of the darkest colour; larger values have the same. 0: the largest.
  int32_t picture_width = 1200;  ///< [px, 400 to 8000]
};

/// Draws a map; cells larger than a pixel are squares, smaller ones are averaged. Fails with
/// kBadConfig.
[[nodiscard]] THRONG_API Result<Image> draw_heat_map(const HeatMap& map);

}  // namespace throng
