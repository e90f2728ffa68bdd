// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "render/canvas.h"

#include <algorithm>
#include <cmath>
#include <utility>

// Draws lines and discs by the distance of a pixel's centre to the shape: coverage falls from full
// to none within half a pixel on either side of the edge.
namespace throng::render {
namespace {

int32_t pixel_floor(double v, int32_t limit) {
  return static_cast<int32_t>(std::clamp(std::floor(v), 0.0, static_cast<double>(limit)));
}

double overlap(double a0, double a1, double b0, double b1) {
  return std::max(0.0, std::min(a1, b1) - std::max(a0, b0));
}

// From p to the nearest point of the stretch from a to b.
double distance(Point p, Point a, Point b) {
  const double dx = b.x - a.x, dy = b.y - a.y;
  const double square = dx * dx + dy * dy;
  const double along = (p.x - a.x) * dx + (p.y - a.y) * dy;
  const double t = square > 0 ? std::clamp(along / square, 0.0, 1.0) : 0;
  const double ex = p.x - a.x - t * dx, ey = p.y - a.y - t * dy;
  return std::sqrt(ex * ex + ey * ey);
}

}  // namespace

Canvas::Canvas(int32_t width, int32_t height, Rgb paper) {
  image_.width = width;
  image_.height = height;
  image_.rgb.resize(static_cast<size_t>(width) * static_cast<size_t>(height) * 3);
  for (size_t i = 0; i < image_.rgb.size(); i += 3) {
    image_.rgb[i] = paper.r;
    image_.rgb[i + 1] = paper.g;
    image_.rgb[i + 2] = paper.b;
  }
}

Rgb Canvas::at(int32_t x, int32_t y) const {
  const size_t i =
      (static_cast<size_t>(y) * static_cast<size_t>(width()) + static_cast<size_t>(x)) * 3;
  return {image_.rgb[i], image_.rgb[i + 1], image_.rgb[i + 2]};
}

void Canvas::set(int32_t x, int32_t y, Rgb colour) {
  if (x < 0 || y < 0 || x >= width() || y >= height()) return;
  const size_t i =
      (static_cast<size_t>(y) * static_cast<size_t>(width()) + static_cast<size_t>(x)) * 3;
  image_.rgb[i] = colour.r;
  image_.rgb[i + 1] = colour.g;
  image_.rgb[i + 2] = colour.b;
}

void Canvas::blend(int32_t x, int32_t y, Rgb colour, double coverage) {
  if (x < 0 || y < 0 || x >= width() || y >= height() || coverage <= 0) return;
  set(x, y, coverage >= 1 ? colour : mix(at(x, y), colour, coverage));
}

void Canvas::fill(const Rect& rect, Rgb colour) {
  const double x1 = rect.x + rect.width, y1 = rect.y + rect.height;
  for (int32_t y = pixel_floor(rect.y, height()); y < std::min<double>(y1, height()); ++y) {
    const double rows = overlap(rect.y, y1, y, y + 1);
    for (int32_t x = pixel_floor(rect.x, width()); x < std::min<double>(x1, width()); ++x) {
      blend(x, y, colour, rows * overlap(rect.x, x1, x, x + 1));
    }
  }
}

void Canvas::frame(const Rect& rect, double line, Rgb colour) {
  fill({rect.x, rect.y, rect.width, line}, colour);
  fill({rect.x, rect.y + rect.height - line, rect.width, line}, colour);
  fill({rect.x, rect.y, line, rect.height}, colour);
  fill({rect.x + rect.width - line, rect.y, line, rect.height}, colour);
}

void Canvas::hatch(const Rect& rect, Rgb paper, Rgb colour, double spacing) {
  for (int32_t y = pixel_floor(rect.y, height());
       y < std::min<double>(rect.y + rect.height, height()); ++y) {
    for (int32_t x = pixel_floor(rect.x, width());
         x < std::min<double>(rect.x + rect.width, width()); ++x) {
      set(x, y, on_hatch(x, y, spacing) ? colour : paper);
    }
  }
}

void Canvas::path(std::span<const Point> points, double line, Rgb colour) {
  const double radius = line / 2;
  Point low = points[0], high = points[0];
  for (const Point& p : points) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y)};
  }
  const int32_t x1 = pixel_floor(high.x + radius + 2, width());
  const int32_t y1 = pixel_floor(high.y + radius + 2, height());
  for (int32_t y = pixel_floor(low.y - radius - 1, height()); y < y1; ++y) {
    for (int32_t x = pixel_floor(low.x - radius - 1, width()); x < x1; ++x) {
      double nearest = 1e9;
      for (size_t i = 0; i < points.size(); ++i) {
        const Point a = points[i], b = points[std::min(i + 1, points.size() - 1)];
        nearest = std::min(nearest, distance({x + 0.5, y + 0.5}, a, b));
      }
      blend(x, y, colour, radius + 0.5 - nearest);
    }
  }
}

void Canvas::line(Point a, Point b, double line, Rgb colour) {
  path(std::array<Point, 2>{a, b}, line, colour);
}

void Canvas::disc(Point centre, double radius, Rgb colour) {
  path({&centre, 1}, 2 * radius, colour);
}

void Canvas::fill_convex(std::span<const Point> corners, Rgb colour) {
  double top = corners[0].y, bottom = corners[0].y;
  for (const Point& p : corners) {
    top = std::min(top, p.y);
    bottom = std::max(bottom, p.y);
  }
  const int32_t last = pixel_floor(std::ceil(bottom - 0.5), height());
  for (int32_t y = pixel_floor(std::ceil(top - 0.5), height()); y < last; ++y) {
    const double at = y + 0.5;
    double left = width(), right = 0;
    for (size_t i = 0; i < corners.size(); ++i) {
      const Point a = corners[i], b = corners[(i + 1) % corners.size()];
      if ((a.y <= at) == (b.y <= at)) continue;
      const double x = a.x + (at - a.y) / (b.y - a.y) * (b.x - a.x);
      left = std::min(left, x);
      right = std::max(right, x);
    }
    const int32_t end = pixel_floor(std::ceil(right - 0.5), width());
    for (int32_t x = pixel_floor(std::ceil(left - 0.5), width()); x < end; ++x) set(x, y, colour);
  }
}

void Canvas::draw_reduced(const Canvas& other, int32_t factor, int32_t x0, int32_t y0) {
  const double samples = factor * factor;
  for (int32_t y = 0; y < other.height() / factor; ++y) {
    for (int32_t x = 0; x < other.width() / factor; ++x) {
      int32_t r = 0, g = 0, b = 0;
      for (int32_t i = 0; i < factor * factor; ++i) {
        const Rgb c = other.at(x * factor + i % factor, y * factor + i / factor);
        r += c.r;
        g += c.g;
        b += c.b;
      }
      set(x0 + x, y0 + y,
          {static_cast<uint8_t>(r / samples + 0.5), static_cast<uint8_t>(g / samples + 0.5),
           static_cast<uint8_t>(b / samples + 0.5)});
    }
  }
}

bool on_hatch(int32_t x, int32_t y, double spacing) {
  const int32_t period = std::max(3, static_cast<int32_t>(std::lround(spacing)));
  return (x + y) % period == 0;
}

}  // namespace throng::render
