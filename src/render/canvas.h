// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "render/colour.h"
#include "throng/picture.h"

/// A picture under construction. Coordinates in pixels from the top left corner; the centre of the
/// first pixel is (0.5, 0.5). Whatever lies outside is left out.
namespace throng::render {

struct Point {
  double x = 0, y = 0;
};

struct Rect {
  double x = 0, y = 0, width = 0, height = 0;
};

class Canvas {
 public:
  Canvas(int32_t width, int32_t height, Rgb paper);

  [[nodiscard]] int32_t width() const { return image_.width; }
  [[nodiscard]] int32_t height() const { return image_.height; }
  [[nodiscard]] Rgb at(int32_t x, int32_t y) const;
  void set(int32_t x, int32_t y, Rgb colour);
  void blend(int32_t x, int32_t y, Rgb colour, double coverage);

  void fill(const Rect& rect, Rgb colour);                ///< Edges by coverage.
  void frame(const Rect& rect, double line, Rgb colour);  ///< A line just inside the edges.
  void hatch(const Rect& rect, Rgb paper, Rgb colour, double spacing);
  /// A line through all points, with round ends and corners; blended once where it meets itself.
  void path(std::span<const Point> points, double line, Rgb colour);
  void line(Point a, Point b, double line, Rgb colour);
  void disc(Point centre, double radius, Rgb colour);
  /// Fills a convex polygon, hard edges: for pictures that are reduced afterwards.
  void fill_convex(std::span<const Point> corners, Rgb colour);
  /// Draws `other`, reduced by averaging `factor` x `factor` pixels, with its corner at (x, y).
  void draw_reduced(const Canvas& other, int32_t factor, int32_t x, int32_t y);

  Image take() && { return std::move(image_); }

 private:
  Image image_;
};

/// Is (x, y) on a stripe of the diagonal hatching? The same pattern for areas, swatches and maps.
[[nodiscard]] bool on_hatch(int32_t x, int32_t y, double spacing);

}  // namespace throng::render
