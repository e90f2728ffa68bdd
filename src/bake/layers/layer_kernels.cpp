// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "bake/layers/layer_kernels.h"

#include <algorithm>

// Linear passes over the 64 x 64 cells of a layer or a free-span layer, 16 to 32 cells a vector;
// results are rows of bits.

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bake/layers/layer_kernels.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
#include <hwy/highway.h>

#include "bake/columns/vector_bits-inl.h"

HWY_BEFORE_NAMESPACE();
namespace throng::bake {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using DI = hn::CappedTag<int32_t, 16>;
using DH = hn::Rebind<uint16_t, DI>;  // 16-bit halves of a vector of heights
using DB = hn::Rebind<uint8_t, DI>;
using DU = hn::CappedTag<uint16_t, 32>;
using DC = hn::Rebind<uint8_t, DU>;

// Free spans a and b continue each other: a small step, and enough free over both.
HWY_INLINE hn::Mask<DI> linked(hn::Vec<DI> top_a, hn::Vec<DI> ceiling_a, hn::Vec<DI> top_b,
                               hn::Vec<DI> ceiling_b, hn::Vec<DI> max_step,
                               hn::Vec<DI> min_free_span) {
  const auto high = hn::Max(top_a, top_b), low = hn::Min(top_a, top_b);
  const auto headroom = hn::Sub(hn::Min(ceiling_a, ceiling_b), high);
  return hn::Not(hn::Or(hn::Gt(hn::Sub(high, low), max_step), hn::Lt(headroom, min_free_span)));
}

void LinkFreeSpans(const TileFreeSpans& free_spans, int32_t free_layer, const LinkRule& rule,
                   const world::CellRows* only, FreeSpanLinks& links) {
  const DI di;
  const int32_t lanes = static_cast<int32_t>(hn::Lanes(di));
  const FreeSpanLayer& g = *free_spans.layers[static_cast<size_t>(free_layer)];
  const int32_t max_step = rule.step, min_free_span = rule.free_span;
  const auto step = hn::Set(di, max_step), free_span = hn::Set(di, min_free_span),
             k = hn::Set(di, free_layer);
  for (int32_t z = 0; z < kTileSide; ++z) {
    uint64_t has = 0, left = 0, up = 0;
    for (int32_t x = 0; x < kTileSide; x += lanes) {
      const size_t c = static_cast<size_t>(z * kTileSide + x);
      const auto top = hn::Load(di, &g.top[c]), ceiling = hn::Load(di, &g.ceiling[c]);
      has |= bits_of(di, hn::Gt(hn::Load(di, &free_spans.count[c]), k)) << x;
      if (c > 0) {
        left |= bits_of(di, linked(top, ceiling, hn::LoadU(di, &g.top[c] - 1),
                                   hn::LoadU(di, &g.ceiling[c] - 1), step, free_span))
                << x;
      } else {
        // The first cell has nothing to its left; the others of its vector look one back.
        for (int32_t i = 1; i < lanes; ++i) {
          const size_t at = static_cast<size_t>(i);
          const int32_t high = std::max(g.top[at], g.top[at - 1]),
                        low = std::min(g.top[at], g.top[at - 1]);
          const int32_t ceil = std::min(g.ceiling[at], g.ceiling[at - 1]);
          const bool ok = static_cast<int64_t>(high) - low <= max_step &&
                          static_cast<int64_t>(ceil) - high >= min_free_span;
          left |= static_cast<uint64_t>(ok) << i;
        }
      }
      if (z == 0) continue;
      const size_t above = c - kTileSide;
      up |= bits_of(di, linked(top, ceiling, hn::Load(di, &g.top[above]),
                               hn::Load(di, &g.ceiling[above]), step, free_span))
            << x;
    }
    const size_t row = static_cast<size_t>(z);
    if (only != nullptr) has &= (*only)[row];
    links.has[row] = has;
    links.left[row] = left & has & (has << 1);
    links.up[row] = z > 0 ? up & has & links.has[row - 1] : 0;
  }
}

void LowFreeSpans(const TileFreeSpans& free_spans, int32_t free_layer, int32_t height,
                  world::CellRows& rows) {
  const DI di;
  const FreeSpanLayer& g = *free_spans.layers[static_cast<size_t>(free_layer)];
  const auto k = hn::Set(di, free_layer), least = hn::Set(di, height),
             sky = hn::Set(di, kOpenSkyMm);
  for (size_t z = 0; z < kTileSide; ++z) {
    rows[z] = 0;
    for (size_t x = 0; x < kTileSide; x += hn::Lanes(di)) {
      const size_t c = z * kTileSide + x;
      const auto ceiling = hn::Load(di, &g.ceiling[c]);
      const auto low =
          hn::And(hn::Ne(ceiling, sky), hn::Lt(hn::Sub(ceiling, hn::Load(di, &g.top[c])), least));
      rows[z] |= bits_of(di, hn::And(low, hn::Gt(hn::Load(di, &free_spans.count[c]), k))) << x;
    }
  }
}

TopRange FreeSpanRange(const TileFreeSpans& free_spans, int32_t free_layer) {
  const DI di;
  const FreeSpanLayer& g = *free_spans.layers[static_cast<size_t>(free_layer)];
  auto low = hn::Set(di, INT32_MAX), high = hn::Set(di, INT32_MIN);
  for (size_t c = 0; c < kTileArea; c += hn::Lanes(di)) {
    const auto has = hn::Gt(hn::Load(di, &free_spans.count[c]), hn::Set(di, free_layer));
    const auto top = hn::Load(di, &g.top[c]);
    low = hn::IfThenElse(has, hn::Min(low, top), low);
    high = hn::IfThenElse(has, hn::Max(high, top), high);
  }
  return {hn::GetLane(hn::MinOfLanes(di, low)), hn::GetLane(hn::MaxOfLanes(di, high))};
}

TopRange RunRange(const FreeSpanLayer& free_layer, int32_t z, uint64_t cells) {
  const DI di;
  const int32_t lanes = static_cast<int32_t>(hn::Lanes(di));
  auto low = hn::Set(di, INT32_MAX), high = hn::Set(di, INT32_MIN);
  for (int32_t x = 0; x < kTileSide; x += lanes) {
    const uint64_t here = cells >> x & ((1ULL << lanes) - 1);
    if (here == 0) continue;
    const auto mask = mask_of(di, here);
    const auto top = hn::Load(di, &free_layer.top[static_cast<size_t>(z * kTileSide + x)]);
    low = hn::IfThenElse(mask, hn::Min(low, top), low);
    high = hn::IfThenElse(mask, hn::Max(high, top), high);
  }
  return {hn::GetLane(hn::MinOfLanes(di, low)), hn::GetLane(hn::MaxOfLanes(di, high))};
}

void ClearLayer(Layer& layer) {
  const DU du;
  const auto none = hn::Set(du, kNone16), zero = hn::Zero(du);
  for (size_t c = 0; c < kTileArea; c += hn::Lanes(du)) {
    hn::Store(none, du, &layer.top[c]);
    hn::Store(zero, du, &layer.ceiling[c]);
    hn::Store(none, du, &layer.feet[c]);
  }
}

// Lower halves of 32-bit lanes that hold 16-bit values.
HWY_INLINE hn::Vec<DH> narrow(hn::Vec<DI> v) {
  const DH dh;
  const hn::RebindToUnsigned<DI> dw;
  return hn::TruncateTo(dh, hn::BitCast(dw, v));
}

void WriteFreeSpans(const FreeSpanLayer& free_layer, int32_t z, uint64_t cells, Layer& layer) {
  const DI di;
  const DH dh;
  const DB db;
  const int32_t lanes = static_cast<int32_t>(hn::Lanes(di));
  const auto base = hn::Set(di, layer.base), none = hn::Set(di, kNone16);
  const auto sky = hn::Set(di, kOpenSkyMm), highest = hn::Set(di, kHighCeiling16);
  for (int32_t x = 0; x < kTileSide; x += lanes) {
    const uint64_t here = cells >> x & (lanes < 64 ? (1ULL << lanes) - 1 : ~0ULL);
    if (here == 0) continue;
    const size_t c = static_cast<size_t>(z * kTileSide + x);
    const auto support = hn::Load(di, &free_layer.support[c]);
    const auto top = hn::Sub(hn::Load(di, &free_layer.top[c]), base);
    const auto raw_ceiling = hn::Load(di, &free_layer.ceiling[c]);
    // An open sky would overflow the difference: it is replaced after it.
    const auto ceiling = hn::IfThenElse(hn::Eq(raw_ceiling, sky), none,
                                        hn::Min(hn::Sub(raw_ceiling, base), highest));
    const auto feet = hn::Sub(hn::ShiftRight<8>(support), base);
    const auto code = hn::And(support, hn::Set(di, 255));
    const auto bad =
        hn::Or(hn::Eq(support, hn::Set(di, kNoSupport)),
               hn::Or(hn::Lt(feet, hn::Zero(di)), hn::Gt(feet, hn::Set(di, kHighCeiling16))));
    const auto kept = hn::IfThenElse(bad, none, feet);
    const auto codes = hn::TruncateTo(db, hn::BitCast(hn::RebindToUnsigned<DI>(), code));
    if (here == (lanes < 64 ? (1ULL << lanes) - 1 : ~0ULL)) {
      hn::StoreU(narrow(top), dh, &layer.top[c]);
      hn::StoreU(narrow(ceiling), dh, &layer.ceiling[c]);
      hn::StoreU(narrow(kept), dh, &layer.feet[c]);
      hn::StoreU(codes, db, &layer.code[c]);
    } else {
      const auto mask = mask_of(dh, here);
      hn::BlendedStore(narrow(top), mask, dh, &layer.top[c]);
      hn::BlendedStore(narrow(ceiling), mask, dh, &layer.ceiling[c]);
      hn::BlendedStore(narrow(kept), mask, dh, &layer.feet[c]);
      hn::BlendedStore(codes, mask_of(db, here), db, &layer.code[c]);
    }
  }
}

void Summarise(Layer& layer) {
  const DU du;
  const DC dc;
  const auto none = hn::Set(du, kNone16), zero = hn::Zero(du), one = hn::Set(du, 1);
  auto low_top = none, high_top = zero, low_feet = none, high_feet = zero, low_ceiling = none;
  auto cells = zero, present = zero, low_code = none, high_code = zero;
  for (size_t c = 0; c < kTileArea; c += hn::Lanes(du)) {
    const auto top = hn::Load(du, &layer.top[c]);
    const auto feet = hn::Load(du, &layer.feet[c]);
    const auto code = hn::PromoteTo(du, hn::LoadU(dc, &layer.code[c]));
    const auto free_span = hn::Ne(top, none), stands = hn::Ne(feet, none);
    low_top = hn::Min(low_top, top);
    high_top = hn::Max(high_top, hn::IfThenElseZero(free_span, top));
    low_feet = hn::Min(low_feet, feet);
    high_feet = hn::Max(high_feet, hn::IfThenElseZero(stands, feet));
    low_ceiling =
        hn::Min(low_ceiling, hn::IfThenElse(free_span, hn::Load(du, &layer.ceiling[c]), none));
    cells = hn::Add(cells, hn::IfThenElseZero(free_span, one));
    present = hn::Add(present, hn::IfThenElseZero(stands, one));
    low_code = hn::Min(low_code, hn::IfThenElse(stands, code, none));
    high_code = hn::Max(high_code, hn::IfThenElseZero(stands, code));
  }
  layer.low_top = hn::GetLane(hn::MinOfLanes(du, low_top));
  layer.high_top = hn::GetLane(hn::MaxOfLanes(du, high_top));
  layer.low_feet = hn::GetLane(hn::MinOfLanes(du, low_feet));
  layer.high_feet = hn::GetLane(hn::MaxOfLanes(du, high_feet));
  layer.low_ceiling = hn::GetLane(hn::MinOfLanes(du, low_ceiling));
  alignas(64) uint16_t sums[2][32] = {};
  hn::Store(cells, du, sums[0]);
  hn::Store(present, du, sums[1]);
  layer.cells = layer.present = 0;
  for (size_t i = 0; i < hn::Lanes(du); ++i) {
    layer.cells += sums[0][i];
    layer.present += sums[1][i];
  }
  layer.some_code = static_cast<uint8_t>(hn::GetLane(hn::MaxOfLanes(du, high_code)));
  layer.one_code = hn::GetLane(hn::MinOfLanes(du, low_code)) == layer.some_code;
}

bool MayBePlane(const Layer& layer) {
  const DU du;
  const auto none = hn::Set(du, kNone16), bias = hn::Set(du, 32768);
  auto low_x = none, high_x = hn::Zero(du), low_z = none, high_z = hn::Zero(du);
  const auto widen = [&](hn::Vec<DU> a, hn::Vec<DU> b, hn::Mask<DU> both, hn::Vec<DU>& low,
                         hn::Vec<DU>& high) {
    const auto difference = hn::Add(hn::Sub(b, a), bias);
    low = hn::IfThenElse(both, hn::Min(low, difference), low);
    high = hn::IfThenElse(both, hn::Max(high, difference), high);
  };
  const auto spread = [&](hn::Vec<DU> low, hn::Vec<DU> high) {
    return int32_t{hn::GetLane(hn::MaxOfLanes(du, high))} -
           int32_t{hn::GetLane(hn::MinOfLanes(du, low))};
  };
  const hn::Mask<DU> not_last = [&] {
    return hn::Lt(hn::Iota(du, 1), hn::Set(du, static_cast<uint16_t>(hn::Lanes(du))));
  }();
  for (int32_t z = 0; z < kTileSide; ++z) {
    for (int32_t x = 0; x < kTileSide; x += static_cast<int32_t>(hn::Lanes(du))) {
      const size_t c = static_cast<size_t>(z * kTileSide + x);
      const auto feet = hn::Load(du, &layer.feet[c]);
      const auto stands = hn::Ne(feet, none);
      const auto right = hn::LoadU(du, &layer.feet[0] + c + 1);
      auto both = hn::And(stands, hn::Ne(right, none));
      if (x + static_cast<int32_t>(hn::Lanes(du)) == kTileSide) both = hn::And(both, not_last);
      widen(feet, right, both, low_x, high_x);
      if (z + 1 == kTileSide) continue;
      const auto below = hn::Load(du, &layer.feet[c + kTileSide]);
      widen(feet, below, hn::And(stands, hn::Ne(below, none)), low_z, high_z);
    }
    if (z % 8 == 7 && (spread(low_x, high_x) > 2 || spread(low_z, high_z) > 2)) return false;
  }
  return true;
}

// Size of the gentler of the differences b - a and c - b, 0 if they disagree or a cell has no feet.
HWY_INLINE hn::Vec<DU> gentler(hn::Vec<DU> a, hn::Vec<DU> b, hn::Vec<DU> c) {
  const DU du;
  const auto none = hn::Set(du, kNone16);
  const auto first = hn::Sub(hn::Max(a, b), hn::Min(a, b)),
             second = hn::Sub(hn::Max(b, c), hn::Min(b, c));
  const auto agree = hn::Not(hn::Xor(hn::Gt(b, a), hn::Gt(c, b)));
  const auto all = hn::And(hn::Ne(a, none), hn::And(hn::Ne(b, none), hn::Ne(c, none)));
  return hn::IfThenElseZero(hn::And(agree, all), hn::Min(first, second));
}

void MakeTilt(const Layer& layer, std::array<uint16_t, kTileArea>& tilt) {
  const DU du;
  const size_t lanes = hn::Lanes(du);
  alignas(64) uint16_t along[kTileSide], across[kTileSide + 64];
  for (size_t z = 0; z < kTileSide; ++z) {
    if (layer.useful[z] == 0) continue;
    const size_t middle = std::clamp<size_t>(z, 1, kTileSide - 2);
    const uint16_t* row = &layer.feet[z * kTileSide];
    const uint16_t* centre = &layer.feet[middle * kTileSide];
    for (size_t x = 0; x < kTileSide; x += lanes) {
      hn::Store(gentler(hn::Load(du, centre + x - kTileSide), hn::Load(du, centre + x),
                        hn::Load(du, centre + x + kTileSide)),
                du, along + x);
      // Written for x + 1: rows are read from their first cell on, never before the array.
      hn::StoreU(
          gentler(hn::Load(du, row + x), hn::LoadU(du, row + x + 1), hn::LoadU(du, row + x + 2)),
          du, across + x + 1);
    }
    across[0] = across[1];
    across[kTileSide - 1] = across[kTileSide - 2];
    for (size_t x = 0; x < kTileSide; x += lanes) {
      hn::StoreU(hn::AverageRound(hn::Load(du, along + x), hn::Load(du, across + x)), du,
                 &tilt[z * kTileSide + x]);
    }
  }
}

void KeepFeet(const world::CellRows& rows, Layer& layer) {
  const DU du;
  const auto none = hn::Set(du, kNone16);
  auto low = none, high = hn::Zero(du);
  layer.present = 0;
  for (size_t z = 0; z < kTileSide; ++z) {
    uint64_t present = 0;
    for (size_t x = 0; x < kTileSide; x += hn::Lanes(du)) {
      uint16_t* at = &layer.feet[z * kTileSide + x];
      const auto feet = hn::IfThenElse(mask_of(du, rows[z] >> x), hn::Load(du, at), none);
      const auto stands = hn::Ne(feet, none);
      low = hn::Min(low, feet);
      high = hn::Max(high, hn::IfThenElseZero(stands, feet));
      present |= bits_of(du, stands) << x;
      hn::Store(feet, du, at);
    }
    layer.present += static_cast<int32_t>(hwy::PopCount(present));
  }
  layer.low_feet = hn::GetLane(hn::MinOfLanes(du, low));
  layer.high_feet = hn::GetLane(hn::MaxOfLanes(du, high));
}

bool UsefulCells(const Layer& layer, const BodyNeed& need, world::CellRows& rows) {
  const DU du;
  const DC dc;
  const auto none = hn::Set(du, kNone16);
  const auto set = [&](int32_t v) {
    return hn::Set(du, static_cast<uint16_t>(std::clamp(v, 0, int32_t{kHighCeiling16})));
  };
  const auto bottom = set(need.bottom), height = set(need.height), barred = set(need.blocked_code);
  const auto at_most = [](hn::Vec<DU> a, hn::Vec<DU> b) { return hn::Eq(hn::Min(a, b), a); };
  uint64_t any = 0;
  for (size_t z = 0; z < kTileSide; ++z) {
    uint64_t row = 0;
    for (size_t x = 0; x < kTileSide; x += hn::Lanes(du)) {
      const size_t c = z * kTileSide + x;
      const auto feet = hn::Load(du, &layer.feet[c]);
      const auto code = hn::PromoteTo(du, hn::LoadU(dc, &layer.code[c]));
      const auto stands = hn::And(hn::Ne(feet, none), hn::Ne(code, barred));
      const auto low = at_most(hn::Load(du, &layer.top[c]), hn::SaturatedAdd(feet, bottom));
      // Saturated, a head passes under the open sky only.
      const auto headroom =
          at_most(hn::SaturatedAdd(feet, height), hn::Load(du, &layer.ceiling[c]));
      row |= bits_of(du, hn::And(stands, hn::And(low, headroom))) << x;
    }
    any |= rows[z] = row;
  }
  return any != 0;
}

void PresentBits(const Layer& layer, std::array<uint64_t, kTileSide>& rows) {
  const DU du;
  const auto none = hn::Set(du, kNone16);
  for (size_t z = 0; z < kTileSide; ++z) {
    uint64_t row = 0;
    for (size_t x = 0; x < kTileSide; x += hn::Lanes(du)) {
      row |= bits_of(du, hn::Ne(hn::Load(du, &layer.feet[z * kTileSide + x]), none)) << x;
    }
    rows[z] = row;
  }
}

HeightRange CeilingRange(const Layer& layer) {
  const DU du;
  const auto none = hn::Set(du, kNone16);
  auto low = none, high = hn::Zero(du);
  for (size_t c = 0; c < kTileArea; c += hn::Lanes(du)) {
    const auto stands = hn::Ne(hn::Load(du, &layer.feet[c]), none);
    const auto ceiling = hn::Load(du, &layer.ceiling[c]);
    low = hn::Min(low, hn::IfThenElse(stands, ceiling, none));
    high = hn::Max(high, hn::IfThenElseZero(stands, ceiling));
  }
  return {hn::GetLane(hn::MinOfLanes(du, low)), hn::GetLane(hn::MaxOfLanes(du, high))};
}

void ChooseFreeSpans(std::span<const FreeSpanLine> lines, int32_t* near, uint16_t* top,
                     uint16_t* ceiling) {
  const DI di;
  const DH dh;
  const auto none = hn::Set(di, kNone16), zero = hn::Zero(di);
  const auto highest = hn::Set(di, kHighCeiling16);
  for (size_t i = 0; i < kTileSide; i += hn::Lanes(di)) {
    const auto wanted = hn::LoadU(di, near + i);
    auto least = hn::Set(di, INT32_MAX);
    auto best_top = none, best_ceiling = zero;
    for (const FreeSpanLine& line : lines) {
      const auto shift = hn::Set(di, line.shift);
      const auto own_top = hn::PromoteTo(di, hn::LoadU(dh, line.top + i));
      const auto own_ceiling = hn::PromoteTo(di, hn::LoadU(dh, line.ceiling + i));
      const auto moved = hn::Add(own_top, shift);
      const auto height = hn::IfThenElse(hn::Lt(moved, zero), none, hn::Min(moved, none));
      const auto headroom =
          hn::IfThenElse(hn::Eq(own_ceiling, none), none,
                         hn::Min(hn::Max(hn::Add(own_ceiling, shift), zero), highest));
      const auto distance = hn::Abs(hn::Sub(moved, wanted));
      const auto better = hn::And(hn::Ne(own_top, none), hn::Lt(distance, least));
      least = hn::IfThenElse(better, distance, least);
      best_top = hn::IfThenElse(better, height, best_top);
      best_ceiling = hn::IfThenElse(better, headroom, best_ceiling);
    }
    hn::StoreU(narrow(best_top), dh, top + i);
    hn::StoreU(narrow(best_ceiling), dh, ceiling + i);
    hn::StoreU(hn::IfThenElse(hn::Eq(best_top, none), wanted, best_top), di, near + i);
  }
}

// Heights of a plane over one vector of cells of row z.
HWY_INLINE hn::Vec<DI> plane_heights(const LevelPlane& plane, int32_t x, int32_t z) {
  const DI di;
  const auto cells = counting_from(di, x);
  const auto rise = hn::Add(hn::Set(di, plane.part + plane.slope_z * z + 512),
                            hn::Mul(cells, hn::Set(di, plane.slope_x)));
  return hn::Add(hn::Set(di, plane.base), hn::ShiftRight<10>(rise));
}

bool PlaneFits(const Layer& layer, const LevelPlane& plane) {
  const DI di;
  const DH dh;
  const auto none = hn::Set(di, kNone16), one = hn::Set(di, 1);
  for (int32_t z = 0; z < kTileSide; ++z) {
    auto off = hn::Lt(none, none);
    for (int32_t x = 0; x < kTileSide; x += static_cast<int32_t>(hn::Lanes(di))) {
      const auto feet =
          hn::PromoteTo(di, hn::Load(dh, &layer.feet[static_cast<size_t>(z * kTileSide + x)]));
      const auto miss = hn::Abs(hn::Sub(plane_heights(plane, x, z), feet));
      off = hn::Or(off, hn::And(hn::Ne(feet, none), hn::Gt(miss, one)));
    }
    if (!hn::AllFalse(di, off)) return false;
  }
  return true;
}

void PutOnPlane(const LevelPlane& plane, Layer& layer) {
  const DI di;
  const DH dh;
  const auto none = hn::Set(di, kNone16);
  for (int32_t z = 0; z < kTileSide; ++z) {
    for (int32_t x = 0; x < kTileSide; x += static_cast<int32_t>(hn::Lanes(di))) {
      uint16_t* row = &layer.feet[static_cast<size_t>(z * kTileSide + x)];
      const auto feet = hn::PromoteTo(di, hn::Load(dh, row));
      const auto height = plane_heights(plane, x, z);
      hn::Store(narrow(hn::IfThenElse(hn::Eq(feet, none), none, height)), dh, row);
    }
  }
}

void LinkTops(const Layer& layer, int32_t step, TopLinks& links) {
  const DU du;
  const auto none = hn::Set(du, kNone16);
  const auto most = hn::Set(du, static_cast<uint16_t>(std::min(step, 65535)));
  const auto linked = [&](hn::Vec<DU> a, hn::Vec<DU> b) {
    const auto apart = hn::Sub(hn::Max(a, b), hn::Min(a, b));
    return bits_of(du, hn::Eq(hn::Min(apart, most), apart));
  };
  for (size_t z = 0; z < kTileSide; ++z) {
    uint64_t has = 0, right = 0, down = 0;
    for (size_t x = 0; x < kTileSide; x += hn::Lanes(du)) {
      const size_t c = z * kTileSide + x;
      const auto top = hn::Load(du, &layer.top[c]);
      has |= bits_of(du, hn::Ne(top, none)) << x;
      // Past the last row this reads the array that follows: masked below.
      right |= linked(top, hn::LoadU(du, &layer.top[0] + c + 1)) << x;
      if (z + 1 < kTileSide) down |= linked(top, hn::Load(du, &layer.top[c + kTileSide])) << x;
    }
    links.has[z] = has;
    links.right[z] = right & has & (has >> 1);
    links.down[z] = down & has;
  }
  for (size_t z = 0; z + 1 < kTileSide; ++z) links.down[z] &= links.has[z + 1];
}

void EvenRuns(const Layer& layer, const LinkRule& rule, world::CellRows& rows) {
  const DU du;
  const auto step = hn::Set(du, static_cast<uint16_t>(rule.step));
  const auto free_span = hn::Set(du, static_cast<uint16_t>(rule.free_span)),
             none = hn::Set(du, kNone16);
  const auto at_most = [](hn::Vec<DU> a, hn::Vec<DU> b) { return hn::Eq(hn::Min(a, b), a); };
  for (size_t z = 0; z < kTileSide; ++z) {
    uint64_t has = 0, even = 0;
    for (size_t x = 0; x < kTileSide; x += hn::Lanes(du)) {
      const size_t c = z * kTileSide + x;
      // Past the last row this reads the array that follows: masked below.
      const auto top = hn::Load(du, &layer.top[c]), next = hn::LoadU(du, &layer.top[0] + c + 1);
      const auto ceiling =
          hn::Min(hn::Load(du, &layer.ceiling[c]), hn::LoadU(du, &layer.ceiling[0] + c + 1));
      const auto high = hn::Max(top, next);
      has |= bits_of(du, hn::Ne(top, none)) << x;
      even |= bits_of(du, hn::And(at_most(hn::Sub(high, hn::Min(top, next)), step),
                                  at_most(free_span, hn::SaturatedSub(ceiling, high))))
              << x;
    }
    rows[z] = even & has & has >> 1;
  }
}

void AddFreeSpanBits(const Layer& layer, std::array<uint64_t, kTileSide>& rows) {
  const DU du;
  const auto none = hn::Set(du, kNone16);
  for (size_t z = 0; z < kTileSide; ++z) {
    for (size_t x = 0; x < kTileSide; x += hn::Lanes(du)) {
      const auto top = hn::Load(du, &layer.top[z * kTileSide + x]);
      rows[z] |= bits_of(du, hn::Ne(top, none)) << x;
    }
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace throng::bake
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace throng::bake {

HWY_EXPORT(LinkFreeSpans);
HWY_EXPORT(LowFreeSpans);
HWY_EXPORT(FreeSpanRange);
HWY_EXPORT(RunRange);
HWY_EXPORT(ClearLayer);
HWY_EXPORT(WriteFreeSpans);
HWY_EXPORT(Summarise);
HWY_EXPORT(MayBePlane);
HWY_EXPORT(MakeTilt);
HWY_EXPORT(KeepFeet);
HWY_EXPORT(UsefulCells);
HWY_EXPORT(PresentBits);
HWY_EXPORT(CeilingRange);
HWY_EXPORT(ChooseFreeSpans);
HWY_EXPORT(LinkTops);
HWY_EXPORT(EvenRuns);
HWY_EXPORT(AddFreeSpanBits);
HWY_EXPORT(PlaneFits);
HWY_EXPORT(PutOnPlane);

void link_free_spans(const TileFreeSpans& free_spans, int32_t free_layer, const LinkRule& rule,
                     const world::CellRows* only, FreeSpanLinks& links) {
  HWY_DYNAMIC_DISPATCH(LinkFreeSpans)(free_spans, free_layer, rule, only, links);
}

void low_free_spans(const TileFreeSpans& free_spans, int32_t free_layer, int32_t height,
                    world::CellRows& rows) {
  HWY_DYNAMIC_DISPATCH(LowFreeSpans)(free_spans, free_layer, height, rows);
}

TopRange free_span_range(const TileFreeSpans& free_spans, int32_t free_layer) {
  return HWY_DYNAMIC_DISPATCH(FreeSpanRange)(free_spans, free_layer);
}

TopRange run_range(const FreeSpanLayer& free_layer, int32_t z, uint64_t cells) {
  return HWY_DYNAMIC_DISPATCH(RunRange)(free_layer, z, cells);
}

void clear_layer(Layer& layer) { HWY_DYNAMIC_DISPATCH(ClearLayer)(layer); }

void write_free_spans(const FreeSpanLayer& free_layer, int32_t z, uint64_t cells, Layer& layer) {
  HWY_DYNAMIC_DISPATCH(WriteFreeSpans)(free_layer, z, cells, layer);
}

void summarise(Layer& layer) { HWY_DYNAMIC_DISPATCH(Summarise)(layer); }

bool may_be_plane(const Layer& layer) { return HWY_DYNAMIC_DISPATCH(MayBePlane)(layer); }

void make_tilt(const Layer& layer, std::array<uint16_t, kTileArea>& tilt) {
  HWY_DYNAMIC_DISPATCH(MakeTilt)(layer, tilt);
}

bool useful_cells(const Layer& layer, const BodyNeed& need, world::CellRows& rows) {
  return HWY_DYNAMIC_DISPATCH(UsefulCells)(layer, need, rows);
}

void keep_feet(const world::CellRows& rows, Layer& layer) {
  HWY_DYNAMIC_DISPATCH(KeepFeet)(rows, layer);
}

void present_bits(const Layer& layer, std::array<uint64_t, kTileSide>& rows) {
  HWY_DYNAMIC_DISPATCH(PresentBits)(layer, rows);
}

HeightRange ceiling_range(const Layer& layer) { return HWY_DYNAMIC_DISPATCH(CeilingRange)(layer); }

void choose_free_spans(std::span<const FreeSpanLine> lines, int32_t* near, uint16_t* top,
                       uint16_t* ceiling) {
  HWY_DYNAMIC_DISPATCH(ChooseFreeSpans)(lines, near, top, ceiling);
}

bool plane_fits(const Layer& layer, const LevelPlane& plane) {
  return HWY_DYNAMIC_DISPATCH(PlaneFits)(layer, plane);
}

void put_on_plane(const LevelPlane& plane, Layer& layer) {
  HWY_DYNAMIC_DISPATCH(PutOnPlane)(plane, layer);
}

void link_tops(const Layer& layer, int32_t step, TopLinks& links) {
  HWY_DYNAMIC_DISPATCH(LinkTops)(layer, step, links);
}

void even_runs(const Layer& layer, const LinkRule& rule, world::CellRows& rows) {
  HWY_DYNAMIC_DISPATCH(EvenRuns)(layer, rule, rows);
}

void add_free_span_bits(const Layer& layer, std::array<uint64_t, kTileSide>& rows) {
  HWY_DYNAMIC_DISPATCH(AddFreeSpanBits)(layer, rows);
}

}  // namespace throng::bake
#endif  // HWY_ONCE
