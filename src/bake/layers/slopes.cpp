// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cstdlib>

#include "bake/layers/legality.h"
#include "bake/layers/surface_planes.h"

// Feet on a cell lie on a plane p with gradient g. For a body at P and a solid at Q within its
// radius r,
// y(Q) - p(P) = (y(Q) - p(Q)) + g (Q - P) <= (y(Q) - p(Q)) + |g| r, and over a cell B whose solid
// tops out at top, y(Q) - p(Q) <= top - min over B of p. So the body is free if, for the highest of
// these over all cells that it reaches, the sum stays below its bottom. Whole cells are compared
// with the plane where they are, not with one height. At creases, where the feet's slope is the
// gentler one, a plane between the two may prove what theirs cannot; it then owes how far the feet
// can be from it on the cell.

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bake/layers/slopes.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
#include <hwy/highway.h>

#include "bake/columns/vector_bits-inl.h"

HWY_BEFORE_NAMESPACE();
namespace throng::bake {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using DI = hn::CappedTag<int32_t, 16>;
using VI = hn::Vec<DI>;

constexpr int32_t kRounding = 2;  // of feet and planes [mm]

HWY_INLINE VI load_feet(const uint16_t* feet) {
  const DI di;
  return hn::PromoteTo(di, hn::LoadU(hn::Rebind<uint16_t, DI>(), feet));
}

// As sheet_slope: the gentler of b - a and c - b, 0 if they disagree or a cell has no feet.
HWY_INLINE VI slope_of(VI a, VI b, VI c) {
  const DI di;
  const VI none = hn::Set(di, kNone16), zero = hn::Zero(di);
  const VI first = hn::Sub(b, a), second = hn::Sub(c, b);
  const auto up = hn::And(hn::Gt(first, zero), hn::Gt(second, zero));
  const auto down = hn::Not(hn::Or(hn::Gt(first, zero), hn::Gt(second, zero)));
  const auto all = hn::And(hn::Ne(a, none), hn::And(hn::Ne(b, none), hn::Ne(c, none)));
  const VI gentler =
      hn::IfThenElse(up, hn::Min(first, second), hn::IfThenElseZero(down, hn::Max(first, second)));
  return hn::IfThenElseZero(all, gentler);
}

// Half of a difference, rounded towards zero.
HWY_INLINE VI half(VI difference) {
  return hn::ShiftRight<1>(hn::Sub(difference, hn::ShiftRight<31>(difference)));
}

// The planes of one row of cells: the feet's own, and at creases the one between. [mm per cell]
struct RowPlanes {
  alignas(64) int32_t gx[kTileSide + 32], gz[kTileSide + 32];
  alignas(64) int32_t between_x[kTileSide + 32], between_z[kTileSide + 32];
  uint64_t creased;  // cells with feet on all four sides

  void make(const Layer& layer, int32_t z) {
    const DI di;
    const int32_t lanes = static_cast<int32_t>(hn::Lanes(di));
    const VI none = hn::Set(di, kNone16);
    const uint16_t* row = &layer.feet[static_cast<size_t>(z * kTileSide)];
    const uint16_t* centre =
        &layer.feet[static_cast<size_t>(std::clamp(z, 1, kTileSide - 2) * kTileSide)];
    uint64_t beside = 0, around = 0;
    for (int32_t x = 0; x < kTileSide; x += lanes) {
      // Written for x + 1: rows are read from their first cell on, never before the array.
      const VI left = load_feet(row + x), right = load_feet(row + x + 2);
      hn::StoreU(slope_of(left, load_feet(row + x + 1), right), di, gx + x + 1);
      hn::StoreU(half(hn::Sub(right, left)), di, between_x + x + 1);
      beside |= bits_of(di, hn::And(hn::Ne(left, none), hn::Ne(right, none))) << x;
      const VI up = load_feet(centre + x - kTileSide), down = load_feet(centre + x + kTileSide);
      hn::Store(slope_of(up, load_feet(centre + x), down), di, gz + x);
      hn::Store(half(hn::Sub(down, up)), di, between_z + x);
      around |= bits_of(di, hn::And(hn::Ne(up, none), hn::Ne(down, none))) << x;
    }
    gx[0] = gx[1];
    gx[kTileSide - 1] = gx[kTileSide - 2];
    between_x[0] = between_z[0] = 0;
    constexpr uint64_t kInner = ~uint64_t{0} >> 1 & ~uint64_t{1};
    creased = z == 0 || z == kTileSide - 1 ? 0 : beside << 1 & around & kInner;
  }
};

// Of cells (x, z) and on, one vector: those whose body is free when judged by the given planes,
// which may err by `owed`. All in half millimetres: centres of cells lie half a cell from their
// corners.
HWY_INLINE uint64_t free_lanes(const LayerWindow& window, const BodyWindow& body, int32_t x,
                               int32_t z, VI height, VI feet_tilt, VI gx, VI gz, VI owed) {
  const DI di;
  const hn::RebindToFloat<DI> df;
  const hn::Rebind<uint16_t, DI> dh;
  const auto fx = hn::ConvertTo(df, gx), fz = hn::ConvertTo(df, gz);
  // Rounded up by more than the floats err.
  const auto reach = hn::Mul(hn::Sqrt(hn::Add(hn::Mul(fx, fx), hn::Mul(fz, fz))),
                             hn::Set(df, static_cast<float>(body.radius * (1 + 1e-6))));
  const VI lean = hn::ConvertTo(di, hn::Ceil(reach));
  const VI budget =
      hn::ShiftLeft<1>(hn::Sub(hn::Sub(hn::Set(di, body.bottom - kRounding), lean), owed));
  const VI tilt = hn::Add(hn::Abs(gx), hn::Abs(gz));  // of the plane over a cell [mm]
  const VI bottom = hn::Set(di, body.bottom);
  // A column may also pass as in the window: its whole top against the lowest and highest feet.
  const VI level_high = hn::ShiftLeft<1>(hn::Add(hn::Sub(height, feet_tilt), bottom));
  const VI level_low = hn::ShiftLeft<1>(hn::Sub(hn::Add(height, feet_tilt), bottom));
  const VI max_above = hn::Sub(budget, tilt);  // by which a top may pass the plane, up or down
  auto bad = hn::Lt(budget, hn::Zero(di));
  for (int32_t dz = -body.reach; dz <= body.reach; ++dz) {
    const int32_t w = body.width[static_cast<size_t>(std::abs(dz))];
    VI middle = hn::Add(height, hn::Sub(hn::Mul(gz, hn::Set(di, dz)), hn::Mul(gx, hn::Set(di, w))));
    const uint16_t* tops = &window.top[window.index(x - w, z + dz)];
    for (int32_t dx = -w; dx <= w; ++dx, ++tops) {
      const VI top = hn::ShiftLeft<1>(hn::PromoteTo(di, hn::LoadU(dh, tops)));
      const VI above = hn::Sub(top, hn::ShiftLeft<1>(middle));
      const auto high = hn::And(hn::Gt(top, level_high), hn::Gt(above, max_above));
      const auto low = hn::And(hn::Lt(top, level_low), hn::Gt(hn::Neg(above), max_above));
      bad = hn::Or(bad, hn::Or(high, low));
      middle = hn::Add(middle, gx);
    }
    if (hn::AllTrue(di, bad)) return 0;
  }
  return bits_of(di, hn::Not(bad));
}

void RecheckSlopes(const Layer& layer, const BodyWindow& body, const LegalityScratch& scratch,
                   LegalCells& cells) {
  const DI di;
  const hn::Rebind<uint16_t, DI> dh;
  const VI zero = hn::Zero(di);
  const int32_t lanes = static_cast<int32_t>(hn::Lanes(di));
  RowPlanes planes;
  for (int32_t z = 0; z < kTileSide; ++z) {
    const uint64_t row = cells.slanted[static_cast<size_t>(z)];
    if (row == 0) continue;
    planes.make(layer, z);
    for (int32_t x = 0; x < kTileSide; x += lanes) {
      const uint64_t asked = (row >> x) & ((uint64_t{1} << lanes) - 1);
      if (asked == 0) continue;
      const size_t cell = static_cast<size_t>(z * kTileSide + x);
      const VI height = load_feet(&layer.feet[cell]);
      const VI tilt = hn::PromoteTo(di, hn::LoadU(dh, &scratch.tilt[cell]));
      const VI gx = hn::Load(di, planes.gx + x), gz = hn::Load(di, planes.gz + x);
      const uint64_t sloped = asked & bits_of(di, hn::Ne(hn::Or(gx, gz), zero));
      uint64_t free = 0;
      if (sloped != 0) {
        free = sloped & free_lanes(scratch.window, body, x, z, height, tilt, gx, gz, zero);
      }
      const VI mx = hn::Load(di, planes.between_x + x), mz = hn::Load(di, planes.between_z + x);
      const VI apart = hn::Add(hn::Abs(hn::Sub(mx, gx)), hn::Abs(hn::Sub(mz, gz)));
      const uint64_t creased =
          asked & ~free & (planes.creased >> x) & bits_of(di, hn::Ne(apart, zero));
      if (creased != 0) {
        const VI owed = hn::ShiftRight<1>(hn::Add(apart, hn::Set(di, 1)));
        free |= creased & free_lanes(scratch.window, body, x, z, height, tilt, mx, mz, owed);
      }
      cells.legal[static_cast<size_t>(z)] |= free << x;
    }
  }
}

// The finer test, for the same cells. With the feet's plane p on A, through f with gradient a, and
// a plane s of gradient s' for comparison,
//   y(Q) - p(P) = (y(Q) - s(Q)) + s' (Q - P) + (s(P) - p(P)),
// where the middle is at most |s'| r, and a difference of planes over a cell is at most the one at
// its centre and half of what their gradients differ by. s is the surface's plane on A, which is
// right at ridges, or on B, which is right in valleys; both are better than none on a slope.
using DF = hn::RebindToFloat<DI>;
using VF = hn::Vec<DF>;

// Feet are rounded to whole mm when they are read; the rest is for the arithmetic. [mm]
constexpr float kFeetRounding = 0.6f;

HWY_INLINE VF half_apart(VF ax, VF az, VF bx, VF bz) {
  const DF df;
  const VF apart = hn::Add(hn::Abs(hn::Sub(ax, bx)), hn::Abs(hn::Sub(az, bz)));
  return hn::Mul(apart, hn::Set(df, 0.5f));
}

HWY_INLINE uint64_t free_by_planes(const LayerWindow& window, const CellPlanes& planes,
                                   const BodyWindow& body, int32_t x, int32_t z, uint64_t asked,
                                   VI feet_mm, VI feet_tilt, VF ax, VF az) {
  const DI di;
  const DF df;
  const hn::Rebind<uint16_t, DI> dh;
  const VF feet = hn::ConvertTo(df, feet_mm);
  const VF radius = hn::Set(df, static_cast<float>(body.radius));
  const VF budget = hn::Set(df, static_cast<float>(body.bottom) - kFeetRounding);
  const VI bottom = hn::Set(di, body.bottom);
  const VF level_high = hn::ConvertTo(df, hn::Add(hn::Sub(feet_mm, feet_tilt), bottom));
  const VF level_low = hn::ConvertTo(df, hn::Sub(hn::Add(feet_mm, feet_tilt), bottom));
  const size_t own = window.index(x, z);
  const VF sx = hn::LoadU(df, &planes.slope_x[own]), sz = hn::LoadU(df, &planes.slope_z[own]);
  // What comparing with A's plane costs in any case, and how much its feet are off it.
  const VF own_cost =
      hn::Add(half_apart(sx, sz, ax, az), hn::Mul(hn::LoadU(df, &planes.steepness[own]), radius));
  const VF surface = hn::LoadU(df, &planes.height[own]);
  const VF own_up = hn::Sub(budget, hn::Add(own_cost, hn::Sub(surface, feet)));
  const VF own_down = hn::Sub(budget, hn::Sub(own_cost, hn::Sub(surface, feet)));
  for (int32_t dz = -body.reach; dz <= body.reach; ++dz) {
    const int32_t w = body.width[static_cast<size_t>(std::abs(dz))];
    const VF fz = hn::Set(df, static_cast<float>(dz));
    const VF across = hn::Add(surface, hn::Mul(sz, fz));
    for (int32_t dx = -w; dx <= w; ++dx) {
      const size_t i = window.index(x + dx, z + dz);
      const VF fx = hn::Set(df, static_cast<float>(dx));
      const VF height = hn::LoadU(df, &planes.height[i]);
      const VF bx = hn::LoadU(df, &planes.slope_x[i]), bz = hn::LoadU(df, &planes.slope_z[i]);
      const VF excess = hn::Max(hn::LoadU(df, &planes.excess[i]), hn::Zero(df));
      const VF over_own = hn::Sub(height, hn::Add(across, hn::Mul(sx, fx)));
      const VF own_apart = half_apart(bx, bz, sx, sz);
      const VF highest = hn::Add(hn::Add(over_own, own_apart), excess);
      const auto own_low = hn::Le(highest, own_up);
      const auto own_high = hn::Le(hn::Sub(own_apart, over_own), own_down);
      // Mostly the slope continues, and A's plane suffices.
      if ((asked & ~bits_of(df, hn::And(own_low, own_high))) == 0) continue;
      const VF over_theirs =
          hn::Sub(hn::Sub(hn::Sub(height, hn::Mul(bx, fx)), hn::Mul(bz, fz)), feet);
      const VF their_cost =
          hn::Add(half_apart(bx, bz, ax, az), hn::Mul(hn::LoadU(df, &planes.steepness[i]), radius));
      const VF top = hn::ConvertTo(df, hn::PromoteTo(di, hn::LoadU(dh, &window.top[i])));
      const auto low = hn::Or(hn::Le(hn::Add(hn::Add(over_theirs, their_cost), excess), budget),
                              hn::Le(top, level_high));
      const auto high =
          hn::Or(hn::Le(hn::Sub(their_cost, over_theirs), budget), hn::Ge(top, level_low));
      asked &= bits_of(df, hn::And(hn::Or(own_low, low), hn::Or(own_high, high)));
      if (asked == 0) return 0;
    }
  }
  return asked;
}

void RecheckPlanes(const Layer& layer, const BodyWindow& body, const CellPlanes& surface,
                   const LegalityScratch& scratch, LegalCells& cells) {
  const DI di;
  const DF df;
  const hn::Rebind<uint16_t, DI> dh;
  const int32_t lanes = static_cast<int32_t>(hn::Lanes(di));
  RowPlanes planes;
  for (int32_t z = 0; z < kTileSide; ++z) {
    const size_t r = static_cast<size_t>(z);
    const uint64_t row = cells.slanted[r] & ~cells.legal[r];
    if (row == 0) continue;
    planes.make(layer, z);
    for (int32_t x = 0; x < kTileSide; x += lanes) {
      const uint64_t asked = (row >> x) & ((uint64_t{1} << lanes) - 1);
      if (asked == 0) continue;
      const size_t cell = static_cast<size_t>(z * kTileSide + x);
      const uint64_t free =
          free_by_planes(scratch.window, surface, body, x, z, asked, load_feet(&layer.feet[cell]),
                         hn::PromoteTo(di, hn::LoadU(dh, &scratch.tilt[cell])),
                         hn::ConvertTo(df, hn::Load(di, planes.gx + x)),
                         hn::ConvertTo(df, hn::Load(di, planes.gz + x)));
      cells.legal[r] |= free << x;
    }
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace throng::bake
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace throng::bake {

HWY_EXPORT(RecheckSlopes);
HWY_EXPORT(RecheckPlanes);

void recheck_slopes(const Layer& layer, const BodyWindow& body, const LegalityScratch& scratch,
                    LegalCells& cells) {
  HWY_DYNAMIC_DISPATCH(RecheckSlopes)(layer, body, scratch, cells);
}

void recheck_planes(const Layer& layer, const BodyWindow& body, const CellPlanes& planes,
                    const LegalityScratch& scratch, LegalCells& cells) {
  HWY_DYNAMIC_DISPATCH(RecheckPlanes)(layer, body, planes, scratch, cells);
}

}  // namespace throng::bake
#endif  // HWY_ONCE
