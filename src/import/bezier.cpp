// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "import/bezier.h"

#include <algorithm>
#include <cmath>

#include "throng/base.h"

// Over a step of length 1/n a quadratic curve leaves its chord by at most |p0 - 2 p1 + p2| / (4
// n^2). Across a patch the two directions add up, and a quad's two triangles leave the bilinear
// quad by a quarter of its twist; each of the three gets a third of the tolerance. Steps are chosen
// for a whole column or row of pieces, so that neighbours share their points and no crack opens.
namespace throng {
namespace {

constexpr int kMostSteps = 64;

int steps_for(double bend, double tolerance) {
  const double steps = std::sqrt(bend / (4 * tolerance));
  return static_cast<int>(std::clamp(std::ceil(steps), 1.0, double{kMostSteps}));
}

Vec3d quadratic(Vec3d a, Vec3d b, Vec3d c, double t) {
  const double s = 1 - t;
  return a * (s * s) + b * (2 * s * t) + c * (t * t);
}

}  // namespace

PatchMesh tessellate_biquadratic(int32_t columns, int32_t rows, std::span<const Vec3d> control,
                                 double tolerance) {
  THRONG_ASSERT(columns >= 3 && rows >= 3 && columns % 2 == 1 && rows % 2 == 1);
  THRONG_ASSERT(control.size() == static_cast<size_t>(columns) * rows);
  const auto at = [&](int32_t column, int32_t row) {
    return control[static_cast<size_t>(row) * columns + column];
  };
  const double share = tolerance / 3;
  std::vector<int> column_steps(static_cast<size_t>(columns / 2), 1);
  std::vector<int> row_steps(static_cast<size_t>(rows / 2), 1);
  for (int32_t i = 0; i + 2 < columns; i += 2) {
    double bend = 0;
    for (int32_t j = 0; j < rows; ++j) {
      bend = std::max(bend, length(at(i, j) - at(i + 1, j) * 2 + at(i + 2, j)));
    }
    column_steps[i / 2] = steps_for(bend, share);
  }
  for (int32_t j = 0; j + 2 < rows; j += 2) {
    double bend = 0;
    for (int32_t i = 0; i < columns; ++i) {
      bend = std::max(bend, length(at(i, j) - at(i, j + 1) * 2 + at(i, j + 2)));
    }
    row_steps[j / 2] = steps_for(bend, share);
  }
  // Twist: the mixed derivative is at most 4 times the largest mixed difference of control points.
  for (int32_t j = 0; j + 2 < rows; j += 2) {
    for (int32_t i = 0; i + 2 < columns; i += 2) {
      double twist = 0;
      for (int32_t k = 0; k < 4; ++k) {
        const int32_t a = i + (k & 1);
        const int32_t b = j + (k >> 1);
        twist =
            std::max(twist, 4 * length(at(a, b) - at(a + 1, b) - at(a, b + 1) + at(a + 1, b + 1)));
      }
      int& nu = column_steps[i / 2];
      int& nv = row_steps[j / 2];
      while (twist / (4.0 * nu * nv) > share && (nu < kMostSteps || nv < kMostSteps)) {
        ((nu <= nv && nu < kMostSteps) || nv == kMostSteps ? nu : nv) += 1;
      }
    }
  }

  PatchMesh mesh{.columns = 1, .rows = 1, .points = {}};
  for (const int steps : column_steps) mesh.columns += steps;
  for (const int steps : row_steps) mesh.rows += steps;
  mesh.points.reserve(static_cast<size_t>(mesh.columns) * mesh.rows);
  for (size_t jp = 0; jp < row_steps.size(); ++jp) {
    const auto j = static_cast<int32_t>(2 * jp);
    const bool last_piece = jp + 1 == row_steps.size();
    for (int v = 0; v < row_steps[jp] + (last_piece ? 1 : 0); ++v) {
      const double tv = static_cast<double>(v) / row_steps[jp];
      const auto along = [&](int32_t column) {
        return quadratic(at(column, j), at(column, j + 1), at(column, j + 2), tv);
      };
      for (size_t ip = 0; ip < column_steps.size(); ++ip) {
        const auto i = static_cast<int32_t>(2 * ip);
        const bool last_column = ip + 1 == column_steps.size();
        const Vec3d a = along(i);
        const Vec3d b = along(i + 1);
        const Vec3d c = along(i + 2);
        for (int u = 0; u < column_steps[ip] + (last_column ? 1 : 0); ++u) {
          mesh.points.push_back(quadratic(a, b, c, static_cast<double>(u) / column_steps[ip]));
        }
      }
    }
  }
  return mesh;
}

}  // namespace throng
