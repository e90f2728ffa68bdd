// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "bake/surface/self_support.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "bake/surface/body_sweep.h"

// Between two points of a part, S(s, t) and S(s + ds, t + dt), lies a ds + b dt, where a and b are
// means of the derivatives along the straight line between their parameters. Means lie in the hulls
// of the derivatives' control points, so a x b lies in the hull of the products of these. Where all
// of these lie in a cone narrower than a half space, so does a x b: the line between the points is
// no steeper than the cone's steepest plane, and leaves the plane across a normal of the part by at
// most twice the cone's half angle. This holds for parts of any outline, and all pairs of their
// points.
//
// A triangle's point is at most `deviation` from the surface's at the same parameters, by the bound
// of import/patches/patch_steps.cpp and because its corners are that near to the surface.
namespace throng::bake {
namespace {

constexpr int32_t kSideMargin = 24;  // 256ths on each side of the cells

PatchPart widened(const PatchPart& cells) {
  const auto low = [](int32_t at) { return static_cast<uint8_t>(std::max(0, at - kSideMargin)); };
  const auto high = [](int32_t at) {
    return static_cast<uint8_t>(std::min(255, at + kSideMargin));
  };
  return {low(cells.s0), high(cells.s1), low(cells.t0), high(cells.t1)};
}

template <class Split>
BezierPatch cut(BezierPatch patch, int32_t from, int32_t to, Split split) {
  if (to < 256) patch = split(patch, to / 256.0)[0];
  if (from > 0) patch = split(patch, static_cast<double>(from) / to)[1];
  return patch;
}

}  // namespace

SelfSupport::SelfSupport(const BezierPatch& whole, const PatchPart& cells)
    : part_(widened(cells)), upright_slope_(kNever), along_slope_(kNever) {
  const int32_t span_s = part_.s1 + 1 - part_.s0, span_t = part_.t1 + 1 - part_.t0;
  const BezierPatch piece =
      cut(cut(whole, part_.s0, part_.s1 + 1, split_s), part_.t0, part_.t1 + 1, split_t);
  bound_slopes(piece);
  const auto& c = piece.points;
  for (size_t k = 0; k < 4; ++k) {
    for (size_t i = 0; i < 2; ++i) {
      const size_t row = 4 * k + i, column = 4 * i + k;
      ss_ = std::max(ss_, length(c[row] - c[row + 1] * 2 + c[row + 2]));
      tt_ = std::max(tt_, length(c[column] - c[column + 4] * 2 + c[column + 8]));
    }
  }
  for (size_t j = 0; j < 3; ++j) {
    for (size_t i = 0; i < 3; ++i) {
      const size_t a = 4 * j + i;
      st_ = std::max(st_, length(c[a] - c[a + 1] - c[a + 4] + c[a + 5]));
    }
  }
  ss_ *= 6.0 / (span_s * span_s);
  st_ *= 9.0 / (span_s * span_t);
  tt_ *= 6.0 / (span_t * span_t);
}

void SelfSupport::bound_slopes(const BezierPatch& piece) {
  const auto& p = piece.points;
  std::array<Vec3d, 12> along_s, along_t;
  Vec3d mean_s, mean_t;
  for (size_t j = 0; j < 4; ++j) {
    for (size_t i = 0; i < 3; ++i) {
      along_s[3 * j + i] = p[4 * j + i + 1] - p[4 * j + i];
      along_t[3 * j + i] = p[4 * (i + 1) + j] - p[4 * i + j];
      mean_s = mean_s + along_s[3 * j + i];
      mean_t = mean_t + along_t[3 * j + i];
    }
  }
  const Vec3d mean = cross(mean_t, mean_s);
  if (!(length(mean) > 0)) return;
  const Vec3d middle = mean * (1 / length(mean));
  double up = 1, along = 1;  // minimum cosines, of the angles to the vertical and to the middle
  for (const Vec3d& t : along_t) {
    for (const Vec3d& s : along_s) {
      const Vec3d normal = cross(t, s);
      const double size = length(normal);
      up = std::min(up, size > 0 ? normal.y / size : -1);
      along = std::min(along, size > 0 ? dot(normal, middle) / size : -1);
    }
  }
  if (up > 0) upright_slope_ = std::sqrt(std::max(0.0, 1 - up * up)) / up;
  // Of the doubled angle.
  const double twice = 2 * along * along - 1;
  if (along > 0 && twice > 0) {
    along_slope_ = 2 * along * std::sqrt(std::max(0.0, 1 - along * along)) / twice;
  }
}

double SelfSupport::deviation(int32_t span_s, int32_t span_t) const {
  return (span_s * span_s * ss_ + 2.0 * span_s * span_t * st_ + span_t * span_t * tt_) / 8;
}

double SelfSupport::rise(bool upright, double radius, double deviation) const {
  return (upright ? upright_slope_ : along_slope_) * (radius + deviation) + deviation;
}

}  // namespace throng::bake
