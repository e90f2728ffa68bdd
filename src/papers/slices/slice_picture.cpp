// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "render/canvas.h"
#include "render/marks.h"
#include "render/text.h"
#include "throng/papers.h"

// Draws a slice as in [ML06] figures 9 and 10: darker is higher, the contrast stretched, cells
// without a surface white. Cells become blocks of whole pixels, or share a pixel that shows the
// highest of them: a wall one cell wide must stay visible.
namespace throng {
namespace {

constexpr int32_t kMapSide = 900;  // The longer side of the map, at most. [px]

uint8_t grey(int32_t value, int32_t low, int32_t high) {
  // Never white: that is the far plane.
  const double t = high > low ? static_cast<double>(value - low) / (high - low) : 0;
  return static_cast<uint8_t>(std::lround(228 - 204 * t));
}

}  // namespace

Image draw_slice(const DepthSlices& slices, size_t index) {
  const DepthSlice& slice = slices.slices[index];
  int32_t low = INT32_MAX, high = INT32_MIN;
  for (const uint16_t depth : slice.depths) {
    if (depth == DepthSlice::kNone) continue;
    low = std::min(low, slice.height - depth);
    high = std::max(high, slice.height - depth);
  }
  const int32_t longest = std::max(slices.width, slices.depth);
  const int32_t block = std::clamp(kMapSide / longest, 1, 64);                // pixels a cell
  const int32_t share = block > 1 ? 1 : (longest + kMapSide - 1) / kMapSide;  // cells a pixel
  const int32_t columns = (slices.width + share - 1) / share;
  const int32_t rows = (slices.depth + share - 1) / share;

  constexpr int32_t kMargin = 24, kHead = 58, kBar = 116;
  const int32_t map_width = columns * block, map_height = rows * block;
  const int32_t width = std::max(map_width + 2 * kMargin + kBar, 420);
  render::Canvas canvas(width, std::max(map_height, 160) + kHead + kMargin + 40, render::kPaper);
  render::draw_text(canvas, {kMargin, 28},
                    fmt::format("Slice {} of {}, cut at {:.3f} m", index + 1, slices.slices.size(),
                                slice.height / 1000.0),
                    {.size = 13, .bold = true});
  render::draw_text(
      canvas, {kMargin, 47},
      "highest surface within 65.5 m below the cut: darker is higher, white is nothing",
      {.size = 8, .colour = render::kFaintInk});

  for (int32_t row = 0; row < rows; ++row) {
    for (int32_t column = 0; column < columns; ++column) {
      uint16_t depth = DepthSlice::kNone;  // the smallest
      for (int32_t z = row * share; z < std::min((row + 1) * share, slices.depth); ++z) {
        for (int32_t x = column * share; x < std::min((column + 1) * share, slices.width); ++x) {
          const size_t cell =
              static_cast<size_t>(z) * static_cast<size_t>(slices.width) + static_cast<size_t>(x);
          depth = std::min(depth, slice.depths[cell]);
        }
      }
      if (depth == DepthSlice::kNone) continue;
      const uint8_t g = grey(slice.height - depth, low, high);
      const double x = kMargin + column * block, y = kHead + row * block;
      canvas.fill({x, y, static_cast<double>(block), static_cast<double>(block)}, {g, g, g});
    }
  }
  canvas.frame({kMargin - 1.0, kHead - 1.0, map_width + 2.0, map_height + 2.0}, 1, render::kRule);
  render::draw_scale_bar(canvas, {kMargin, kHead + map_height + 16.0}, map_width * 0.4,
                         block / (slices.cell * share), 8);
  if (low <= high) {
    const auto colour = [](double t) {
      const uint8_t g = grey(static_cast<int32_t>(t * 1000), 0, 1000);
      return render::Rgb{g, g, g};
    };
    const double bar_height = std::min(std::max(map_height, 140), 300);
    render::draw_height_bar(
        canvas, {kMargin + map_width + 20.0, static_cast<double>(kHead), 14, bar_height},
        low / 1000.0, high / 1000.0, 8, colour);
  }
  return std::move(canvas).take();
}

}  // namespace throng
