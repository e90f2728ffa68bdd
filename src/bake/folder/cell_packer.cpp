// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "bake/folder/cell_packer.h"

#include <algorithm>
#include <bit>
#include <cstring>

// A block takes the slope that its own neighbours suggest, if the rest then takes fewer bits: over
// one plane of a model a cell is off by a rounded millimetre or two. A row of blocks is worked on
// at once, a vector of cells at a time; what is found for a block stands in all columns of it.

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bake/folder/cell_packer.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
#include <hwy/highway.h>

#include "bake/columns/vector_bits-inl.h"

HWY_BEFORE_NAMESPACE();
namespace throng::bake {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using DU = hn::CappedTag<uint16_t, 32>;
using DI = hn::RebindToSigned<DU>;
using VU = hn::Vec<DU>;
using VI = hn::Vec<DI>;
using MU = hn::Mask<DU>;

constexpr int32_t kMaxBlockRise = 4096;  // rise over a block beyond which no slope is sought [mm]

HWY_INLINE VI as_signed(VU v) { return hn::BitCast(DI(), v); }
HWY_INLINE VU as_unsigned(VI v) { return hn::BitCast(DU(), v); }

// Joins what was found for the eight columns of each block; all eight hold the result then.
template <class D, class Op>
HWY_INLINE void join_blocks(D d, hn::TFromD<D>* row, Op op) {
#if HWY_TARGET == HWY_SCALAR
  for (size_t x = 0; x < 64; x += 8) {
    auto joined = hn::Set(d, row[x]);
    for (size_t i = 1; i < 8; ++i) joined = op(joined, hn::Set(d, row[x + i]));
    std::fill_n(row + x, 8, hn::GetLane(joined));
  }
#else
  const hn::Repartition<uint32_t, D> dw;
  for (size_t x = 0; x < 64; x += hn::Lanes(d)) {
    auto v = hn::Load(d, row + x);
    v = op(v, hn::BitCast(d, hn::RotateRight<16>(hn::BitCast(dw, v))));
    v = op(v, hn::BitCast(d, hn::Shuffle2301(hn::BitCast(dw, v))));
    v = op(v, hn::BitCast(d, hn::Shuffle1032(hn::BitCast(dw, v))));
    hn::Store(v, d, row + x);
  }
#endif
}
struct Least {
  template <class V>
  HWY_INLINE V operator()(V a, V b) const {
    return hn::Min(a, b);
  }
};
struct Most {
  template <class V>
  HWY_INLINE V operator()(V a, V b) const {
    return hn::Max(a, b);
  }
};
struct Sum {
  template <class V>
  HWY_INLINE V operator()(V a, V b) const {
    return hn::Add(a, b);
  }
};

// For each cell along a row of eight blocks what was found for its column, then for its block.
struct BlockRow {
  alignas(64) uint16_t low[64], high[64];  // of the values
  alignas(64) uint16_t sum[64];            // of the column
  alignas(64) uint16_t held[64];           // 65535: all cells have a value
  alignas(64) uint16_t hole[64];           // 65535: a cell has feet but no value
  alignas(64) int16_t rise_x[64], rise_z[64];
  alignas(64) int16_t pairs_x[64], pairs_z[64];
  alignas(64) int16_t slope_x[64], slope_z[64];
  alignas(64) int16_t rest_low[64], rest_high[64];
  alignas(64) uint16_t hole_mark[64];  // what a cell without a value holds
  alignas(64) uint16_t rest[8][64];
  alignas(64) uint8_t bytes[8][64];
};

alignas(64) constexpr uint16_t kLastOfBlock[32] = {0, 0,     0, 0, 0,     0, 0, 65535, 0, 0,    0,
                                                   0, 0,     0, 0, 65535, 0, 0, 0,     0, 0,    0,
                                                   0, 65535, 0, 0, 0,     0, 0, 0,     0, 65535};
// x of a cell in its block times 1024: the high half of the product with a slope is slope * x >> 6.
alignas(64) constexpr int16_t kAlong[32] = {
    0, 1024, 2048, 3072, 4096, 5120, 6144, 7168, 0, 1024, 2048, 3072, 4096, 5120, 6144, 7168,
    0, 1024, 2048, 3072, 4096, 5120, 6144, 7168, 0, 1024, 2048, 3072, 4096, 5120, 6144, 7168};

// One vector of cells along a row of blocks: cells x and on of its eight rows.
class Strip {
 public:
  Strip(const uint16_t* values, const uint16_t* feet, size_t x, BlockRow& row)
      : values_(values + x), feet_(feet + x), x_(x), row_(row) {}

  // Lowest and highest value and sum, where all cells have feet. True if all have a value.
  HWY_INLINE bool find_range() const {
    const VU none = hn::Set(du_, kNone16);
    VU low = none, high = hn::Zero(du_), sum = high;
    for (size_t z = 0; z < 8; ++z) {
      const VU v = value(z * 64);
      low = hn::Min(low, v);
      high = hn::Max(high, v);
      sum = hn::Add(sum, v);
    }
    hn::Store(low, du_, row_.low + x_);
    hn::Store(high, du_, row_.high + x_);
    hn::Store(sum, du_, row_.sum + x_);
    return hn::AllFalse(du_, hn::Eq(high, none));
  }

  // The same where some have none, and which blocks have all.
  HWY_INLINE void find_range_of_some() const {
    const VU none = hn::Set(du_, kNone16);
    VU low = none, high = hn::Zero(du_), sum = high, hole = high, all = none;
    for (size_t z = 0; z < 8; ++z) {
      const VU v = value(z * 64);
      const VU stands = has(feet_, z * 64), real = hn::VecFromMask(du_, hn::Ne(v, none));
      const VU held = hn::And(stands, real);
      low = hn::Min(low, hn::Or(v, hn::Not(stands)));
      high = hn::Max(high, hn::And(v, held));
      sum = hn::Add(sum, v);
      hole = hn::Or(hole, hn::AndNot(real, stands));
      all = hn::And(all, held);
    }
    hn::Store(low, du_, row_.low + x_);
    hn::Store(high, du_, row_.high + x_);
    hn::Store(sum, du_, row_.sum + x_);
    hn::Store(hole, du_, row_.hole + x_);
    hn::Store(all, du_, row_.held + x_);
  }

  // Sums of the rises from cell to cell, and their number.
  HWY_INLINE void find_rises() const {
    const VU last = hn::Load(du_, kLastOfBlock + x_ % 8);
    VU rise_x = hn::Zero(du_), rise_z = rise_x, pairs_x = rise_x, pairs_z = rise_x;
    VU above = rise_x, above_held = rise_x;
    for (size_t z = 0; z < 8; ++z) {
      const VU v = value(z * 64), right = value(z * 64 + 1), held = held_at(z * 64);
      const VU both_x = hn::AndNot(last, hn::And(held, held_at(z * 64 + 1)));
      const VU both_z = hn::And(held, above_held);
      rise_x = hn::Add(rise_x, hn::And(both_x, hn::Sub(right, v)));
      rise_z = hn::Add(rise_z, hn::And(both_z, hn::Sub(v, above)));
      pairs_x = hn::Sub(pairs_x, both_x);
      pairs_z = hn::Sub(pairs_z, both_z);
      above = v;
      above_held = held;
    }
    hn::Store(as_signed(rise_x), di_, row_.rise_x + x_);
    hn::Store(as_signed(rise_z), di_, row_.rise_z + x_);
    hn::Store(as_signed(pairs_x), di_, row_.pairs_x + x_);
    hn::Store(as_signed(pairs_z), di_, row_.pairs_z + x_);
  }

  // The rises in z of blocks that have all values: from the first row to the last.
  HWY_INLINE void find_whole_rises() const {
    hn::Store(as_signed(hn::Sub(value(7 * 64), value(0))), di_, row_.rise_z + x_);
  }

  // Lowest and highest of what the slopes leave.
  template <bool kWhole>
  HWY_INLINE void find_rest_range() const {
    const VI lowest = hn::Set(di_, INT16_MIN), highest = hn::Set(di_, INT16_MAX);
    const VU ground = ground_at(hn::Load(du_, row_.low + x_));
    const VI slope_z = hn::Load(di_, row_.slope_z + x_);
    VI low = highest, high = lowest;
    for (size_t z = 0; z < 8; ++z) {
      const VI rest = as_signed(rest_of(z, ground, slope_z));
      if constexpr (kWhole) {
        low = hn::Min(low, rest);
        high = hn::Max(high, rest);
      } else {
        const auto held = hn::RebindMask(di_, hn::MaskFromVec(held_at(z * 64)));
        low = hn::Min(low, hn::IfThenElse(held, rest, highest));
        high = hn::Max(high, hn::IfThenElse(held, rest, lowest));
      }
    }
    hn::Store(low, di_, row_.rest_low + x_);
    hn::Store(high, di_, row_.rest_high + x_);
  }

  // What the slopes leave, less the lowest of it.
  template <bool kWhole>
  HWY_INLINE void make_rest() const {
    const hn::Rebind<uint8_t, DU> db;
    const VU none = hn::Set(du_, kNone16);
    const VU lowest = as_unsigned(hn::Load(di_, row_.rest_low + x_));
    const VU ground = ground_at(hn::Add(hn::Load(du_, row_.low + x_), lowest));
    const VU mark = hn::Load(du_, row_.hole_mark + x_);
    const VI slope_z = hn::Load(di_, row_.slope_z + x_);
    for (size_t z = 0; z < 8; ++z) {
      VU rest = rest_of(z, ground, slope_z);
      if constexpr (!kWhole) {
        rest = hn::IfThenElse(hn::Ne(value(z * 64), none), rest, mark);
        rest = hn::And(rest, has(feet_, z * 64));
      }
      hn::Store(rest, du_, row_.rest[z] + x_);
      hn::Store(hn::DemoteTo(db, as_signed(rest)), db, row_.bytes[z] + x_);
    }
  }

 private:
  HWY_INLINE VU value(size_t cell) const { return hn::LoadU(du_, values_ + cell); }
  HWY_INLINE VU has(const uint16_t* array, size_t cell) const {
    return hn::VecFromMask(du_, hn::Ne(hn::LoadU(du_, array + cell), hn::Set(du_, kNone16)));
  }
  HWY_INLINE VU held_at(size_t cell) const { return hn::And(has(feet_, cell), has(values_, cell)); }
  HWY_INLINE VU ground_at(VU low) const {
    const VI slope_x = hn::Load(di_, row_.slope_x + x_);
    return hn::Add(low, as_unsigned(hn::MulHigh(slope_x, hn::Load(di_, kAlong + x_ % 8))));
  }
  HWY_INLINE VU rest_of(size_t z, VU ground, VI slope_z) const {
    const VI along_z = hn::MulHigh(slope_z, hn::Set(di_, static_cast<int16_t>(z * 1024)));
    return hn::Sub(hn::Sub(value(z * 64), ground), as_unsigned(along_z));
  }

  static constexpr DU du_{};
  static constexpr DI di_{};
  const uint16_t* values_;
  const uint16_t* feet_;
  size_t x_;
  BlockRow& row_;
};

// Bits a cell that numbers up to `max_value` take, one more number if some cells have none.
HWY_INLINE uint32_t width_for(uint32_t max_value, bool hole) {
  const auto bits = static_cast<uint32_t>(std::bit_width(max_value + (hole ? 1 : 0)));
  return bits == 0 ? 0 : std::bit_ceil(bits);
}

// The words of a block of up to 8 bits a cell, as rest_at reads them. Returns where they end.
template <uint32_t kWidth>
HWY_INLINE uint64_t* append_bytes(const BlockRow& row, size_t b, uint64_t* out) {
  uint64_t words[kWidth] = {};
  for (uint32_t z = 0; z < 8; ++z) {
    uint64_t bytes;
    std::memcpy(&bytes, &row.bytes[z][8 * b], 8);
    words[z % kWidth] |= bytes << (z / kWidth * kWidth);
  }
  std::memcpy(out, words, sizeof words);
  return out + kWidth;
}

HWY_INLINE uint64_t* append_rest(const BlockRow& row, size_t b, uint32_t width, uint64_t* out) {
  switch (width) {
    case 0:
      return out;
    case 1:
      return append_bytes<1>(row, b, out);
    case 2:
      return append_bytes<2>(row, b, out);
    case 4:
      return append_bytes<4>(row, b, out);
    case 8:
      return append_bytes<8>(row, b, out);
    default:
      for (size_t z = 0; z < 8; ++z) std::memcpy(out + 2 * z, &row.rest[z][8 * b], 16);
      return out + 16;
  }
}

// Blocks of one row, from lowest and highest value; slopes are still 0.
struct RowPlan {
  bool any = false;     // a block needs words
  bool whole = true;    // those that do have all their values
  bool sloped = false;  // a slope may help one
};

HWY_INLINE bool may_slope(const world::ValueBlock& block, const BlockRow& row, size_t b) {
  return block.width > 1 && row.high[8 * b] - row.low[8 * b] < kMaxBlockRise;
}

HWY_INLINE RowPlan plan_row(const BlockRow& row, uint16_t low, world::ValueBlock* blocks) {
  RowPlan plan;
  for (size_t b = 0; b < 8; ++b) {
    const size_t i = 8 * b;
    const bool hole = row.hole[i] != 0;
    if (row.low[i] == kNone16) {  // no values: only holes, or nothing
      blocks[b].base = hole ? world::kNoValue : 0;
      continue;
    }
    const uint32_t range = static_cast<uint32_t>(row.high[i] - row.low[i]);
    blocks[b].base = static_cast<uint16_t>(row.low[i] - low);
    blocks[b].width = static_cast<uint8_t>(width_for(range, hole));
    blocks[b].holes = hole;
    if (blocks[b].width == 0) continue;
    plan.any = true;
    plan.whole &= row.held[i] != 0;
    plan.sloped |= may_slope(blocks[b], row, b);
  }
  return plan;
}

// Fills in the slopes that blocks may take.
HWY_INLINE void choose_slopes(const world::ValueBlock* blocks, bool whole, BlockRow& row) {
  // Sums may wrap round at odd shapes: then the slope is a bad one, and not taken.
  const auto slope = [](int32_t rise, int32_t pairs) {
    const int32_t mean = pairs == 56 ? rise * 64 / 56 : rise * 64 / std::max(pairs, 1);
    return static_cast<int16_t>(std::clamp(mean, -32767, 32767));
  };
  for (size_t b = 0; b < 8; ++b) {
    const size_t i = 8 * b;
    if (!may_slope(blocks[b], row, b)) continue;
    const auto across = static_cast<int16_t>(row.sum[i + 7] - row.sum[i]);
    const int16_t slope_x = whole ? slope(across, 56) : slope(row.rise_x[i], row.pairs_x[i]);
    const int16_t slope_z = slope(row.rise_z[i], whole ? 56 : row.pairs_z[i]);
    std::fill_n(row.slope_x + i, 8, slope_x);
    std::fill_n(row.slope_z + i, 8, slope_z);
  }
}

// Keeps the slopes of blocks that take fewer bits with them.
HWY_INLINE void keep_slopes(world::ValueBlock* blocks, BlockRow& row) {
  for (size_t b = 0; b < 8; ++b) {
    const size_t i = 8 * b;
    if ((row.slope_x[i] | row.slope_z[i]) != 0) {
      const int32_t range = std::max(row.rest_high[i] - row.rest_low[i], 0);
      const uint32_t width = width_for(static_cast<uint32_t>(range), blocks[b].holes);
      if (width < blocks[b].width) {
        blocks[b].slope_x = row.slope_x[i];
        blocks[b].slope_z = row.slope_z[i];
        blocks[b].base = static_cast<uint16_t>(blocks[b].base + row.rest_low[i]);
        blocks[b].width = static_cast<uint8_t>(width);
        continue;
      }
      std::fill_n(row.slope_x + i, 8, int16_t{0});
      std::fill_n(row.slope_z + i, 8, int16_t{0});
    }
    std::fill_n(row.rest_low + i, 8, int16_t{0});
  }
}

template <class Each>
HWY_INLINE void for_strips(const uint16_t* values, const uint16_t* feet, BlockRow& row, Each each) {
  for (size_t x = 0; x < 64; x += hn::Lanes(DU())) each(Strip(values, feet, x, row));
}

// A row of eight blocks: their heads, and their words from `payload[used]` on. Returns `used` for
// the next.
HWY_INLINE size_t pack_row(const uint16_t* values, const uint16_t* feet, bool all_stand,
                           uint16_t low, size_t used, uint64_t* heads, uint64_t* payload) {
  const DU du;
  const DI di;
  BlockRow row;
  world::ValueBlock blocks[8];
  bool all_held = all_stand;
  if (all_stand) {
    for_strips(values, feet, row, [&](const Strip& strip) { all_held &= strip.find_range(); });
  }
  if (all_held) {
    std::fill_n(row.hole, 64, uint16_t{0});
    std::fill_n(row.held, 64, kNone16);
  } else {
    for_strips(values, feet, row, [](const Strip& strip) { strip.find_range_of_some(); });
    join_blocks(du, row.hole, Most());
    join_blocks(du, row.held, Least());
  }
  join_blocks(du, row.low, Least());
  join_blocks(du, row.high, Most());
  const RowPlan plan = plan_row(row, low, blocks);
  if (plan.any) {
    std::fill_n(row.slope_x, 64, int16_t{0});
    std::fill_n(row.slope_z, 64, int16_t{0});
    std::fill_n(row.rest_low, 64, int16_t{0});
    if (plan.sloped) {
      if (plan.whole) {
        for_strips(values, feet, row, [](const Strip& strip) { strip.find_whole_rises(); });
      } else {
        for_strips(values, feet, row, [](const Strip& strip) { strip.find_rises(); });
        join_blocks(di, row.rise_x, Sum());
        join_blocks(di, row.pairs_x, Sum());
        join_blocks(di, row.pairs_z, Sum());
      }
      join_blocks(di, row.rise_z, Sum());
      choose_slopes(blocks, plan.whole, row);
      if (plan.whole) {
        for_strips(values, feet, row,
                   [](const Strip& strip) { strip.template find_rest_range<true>(); });
      } else {
        for_strips(values, feet, row,
                   [](const Strip& strip) { strip.template find_rest_range<false>(); });
      }
      join_blocks(di, row.rest_low, Least());
      join_blocks(di, row.rest_high, Most());
      keep_slopes(blocks, row);
    }
    if (plan.whole) {
      for_strips(values, feet, row, [](const Strip& strip) { strip.template make_rest<true>(); });
    } else {
      for (size_t b = 0; b < 8; ++b) {
        std::fill_n(row.hole_mark + 8 * b, 8, static_cast<uint16_t>((1u << blocks[b].width) - 1));
      }
      for_strips(values, feet, row, [](const Strip& strip) { strip.template make_rest<false>(); });
    }
  }
  uint64_t* out = payload + used;
  for (size_t b = 0; b < 8; ++b) {
    if (blocks[b].width != 0) blocks[b].first = static_cast<uint32_t>(out - payload);
    out = append_rest(row, b, blocks[b].width, out);
    heads[b] = world::pack_head(blocks[b]);
  }
  return static_cast<size_t>(out - payload);
}

size_t PackBlocks(const uint16_t* values, const uint16_t* feet, const world::CellRows* has,
                  uint16_t low, uint64_t* heads, uint64_t* payload) {
  size_t used = 0;
  for (size_t z = 0; z < 8; ++z, values += 512, feet += 512, heads += 8) {
    uint64_t any = ~uint64_t{0}, all = any;
    if (has != nullptr) {
      any = 0;
      for (size_t i = 8 * z; i < 8 * z + 8; ++i) {
        any |= (*has)[i];
        all &= (*has)[i];
      }
    }
    if (any == 0) {
      std::fill_n(heads, 8, 0);
    } else {
      used = pack_row(values, feet, all == ~uint64_t{0}, low, used, heads, payload);
    }
  }
  return used;
}

}  // namespace HWY_NAMESPACE
}  // namespace throng::bake
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace throng::bake {

HWY_EXPORT(PackBlocks);

void pack_values(const uint16_t* values, const uint16_t* feet, const world::CellRows* has,
                 uint16_t low, std::vector<uint64_t>& words) {
  uint64_t packed[world::kValueHead + world::kBlocks * 16];  // as much as values can take
  const size_t used =
      HWY_DYNAMIC_DISPATCH(PackBlocks)(values, feet, has, low, packed, packed + world::kValueHead);
  words.insert(words.end(), packed, packed + world::kValueHead + used);
}

namespace {

// Bit i: byte i of a word is not 0.
uint64_t bytes_with_bits(uint64_t word) {
  constexpr uint64_t kLow = 0x7f7f7f7f7f7f7f7f;
  const uint64_t high = (((word & kLow) + kLow) | word) & ~kLow;
  return ((high >> 7) * 0x0102040810204080) >> 56;
}

}  // namespace

void pack_bits(const world::CellRows& rows, std::vector<uint64_t>& words) {
  uint64_t packed[world::kBitHead + world::kBlocks];
  uint64_t* next = packed + world::kBitHead;
  uint64_t mixed = 0, full = 0;
  for (size_t z = 0; z < 8; ++z) {
    const uint64_t* row = &rows[8 * z];
    uint64_t any = 0, all = ~uint64_t{0};
    for (size_t i = 0; i < 8; ++i) {
      any |= row[i];
      all &= row[i];
    }
    if (any == 0) continue;
    if (all == ~uint64_t{0}) {
      full |= uint64_t{0xff} << (8 * z);
      continue;
    }
    const uint64_t full_here = ~bytes_with_bits(~all) & 0xff;
    const uint64_t mixed_here = bytes_with_bits(any) & ~full_here;
    full |= full_here << (8 * z);
    mixed |= mixed_here << (8 * z);
    for (uint64_t left = mixed_here; left != 0; left &= left - 1) {
      const int x = std::countr_zero(left);
      uint64_t cells = 0;
      for (size_t i = 0; i < 8; ++i) cells |= (row[i] >> (8 * x) & 0xff) << (8 * i);
      *next++ = cells;
    }
  }
  packed[0] = mixed;
  packed[1] = full;
  words.insert(words.end(), packed, next);
}

}  // namespace throng::bake
#endif
