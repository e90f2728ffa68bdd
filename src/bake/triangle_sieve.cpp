// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "bake/triangle_sieve.h"

#include <algorithm>
#include <array>
#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bake/triangle_sieve.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
#include <hwy/highway.h>

#include "bake/vector_bits-inl.h"

#ifndef THRONG_TRIANGLE_SIEVE_ONCE
#define THRONG_TRIANGLE_SIEVE_ONCE
namespace throng {

constexpr size_t kSieveLanes = 16;  // at most, in a vector

// A cylinder around an axis, grown or shrunk by the margin.
struct SieveCylinder {
  float radius, low, high;
};

// A question in single precision, from the list's origin.
struct SieveView {
  std::array<float, 3> centre;
  std::array<std::array<float, 3>, 3> axis;  // side, front, up
  float margin;
  SieveCylinder first, second;
  std::array<SieveCylinder, 31> whole, decisive;
  size_t count;
};

}  // namespace throng
#endif

HWY_BEFORE_NAMESPACE();
namespace throng {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using DF = hn::CappedTag<float, kSieveLanes>;
using DI = hn::Rebind<uint32_t, DF>;
using VF = hn::Vec<DF>;
using MF = hn::Mask<DF>;

HWY_INLINE VF min_of(const VF (&v)[3]) { return hn::Min(hn::Min(v[0], v[1]), v[2]); }
HWY_INLINE VF max_of(const VF (&v)[3]) { return hn::Max(hn::Max(v[0], v[1]), v[2]); }

// Not past the end of the list.
HWY_INLINE MF lanes_of(size_t left) {
  const DF df;
  return hn::FirstN(df, std::min(left, hn::Lanes(df)));
}

size_t Narrow(const SieveList& list, const float* low, const float* high, SieveList& out) {
  const DF df;
  const DI di;
  size_t kept = 0;
  for (size_t i = 0; i < list.count; i += hn::Lanes(df)) {
    VF corner[9];
    for (size_t k = 0; k < 9; ++k) corner[k] = hn::LoadU(df, &list.corner[k * list.stride + i]);
    MF near = lanes_of(list.count - i);
    for (size_t k = 0; k < 3; ++k) {
      const VF at[3] = {corner[k], corner[k + 3], corner[k + 6]};
      near = hn::And(near, hn::And(hn::Le(min_of(at), hn::Set(df, high[k])),
                                   hn::Ge(max_of(at), hn::Set(df, low[k]))));
    }
    if (hn::AllFalse(df, near)) continue;
    for (size_t k = 0; k < 9; ++k) {
      hn::StoreU(hn::Compress(corner[k], near), df, &out.corner[k * out.stride + kept]);
    }
    const auto id = hn::LoadU(di, &list.triangle[i]);
    hn::StoreU(hn::Compress(id, hn::RebindMask(di, near)), di, &out.triangle[kept]);
    kept += hn::CountTrue(df, near);
  }
  return kept;
}

// A triangle seen along the axis: how far its corners lie to the side, to the front and between.
struct Outline {
  VF low, high, left, right, back, front, left_back, right_front, left_front, right_back;

  HWY_INLINE Outline(const VF (&x)[3], const VF (&y)[3], const VF (&z)[3])
      : low(min_of(z)),
        high(max_of(z)),
        left(min_of(x)),
        right(max_of(x)),
        back(min_of(y)),
        front(max_of(y)) {
    const VF sum[3] = {hn::Add(x[0], y[0]), hn::Add(x[1], y[1]), hn::Add(x[2], y[2])};
    const VF off[3] = {hn::Sub(x[0], y[0]), hn::Sub(x[1], y[1]), hn::Sub(x[2], y[2])};
    left_back = min_of(sum);
    right_front = max_of(sum);
    left_front = min_of(off);
    right_back = max_of(off);
  }

  [[nodiscard]] HWY_INLINE MF may_enter(const SieveCylinder& tube) const {
    const DF df;
    const VF r = hn::Set(df, tube.radius), d = hn::Set(df, tube.radius * 1.41422F);
    const VF nr = hn::Neg(r), nd = hn::Neg(d);
    const MF heights =
        hn::And(hn::Le(low, hn::Set(df, tube.high)), hn::Ge(high, hn::Set(df, tube.low)));
    const MF box = hn::And(hn::And(hn::Le(left, r), hn::Ge(right, nr)),
                           hn::And(hn::Le(back, r), hn::Ge(front, nr)));
    const MF across = hn::And(hn::And(hn::Le(left_back, d), hn::Ge(right_front, nd)),
                              hn::And(hn::Le(left_front, d), hn::Ge(right_back, nd)));
    return hn::And(heights, hn::And(box, across));
  }
};

// The plane n p = at of a triangle, not normalised, n's height not negative. If coordinates are
// wrong by at most a third of the margin m and no longer than l along edges, n is wrong by less
// than 4 m (l + m), and n (q - p) by less than `give` for two points of the triangle.
struct Plane {
  VF height, across, at, give;

  HWY_INLINE Plane(const VF (&x)[3], const VF (&y)[3], const VF (&z)[3], const Outline& outline,
                   float margin) {
    const DF df;
    const VF x1 = hn::Sub(x[1], x[0]), y1 = hn::Sub(y[1], y[0]), z1 = hn::Sub(z[1], z[0]);
    const VF x2 = hn::Sub(x[2], x[0]), y2 = hn::Sub(y[2], y[0]), z2 = hn::Sub(z[2], z[0]);
    const VF nx = hn::Sub(hn::Mul(y1, z2), hn::Mul(z1, y2));
    const VF ny = hn::Sub(hn::Mul(z1, x2), hn::Mul(x1, z2));
    const VF nz = hn::Sub(hn::Mul(x1, y2), hn::Mul(y1, x2));
    const VF along = hn::Add(hn::Add(hn::Mul(nx, x[0]), hn::Mul(ny, y[0])), hn::Mul(nz, z[0]));
    height = hn::Abs(nz);
    at = hn::IfThenElse(hn::Lt(nz, hn::Zero(df)), hn::Neg(along), along);
    across = hn::Sqrt(hn::Add(hn::Mul(nx, nx), hn::Mul(ny, ny)));
    const VF longest =
        hn::Max(hn::Max(hn::Sub(outline.right, outline.left), hn::Sub(outline.front, outline.back)),
                hn::Sub(outline.high, outline.low));
    const VF m = hn::Set(df, margin);
    give = hn::Mul(hn::Mul(hn::Mul(hn::Set(df, 24.0F), m), longest), hn::Add(longest, m));
  }

  [[nodiscard]] HWY_INLINE MF may_enter(const SieveCylinder& tube) const {
    const DF df;
    const VF reach = hn::MulAdd(hn::Set(df, tube.radius), across, give);
    return hn::And(hn::Le(hn::Mul(height, hn::Set(df, tube.low)), hn::Add(at, reach)),
                   hn::Ge(hn::Mul(height, hn::Set(df, tube.high)), hn::Sub(at, reach)));
  }
};

uint32_t Sieve(const SieveList& list, const SieveView& view, SieveHits& hits) {
  const DF df;
  const DI di;
  const uint32_t all = (1u << view.count) - 1;
  uint32_t answered = 0;
  for (size_t i = 0; i < list.count && answered != all; i += hn::Lanes(df)) {
    VF x[3], y[3], z[3];
    for (size_t c = 0; c < 3; ++c) {
      VF d[3];
      for (size_t k = 0; k < 3; ++k) {
        d[k] = hn::Sub(hn::LoadU(df, &list.corner[(3 * c + k) * list.stride + i]),
                       hn::Set(df, view.centre[k]));
      }
      const auto along = [&](const std::array<float, 3>& axis) HWY_ATTR {
        return hn::MulAdd(
            d[2], hn::Set(df, axis[2]),
            hn::MulAdd(d[1], hn::Set(df, axis[1]), hn::Mul(d[0], hn::Set(df, axis[0]))));
      };
      x[c] = along(view.axis[0]);
      y[c] = along(view.axis[1]);
      z[c] = along(view.axis[2]);
    }
    const Outline outline(x, y, z);
    const MF near = hn::And(lanes_of(list.count - i),
                            hn::Or(outline.may_enter(view.first), outline.may_enter(view.second)));
    if (hn::AllFalse(df, near)) continue;
    const Plane plane(x, y, z, outline, view.margin);
    VF far2[3];
    for (size_t c = 0; c < 3; ++c) far2[c] = hn::MulAdd(x[c], x[c], hn::Mul(y[c], y[c]));
    auto entered = hn::Zero(di);
    for (uint32_t left = all & ~answered; left != 0; left &= left - 1) {
      const auto b = static_cast<size_t>(__builtin_ctz(left));
      const SieveCylinder& tube = view.decisive[b];
      const MF may =
          hn::And(near, hn::And(outline.may_enter(view.whole[b]), plane.may_enter(view.whole[b])));
      if (hn::AllFalse(df, may)) continue;
      const VF low = hn::Set(df, tube.low), high = hn::Set(df, tube.high);
      const VF r2 = hn::Set(df, tube.radius * tube.radius);
      MF in = hn::And(hn::And(hn::Gt(z[0], low), hn::Lt(z[0], high)), hn::Lt(far2[0], r2));
      for (size_t c = 1; c < 3; ++c) {
        in = hn::Or(in,
                    hn::And(hn::And(hn::Gt(z[c], low), hn::Lt(z[c], high)), hn::Lt(far2[c], r2)));
      }
      if (hn::AllFalse(df, hn::And(in, may))) {
        entered =
            hn::Or(entered, hn::IfThenElseZero(hn::RebindMask(di, may), hn::Set(di, 1u << b)));
      } else {
        answered |= 1u << b;
      }
    }
    const auto any = hn::Ne(entered, hn::Zero(di));
    if (hn::AllFalse(di, any)) continue;
    hn::StoreU(hn::Compress(hn::LoadU(di, &list.triangle[i]), any), di, &hits.triangle[hits.count]);
    hn::StoreU(hn::Compress(entered, any), di, &hits.tubes[hits.count]);
    hits.count += hn::CountTrue(di, any);
  }
  return answered;
}

}  // namespace HWY_NAMESPACE
}  // namespace throng
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace throng {

HWY_EXPORT(Narrow);
HWY_EXPORT(Sieve);

namespace {

// Of what is computed from coordinates of at most `extent` by a subtraction and a product with an
// axis, all in floats: below 20 roundings of 2^-24, so this is three times enough.
double margin_of(double extent) { return 4e-6 * extent + 1e-6; }

std::array<float, 3> to_floats(Vec3d v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

double largest(Vec3d v) { return std::max({std::fabs(v.x), std::fabs(v.y), std::fabs(v.z)}); }

// The share is for the rounding of squares and limits.
SieveCylinder grown(const BodySweep& sweep, double margin) {
  return {static_cast<float>(sweep.radius * (1 + 1e-6) + 2 * margin),
          static_cast<float>(sweep.low - margin - 1e-6 * std::fabs(sweep.low)),
          static_cast<float>(sweep.high + margin + 1e-6 * std::fabs(sweep.high))};
}

SieveCylinder shrunk(const BodySweep& sweep, double margin) {
  return {static_cast<float>(std::max(0.0, sweep.radius * (1 - 1e-6) - 2 * margin)),
          static_cast<float>(sweep.low + margin + 1e-6 * std::fabs(sweep.low)),
          static_cast<float>(sweep.high - margin - 1e-6 * std::fabs(sweep.high))};
}

void make_room(SieveList& list, size_t count) {
  if (list.stride >= count + kSieveLanes) return;
  const size_t stride = std::max<size_t>(2 * list.stride, count + 4 * kSieveLanes);
  std::vector<float> corner(9 * stride);
  for (size_t k = 0; k < 9; ++k) {
    std::copy_n(list.corner.data() + k * list.stride, list.count, corner.data() + k * stride);
  }
  list.corner = std::move(corner);
  list.triangle.resize(stride);
  list.stride = stride;
}

}  // namespace

void SieveList::clear(Vec3d around) {
  origin = around;
  extent = 0;
  count = 0;
}

void SieveList::add(uint32_t id, const LocalTriangle& corners) {
  make_room(*this, count + 1);
  for (size_t c = 0; c < 3; ++c) {
    const Vec3d at = corners[c] - origin;
    const std::array<float, 3> p = to_floats(at);
    for (size_t k = 0; k < 3; ++k) corner[(3 * c + k) * stride + count] = p[k];
    extent = std::max(extent, largest(at));
  }
  triangle[count++] = id;
}

void narrow(const SieveList& list, const Box3d& box, SieveList& out) {
  out.clear(list.origin);
  make_room(out, list.count);
  out.extent = list.extent;
  const Vec3d low = box.min - list.origin, high = box.max - list.origin;
  const double margin = margin_of(std::max({list.extent, largest(low), largest(high)}));
  const Vec3d give{margin, margin, margin};
  out.count = HWY_DYNAMIC_DISPATCH(Narrow)(list, to_floats(low - give).data(),
                                           to_floats(high + give).data(), out);
}

uint32_t sieve(const SieveList& list, const SieveQuestion& question, SieveHits& hits) {
  SieveView view;
  const Vec3d centre = question.frame.centre - list.origin;
  view.centre = to_floats(centre);
  view.axis = {to_floats(question.frame.side), to_floats(question.frame.front),
               to_floats(question.frame.up)};
  const double margin = margin_of(list.extent + largest(centre));
  view.margin = static_cast<float>(margin);
  view.first = grown(question.first, margin);
  view.second = grown(question.second, margin);
  view.count = question.tubes.size();
  for (size_t i = 0; i < view.count; ++i) {
    view.whole[i] = grown(question.tubes[i].whole, margin);
    view.decisive[i] = shrunk(question.tubes[i].decisive, margin);
  }
  hits.count = 0;
  if (hits.triangle.size() < list.stride) {
    hits.triangle.resize(list.stride);
    hits.tubes.resize(list.stride);
  }
  return HWY_DYNAMIC_DISPATCH(Sieve)(list, view, hits);
}

}  // namespace throng
#endif  // HWY_ONCE
