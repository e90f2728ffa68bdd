// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "view/node_pick.h"

#include <algorithm>
#include <cmath>
#include <numbers>

// A sight line is compared with a ball around each node, and where it meets that with the triangles
// that are drawn of it.
namespace throng::view {
namespace {

MarkVertex vertex(Vec3d p, Rgba colour) {
  return {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z), colour};
}

// How far along a line it meets a triangle, from either side. [m]
std::optional<double> meets(const SightLine& line, Vec3d a, Vec3d b, Vec3d c) {
  const Vec3d ab = b - a, ac = c - a, across = cross(line.direction, ac);
  const double size = dot(ab, across);
  if (std::fabs(size) < 1e-12) return {};
  const Vec3d from = line.eye - a;
  const double u = dot(from, across) / size;
  const Vec3d other = cross(from, ab);
  const double v = dot(line.direction, other) / size;
  if (u < -1e-9 || v < -1e-9 || u + v > 1 + 1e-9) return {};
  const double along = dot(ac, other) / size;
  return along > 0 ? std::optional(along) : std::nullopt;
}

}  // namespace

void DrawnNodes::add(uint32_t node, const std::vector<std::array<Vec3d, 4>>& squares) {
  Box3d box;
  for (const auto& square : squares) {
    for (const Vec3d& p : square) box.add(p);
  }
  if (box.empty()) return;
  const Vec3d middle = (box.min + box.max) * 0.5;
  // A little more, for the rounding of floats far from the origin.
  const double radius = 0.5 * length(box.max - box.min) + 0.01;
  balls_.push_back({static_cast<float>(middle.x), static_cast<float>(middle.y),
                    static_cast<float>(middle.z), static_cast<float>(radius), node});
}

std::optional<uint32_t> DrawnNodes::first_on(const Nodes& nodes, const SightLine& line, double cut,
                                             double farthest) const {
  std::optional<uint32_t> found;
  double nearest = farthest;
  for (const Ball& ball : balls_) {
    const Vec3d to = Vec3d{ball.x, ball.y, ball.z} - line.eye;
    const double along = dot(to, line.direction), radius = ball.radius;
    if (along < -radius || along - radius > nearest) continue;
    if (dot(to, to) - along * along > radius * radius) continue;
    for_node_squares(nodes, ball.node, nodes.node(ball.node), [&](const std::array<Vec3d, 4>& c) {
      for (const auto& [b, d] : {std::pair{1, 2}, {2, 3}}) {
        const auto at = meets(line, c[0], c[static_cast<size_t>(b)], c[static_cast<size_t>(d)]);
        if (!at || *at >= nearest || (line.eye + line.direction * *at).y > cut) continue;
        nearest = *at;
        found = ball.node;
      }
    });
  }
  return found;
}

void add_cylinder(Marks& marks, const NodeCylinder& cylinder, Vec3d origin, Rgba sides, Rgba rim) {
  constexpr int32_t kSides = 16;
  const Vec3d up = cylinder.axis;
  const Vec3d other = std::fabs(up.y) < 0.9 ? Vec3d{0, 1, 0} : Vec3d{1, 0, 0};
  Vec3d right = cross(other, up);
  right = right * (1 / length(right));
  const Vec3d front = cross(right, up);
  constexpr double kLift = 0.03;  // [m] over the ground
  const auto at = [&](int32_t n, double height) {
    const double angle = 2 * std::numbers::pi * n / kSides;
    return cylinder.feet + (right * std::cos(angle) + front * std::sin(angle)) * cylinder.radius +
           up * height - origin;
  };
  for (int32_t n = 0; n < kSides; ++n) {
    const Vec3d a = at(n, kLift), b = at(n + 1, kLift), c = at(n + 1, cylinder.height),
                d = at(n, cylinder.height);
    for (const Vec3d& p : {a, b, c, a, c, d}) marks.triangles.push_back(vertex(p, sides));
    for (const Vec3d& p : {a, b, c, d}) marks.lines.push_back(vertex(p, rim));
    if (n % 4 != 0) continue;
    for (const Vec3d& p : {a, d}) marks.lines.push_back(vertex(p, rim));
  }
}

NodeDetail detail_of(const Nodes& nodes, const NodeBins& bins, uint32_t node) {
  NodeDetail detail{.info = nodes.node(node), .middle = nodes.middle(node)};
  detail.inclination = bins.inclination_of(detail.info.inclination);
  detail.height = bins.height_of(detail.info.height);
  detail.headroom = bins.height_of(detail.info.headroom);
  detail.width = bins.width_of(detail.info.width);
  return detail;
}

Marks picked_node_marks(const Nodes& nodes, uint32_t node, Vec3d origin) {
  Marks marks;
  const Rgba outline = rgba(40, 220, 255, 255);
  const Vec3d lift = Vec3d{0, 0.06, 0} - origin;
  for_node_squares(nodes, node, nodes.node(node), [&](const std::array<Vec3d, 4>& c) {
    for (size_t k = 0; k < 4; ++k) {
      marks.lines.push_back(vertex(c[k] + lift, outline));
      marks.lines.push_back(vertex(c[(k + 1) % 4] + lift, outline));
    }
  });
  if (const auto cylinder = nodes.cylinder(node)) {
    add_cylinder(marks, *cylinder, origin, rgba(40, 220, 255, 50), outline);
  }
  marks.line_width = 2.5F;
  return marks;
}

}  // namespace throng::view
