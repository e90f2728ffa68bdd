// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "crowd/link/link_line.h"

#include <algorithm>
#include <array>
#include <cmath>

// A moving cylinder against an upright convex prism: the part of the line on which their heights
// overlap, and the distance of this part from the polygon. Exact, linear in the polygon's corners.
namespace throng::crowd {
namespace {

using Point = std::array<double, 2>;

double cross_of(const Point& a, const Point& b, const Point& c) {
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

// Square of the distance of a point from a segment.
double square_to(const Point& p, const Point& a, const Point& b) {
  const double wx = b[0] - a[0], wz = b[1] - a[1], whole = wx * wx + wz * wz;
  const double along = (p[0] - a[0]) * wx + (p[1] - a[1]) * wz;
  const double part = whole > 0 ? std::clamp(along / whole, 0.0, 1.0) : 0;
  const double dx = p[0] - a[0] - part * wx, dz = p[1] - a[1] - part * wz;
  return dx * dx + dz * dz;
}

bool cross_each_other(const Point& a, const Point& b, const Point& c, const Point& d) {
  return cross_of(a, b, c) * cross_of(a, b, d) < 0 && cross_of(c, d, a) * cross_of(c, d, b) < 0;
}

// Keeps the part of [from, to] where value + t * rise > 0. False: there is none.
bool keep_above(double value, double rise, double& from, double& to) {
  if (rise == 0) return value > 0;
  const double zero = -value / rise;
  if (rise > 0) from = std::max(from, zero);
  if (rise < 0) to = std::min(to, zero);
  return from <= to;
}

}  // namespace

bool meets(const LinkLine& line, const Prism& prism) {
  double first = 0, last = 1;
  const double rise = line.to.y - line.from.y;
  if (!keep_above(line.from.y + line.top - prism.low, rise, first, last) ||
      !keep_above(prism.high - line.from.y - line.bottom, -rise, first, last)) {
    return false;
  }
  const auto at = [&](double part) {
    return Point{line.from.x + part * (line.to.x - line.from.x),
                 line.from.z + part * (line.to.z - line.from.z)};
  };
  const Point a = at(first), b = at(last);
  const double range = line.radius * line.radius;
  bool left = true, right = true;  // of all sides
  for (size_t i = 0; i < prism.corners.size(); ++i) {
    const Point& c = prism.corners[i];
    const Point& d = prism.corners[(i + 1) % prism.corners.size()];
    const double nearest =
        std::min({square_to(a, c, d), square_to(b, c, d), square_to(c, a, b), square_to(d, a, b)});
    if (nearest < range || cross_each_other(a, b, c, d)) return true;
    const double side = cross_of(c, d, a);
    left = left && side >= 0;
    right = right && side <= 0;
  }
  return left || right;
}

}  // namespace throng::crowd
