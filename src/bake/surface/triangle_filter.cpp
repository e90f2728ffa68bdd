// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "bake/surface/triangle_filter.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

// Tests triangles against cylinders a vector at a time, with margins for rounding in single
// precision: a sure yes or no, or an exact test later. Linear in the triangles.

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bake/surface/triangle_filter.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
#include <hwy/highway.h>

#include "bake/columns/vector_bits-inl.h"
#include "core/arrays/compress-inl.h"

#ifndef THRONG_TRIANGLE_FILTER_ONCE
#define THRONG_TRIANGLE_FILTER_ONCE
namespace throng::bake {

constexpr size_t kFilterLanes = 16;  // at most, in a vector

// A cylinder around an axis, grown or shrunk by the margin.
struct FilterCylinder {
  float radius, low, high;
};

// A cylinders' axis, from the list's origin.
struct FilterAxis {
  std::array<float, 3> centre, up;
  float margin, reach;  // of numbers here; of the cylinders
};

// A question in single precision.
struct FilterView {
  FilterAxis axis;
  std::array<float, 3> side, front;
  FilterCylinder first, second;
  std::array<FilterCylinder, 31> whole, decisive;
  size_t count;
};

}  // namespace throng::bake
#endif

HWY_BEFORE_NAMESPACE();
namespace throng::bake {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
namespace simd = throng::HWY_NAMESPACE;

using DF = hn::CappedTag<float, kFilterLanes>;
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

// A unit normal of each triangle, and from where to where its corners lie along it. Whatever
// rounding does to the normal, these are that direction's; a triangle of no area may have none.
// And a ball around it.
void FindPlanes(FilterList& list, float margin) {
  const DF df;
  const VF one = hn::Set(df, 1.0F), least = hn::Set(df, 1e-30F), m = hn::Set(df, margin);
  for (size_t i = 0; i < list.count; i += hn::Lanes(df)) {
    VF x[3], y[3], z[3];
    for (size_t c = 0; c < 3; ++c) {
      x[c] = hn::LoadU(df, &list.corner[(3 * c) * list.stride + i]);
      y[c] = hn::LoadU(df, &list.corner[(3 * c + 1) * list.stride + i]);
      z[c] = hn::LoadU(df, &list.corner[(3 * c + 2) * list.stride + i]);
    }
    const VF x1 = hn::Sub(x[1], x[0]), y1 = hn::Sub(y[1], y[0]), z1 = hn::Sub(z[1], z[0]);
    const VF x2 = hn::Sub(x[2], x[0]), y2 = hn::Sub(y[2], y[0]), z2 = hn::Sub(z[2], z[0]);
    VF nx = hn::Sub(hn::Mul(y1, z2), hn::Mul(z1, y2));
    VF ny = hn::Sub(hn::Mul(z1, x2), hn::Mul(x1, z2));
    VF nz = hn::Sub(hn::Mul(x1, y2), hn::Mul(y1, x2));
    const VF size2 = hn::MulAdd(nz, nz, hn::MulAdd(ny, ny, hn::Mul(nx, nx)));
    const VF inverse = hn::IfThenElseZero(hn::Gt(size2, least), hn::Div(one, hn::Sqrt(size2)));
    nx = hn::Mul(nx, inverse);
    ny = hn::Mul(ny, inverse);
    nz = hn::Mul(nz, inverse);
    VF at[3];
    for (size_t c = 0; c < 3; ++c) {
      at[c] = hn::MulAdd(nz, z[c], hn::MulAdd(ny, y[c], hn::Mul(nx, x[c])));
    }
    const VF third = hn::Set(df, 1.0F / 3);
    const VF cx = hn::Mul(hn::Add(hn::Add(x[0], x[1]), x[2]), third);
    const VF cy = hn::Mul(hn::Add(hn::Add(y[0], y[1]), y[2]), third);
    const VF cz = hn::Mul(hn::Add(hn::Add(z[0], z[1]), z[2]), third);
    VF far2 = hn::Zero(df);
    for (size_t c = 0; c < 3; ++c) {
      const VF dx = hn::Sub(x[c], cx), dy = hn::Sub(y[c], cy), dz = hn::Sub(z[c], cz);
      far2 = hn::Max(far2, hn::MulAdd(dz, dz, hn::MulAdd(dy, dy, hn::Mul(dx, dx))));
    }
    hn::StoreU(cx, df, &list.plane[5 * list.stride + i]);
    hn::StoreU(cy, df, &list.plane[6 * list.stride + i]);
    hn::StoreU(cz, df, &list.plane[7 * list.stride + i]);
    hn::StoreU(hn::MulAdd(hn::Sqrt(far2), hn::Set(df, 1 + 1e-6F), m), df,
               &list.plane[8 * list.stride + i]);
    hn::StoreU(nx, df, &list.plane[i]);
    hn::StoreU(ny, df, &list.plane[list.stride + i]);
    hn::StoreU(nz, df, &list.plane[2 * list.stride + i]);
    hn::StoreU(hn::Sub(min_of(at), m), df, &list.plane[3 * list.stride + i]);
    hn::StoreU(hn::Add(max_of(at), m), df, &list.plane[4 * list.stride + i]);
  }
}

size_t Narrow(const FilterList& list, const float* middle, const float* half, FilterList& out) {
  const DF df;
  const DI di;
  // Reused apart from the lists, which stores of vectors might change for all that the compiler
  // knows.
  const float* const corners = list.corner.data();
  const float* const planes = list.plane.data();
  const uint32_t* const ids = list.triangle.data();
  float* const to_corners = out.corner.data();
  float* const to_planes = out.plane.data();
  uint32_t* const to_ids = out.triangle.data();
  const size_t stride = list.stride, to_stride = out.stride, count = list.count;
  const VF x = hn::Set(df, middle[0]), y = hn::Set(df, middle[1]), z = hn::Set(df, middle[2]);
  const VF dx = hn::Set(df, half[0]), dy = hn::Set(df, half[1]), dz = hn::Set(df, half[2]);
  size_t kept = 0;
  for (size_t i = 0; i < count; i += hn::Lanes(df)) {
    const float* ball = planes + 5 * stride + i;
    const VF radius = hn::LoadU(df, ball + 3 * stride);
    const auto within = [&](size_t k, VF at, VF reach) HWY_ATTR {
      const VF off = hn::Abs(hn::Sub(hn::LoadU(df, ball + k * stride), at));
      return hn::Le(off, hn::Add(radius, reach));
    };
    const MF close = hn::And(hn::And(lanes_of(count - i), within(0, x, dx)),
                             hn::And(within(1, y, dy), within(2, z, dz)));
    if (hn::AllFalse(df, close)) continue;
    const auto overlaps = [&](size_t k, VF at, VF reach) HWY_ATTR {
      const float* corner = corners + k * stride + i;
      const VF of[3] = {hn::LoadU(df, corner), hn::LoadU(df, corner + 3 * stride),
                        hn::LoadU(df, corner + 6 * stride)};
      return hn::And(hn::Le(hn::Sub(min_of(of), at), reach),
                     hn::Le(hn::Sub(at, max_of(of)), reach));
    };
    const MF near = hn::And(hn::And(close, overlaps(0, x, dx)),
                            hn::And(overlaps(1, y, dy), overlaps(2, z, dz)));
    if (hn::AllFalse(df, near)) continue;
    for (size_t k = 0; k < 9; ++k) {
      const VF corner = hn::LoadU(df, corners + k * stride + i);
      hn::StoreU(simd::compress(corner, near), df, to_corners + k * to_stride + kept);
      const VF plane = hn::LoadU(df, planes + k * stride + i);
      hn::StoreU(simd::compress(plane, near), df, to_planes + k * to_stride + kept);
    }
    const auto id = hn::LoadU(di, ids + i);
    hn::StoreU(simd::compress(id, hn::RebindMask(di, near)), di, to_ids + kept);
    kept += hn::CountTrue(df, near);
  }
  return kept;
}

// Where the planes of triangles come highest into upright tubes: uphill, at the rim. If such a
// point is in the triangle, as seen from above and by more than the margin, the triangle is there
// between the heights of its slab.
uint32_t HoldsRim(const FilterList& list, const FilterAxis& axis, const FilterCylinder* tubes,
                  uint32_t all) {
  const DF df;
  const VF m = hn::Set(df, axis.margin), zero = hn::Zero(df);
  uint32_t held = 0;
  for (size_t i = 0; i < list.count && held != all; i += hn::Lanes(df)) {
    const auto row = [&](size_t k)
                         HWY_ATTR { return hn::LoadU(df, &list.plane[k * list.stride + i]); };
    VF nx = row(0), ny = row(1), nz = row(2);
    const VF at = hn::MulAdd(
        nz, hn::Set(df, axis.centre[2]),
        hn::MulAdd(ny, hn::Set(df, axis.centre[1]), hn::Mul(nx, hn::Set(df, axis.centre[0]))));
    const VF from = hn::Sub(hn::Sub(row(3), at), m), to = hn::Add(hn::Sub(row(4), at), m);
    // Upward; too steep a triangle bounds too little.
    const MF turned = hn::Lt(ny, zero);
    nx = hn::IfThenElse(turned, hn::Neg(nx), nx);
    ny = hn::Abs(ny);
    nz = hn::IfThenElse(turned, hn::Neg(nz), nz);
    const VF low = hn::IfThenElse(turned, hn::Neg(to), from);
    const VF high = hn::IfThenElse(turned, hn::Neg(from), to);
    const MF flat = hn::And(hn::Gt(ny, hn::Set(df, 0.1F)), lanes_of(list.count - i));
    const VF across = hn::Sqrt(hn::MulAdd(nx, nx, hn::MulAdd(nz, nz, hn::Set(df, 1e-12F))));
    const VF uphill_x = hn::Neg(hn::Div(nx, across)), uphill_z = hn::Neg(hn::Div(nz, across));
    VF x[3], z[3], dx[3], dz[3], give[3];
    for (size_t c = 0; c < 3; ++c) {
      const float* corner = &list.corner[3 * c * list.stride + i];
      x[c] = hn::Sub(hn::LoadU(df, corner), hn::Set(df, axis.centre[0]));
      z[c] = hn::Sub(hn::LoadU(df, corner + 2 * list.stride), hn::Set(df, axis.centre[2]));
    }
    for (size_t c = 0; c < 3; ++c) {
      dx[c] = hn::Sub(x[(c + 1) % 3], x[c]);
      dz[c] = hn::Sub(z[(c + 1) % 3], z[c]);
      give[c] = hn::Mul(m, hn::Add(hn::Abs(dx[c]), hn::Abs(dz[c])));
    }
    for (uint32_t left = all & ~held; left != 0; left &= left - 1) {
      const auto b = static_cast<size_t>(__builtin_ctz(left));
      const VF radius = hn::Set(df, tubes[b].radius * 0.999F);
      const VF qx = hn::Mul(uphill_x, radius), qz = hn::Mul(uphill_z, radius);
      const VF rise = hn::MulAdd(nx, qx, hn::Mul(nz, qz));
      // Heights there are (slab - rise) / ny.
      MF in =
          hn::And(hn::Gt(hn::Sub(low, rise), hn::Mul(ny, hn::Add(hn::Set(df, tubes[b].low), m))),
                  hn::Lt(hn::Sub(high, rise), hn::Mul(ny, hn::Sub(hn::Set(df, tubes[b].high), m))));
      MF left_of = flat, right_of = flat;
      for (size_t c = 0; c < 3; ++c) {
        const VF side =
            hn::Sub(hn::Mul(dx[c], hn::Sub(qz, z[c])), hn::Mul(dz[c], hn::Sub(qx, x[c])));
        left_of = hn::And(left_of, hn::Gt(side, give[c]));
        right_of = hn::And(right_of, hn::Lt(side, hn::Neg(give[c])));
      }
      in = hn::And(in, hn::Or(left_of, right_of));
      held |= hn::AllFalse(df, in) ? 0 : 1u << b;
    }
  }
  return held;
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

  [[nodiscard]] HWY_INLINE MF may_enter(const FilterCylinder& tube) const {
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

// Between which two planes a triangle lies, seen from a cylinder's axis. The square root is of what
// is left of a unit normal whose squares are known to 4e-7, so it is taken of a little more.
struct Slab {
  VF height, across, low, high;

  HWY_INLINE Slab(const FilterList& list, size_t i, const FilterAxis& axis) {
    const DF df;
    VF n[3];
    for (size_t k = 0; k < 3; ++k) n[k] = hn::LoadU(df, &list.plane[k * list.stride + i]);
    const auto along = [&](const std::array<float, 3>& v) HWY_ATTR {
      return hn::MulAdd(n[2], hn::Set(df, v[2]),
                        hn::MulAdd(n[1], hn::Set(df, v[1]), hn::Mul(n[0], hn::Set(df, v[0]))));
    };
    height = along(axis.up);
    const VF at = along(axis.centre), m = hn::Set(df, axis.margin);
    low = hn::Sub(hn::LoadU(df, &list.plane[3 * list.stride + i]), hn::Add(at, m));
    high = hn::Sub(hn::LoadU(df, &list.plane[4 * list.stride + i]), hn::Sub(at, m));
    const VF left = hn::NegMulAdd(height, height, hn::Set(df, 1.0F));
    across = hn::Sqrt(hn::Add(hn::Max(left, hn::Zero(df)), hn::Set(df, 2e-6F)));
  }

  [[nodiscard]] HWY_INLINE MF may_enter(const FilterCylinder& tube) const {
    const DF df;
    const VF reach = hn::Mul(across, hn::Set(df, tube.radius));
    const VF bottom = hn::Mul(height, hn::Set(df, tube.low));
    const VF top = hn::Mul(height, hn::Set(df, tube.high));
    return hn::And(hn::Le(hn::Sub(hn::Min(bottom, top), reach), high),
                   hn::Ge(hn::Add(hn::Max(bottom, top), reach), low));
  }
};

// How far a triangle's ball is from a cylinder's axis, at least: of what is left of a square whose
// parts are known to 1e-6 of it, it takes a little less.
struct Ball {
  VF d[3], height, d2, far2, radius;

  HWY_INLINE Ball(const FilterList& list, size_t i, const FilterAxis& axis) {
    const DF df;
    for (size_t k = 0; k < 3; ++k) {
      d[k] = hn::Sub(hn::LoadU(df, &list.plane[(5 + k) * list.stride + i]),
                     hn::Set(df, axis.centre[k]));
    }
    height = hn::MulAdd(
        d[2], hn::Set(df, axis.up[2]),
        hn::MulAdd(d[1], hn::Set(df, axis.up[1]), hn::Mul(d[0], hn::Set(df, axis.up[0]))));
    d2 = hn::MulAdd(d[2], d[2], hn::MulAdd(d[1], d[1], hn::Mul(d[0], d[0])));
    far2 = hn::NegMulAdd(height, height, hn::Mul(d2, hn::Set(df, 1 - 4e-6F)));
    radius = hn::LoadU(df, &list.plane[8 * list.stride + i]);
  }

  [[nodiscard]] HWY_INLINE MF may_enter(const FilterCylinder& tube) const {
    const VF near = hn::Add(radius, hn::Set(DF(), tube.radius));
    return hn::Le(far2, hn::Mul(near, near));
  }
};

// How far a triangle reaches towards a cylinder's axis, from the side where its ball lies. The
// direction from the axis to it is `length` long, not 1, and normal to the axis up to rounding,
// which `give` bounds.
struct Flank {
  VF nearest, length, give;

  HWY_INLINE Flank(const FilterList& list, size_t i, const FilterAxis& axis, const Ball& ball) {
    const DF df;
    VF offset[3];
    for (size_t k = 0; k < 3; ++k) {
      offset[k] = hn::NegMulAdd(ball.height, hn::Set(df, axis.up[k]), ball.d[k]);
    }
    VF along[3];
    for (size_t c = 0; c < 3; ++c) {
      along[c] = hn::Zero(df);
      for (size_t k = 0; k < 3; ++k) {
        const VF at = hn::LoadU(df, &list.corner[(3 * c + k) * list.stride + i]);
        along[c] = hn::MulAdd(offset[k], hn::Sub(at, hn::Set(df, axis.centre[k])), along[c]);
      }
    }
    nearest = min_of(along);
    length = hn::Sqrt(hn::MulAdd(offset[2], offset[2],
                                 hn::MulAdd(offset[1], offset[1], hn::Mul(offset[0], offset[0]))));
    const VF size2 = hn::Add(hn::MulAdd(ball.radius, ball.radius, ball.d2),
                             hn::Set(df, axis.reach * axis.reach));
    give = hn::Mul(size2, hn::Set(df, 4e-6F));
  }

  [[nodiscard]] HWY_INLINE MF may_enter(const FilterCylinder& tube) const {
    return hn::Le(nearest, hn::MulAdd(hn::Set(DF(), tube.radius * (1 + 1e-6F)), length, give));
  }
};

uint32_t Glance(const FilterList& list, const FilterAxis& axis, const FilterCylinder* tubes,
                uint32_t left) {
  const DF df;
  uint32_t met = 0;
  for (size_t i = 0; i < list.count && left != 0; i += hn::Lanes(df)) {
    const Slab slab(list, i, axis);
    const MF there = lanes_of(list.count - i);
    MF any = hn::FirstN(df, 0);
    for (uint32_t b = left; b != 0; b &= b - 1) {
      any = hn::Or(any, slab.may_enter(tubes[__builtin_ctz(b)]));
    }
    if (hn::AllFalse(df, hn::And(any, there))) continue;
    const Ball ball(list, i, axis);
    const Flank flank(list, i, axis, ball);
    for (uint32_t b = left; b != 0; b &= b - 1) {
      const auto k = static_cast<size_t>(__builtin_ctz(b));
      const MF aside = hn::And(ball.may_enter(tubes[k]), flank.may_enter(tubes[k]));
      const MF may = hn::And(hn::And(slab.may_enter(tubes[k]), there), aside);
      met |= hn::AllFalse(df, may) ? 0 : 1u << k;
    }
    left &= ~met;
  }
  return met;
}

// Looks at corners, the middles of edges and of triangles; doubled and trebled, so is the tube.
bool Holds(const FilterList& list, const std::array<float, 3>& centre, const FilterCylinder& tube) {
  const DF df;
  const VF low = hn::Set(df, tube.low), low2 = hn::Add(low, low), low3 = hn::Add(low2, low);
  const VF high = hn::Set(df, tube.high), high2 = hn::Add(high, high), high3 = hn::Add(high2, high);
  const VF near = hn::Set(df, tube.radius * tube.radius);
  const VF near2 = hn::Mul(near, hn::Set(df, 4.0F)), near3 = hn::Mul(near, hn::Set(df, 9.0F));
  for (size_t i = 0; i < list.count; i += hn::Lanes(df)) {
    VF x[3], y[3], z[3];
    for (size_t c = 0; c < 3; ++c) {
      const float* at = &list.corner[3 * c * list.stride + i];
      x[c] = hn::Sub(hn::LoadU(df, at), hn::Set(df, centre[0]));
      z[c] = hn::Sub(hn::LoadU(df, at + list.stride), hn::Set(df, centre[1]));
      y[c] = hn::Sub(hn::LoadU(df, at + 2 * list.stride), hn::Set(df, centre[2]));
    }
    const auto inside = [&](VF px, VF py, VF pz, VF from, VF to, VF radius2) HWY_ATTR {
      const VF far2 = hn::MulAdd(px, px, hn::Mul(py, py));
      return hn::And(hn::And(hn::Gt(pz, from), hn::Lt(pz, to)), hn::Lt(far2, radius2));
    };
    MF in = inside(x[0], y[0], z[0], low, high, near);
    in = hn::Or(in, inside(x[1], y[1], z[1], low, high, near));
    in = hn::Or(in, inside(x[2], y[2], z[2], low, high, near));
    const VF x3 = hn::Add(x[0], x[1]), y3 = hn::Add(y[0], y[1]), z3 = hn::Add(z[0], z[1]);
    in = hn::Or(in, inside(x3, y3, z3, low2, high2, near2));
    in = hn::Or(in, inside(hn::Add(x[1], x[2]), hn::Add(y[1], y[2]), hn::Add(z[1], z[2]), low2,
                           high2, near2));
    in = hn::Or(in, inside(hn::Add(x[2], x[0]), hn::Add(y[2], y[0]), hn::Add(z[2], z[0]), low2,
                           high2, near2));
    in = hn::Or(
        in, inside(hn::Add(x3, x[2]), hn::Add(y3, y[2]), hn::Add(z3, z[2]), low3, high3, near3));
    if (!hn::AllFalse(df, hn::And(in, lanes_of(list.count - i)))) return true;
  }
  return false;
}

uint32_t Filter(const FilterList& list, const FilterView& view, FilterHits& hits) {
  const DF df;
  const DI di;
  const uint32_t all = (1u << view.count) - 1;
  uint32_t answered = 0;
  for (size_t i = 0; i < list.count && answered != all; i += hn::Lanes(df)) {
    const Slab slab(list, i, view.axis);
    const MF close = hn::And(lanes_of(list.count - i),
                             hn::Or(slab.may_enter(view.first), slab.may_enter(view.second)));
    if (hn::AllFalse(df, close)) continue;
    VF x[3], y[3], z[3];
    for (size_t c = 0; c < 3; ++c) {
      VF d[3];
      for (size_t k = 0; k < 3; ++k) {
        d[k] = hn::Sub(hn::LoadU(df, &list.corner[(3 * c + k) * list.stride + i]),
                       hn::Set(df, view.axis.centre[k]));
      }
      const auto along = [&](const std::array<float, 3>& axis) HWY_ATTR {
        return hn::MulAdd(
            d[2], hn::Set(df, axis[2]),
            hn::MulAdd(d[1], hn::Set(df, axis[1]), hn::Mul(d[0], hn::Set(df, axis[0]))));
      };
      x[c] = along(view.side);
      y[c] = along(view.front);
      z[c] = along(view.axis.up);
    }
    const Outline outline(x, y, z);
    const MF near =
        hn::And(close, hn::Or(outline.may_enter(view.first), outline.may_enter(view.second)));
    if (hn::AllFalse(df, near)) continue;
    // Points of the triangle that decide much: its corners, the middles of its edges and its own.
    VF height[7], far2[7];
    for (size_t c = 0; c < 7; ++c) {
      const auto point = [&](const VF(&v)[3]) HWY_ATTR {
        if (c < 3) return v[c];
        if (c < 6) return hn::Mul(hn::Add(v[c - 3], v[(c - 2) % 3]), hn::Set(df, 0.5F));
        return hn::Mul(hn::Add(hn::Add(v[0], v[1]), v[2]), hn::Set(df, 1.0F / 3));
      };
      const VF across = point(x), ahead = point(y);
      height[c] = point(z);
      far2[c] = hn::MulAdd(across, across, hn::Mul(ahead, ahead));
    }
    auto entered = hn::Zero(di);
    for (uint32_t left = all & ~answered; left != 0; left &= left - 1) {
      const auto b = static_cast<size_t>(__builtin_ctz(left));
      const FilterCylinder& tube = view.decisive[b];
      const MF may =
          hn::And(near, hn::And(outline.may_enter(view.whole[b]), slab.may_enter(view.whole[b])));
      if (hn::AllFalse(df, may)) continue;
      const VF low = hn::Set(df, tube.low), high = hn::Set(df, tube.high);
      const VF r2 = hn::Set(df, tube.radius * tube.radius);
      const auto holds = [&](size_t c) HWY_ATTR {
        return hn::And(hn::And(hn::Gt(height[c], low), hn::Lt(height[c], high)),
                       hn::Lt(far2[c], r2));
      };
      MF in = holds(0);
      for (size_t c = 1; c < 7; ++c) in = hn::Or(in, holds(c));
      if (hn::AllFalse(df, hn::And(in, may))) {
        entered =
            hn::Or(entered, hn::IfThenElseZero(hn::RebindMask(di, may), hn::Set(di, 1u << b)));
      } else {
        answered |= 1u << b;
      }
    }
    const auto any = hn::Ne(entered, hn::Zero(di));
    if (hn::AllFalse(di, any)) continue;
    hn::StoreU(simd::compress(hn::LoadU(di, &list.triangle[i]), any), di,
               &hits.triangle[hits.count]);
    hn::StoreU(simd::compress(entered, any), di, &hits.tubes[hits.count]);
    hits.count += hn::CountTrue(di, any);
  }
  return answered;
}

}  // namespace HWY_NAMESPACE
}  // namespace throng::bake
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace throng::bake {

HWY_EXPORT(FindPlanes);
HWY_EXPORT(Glance);
HWY_EXPORT(Holds);
HWY_EXPORT(HoldsRim);
HWY_EXPORT(Narrow);
HWY_EXPORT(Filter);

namespace {

// Of what is computed from coordinates of at most `extent` by a subtraction and a product with an
// axis, all in floats: below 20 roundings of 2^-24, so this is three times enough.
double margin_of(double extent) { return 4e-6 * extent + 1e-6; }

std::array<float, 3> to_floats(Vec3d v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

double largest(Vec3d v) { return std::max({std::fabs(v.x), std::fabs(v.y), std::fabs(v.z)}); }

// The share is for the rounding of squares and limits.
FilterCylinder grown(const BodySweep& sweep, double margin) {
  return {static_cast<float>(sweep.radius * (1 + 1e-6) + 2 * margin),
          static_cast<float>(sweep.low - margin - 1e-6 * std::fabs(sweep.low)),
          static_cast<float>(sweep.high + margin + 1e-6 * std::fabs(sweep.high))};
}

FilterCylinder shrunk(const BodySweep& sweep, double margin) {
  return {static_cast<float>(std::max(0.0, sweep.radius * (1 - 1e-6) - 2 * margin)),
          static_cast<float>(sweep.low + margin + 1e-6 * std::fabs(sweep.low)),
          static_cast<float>(sweep.high - margin - 1e-6 * std::fabs(sweep.high))};
}

// Heights up to `reach` are multiplied with a normal's share, which is rounded.
FilterAxis axis_of(const BodyFrame& frame, Vec3d centre, double margin, double reach) {
  return {.centre = to_floats(centre),
          .up = to_floats(frame.up),
          .margin = static_cast<float>(margin + 1e-6 * reach),
          .reach = static_cast<float>(reach)};
}

double reach_of(const BodySweep& sweep) {
  return std::max({sweep.radius, std::fabs(sweep.low), std::fabs(sweep.high)});
}

void make_room(FilterList& list, size_t count) {
  if (list.stride >= count + kFilterLanes) return;
  const size_t stride = std::max<size_t>(2 * list.stride, count + 4 * kFilterLanes);
  std::vector<float> corner(9 * stride);
  for (size_t k = 0; k < 9; ++k) {
    std::copy_n(list.corner.data() + k * list.stride, list.count, corner.data() + k * stride);
  }
  list.corner = std::move(corner);
  list.plane.resize(9 * stride);  // Nothing is in it before all are there.
  list.triangle.resize(stride);
  list.stride = stride;
}

}  // namespace

void FilterList::clear(Vec3d around) {
  origin = around;
  extent = 0;
  count = 0;
}

void FilterList::add(uint32_t id, const LocalTriangle& corners) {
  make_room(*this, count + 1);
  for (size_t c = 0; c < 3; ++c) {
    const Vec3d at = corners[c] - origin;
    const std::array<float, 3> p = to_floats(at);
    for (size_t k = 0; k < 3; ++k) corner[(3 * c + k) * stride + count] = p[k];
    extent = std::max(extent, largest(at));
  }
  triangle[count++] = id;
}

void FilterList::add(const Scene& scene, std::span<const uint32_t> ids) {
  make_room(*this, count + ids.size());
  Vec3d most{extent, extent, extent};
  for (const uint32_t id : ids) {
    float* out = corner.data() + count;
    for (const uint32_t index : scene.triangles[id]) {
      const Vec3d at = scene.positions[index] - origin;
      out[0] = static_cast<float>(at.x);
      out[stride] = static_cast<float>(at.y);
      out[2 * stride] = static_cast<float>(at.z);
      out += 3 * stride;
      most = {std::max(most.x, std::fabs(at.x)), std::max(most.y, std::fabs(at.y)),
              std::max(most.z, std::fabs(at.z))};
    }
    triangle[count++] = id;
  }
  extent = largest(most);
}

void FilterList::close() {
  if (count > 0) HWY_DYNAMIC_DISPATCH(FindPlanes)(*this, static_cast<float>(margin_of(extent)));
}

void narrow(const FilterList& list, const Box3d& box, FilterList& out) {
  out.clear(list.origin);
  make_room(out, list.count);
  out.extent = list.extent;
  const Vec3d low = box.min - list.origin, high = box.max - list.origin;
  const double margin = margin_of(std::max({list.extent, largest(low), largest(high)}));
  const Vec3d give{2 * margin, 2 * margin, 2 * margin};
  out.count = HWY_DYNAMIC_DISPATCH(Narrow)(list, to_floats((low + high) * 0.5).data(),
                                           to_floats((high - low) * 0.5 + give).data(), out);
}

uint32_t glance(const FilterList& list, const BodyFrame& frame, std::span<const BodySweep> tubes,
                uint32_t asked) {
  const Vec3d centre = frame.centre - list.origin;
  const double margin = margin_of(list.extent + largest(centre));
  std::array<FilterCylinder, 31> cylinders;
  double reach = 0;
  for (uint32_t left = asked; left != 0; left &= left - 1) {
    const auto i = static_cast<size_t>(std::countr_zero(left));
    cylinders[i] = grown(tubes[i], margin);
    reach = std::max(reach, reach_of(tubes[i]));
  }
  return HWY_DYNAMIC_DISPATCH(Glance)(list, axis_of(frame, centre, margin, reach), cylinders.data(),
                                      asked);
}

bool surely_enters(const FilterList& list, Vec3d centre, const BodySweep& tube) {
  const Vec3d at = centre - list.origin;
  const double margin = margin_of(list.extent + largest(at));
  return HWY_DYNAMIC_DISPATCH(Holds)(list, to_floats(at), shrunk(tube, margin));
}

uint32_t surely_enters_uphill(const FilterList& list, Vec3d centre,
                              std::span<const BodySweep> tubes, uint32_t asked) {
  const Vec3d at = centre - list.origin;
  const double margin = margin_of(list.extent + largest(at));
  std::array<FilterCylinder, 31> cylinders;
  double reach = 0;
  for (uint32_t left = asked; left != 0; left &= left - 1) {
    const auto i = static_cast<size_t>(std::countr_zero(left));
    cylinders[i] = shrunk(tubes[i], margin);
    reach = std::max(reach, reach_of(tubes[i]));
  }
  return HWY_DYNAMIC_DISPATCH(HoldsRim)(
      list, {to_floats(at), {0, 1, 0}, static_cast<float>(margin + 1e-6 * reach), 0},
      cylinders.data(), asked);
}

uint32_t filter(const FilterList& list, const FilterQuery& question, FilterHits& hits) {
  FilterView view;
  const Vec3d centre = question.frame.centre - list.origin;
  const double margin = margin_of(list.extent + largest(centre));
  view.axis = axis_of(question.frame, centre, margin,
                      std::max(reach_of(question.first), reach_of(question.second)));
  view.side = to_floats(question.frame.side);
  view.front = to_floats(question.frame.front);
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
  return HWY_DYNAMIC_DISPATCH(Filter)(list, view, hits);
}

}  // namespace throng::bake
#endif  // HWY_ONCE
