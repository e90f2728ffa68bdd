// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "crowd/link/link_line.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

// A moving cylinder against an upright convex prism: the part of the line on which their heights
// overlap, and the distance of this part from the polygon. Exact, linear in the polygon's corners.
// Two cylinders: the same of both lines, each with the heights of the whole other; constant time.
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

// In plan, the part of a line on which the cylinder overlaps these heights.
std::optional<std::pair<Point, Point>> part_between(const LinkLine& line, double low, double high) {
  double first = 0, last = 1;
  const double rise = line.to.y - line.from.y;
  if (!keep_above(line.from.y + line.top - low, rise, first, last) ||
      !keep_above(high - line.from.y - line.bottom, -rise, first, last)) {
    return std::nullopt;
  }
  const auto at = [&](double part) {
    return Point{line.from.x + part * (line.to.x - line.from.x),
                 line.from.z + part * (line.to.z - line.from.z)};
  };
  return std::pair(at(first), at(last));
}

}  // namespace

bool meets(const LinkLine& line, const Prism& prism) {
  const auto part = part_between(line, prism.low, prism.high);
  if (!part) return false;
  const auto& [a, b] = *part;
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

bool meets(const LinkLine& a, const LinkLine& b) {
  const auto part_beside = [](const LinkLine& line, const LinkLine& other) {
    return part_between(line, std::min(other.from.y, other.to.y) + other.bottom,
                        std::max(other.from.y, other.to.y) + other.top);
  };
  const auto of_a = part_beside(a, b), of_b = part_beside(b, a);
  if (!of_a || !of_b) return false;
  const auto& [p, q] = *of_a;
  const auto& [c, d] = *of_b;
  const double nearest =
      std::min({square_to(p, c, d), square_to(q, c, d), square_to(c, p, q), square_to(d, p, q)});
  const double range = a.radius + b.radius;
  return nearest < range * range || cross_each_other(p, q, c, d);
}

}  // namespace throng::crowd
