// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>

#include "throng/scene.h"

// Bernstein's polynomials and de Casteljau's construction, as in G. Farin. Curves and Surfaces for
// CAGD. 5th edition, 2002, chapters 4, 5 and 14. Only + - * /: the same bits on every machine.
namespace throng {
namespace {

using Weights = std::array<double, 4>;

Weights bernstein(double u) {
  const double v = 1 - u;
  return {v * v * v, 3 * u * v * v, 3 * u * u * v, u * u * u};
}

Weights bernstein_derivative(double u) {
  const double v = 1 - u;
  return {-3 * v * v, 3 * v * (v - 2 * u), 3 * u * (2 * v - u), 3 * u * u};
}

Vec3d blend(const std::array<Vec3d, 16>& points, const Weights& ws, const Weights& wt) {
  Vec3d sum;
  for (size_t j = 0; j < 4; ++j) {
    Vec3d row;
    for (size_t i = 0; i < 4; ++i) row = row + points[4 * j + i] * ws[i];
    sum = sum + row * wt[j];
  }
  return sum;
}

// Splits one cubic curve: the control points of both halves.
void split_curve(const std::array<Vec3d, 4>& c, double at, std::array<Vec3d, 4>& low,
                 std::array<Vec3d, 4>& high) {
  const auto mix = [at](Vec3d a, Vec3d b) { return a * (1 - at) + b * at; };
  const Vec3d ab = mix(c[0], c[1]);
  const Vec3d bc = mix(c[1], c[2]);
  const Vec3d cd = mix(c[2], c[3]);
  const Vec3d abc = mix(ab, bc);
  const Vec3d bcd = mix(bc, cd);
  const Vec3d middle = mix(abc, bcd);
  low = {c[0], ab, abc, middle};
  high = {middle, bcd, cd, c[3]};
}

// `step` separates the control points of one curve, `next` the first ones of the four curves.
std::array<BezierPatch, 2> split_curves(const BezierPatch& patch, double at, size_t step,
                                        size_t next) {
  std::array<BezierPatch, 2> out;
  for (size_t k = 0; k < 4; ++k) {
    std::array<Vec3d, 4> low;
    std::array<Vec3d, 4> high;
    const auto index = [&](size_t i) { return k * next + i * step; };
    split_curve({patch.points[index(0)], patch.points[index(1)], patch.points[index(2)],
                 patch.points[index(3)]},
                at, low, high);
    for (size_t i = 0; i < 4; ++i) {
      out[0].points[index(i)] = low[i];
      out[1].points[index(i)] = high[i];
    }
  }
  return out;
}

Vec3d third(Vec3d p) { return {p.x / 3, p.y / 3, p.z / 3}; }

// One curve of degree 1 to 3, its points `step` apart, as a cubic.
std::array<Vec3d, 4> raise_curve(int32_t degree, const Vec3d* c, size_t step) {
  const Vec3d first = c[0];
  const Vec3d last = c[static_cast<size_t>(degree) * step];
  if (degree == 1) return {first, third(first * 2 + last), third(first + last * 2), last};
  if (degree == 2) {
    const Vec3d middle = c[step] * 2;
    return {first, third(first + middle), third(middle + last), last};
  }
  return {first, c[step], c[2 * step], last};
}

}  // namespace

Vec3d BezierPatch::at(double s, double t) const {
  return blend(points, bernstein(s), bernstein(t));
}

Vec3d BezierPatch::along_s(double s, double t) const {
  return blend(points, bernstein_derivative(s), bernstein(t));
}

Vec3d BezierPatch::along_t(double s, double t) const {
  return blend(points, bernstein(s), bernstein_derivative(t));
}

Vec3d BezierPatch::normal(double s, double t) const {
  const Box3d box = bounds();
  const double size2 = dot(box.max - box.min, box.max - box.min);
  // First at the point itself, then a little towards the middle: near a collapsed edge the
  // derivative along it shrinks, but the direction of the product has a limit.
  Vec3d widest;
  for (const double inward : {0.0, 0x1p-20, 0x1p-16, 0x1p-12, 0x1p-8, 0x1p-4}) {
    const double u = s + (0.5 - s) * inward;
    const double v = t + (0.5 - t) * inward;
    const Vec3d n = cross(along_t(u, v), along_s(u, v));
    if (dot(n, n) > 1e-18 * size2 * size2) return n * (1 / length(n));
    if (dot(n, n) > dot(widest, widest)) widest = n;
  }
  const double long_enough = length(widest);  // A sliver: only its direction is known.
  return long_enough > 0 ? widest * (1 / long_enough) : Vec3d{};
}

Box3d BezierPatch::bounds() const {
  Box3d box;
  for (const Vec3d& p : points) box.add(p);
  return box;
}

Vec3d BezierPatch::vertex(int32_t corner) const {
  constexpr std::array<size_t, 4> kAt{0, 12, 15, 3};
  return points[kAt[static_cast<size_t>(corner)]];
}

std::array<Vec3d, 4> BezierPatch::edge(int32_t edge) const {
  constexpr std::array<std::array<size_t, 4>, 4> kAt{
      {{0, 4, 8, 12}, {12, 13, 14, 15}, {15, 11, 7, 3}, {3, 2, 1, 0}}};
  const auto& at = kAt[static_cast<size_t>(edge)];
  return {points[at[0]], points[at[1]], points[at[2]], points[at[3]]};
}

Vec3d cubic_point(const std::array<Vec3d, 4>& curve, double u) {
  const Weights w = bernstein(u);
  return curve[0] * w[0] + curve[1] * w[1] + curve[2] * w[2] + curve[3] * w[3];
}

std::array<BezierPatch, 2> split_s(const BezierPatch& patch, double at) {
  return split_curves(patch, at, 1, 4);
}

std::array<BezierPatch, 2> split_t(const BezierPatch& patch, double at) {
  return split_curves(patch, at, 4, 1);
}

BezierPatch raise_degree(int32_t degree_s, int32_t degree_t, std::span<const Vec3d> points) {
  THRONG_ASSERT(degree_s >= 1 && degree_s <= 3 && degree_t >= 1 && degree_t <= 3);
  THRONG_ASSERT(points.size() == static_cast<size_t>((degree_s + 1) * (degree_t + 1)));
  const auto columns = static_cast<size_t>(degree_s) + 1;
  std::array<Vec3d, 16> wide{};  // Cubic along s, still degree_t along t.
  for (size_t j = 0; j <= static_cast<size_t>(degree_t); ++j) {
    const auto row = raise_curve(degree_s, points.data() + j * columns, 1);
    std::copy(row.begin(), row.end(), wide.begin() + static_cast<ptrdiff_t>(4 * j));
  }
  BezierPatch patch;
  for (size_t i = 0; i < 4; ++i) {
    const auto column = raise_curve(degree_t, wide.data() + i, 4);
    for (size_t j = 0; j < 4; ++j) patch.points[4 * j + i] = column[j];
  }
  return patch;
}

}  // namespace throng
