// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "path/edits/solid.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "path/edits/plan_shapes.h"

// A cylinder lies in the capsule around its axis and in the slab between its ends. A solid that
// stays clear of either stays clear of the cylinder. The distance of a convex solid from a point of
// the axis is a convex function of the point's place on the axis, so its minimum is found by
// ternary search. Time: linear in the corners or triangles, times 2 kThirds at most.
namespace throng::path {
namespace {

constexpr int kThirds = 24;  // of an axis: what is left of it is below a ten thousandth

double between(double low, double high, double at) { return std::max({low - at, at - high, 0.0}); }

double distance(const Prism& prism, Vec3d p) {
  const double up = between(prism.low, prism.high, p.y);
  if (prism.covers(p.x, p.z)) return up;
  double plan2 = std::numeric_limits<double>::infinity();
  for (size_t i = 0; i < prism.corners.size(); ++i) {
    plan2 = std::min(plan2, squared_to_segment({p.x, p.z}, prism.corners[i],
                                               prism.corners[(i + 1) % prism.corners.size()]));
  }
  return std::sqrt(plan2 + up * up);
}

double to_segment(Vec3d p, Vec3d a, Vec3d b) {
  const Vec3d u = b - a;
  const double size = dot(u, u);
  const double t = size > 0 ? std::clamp(dot(p - a, u) / size, 0.0, 1.0) : 0;
  return length(a + u * t - p);
}

double distance(const std::array<Vec3d, 3>& triangle, Vec3d p) {
  const auto& [a, b, c] = triangle;
  const Vec3d normal = cross(b - a, c - a);
  const double size = dot(normal, normal);
  if (size > 0) {
    const auto inside = [&](Vec3d from, Vec3d to) {
      return dot(cross(to - from, p - from), normal) >= 0;
    };
    if (inside(a, b) && inside(b, c) && inside(c, a)) {
      return std::fabs(dot(p - a, normal)) / std::sqrt(size);
    }
  }
  return std::min({to_segment(p, a, b), to_segment(p, b, c), to_segment(p, c, a)});
}

// Is it nearer to the line from a to b than `radius`?
template <class Shape>
bool comes_near(const Shape& shape, Vec3d a, Vec3d b, double radius) {
  double low = 0, high = 1;
  const double all = length(b - a);
  const auto far = [&](double at) { return distance(shape, a + (b - a) * at); };
  for (int k = 0; k < kThirds; ++k) {
    const double one = (2 * low + high) / 3, two = (low + 2 * high) / 3;
    const double at_one = far(one), at_two = far(two);
    if (std::min(at_one, at_two) < radius) return true;
    // Nothing between is nearer by more than it is away.
    if (std::min(at_one, at_two) - (high - low) * all >= radius) return false;
    (at_one < at_two ? high : low) = at_one < at_two ? two : one;
  }
  return far((low + high) / 2) - (high - low) * all < radius;
}

template <class Corners>
std::pair<double, double> along(const Corners& corners, Vec3d from, Vec3d axis) {
  std::pair<double, double> found{std::numeric_limits<double>::infinity(),
                                  -std::numeric_limits<double>::infinity()};
  for (const Vec3d& corner : corners) {
    const double at = dot(corner - from, axis);
    found = {std::min(found.first, at), std::max(found.second, at)};
  }
  return found;
}

std::pair<double, double> along(const Prism& prism, Vec3d from, Vec3d axis) {
  std::pair<double, double> found{std::numeric_limits<double>::infinity(),
                                  -std::numeric_limits<double>::infinity()};
  for (const auto& [x, z] : prism.corners) {
    const auto [low, high] =
        along(std::array{Vec3d{x, prism.low, z}, Vec3d{x, prism.high, z}}, from, axis);
    found = {std::min(found.first, low), std::max(found.second, high)};
  }
  return found;
}

template <class Shape>
bool meets(const BodyRoom& room, const Shape& shape) {
  if (room.turns_far) {
    const double radius =
        std::sqrt(room.top * room.top + room.radius * room.radius) + room.spread + room.margin;
    return distance(shape, room.feet) < radius;
  }
  const auto [low, high] = along(shape, room.feet, room.axis);
  const double out = room.spread + room.radius * room.sine + room.margin;
  if (high < room.bottom * room.cosine - out || low > room.top + out) return false;
  // A point of an axis that turns moves 2 sin(angle / 2) times its distance up the axis.
  const double turned = room.top * std::sqrt(std::max(0.0, 2 - 2 * room.cosine));
  return comes_near(shape, room.feet + room.axis * room.bottom, room.feet + room.axis * room.top,
                    room.radius + room.spread + turned + room.margin);
}

}  // namespace

Result<Solid> make_solid(const Prism& prism) {
  if (auto ok = check_prism(prism); !ok) return ok.error();
  return Solid{prism, {}};
}

Result<Solid> make_solid(std::span<const Vec3d> corners,
                         std::span<const std::array<uint32_t, 3>> triangles) {
  const auto bad = [](const std::string& what) {
    return Error{Errc::kBadInput, "obstacle: " + what};
  };
  if (triangles.empty()) return bad("it has no triangles");
  std::vector<std::array<Vec3d, 3>> made;
  for (size_t t = 0; t < triangles.size(); ++t) {
    std::array<Vec3d, 3>& triangle = made.emplace_back();
    for (size_t k = 0; k < 3; ++k) {
      if (triangles[t][k] >= corners.size()) {
        return bad("triangle " + std::to_string(t) + " uses corner " +
                   std::to_string(triangles[t][k]) + " of " + std::to_string(corners.size()));
      }
      triangle[k] = corners[triangles[t][k]];
      if (!is_on_earth(triangle[k])) {
        return bad("triangle " + std::to_string(t) + " is not on Earth");
      }
    }
  }
  return solid_of(std::move(made));
}

Solid solid_of(std::vector<std::array<Vec3d, 3>> triangles) {
  Box3d box;
  for (const auto& triangle : triangles) {
    for (const Vec3d& p : triangle) box.add(p);
  }
  return {Prism::box(box.min, box.max), std::move(triangles)};
}

bool is_on_earth(const Vec3d& point) {
  return std::fabs(point.x) < 1e9 && std::fabs(point.y) < 1e9 && std::fabs(point.z) < 1e9;
}

Prism prism_around(const Solid& solid) {
  if (solid.triangles.empty()) return solid.prism;
  constexpr double kBoxMargin = 0.001;  // [m]
  const Prism& box = solid.prism;
  const auto [low, high] = std::minmax_element(box.corners.begin(), box.corners.end());
  return Prism::box({(*low)[0] - kBoxMargin, box.low - kBoxMargin, (*low)[1] - kBoxMargin},
                    {(*high)[0] + kBoxMargin, box.high + kBoxMargin, (*high)[1] + kBoxMargin});
}

bool may_touch(const BodyRoom& room, const Solid& solid) {
  if (solid.triangles.empty()) return meets(room, solid.prism);
  // A flat box may be no prism; what is near to a triangle is near to the box.
  return std::any_of(solid.triangles.begin(), solid.triangles.end(),
                     [&](const auto& triangle) { return meets(room, triangle); });
}

double reach_of(const AvatarClass& avatar) {
  return std::sqrt(avatar.height * avatar.height + avatar.radius * avatar.radius);
}

}  // namespace throng::path
