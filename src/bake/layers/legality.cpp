// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "bake/layers/legality.h"

#include <algorithm>

// Windowed maxima and minima with a disc: rows first, for each width that the disc has, each from
// the next smaller one; then columns. (The horizontal part after van Herk, Gil, Werman; the windows
// are a few cells, so widening beats their recurrences.) Everything is 16 bit, so a vector holds a
// quarter of a row or more.

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bake/layers/legality.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
#include <hwy/highway.h>

#include "bake/columns/vector_bits-inl.h"

HWY_BEFORE_NAMESPACE();
namespace throng::bake {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using DU = hn::CappedTag<uint16_t, 32>;
using VU = hn::Vec<DU>;
using MU = hn::Mask<DU>;

HWY_INLINE MU at_most(VU a, VU b) { return hn::Eq(hn::Min(a, b), a); }

struct Highest {
  HWY_INLINE VU operator()(VU a, VU b) const { return hn::Max(a, b); }
};
struct Lowest {
  HWY_INLINE VU operator()(VU a, VU b) const { return hn::Min(a, b); }
};

// out[x] = extreme of in[x - w .. x + w] for x in [0, 64). `in` has w valid cells on both sides;
// `inner` is out of the next smaller width, or null for none.
template <class Op>
HWY_INLINE void extreme_row(const uint16_t* HWY_RESTRICT in, const uint16_t* inner,
                            int32_t narrower, int32_t w, uint16_t* HWY_RESTRICT out, Op op) {
  const DU du;
  const int32_t lanes = static_cast<int32_t>(hn::Lanes(du));
  for (int32_t x = 0; x < kTileSide; x += lanes) {
    VU value = inner != nullptr ? hn::Load(du, inner + x) : hn::LoadU(du, in + x);
    for (int32_t i = narrower + 1; i <= w; ++i) {
      value = op(value, op(hn::LoadU(du, in + x - i), hn::LoadU(du, in + x + i)));
    }
    hn::Store(value, du, out + x);
  }
}

// Rows of horizontal extremes: for width index k, quantity q, row z: rows[((k * 3 + q) * count + z)
// * 64].
struct RowTable {
  uint16_t* data;
  int32_t count;  // rows
  [[nodiscard]] HWY_INLINE uint16_t* row(int32_t k, int32_t q, int32_t z) const {
    return data + (static_cast<size_t>((k * 3 + q) * count + z)) * kTileSide;
  }
};

// Of the solids and free spans over some cells.
struct Extremes {
  VU high_top, low_top, low_ceiling;
};

bool GroundOf(const Layer& layer, const BodyWindow& body, const BodyLimits& limits,
              BitPlane& ground) {
  const hn::CappedTag<uint8_t, 64> dc;
  ground.fill(0);
  if (layer.one_code) {
    if ((limits.allowed[layer.some_code] & body.class_bit) == 0) return false;
    ground.fill(~uint64_t{0});
    return true;
  }
  uint64_t any = 0;
  for (int32_t code = 0; code <= layer.some_code; ++code) {
    if ((limits.allowed[static_cast<size_t>(code)] & body.class_bit) == 0) continue;
    const auto wanted = hn::Set(dc, static_cast<uint8_t>(code));
    for (size_t c = 0; c < kTileArea; c += hn::Lanes(dc)) {
      const uint64_t same = bits_of(dc, hn::Eq(hn::Load(dc, &layer.code[c]), wanted));
      ground[c / kTileSide] |= same << c % kTileSide;
      any |= same;
    }
  }
  return any != 0;
}

// The extremes of all widths along each row, from those of the next narrower one. Rows that no
// allowed cell reads are left out.
void fill_rows(const std::vector<int32_t>& widths, const BitPlane& ground, int32_t reach,
               const LegalityScratch& scratch, const RowTable& table) {
  const auto is_asked = [&](int32_t z) {
    const int32_t from = std::max(z - reach, 0), to = std::min(z + reach, kTileSide - 1);
    return std::any_of(&ground[static_cast<size_t>(from)], &ground[static_cast<size_t>(to)] + 1,
                       [](uint64_t row) { return row != 0; });
  };
  for (int32_t z = -reach; z < kTileSide + reach; ++z) {
    if (!is_asked(z)) continue;
    const uint16_t* top = &scratch.window.top[scratch.window.index(0, z)];
    const uint16_t* ceiling = &scratch.window.ceiling[scratch.window.index(0, z)];
    const auto row = [&](int32_t k, int32_t q) {
      return k < 0 ? nullptr : table.row(k, q, z + reach);
    };
    int32_t narrower = 0;
    for (int32_t k = 0; k < static_cast<int32_t>(widths.size()); ++k) {
      const int32_t w = widths[static_cast<size_t>(k)];
      extreme_row(top, row(k - 1, 0), narrower, w, row(k, 0), Highest{});
      extreme_row(top, row(k - 1, 1), narrower, w, row(k, 1), Lowest{});
      extreme_row(ceiling, row(k - 1, 2), narrower, w, row(k, 2), Lowest{});
      narrower = w;
    }
  }
}

void LegalCellsOf(const Layer& layer, const BodyWindow& body, const BitPlane& ground,
                  LegalityScratch& scratch, LegalCells& out) {
  out = {};
  const DU du;
  const int32_t lanes = static_cast<int32_t>(hn::Lanes(du));
  const int32_t reach = body.reach;
  const int32_t count = kTileSide + 2 * reach;

  std::vector<int32_t> widths = body.width;  // ascending, each once
  std::sort(widths.begin(), widths.end());
  widths.erase(std::unique(widths.begin(), widths.end()), widths.end());
  const auto index_of = [&](int32_t w) {  // -1: not in the table
    const auto at = std::lower_bound(widths.begin(), widths.end(), w);
    return at != widths.end() && *at == w ? static_cast<int32_t>(at - widths.begin()) : -1;
  };
  std::array<int32_t, 65> width_index{}, core_index{};
  for (size_t d = 0; d < body.width.size(); ++d) width_index[d] = index_of(body.width[d]);
  for (size_t d = 0; d < body.core.size() && body.fine; ++d) {
    core_index[d] = index_of(body.core[d]);
  }
  const int32_t core_reach = static_cast<int32_t>(body.core.size()) - 1;
  scratch.rows.resize(widths.size() * 3 * static_cast<size_t>(count) * kTileSide + 64);
  uint16_t* aligned = scratch.rows.data();
  aligned += (64 - reinterpret_cast<uintptr_t>(aligned) % 64) % 64 / sizeof(uint16_t);
  const RowTable table{aligned, count};
  fill_rows(widths, ground, reach, scratch, table);

  const VU none = hn::Set(du, kNone16);
  const VU bottom = hn::Set(du, static_cast<uint16_t>(std::min(body.bottom, 65535)));
  const VU height = hn::Set(du, static_cast<uint16_t>(std::min(body.height, 65534)));
  const VU hope = hn::Set(du, static_cast<uint16_t>(body.hope));
  const VU gentle = hn::Set(du, static_cast<uint16_t>(body.gentle));
  for (int32_t z = 0; z < kTileSide; ++z) {
    uint64_t legal = 0, slanted = 0, hemmed = 0;
    const uint64_t allowed = ground[static_cast<size_t>(z)];
    if (allowed == 0) continue;
    for (int32_t x = 0; x < kTileSide; x += lanes) {
      const size_t cell = static_cast<size_t>(z * kTileSide + x);
      const VU feet = hn::Load(du, &layer.feet[cell]);
      const MU stands = mask_of(du, allowed >> x);
      if (hn::AllFalse(du, stands)) continue;
      const VU tilt = hn::Load(du, &scratch.tilt[cell]);
      const VU feet_low = hn::SaturatedSub(feet, tilt);
      const VU feet_high = hn::SaturatedAdd(feet, tilt);
      const auto look = [&](int32_t far, const auto& index) {
        Extremes e{hn::Zero(du), none, none};
        for (int32_t d = -far; d <= far; ++d) {
          const int32_t k = index[static_cast<size_t>(d < 0 ? -d : d)];
          if (k < 0) {  // Of the core, for few vectors: not worth a table of all rows.
            const int32_t w = body.core[static_cast<size_t>(d < 0 ? -d : d)];
            const size_t at = scratch.window.index(x - w, z + d);
            for (size_t i = at; i <= at + static_cast<size_t>(2 * w); ++i) {
              const VU top = hn::LoadU(du, &scratch.window.top[i]);
              e.high_top = hn::Max(e.high_top, top);
              e.low_top = hn::Min(e.low_top, top);
              e.low_ceiling = hn::Min(e.low_ceiling, hn::LoadU(du, &scratch.window.ceiling[i]));
            }
            continue;
          }
          const int32_t row = z + d + reach;
          e.high_top = hn::Max(e.high_top, hn::Load(du, table.row(k, 0, row) + x));
          e.low_top = hn::Min(e.low_top, hn::Load(du, table.row(k, 1, row) + x));
          e.low_ceiling = hn::Min(e.low_ceiling, hn::Load(du, table.row(k, 2, row) + x));
        }
        return e;
      };
      const auto is_even = [&](const Extremes& e) {
        return hn::And(at_most(e.high_top, hn::SaturatedAdd(feet_low, bottom)),
                       at_most(feet_high, hn::SaturatedAdd(e.low_top, bottom)));
      };
      // Saturated, a head passes under the open sky only.
      const auto is_open = [&](const Extremes& e) {
        return hn::And(stands, hn::And(at_most(hn::SaturatedAdd(feet_high, height), e.low_ceiling),
                                       hn::Ne(e.high_top, none)));
      };
      const Extremes all = look(reach, width_index);
      const MU open = is_open(all), even = is_even(all);
      const MU free = hn::And(open, even);
      legal |= bits_of(du, free) << x;
      const MU near = hn::And(at_most(all.high_top, hn::SaturatedAdd(feet, hope)),
                              at_most(feet, hn::SaturatedAdd(all.low_top, hope)));
      slanted |= bits_of(du, hn::AndNot(even, hn::And(open, near))) << x;
      const MU denied = hn::AndNot(free, hn::And(stands, at_most(tilt, gentle)));
      if (!body.fine || hn::AllFalse(du, denied)) continue;
      const Extremes core = look(core_reach, core_index);
      hemmed |= bits_of(du, hn::And(denied, hn::And(is_open(core), is_even(core)))) << x;
    }
    out.legal[static_cast<size_t>(z)] = legal;
    out.stands[static_cast<size_t>(z)] = allowed;
    out.slanted[static_cast<size_t>(z)] = slanted;
    out.hemmed[static_cast<size_t>(z)] = hemmed;
  }
}

// Bits of cells whose feet differ from the next cell's (in x, and in z) by more than the step.
bool StepSafe(const Layer& layer, const BitPlane& legal, int32_t step) {
  const DU du;
  const int32_t lanes = static_cast<int32_t>(hn::Lanes(du));
  const VU limit = hn::Set(du, static_cast<uint16_t>(std::min(step, 65535)));
  for (int32_t z = 0; z < kTileSide; ++z) {
    uint64_t across = 0, along = 0;
    for (int32_t x = 0; x < kTileSide; x += lanes) {
      const size_t cell = static_cast<size_t>(z * kTileSide + x);
      const VU feet = hn::Load(du, &layer.feet[cell]);
      // Past the row's end this reads the next row or, at the very end, the array that follows:
      // masked.
      const VU right = hn::LoadU(du, &layer.feet[0] + cell + 1);
      const VU dx = hn::Sub(hn::Max(feet, right), hn::Min(feet, right));
      across |= bits_of(du, hn::Not(at_most(dx, limit))) << x;
      if (z + 1 == kTileSide) continue;
      const VU below = hn::Load(du, &layer.feet[cell + kTileSide]);
      const VU dz = hn::Sub(hn::Max(feet, below), hn::Min(feet, below));
      along |= bits_of(du, hn::Not(at_most(dz, limit))) << x;
    }
    const uint64_t row = legal[static_cast<size_t>(z)];
    if ((row & (row >> 1) & across) != 0) return false;
    if (z + 1 < kTileSide && (row & legal[static_cast<size_t>(z) + 1] & along) != 0) return false;
  }
  return true;
}

}  // namespace HWY_NAMESPACE
}  // namespace throng::bake
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace throng::bake {

HWY_EXPORT(GroundOf);
HWY_EXPORT(LegalCellsOf);
HWY_EXPORT(StepSafe);

bool may_stand(const Layer& layer, const BodyWindow& body, const BodyLimits& limits,
               BitPlane& cells) {
  // Of the surface, whether there are feet or not.
  if (!HWY_DYNAMIC_DISPATCH(GroundOf)(layer, body, limits, cells)) return false;
  BitPlane useful = layer.useful;
  if (body.bottom != limits.max_bottom || body.height != limits.min_height) {
    useful_cells(layer, {body.bottom, body.height, limits.blocked_code}, useful);
  }
  uint64_t any = 0;
  for (size_t z = 0; z < kTileSide; ++z) any |= cells[z] &= useful[z];
  return any != 0;
}

void legal_cells(const Layer& layer, const BodyWindow& body, const BitPlane& cells,
                 LegalityScratch& scratch, LegalCells& out) {
  HWY_DYNAMIC_DISPATCH(LegalCellsOf)(layer, body, cells, scratch, out);
}

bool step_safe(const Layer& layer, const BitPlane& legal, int32_t step) {
  return HWY_DYNAMIC_DISPATCH(StepSafe)(layer, legal, step);
}

}  // namespace throng::bake
#endif  // HWY_ONCE
