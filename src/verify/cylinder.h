// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <optional>

#include "throng/base.h"

/// The exact tests of the oracle, in double precision: an upright cylinder, and a vertical line,
/// against one triangle. Triangles may be degenerate (a segment, a point): they are still solid.
namespace throng::verify {

using Corners = std::array<Vec3d, 3>;

/// Closed upright cylinder around the vertical axis through (x, z), from `low` to `high`.
struct Cylinder {
  double x = 0;
  double z = 0;
  double low = 0;
  double high = 0;
  double radius = 0;

  [[nodiscard]] Box3d bounds() const;
};

/// Intersections shallower than this do not count: a body may touch what it stands beside. [m]
inline constexpr double kTouchMargin = 1e-6;

/// True if the triangle reaches deeper than `touch` into the cylinder: the triangle is clipped to
/// the cylinder's slab and the distance of what is left to the axis is compared with the radius.
[[nodiscard]] bool meets(const Cylinder& cylinder, const Corners& triangle,
                         double touch = kTouchMargin);

/// Height of the triangle on the vertical line through (x, z), or nothing beside it. A triangle
/// that the line could only meet edge-on has no height.
[[nodiscard]] std::optional<double> height_at(const Corners& triangle, double x, double z);

/// Cosine of the angle between the triangle and the ground plane, wherever it faces; 0 for
/// degenerate triangles, on which no body can stand.
[[nodiscard]] double levelness(const Corners& triangle);

}  // namespace throng::verify
