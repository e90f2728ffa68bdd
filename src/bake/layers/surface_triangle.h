// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "bake/columns/triangles.h"

/// A triangle as surface planes see it: which cells it touches, its plane, and exactly how far it
/// stands above another plane inside a cell.
namespace throng::bake {

/// Cells are widened by that much, far more than doubles err. [cells]
inline constexpr double kTouchMargin = 1e-6;

struct SurfacePoint {
  double x, y, z;  // [cells, mm, cells]
};

/// A triangle cut by up to four sides of a cell: a convex polygon.
struct SurfacePart {
  std::array<SurfacePoint, 8> points;
  size_t count = 0;

  void push(const SurfacePoint& p) { points[count++] = p; }

  /// What of it lies where sign * axis >= sign * at.
  template <double SurfacePoint::*axis>
  [[nodiscard]] SurfacePart cut(double at, double sign) const {
    SurfacePart out;
    for (size_t i = 0; i < count; ++i) {
      const SurfacePoint& a = points[i];
      const SurfacePoint& b = points[i + 1 == count ? 0 : i + 1];
      const double da = sign * (a.*axis - at), db = sign * (b.*axis - at);
      if (da >= 0) out.push(a);
      if ((da < 0) == (db < 0)) continue;
      const double t = da / (da - db);
      out.push({a.x + t * (b.x - a.x), a.y + t * (b.y - a.y), a.z + t * (b.z - a.z)});
    }
    return out;
  }
};

struct Interval {
  double low = 1e30, high = -1e30;

  void add(double x) {
    low = std::min(low, x);
    high = std::max(high, x);
  }
};

/// In a tile's frame: cells, and mm from the layer's base.
struct SurfaceTriangle {
  std::array<SurfacePoint, 3> corner;  // by ascending z
  double lowest, highest;
  bool is_plane;                       // the three below say something
  double slope_x, slope_z, at_origin;  // [mm per cell, mm]
  std::array<double, 3> side;          // x by z along 0-1, 1-2, 0-2; 0 where z does not change

  SurfaceTriangle(const CellTriangle& t, double cell_x, double cell_z, double base) {
    constexpr double kMinWidth = 0.05;  // one less wide has no plane worth the name [cells]
    constexpr double kMaxRise = 1000;   // nor has one steeper [mm per cell]
    for (size_t i = 0; i < 3; ++i) corner[i] = {t.x[i] - cell_x, t.y[i] - base, t.z[i] - cell_z};
    const auto& [o, a, b] = corner;
    lowest = std::min({o.y, a.y, b.y});
    highest = std::max({o.y, a.y, b.y});
    const double ax = a.x - o.x, ay = a.y - o.y, az = a.z - o.z;
    const double bx = b.x - o.x, by = b.y - o.y, bz = b.z - o.z;
    const double normal_y = az * bx - ax * bz;
    const double rise_x = az * by - ay * bz, rise_z = ay * bx - ax * by;
    const double size = std::max({std::fabs(ax), std::fabs(bx), std::fabs(bx - ax), bz});
    is_plane = std::fabs(normal_y) > kMinWidth * size &&
               std::max(std::fabs(rise_x), std::fabs(rise_z)) < kMaxRise * std::fabs(normal_y);
    slope_x = is_plane ? rise_x / normal_y : 0;
    slope_z = is_plane ? rise_z / normal_y : 0;
    at_origin = o.y - slope_x * o.x - slope_z * o.z;
    const auto along = [](double dx, double dz) { return dz > 0 ? dx / dz : 0; };
    side = {along(ax, az), along(bx - ax, bz - az), along(bx, bz)};
  }
  [[nodiscard]] double at(double x, double z) const {
    return at_origin + slope_x * x + slope_z * z;
  }
  /// What it covers of a line of z that crosses it.
  [[nodiscard]] Interval on_line(double z) const {
    Interval out;
    out.add(corner[0].x + (z - corner[0].z) * side[2]);
    const size_t i = z <= corner[1].z ? 0 : 1;
    out.add(corner[i].x + (z - corner[i].z) * side[i]);
    return out;
  }
  /// How far it reaches in row z.
  [[nodiscard]] Interval in_row(int32_t z) const {
    const double low = z - kTouchMargin, high = z + 1 + kTouchMargin;
    Interval out;
    if (corner[0].z < low) {
      if (corner[2].z >= low) out = on_line(low);
    } else if (corner[0].z <= high) {
      out.add(corner[0].x);
    }
    if (corner[2].z > high) {
      if (corner[0].z <= high) {
        const Interval end = on_line(high);
        out.add(end.low);
        out.add(end.high);
      }
    } else if (corner[2].z >= low) {
      out.add(corner[2].x);
    }
    if (corner[1].z >= low && corner[1].z <= high) out.add(corner[1].x);
    return out;
  }
  /// What of it lies in row z.
  [[nodiscard]] SurfacePart row_part(int32_t z) const {
    SurfacePart whole;
    for (const SurfacePoint& p : corner) whole.push(p);
    return whole.cut<&SurfacePoint::z>(z - kTouchMargin, 1)
        .cut<&SurfacePoint::z>(z + 1 + kTouchMargin, -1);
  }
};

}  // namespace throng::bake
