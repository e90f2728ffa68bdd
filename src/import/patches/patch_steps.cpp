// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "import/patches/patch_steps.h"

#include <algorithm>
#include <cmath>
#include <vector>

// Over a triangle whose parameters span a x b, a surface f leaves the plane through the three
// corners by at most (a^2 |f_ss| + 2 a b |f_st| + b^2 |f_tt|) / 8. Source: D. Filip, R. Magedson,
// R. Markot. Surface algorithms using bounds on derivatives. 1986. It holds for any triangle: the
// error is a mean, weighted like the corners, of half the second derivative along the offsets to
// them, and the weighted mean square of offsets within an interval of length a is at most a^2 / 4.
//
// That is the error at equal parameters. What counts is the deviation: the distance to the surface,
// which an error along the surface does not add to. Over a plane to which the surface has slopes of
// at most g, the deviation is at most the error's height plus g times the rest of the error. An
// evenly cut patch is bounded in parts, at most 4 x 4, because g is small over a small part; steps
// end where parts do, so that each triangle lies in one part.
namespace throng::importer {
namespace {

// Bounds of second derivatives over a piece, by what each adds to the deviation. [m]
struct DeviationBounds {
  double ss = 0, st = 0, tt = 0;
  [[nodiscard]] double deviation(double a, double b) const {
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
DeviationBounds deviation_bounds(const BezierPatch& piece, double span_s, double span_t) {
  const auto& c = piece.points;
  const Vec3d up = piece.normal(0.5, 0.5);
  const double slope = steepest(piece, up);
  // Raises a bound by what v opens: at most its length, so most vectors raise nothing. (Of doubles
  // whose squares are normal numbers, the root of the square is the number again.)
  const auto raise = [&](double& bound, Vec3d v) {
    if (bound > 1e-150 && bound < 1e150 && dot(v, v) <= bound * bound) return;
    const double height = dot(v, up);
    const double rest = length(v - up * height);
    bound = std::max(bound, std::min(length(v), std::fabs(height) + slope * rest));
  };
  DeviationBounds bounds;
  for (size_t k = 0; k < 4; ++k) {
    for (size_t i = 0; i < 2; ++i) {
      const size_t row = 4 * k + i;
      const size_t column = 4 * i + k;
      raise(bounds.ss, c[row] - c[row + 1] * 2 + c[row + 2]);
      raise(bounds.tt, c[column] - c[column + 4] * 2 + c[column + 8]);
    }
  }
  for (size_t j = 0; j < 3; ++j) {
    for (size_t i = 0; i < 3; ++i) {
      const size_t a = 4 * j + i;
      raise(bounds.st, c[a] - c[a + 1] - c[a + 4] + c[a + 5]);
    }
  }
  bounds.ss *= 6 / (span_s * span_s);
  bounds.st *= 9 / (span_s * span_t);
  bounds.tt *= 6 / (span_t * span_t);
  return bounds;
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

// The smallest number of steps, in multiples of the parts.
Steps min_steps(const BezierPatch& patch, double tolerance, int32_t min_per_side,
                int32_t max_per_side, int32_t halvings) {
  const int32_t parts = 1 << halvings;
  std::vector<DeviationBounds> all_bounds;
  for (const BezierPatch& part : parts_of(patch, halvings)) {
    all_bounds.push_back(deviation_bounds(part, 1.0 / parts, 1.0 / parts));
  }
  const auto is_enough = [&](int32_t s, int32_t t) {
    // Also false for a NaN of wild coordinates.
    return std::all_of(all_bounds.begin(), all_bounds.end(), [&](const DeviationBounds& bounds) {
      return bounds.deviation(1.0 / s, 1.0 / t) <= tolerance;
    });
  };
  Steps best{static_cast<uint8_t>(max_per_side), static_cast<uint8_t>(max_per_side)};
  const int32_t first = (min_per_side + parts - 1) / parts * parts;
  // The more steps along s, the fewer along t.
  int32_t t = max_per_side;
  for (int32_t s = first; s <= max_per_side; s += parts) {
    if (!is_enough(s, t)) continue;
    while (t - parts >= first && is_enough(s, t - parts)) t -= parts;
    if (s * t < best.count()) best = {static_cast<uint8_t>(s), static_cast<uint8_t>(t)};
  }
  return best;
}

// The smallest number of steps over a few sizes of parts.
Steps min_of(const BezierPatch& patch, double tolerance, int32_t min_per_side,
             int32_t max_per_side) {
  constexpr int32_t kMaxHalvings = 2;
  Steps best = min_steps(patch, tolerance, min_per_side, max_per_side, 0);
  for (int32_t h = 1; h <= kMaxHalvings && best.count() > min_per_side * min_per_side; ++h) {
    const Steps steps = min_steps(patch, tolerance, min_per_side, max_per_side, h);
    if (steps.count() < best.count()) best = steps;
  }
  return best;
}

// Pieces are not cut more coarsely, so that no triangle of a patch in pieces covers more than a
// sixteenth of a side: nodes hold the ground around a cell as far as that (bake/own_ground).
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

}  // namespace throng::importer
