// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "throng/base.h"
#include "throng/picture.h"
#include "throng/result.h"

/// Line charts as pictures, for reports.
namespace throng {

/// How a line is drawn.
enum class LineKind : uint8_t {
  kFaint,   ///< Thin and grey: one of many.
  kPlain,   ///< In its own colour.
  kStrong,  ///< Twice as thick.
  kDashed,  ///< A bound, or a result from elsewhere.
};

/// A line of a chart.
struct ChartLine {
  std::string name = {};            ///< Name in the legend; a line without one is not in it.
  std::vector<double> values = {};  ///< One per x of the chart. [finite, >= 0]
  std::vector<double> spread =
      {};  ///< Drawn as a band of values +- spread; or empty. [finite, >= 0]
  LineKind kind = LineKind::kPlain;
};

/// A line chart: lines over a shared x; both axes are linear, y begins at 0.
struct Chart {
  std::string title = {};
  std::vector<std::string> notes = {};  ///< Under the title, one line each.
  std::string x_title = {}, y_title = {};
  std::vector<double> x = {};  ///< [finite, ascending, at least 2]
  std::vector<ChartLine> lines = {};
  double max = 0;        ///< Top of the y axis; values above are cut off. 0: from the values.
  int32_t width = 1200;  ///< [px, 400 to 8000]
};

/// Draws a chart. Fails with kBadConfig and the line that does not fit.
[[nodiscard]] THRONG_API Result<Image> draw_chart(const Chart& chart);

}  // namespace throng
