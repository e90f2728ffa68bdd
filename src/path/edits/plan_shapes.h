// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <optional>
#include <span>
#include <utility>

#include "core/math/plan_point.h"
#include "throng/base.h"

/// Squares of the ground's plane against polygons and triangles: which cells obstacles block.
namespace throng::path {

/// A square of the ground's plane. [m]
struct PlanSquare {
  double x0 = 0, z0 = 0, x1 = 0, z1 = 0;
};

/// Of the distance of a point to the line from a to b. [m2]
double squared_to_segment(PlanPoint p, PlanPoint a, PlanPoint b);

/// Are a square and a convex polygon (of a single point or edge too) nearer than `distance`?
bool is_nearer(const PlanSquare& square, std::span<const PlanPoint> polygon, double distance);

/// Lowest and highest point of a triangle over a square, or none.
std::optional<std::pair<double, double>> heights_over(const PlanSquare& square,
                                                      const std::array<Vec3d, 3>& triangle);

}  // namespace throng::path
