// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "import/patch_steps.h"

#include <algorithm>
#include <cmath>
#include <vector>

// Over a triangle whose parameters span a x b, a surface f leaves the plane through the three
// corners by at most (a^2 |f_ss| + 2 a b |f_st| + b^2 |f_tt|) / 8. Source: D. Filip, R. Magedson,
// R. Markot. Surface algorithms using bounds on derivatives. 1986. It holds for any triangle: the
// error is a mean, weighted like the corners, of half the second derivative along the ways to them,
// and the weighted mean square of ways within an interval of length a is at most a^2 / 4.
//
// That is the error at equal parameters. What counts is the gap, and a surface that slides within
// itself leaves none: seen as a height over a plane with slopes of at most g, the gap is at most
// the error's height and g times the rest of it. What is cut evenly is looked at in parts, at most
// 4 x 4, because over a small part g is small; steps end where parts do, so that each triangle lies
// in one.
namespace throng {
namespace {

// Bounds of second derivatives over a piece, by how much each opens a gap. [m]
struct Bend {
  double ss = 0, st = 0, tt = 0;
  [[nodiscard]] double gap(double a, double b) const {
    return (a * a * ss + 2 * a * b * st + b * b * tt) / 8;
  }
};

// Heights and components in the plane of some vectors, as intervals.
struct Extent {
  double low_x = 0, high_x = 0, low_y = 0, high_y = 0, height = 0;
  bool empty = true;
  void add(double x, double y, double h) {
    low_x = empty ? x : std::min(low_x, x);
    high_x = empty ? x : std::max(high_x, x);
    low_y = empty ? y : std::min(low_y, y);
    high_y = empty ? y : std::max(high_y, y);
    height = std::max(height, std::fabs(h));
    empty = false;
  }
  [[nodiscard]] double far_x() const { return std::max(std::fabs(low_x), std::fabs(high_x)); }
  [[nodiscard]] double far_y() const { return std::max(std::fabs(low_y), std::fabs(high_y)); }
};

// The steepest slope of a piece over the plane across `up`, or 1 if it may fold over it: then the
// whole error counts, as it always may.
double steepest(const BezierPatch& piece, Vec3d up) {
  const auto& c = piece.points;
  const Vec3d forward = piece.along_t(0.5, 0.5);
  const Vec3d flat = forward - up * dot(forward, up);
  const double size = length(flat);
  if (!(size > 0)) return 1;
  const Vec3d x = flat * (1 / size);
  const Vec3d y = cross(up, x);
  Extent ds;
  Extent dt;
  for (size_t k = 0; k < 4; ++k) {
    for (size_t i = 0; i < 3; ++i) {
      const Vec3d s = c[4 * k + i + 1] - c[4 * k + i];
      const Vec3d t = c[4 * (i + 1) + k] - c[4 * i + k];
      ds.add(dot(s, x), dot(s, y), dot(s, up));
      dt.add(dot(t, x), dot(t, y), dot(t, up));
    }
  }
  // A slope g satisfies g . ds = height of ds and g . dt = height of dt, hence
  // |g| <= |heights| |(ds, dt)| / |ds x dt|.
  const double area = dt.low_x * ds.low_y - dt.far_y() * ds.far_x();
  if (!(dt.low_x > 0 && ds.low_y > 0 && area > 0)) return 1;
  const double heights = std::sqrt(ds.height * ds.height + dt.height * dt.height);
  const double sizes = std::sqrt(ds.far_x() * ds.far_x() + ds.far_y() * ds.far_y() +
                                 dt.far_x() * dt.far_x() + dt.far_y() * dt.far_y());
  return std::min(1.0, heights * sizes / area);
}

// `span_s` and `span_t` are the parts of the patch's parameters that the piece covers.
Bend bend_of(const BezierPatch& piece, double span_s, double span_t) {
  const auto& c = piece.points;
  const Vec3d up = piece.normal(0.5, 0.5);
  const double slope = steepest(piece, up);
  // Raises a bound by what v opens: at most its length, so most vectors raise nothing. (Of doubles
  // whose squares are normal numbers, the root of the square is the number again.)
  const auto raise = [&](double& most, Vec3d v) {
    if (most > 1e-150 && most < 1e150 && dot(v, v) <= most * most) return;
    const double height = dot(v, up);
    const double rest = length(v - up * height);
    most = std::max(most, std::min(length(v), std::fabs(height) + slope * rest));
  };
  Bend bend;
  for (size_t k = 0; k < 4; ++k) {
    for (size_t i = 0; i < 2; ++i) {
      const size_t row = 4 * k + i;
      const size_t column = 4 * i + k;
      raise(bend.ss, c[row] - c[row + 1] * 2 + c[row + 2]);
      raise(bend.tt, c[column] - c[column + 4] * 2 + c[column + 8]);
    }
  }
  for (size_t j = 0; j < 3; ++j) {
    for (size_t i = 0; i < 3; ++i) {
      const size_t a = 4 * j + i;
      raise(bend.st, c[a] - c[a + 1] - c[a + 4] + c[a + 5]);
    }
  }
  bend.ss *= 6 / (span_s * span_s);
  bend.st *= 9 / (span_s * span_t);
  bend.tt *= 6 / (span_t * span_t);
  return bend;
}

// The patch in 2^halvings x 2^halvings parts, by t, then s.
std::vector<BezierPatch> parts_of(const BezierPatch& patch, int32_t halvings) {
  std::vector<BezierPatch> rows{patch};
  const auto halve = [&](std::vector<BezierPatch>& parts, auto split) {
    std::vector<BezierPatch> halves;
    halves.reserve(2 * parts.size());
    for (const BezierPatch& part : parts) {
      for (const BezierPatch& half : split(part, 0.5)) halves.push_back(half);
    }
    parts = std::move(halves);
  };
  for (int32_t k = 0; k < halvings; ++k) halve(rows, split_t);
  for (int32_t k = 0; k < halvings; ++k) halve(rows, split_s);
  return rows;
}

// The fewest steps, multiples of what the surface was looked at in.
Steps min_steps(const BezierPatch& patch, double tolerance, int32_t least, int32_t most,
                int32_t halvings) {
  const int32_t parts = 1 << halvings;
  std::vector<Bend> bends;
  for (const BezierPatch& part : parts_of(patch, halvings)) {
    bends.push_back(bend_of(part, 1.0 / parts, 1.0 / parts));
  }
  const auto is_enough = [&](int32_t s, int32_t t) {
    // Also false for a NaN of wild coordinates.
    return std::all_of(bends.begin(), bends.end(),
                       [&](const Bend& bend) { return bend.gap(1.0 / s, 1.0 / t) <= tolerance; });
  };
  Steps best{static_cast<uint8_t>(most), static_cast<uint8_t>(most)};
  const int32_t first = (least + parts - 1) / parts * parts;
  // The more steps along s, the fewer along t.
  int32_t t = most;
  for (int32_t s = first; s <= most; s += parts) {
    if (!is_enough(s, t)) continue;
    while (t - parts >= first && is_enough(s, t - parts)) t -= parts;
    if (s * t < best.count()) best = {static_cast<uint8_t>(s), static_cast<uint8_t>(t)};
  }
  return best;
}

// Of a few ways to look at it the one that asks for the least.
Steps min_of(const BezierPatch& patch, double tolerance, int32_t least, int32_t most) {
  constexpr int32_t kMaxHalvings = 2;
  Steps best = min_steps(patch, tolerance, least, most, 0);
  for (int32_t h = 1; h <= kMaxHalvings && best.count() > least * least; ++h) {
    const Steps steps = min_steps(patch, tolerance, least, most, h);
    if (steps.count() < best.count()) best = steps;
  }
  return best;
}

// Pieces are not cut more coarsely, so that no triangle of a patch in pieces covers more than a
// sixteenth of a side: nodes know the ground around a cell as far as that (bake/own_ground).
constexpr int32_t kMinOfPiece = 4;

}  // namespace

PatchCut cut_within(const BezierPatch& patch, double tolerance) {
  constexpr int32_t kPieces = PatchCut::kMaxPieces;
  PatchCut whole;
  whole.steps[0] = min_of(patch, tolerance, 1, kMaxSteps);
  int32_t count = kPieces * kPieces * kMinOfPiece * kMinOfPiece;
  if (whole.steps[0].count() <= count) return whole;
  PatchCut pieces{.pieces = kPieces, .steps = {}};
  const std::vector<BezierPatch> parts = parts_of(patch, 2);
  count = 0;
  for (size_t k = 0; k < parts.size(); ++k) {
    pieces.steps[k] = min_of(parts[k], tolerance, kMinOfPiece, kMaxSteps / kPieces);
    count += pieces.steps[k].count();
  }
  return whole.steps[0].count() <= count ? whole : pieces;
}

}  // namespace throng
