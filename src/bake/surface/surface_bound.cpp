// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "bake/surface/surface_bound.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

// One cell's bounds are scalar code. Many cells' are the same steps in the same order on vectors,
// one cell in each lane, without fused multiplications: hence the same bits.

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bake/surface/surface_bound.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
#include <hwy/highway.h>

#ifndef THRONG_SURFACE_BOUND_ONCE
#define THRONG_SURFACE_BOUND_ONCE
namespace throng::bake {

constexpr double kWidestCone = 0.94;  // sine of its half angle
constexpr size_t kBoundLanes = 8;     // at most, in a vector
// Bounds of as many cells as there are lanes.
struct BoundLanes {
  using Lanes = std::array<double, kBoundLanes>;
  alignas(64) std::array<Lanes, 12> frame;
  alignas(64) Lanes size, off, sine, cosine, radius, low, high, upright_radius, upright_low,
      upright_high;
};

}  // namespace throng::bake
#endif

HWY_BEFORE_NAMESPACE();
namespace throng::bake {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using DD = hn::CappedTag<double, kBoundLanes>;
using VD = hn::Vec<DD>;

struct V3 {
  VD x, y, z;
};

HWY_INLINE V3 plus(const V3& a, const V3& b) {
  return {hn::Add(a.x, b.x), hn::Add(a.y, b.y), hn::Add(a.z, b.z)};
}
HWY_INLINE V3 minus(const V3& a, const V3& b) {
  return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}
HWY_INLINE V3 times(const V3& a, VD s) {
  return {hn::Mul(a.x, s), hn::Mul(a.y, s), hn::Mul(a.z, s)};
}
HWY_INLINE VD product(const V3& a, const V3& b) {
  return hn::Add(hn::Add(hn::Mul(a.x, b.x), hn::Mul(a.y, b.y)), hn::Mul(a.z, b.z));
}
HWY_INLINE V3 normal_to(const V3& a, const V3& b) {
  return {hn::Sub(hn::Mul(a.y, b.z), hn::Mul(a.z, b.y)),
          hn::Sub(hn::Mul(a.z, b.x), hn::Mul(a.x, b.z)),
          hn::Sub(hn::Mul(a.x, b.y), hn::Mul(a.y, b.x))};
}

HWY_INLINE VD middle_of(VD a, VD b) {
  const VD half = hn::Set(DD(), 0.5);  // As split_s() has it: products first.
  return hn::Add(hn::Mul(a, half), hn::Mul(b, half));
}

// The control points of both halves of a curve.
HWY_INLINE void halve(const VD (&c)[4], VD (&low)[4], VD (&high)[4]) {
  const VD ab = middle_of(c[0], c[1]), bc = middle_of(c[1], c[2]), cd = middle_of(c[2], c[3]);
  low[0] = c[0];
  low[1] = ab;
  low[2] = middle_of(ab, bc);
  high[1] = middle_of(bc, cd);
  high[2] = cd;
  high[3] = c[3];
  low[3] = high[0] = middle_of(low[2], high[1]);
}

// Along s, then each half along t. Points are as far apart as coordinates times the stride.
void Quarter(const double* in, size_t stride, size_t count, double* out, size_t out_stride) {
  const DD dd;
  for (size_t i = 0; i < count; i += hn::Lanes(dd)) {
    for (size_t k = 0; k < 3; ++k) {
      const auto row = [&](size_t point) { return (3 * point + k); };
      VD left[16], right[16];
      for (size_t j = 0; j < 4; ++j) {
        VD c[4], low[4], high[4];
        for (size_t n = 0; n < 4; ++n) c[n] = hn::LoadU(dd, in + row(4 * j + n) * stride + i);
        halve(c, low, high);
        for (size_t n = 0; n < 4; ++n) {
          left[4 * j + n] = low[n];
          right[4 * j + n] = high[n];
        }
      }
      for (size_t n = 0; n < 4; ++n) {
        const VD from[2][4] = {{left[n], left[4 + n], left[8 + n], left[12 + n]},
                               {right[n], right[4 + n], right[8 + n], right[12 + n]}};
        VD part[4][4];
        halve(from[0], part[0], part[1]);
        halve(from[1], part[2], part[3]);
        for (size_t j = 0; j < 4; ++j) {
          hn::StoreInterleaved4(part[0][j], part[1][j], part[2][j], part[3][j], dd,
                                out + row(4 * j + n) * out_stride + 4 * i);
        }
      }
    }
  }
}

// Of the parts from `first` on.
void BoundLanesOf(const double* parts, size_t stride, size_t first, BoundLanes& out) {
  const DD dd;
  const VD zero = hn::Zero(dd), one = hn::Set(dd, 1.0);
  V3 p[16];
  for (size_t k = 0; k < 16; ++k) {
    const double* at = parts + 3 * k * stride + first;
    p[k] = {hn::LoadU(dd, at), hn::LoadU(dd, at + stride), hn::LoadU(dd, at + 2 * stride)};
  }
  const VD three = hn::Set(dd, 3.0), twelfth = hn::Set(dd, 1.0 / 12);
  V3 along_s[12], along_t[12], mean_s{zero, zero, zero}, mean_t = mean_s, centre = mean_s;
  for (size_t j = 0; j < 4; ++j) {
    for (size_t i = 0; i < 3; ++i) {
      along_s[3 * j + i] = times(minus(p[4 * j + i + 1], p[4 * j + i]), three);
      along_t[3 * j + i] = times(minus(p[4 * (i + 1) + j], p[4 * i + j]), three);
      mean_s = plus(mean_s, along_s[3 * j + i]);
      mean_t = plus(mean_t, along_t[3 * j + i]);
    }
  }
  mean_s = times(mean_s, twelfth);
  mean_t = times(mean_t, twelfth);
  for (const V3& point : p) centre = plus(centre, point);
  centre = times(centre, hn::Set(dd, 1.0 / 16));
  VD off_s = zero, off_t = zero;
  for (size_t k = 0; k < 12; ++k) {
    const V3 ds = minus(along_s[k], mean_s), dt = minus(along_t[k], mean_t);
    off_s = hn::Max(off_s, product(ds, ds));
    off_t = hn::Max(off_t, product(dt, dt));
  }
  off_s = hn::Sqrt(off_s);
  off_t = hn::Sqrt(off_t);
  const V3 normal = normal_to(mean_t, mean_s);
  const VD size = hn::Sqrt(product(normal, normal));
  const VD off = hn::Add(hn::Add(hn::Mul(off_t, hn::Sqrt(product(mean_s, mean_s))),
                                 hn::Mul(hn::Sqrt(product(mean_t, mean_t)), off_s)),
                         hn::Mul(off_t, off_s));
  const VD sine = hn::Div(off, size);
  const VD cosine = hn::Sqrt(hn::Sub(one, hn::Mul(sine, sine)));
  const V3 up = times(normal, hn::Div(one, size));
  // As in BodyFrame::around.
  const VD x = hn::Abs(up.x), y = hn::Abs(up.y), z = hn::Abs(up.z);
  const auto by_x = hn::And(hn::Le(x, y), hn::Le(x, z)), by_y = hn::AndNot(by_x, hn::Le(y, z));
  const V3 flat{hn::IfThenElse(by_x, one, zero), hn::IfThenElse(by_y, one, zero),
                hn::IfThenElse(hn::Or(by_x, by_y), zero, one)};
  V3 side = normal_to(flat, up);
  side = times(side, hn::Div(one, hn::Sqrt(product(side, side))));
  const V3 front = normal_to(up, side);

  const VD never = hn::Set(dd, std::numeric_limits<double>::infinity());
  VD radius2 = zero, low = never, high = hn::Neg(never);
  VD upright_radius2 = zero, upright_low = low, upright_high = high;
  for (const V3& point : p) {
    const V3 d = minus(point, centre);
    const VD across = product(d, side), ahead = product(d, front), height = product(d, up);
    radius2 = hn::Max(radius2, hn::Add(hn::Mul(across, across), hn::Mul(ahead, ahead)));
    low = hn::Min(low, height);
    high = hn::Max(high, height);
    upright_radius2 = hn::Max(upright_radius2, hn::Add(hn::Mul(d.x, d.x), hn::Mul(d.z, d.z)));
    upright_low = hn::Min(upright_low, d.y);
    upright_high = hn::Max(upright_high, d.y);
  }
  const V3 frame[4] = {centre, side, front, up};
  for (size_t k = 0; k < 4; ++k) {
    hn::Store(frame[k].x, dd, out.frame[3 * k].data());
    hn::Store(frame[k].y, dd, out.frame[3 * k + 1].data());
    hn::Store(frame[k].z, dd, out.frame[3 * k + 2].data());
  }
  hn::Store(size, dd, out.size.data());
  hn::Store(off, dd, out.off.data());
  hn::Store(sine, dd, out.sine.data());
  hn::Store(cosine, dd, out.cosine.data());
  hn::Store(hn::Sqrt(radius2), dd, out.radius.data());
  hn::Store(low, dd, out.low.data());
  hn::Store(high, dd, out.high.data());
  hn::Store(hn::Sqrt(upright_radius2), dd, out.upright_radius.data());
  hn::Store(upright_low, dd, out.upright_low.data());
  hn::Store(upright_high, dd, out.upright_high.data());
}

size_t BoundLaneCount() { return hn::Lanes(DD()); }

}  // namespace HWY_NAMESPACE
}  // namespace throng::bake
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace throng::bake {

HWY_EXPORT(Quarter);
HWY_EXPORT(BoundLanesOf);
HWY_EXPORT(BoundLaneCount);

namespace {

double sine_of(double cosine) { return std::sqrt(std::max(0.0, 1 - cosine * cosine)); }

}  // namespace

double SurfaceBound::steepest_cosine() const {
  const double up = std::clamp(frame.up.y, -1.0, 1.0), across = sine_of(up);
  if (across * cosine + up * sine < 0) return -1;  // The cone holds straight down.
  return up * cosine - across * sine;
}

std::optional<SurfaceBound> bound_surface(const BezierPatch& patch) {
  const auto& p = patch.points;
  std::array<Vec3d, 12> along_s, along_t;
  Vec3d mean_s, mean_t, centre;
  for (size_t j = 0; j < 4; ++j) {
    for (size_t i = 0; i < 3; ++i) {
      along_s[3 * j + i] = (p[4 * j + i + 1] - p[4 * j + i]) * 3;
      along_t[3 * j + i] = (p[4 * (i + 1) + j] - p[4 * i + j]) * 3;
      mean_s = mean_s + along_s[3 * j + i];
      mean_t = mean_t + along_t[3 * j + i];
    }
  }
  mean_s = mean_s * (1.0 / 12);
  mean_t = mean_t * (1.0 / 12);
  for (const Vec3d& point : p) centre = centre + point;
  centre = centre * (1.0 / 16);
  double off_s = 0, off_t = 0;
  for (size_t k = 0; k < 12; ++k) {
    const Vec3d ds = along_s[k] - mean_s, dt = along_t[k] - mean_t;
    off_s = std::max(off_s, dot(ds, ds));
    off_t = std::max(off_t, dot(dt, dt));
  }
  off_s = std::sqrt(off_s);
  off_t = std::sqrt(off_t);
  const Vec3d normal = cross(mean_t, mean_s);
  const double size = length(normal);
  // (t + dt) x (s + ds) differs from t x s by at most this.
  const double off = off_t * length(mean_s) + length(mean_t) * off_s + off_t * off_s;
  if (!(size > 0) || !(off < kWidestCone * size)) return std::nullopt;
  SurfaceBound bound;
  bound.sine = off / size;
  bound.cosine = std::sqrt(1 - bound.sine * bound.sine);
  bound.frame = BodyFrame::around(centre, normal * (1 / size));
  bound.area = size;
  bound.low = kNever;
  bound.high = -kNever;
  double radius2 = 0;
  for (const Vec3d& point : p) {
    const Vec3d q = bound.frame.local(point);
    radius2 = std::max(radius2, q.x * q.x + q.y * q.y);
    bound.low = std::min(bound.low, q.z);
    bound.high = std::max(bound.high, q.z);
  }
  bound.radius = std::sqrt(radius2);
  return bound;
}

// The normals' heights lie in the hull of those of all products: a wall that bends sideways is
// nowhere steeper than a wall, which the cone cannot show.
double steepest_cosine(const BezierPatch& patch, const SurfaceBound& bound) {
  const auto& p = patch.points;
  double least = kNever;
  for (size_t j = 0; j < 4; ++j) {
    for (size_t i = 0; i < 3; ++i) {
      const Vec3d s = p[4 * j + i + 1] - p[4 * j + i];
      for (size_t k = 0; k < 12; ++k) {
        const Vec3d t = p[k + 4] - p[k];
        least = std::min(least, 9 * (t.z * s.x - t.x * s.z));
      }
    }
  }
  // The normal's length: within `sine` of the mean's.
  const double length = bound.area * (least > 0 ? 1 + bound.sine : 1 - bound.sine);
  return std::max(-1.0, least / length);
}

SurfaceBound upright_bound(const BezierPatch& patch, const SurfaceBound& along) {
  SurfaceBound bound = along;
  bound.frame = {along.frame.centre, {1, 0, 0}, {0, 0, -1}, {0, 1, 0}};
  bound.sine = 0;
  bound.cosine = 1;
  bound.low = kNever;
  bound.high = -kNever;
  double radius2 = 0;
  for (const Vec3d& point : patch.points) {
    const Vec3d q = point - along.frame.centre;
    radius2 = std::max(radius2, q.x * q.x + q.z * q.z);
    bound.low = std::min(bound.low, q.y);
    bound.high = std::max(bound.high, q.y);
  }
  bound.radius = std::sqrt(radius2);
  return bound;
}

void PatchParts::resize(size_t parts) {
  count = parts;
  stride = (parts + kBoundLanes - 1) / kBoundLanes * kBoundLanes;
  if (at.size() < kPatchDoubles * stride) at.resize(kPatchDoubles * stride);
}

void PatchParts::set(size_t part, const BezierPatch& patch) {
  for (size_t p = 0; p < 16; ++p) {
    at[(3 * p) * stride + part] = patch.points[p].x;
    at[(3 * p + 1) * stride + part] = patch.points[p].y;
    at[(3 * p + 2) * stride + part] = patch.points[p].z;
  }
}

BezierPatch PatchParts::patch(size_t part) const {
  BezierPatch patch;
  for (size_t p = 0; p < 16; ++p) {
    patch.points[p] = {at[(3 * p) * stride + part], at[(3 * p + 1) * stride + part],
                       at[(3 * p + 2) * stride + part]};
  }
  return patch;
}

// The lanes past the last part hold whatever was there, and so do their quarters.
void quarter_parts(const PatchParts& parts, PatchParts& out) {
  const size_t lanes = HWY_DYNAMIC_DISPATCH(BoundLaneCount)();
  const size_t rounded = (parts.count + lanes - 1) / lanes * lanes;
  out.resize(4 * rounded);
  out.count = 4 * parts.count;
  HWY_DYNAMIC_DISPATCH(Quarter)
  (parts.at.data(), parts.stride, parts.count, out.at.data(), out.stride);
}

void bound_cells_of(const PatchParts& parts, std::span<CellBounds> out) {
  const size_t lanes = HWY_DYNAMIC_DISPATCH(BoundLaneCount)();
  BoundLanes bounds;
  for (size_t done = 0; done < parts.count; done += lanes) {
    HWY_DYNAMIC_DISPATCH(BoundLanesOf)(parts.at.data(), parts.stride, done, bounds);
    for (size_t i = 0; i < std::min(lanes, parts.count - done); ++i) {
      CellBounds& cell = out[done + i];
      cell.valid = bounds.size[i] > 0 && bounds.off[i] < kWidestCone * bounds.size[i];
      if (!cell.valid) continue;
      const auto vector = [&](size_t k) {
        return Vec3d{bounds.frame[3 * k][i], bounds.frame[3 * k + 1][i],
                     bounds.frame[3 * k + 2][i]};
      };
      cell.along = {.frame = {vector(0), vector(1), vector(2), vector(3)},
                    .sine = bounds.sine[i],
                    .cosine = bounds.cosine[i],
                    .radius = bounds.radius[i],
                    .low = bounds.low[i],
                    .high = bounds.high[i],
                    .area = bounds.size[i]};
      cell.upright = {.frame = {vector(0), {1, 0, 0}, {0, 0, -1}, {0, 1, 0}},
                      .sine = 0,
                      .cosine = 1,
                      .radius = bounds.upright_radius[i],
                      .low = bounds.upright_low[i],
                      .high = bounds.upright_high[i],
                      .area = bounds.size[i]};
    }
  }
}

}  // namespace throng::bake
#endif  // HWY_ONCE
