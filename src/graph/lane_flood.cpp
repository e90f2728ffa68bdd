// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "graph/lane_flood.h"

#include <algorithm>
#include <cstddef>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "graph/lane_flood.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
#include <hwy/highway.h>

// A set a lane. A flood by rows waits for the row before, so that sets beside each other are nearly
// free: each round fills, in every lane, the part that holds the first cell of what is left. By
// integers, and so the same for every width.
HWY_BEFORE_NAMESPACE();
namespace throng::graph {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<uint64_t, LaneScratch::kLanes>;
using V = hn::Vec<D>;

// Whole runs of `open` that hold a seed, as spread_runs of flood.cpp.
HWY_INLINE V SpreadRuns(V seed, V open) {
  V low = hn::Or(hn::AndNot(hn::Add(open, seed), open), seed);
  V down = open;
  low = hn::OrAnd(low, down, hn::ShiftRight<1>(low));
  down = hn::And(down, hn::ShiftRight<1>(down));
  low = hn::OrAnd(low, down, hn::ShiftRight<2>(low));
  down = hn::And(down, hn::ShiftRight<2>(down));
  low = hn::OrAnd(low, down, hn::ShiftRight<4>(low));
  down = hn::And(down, hn::ShiftRight<4>(down));
  low = hn::OrAnd(low, down, hn::ShiftRight<8>(low));
  down = hn::And(down, hn::ShiftRight<8>(down));
  low = hn::OrAnd(low, down, hn::ShiftRight<16>(low));
  down = hn::And(down, hn::ShiftRight<16>(down));
  return hn::OrAnd(low, down, hn::ShiftRight<32>(low));
}

class Round {
 public:
  // `first`: per lane the first row in which something is left, 64 for none.
  HWY_INLINE Round(LaneScratch& scratch, const uint64_t* first) : s_(scratch), first_(first) {
    const D d;
    begin_ = *std::min_element(first, first + hn::Lanes(d));
    for (size_t k = 0; k < hn::Lanes(d); ++k) {
      if (first[k] < 64) last_first_ = std::max<size_t>(last_first_, first[k]);
    }
  }

  HWY_INLINE void Fill() {
    FirstSweep();
    while (SweepUp() && SweepDown()) {
    }
  }

  // Takes what was filled from what is left, and gives each lane its part.
  HWY_INLINE void Take(size_t lanes) {
    const D d;
    const V one = hn::Set(d, 1);
    V cells = hn::Zero(d), west = hn::Zero(d), east = hn::Zero(d), end = hn::Zero(d);
    for (size_t z = begin_; z < end_; ++z) {
      const V filled = Filled(z);
      hn::Store(hn::AndNot(filled, Open(z)), d, s_.open[z].data());
      cells = hn::Add(cells, hn::PopulationCount(filled));
      const auto by = static_cast<int>(z);
      west = hn::Or(west, hn::ShiftLeftSame(hn::And(filled, one), by));
      east = hn::Or(east, hn::ShiftLeftSame(hn::ShiftRight<63>(filled), by));
      end = hn::IfThenElse(hn::Eq(filled, hn::Zero(d)), end, hn::Set(d, z + 1));
    }
    alignas(64) std::array<std::array<uint64_t, LaneScratch::kLanes>, 4> out;
    hn::Store(cells, d, out[0].data());
    hn::Store(west, d, out[1].data());
    hn::Store(east, d, out[2].data());
    hn::Store(end, d, out[3].data());
    for (size_t k = 0; k < lanes; ++k) {
      if (first_[k] == 64) continue;
      PartList& list = s_.found[k];
      PartList::Part& part = list.parts.emplace_back();
      part.rows = static_cast<uint32_t>(list.rows.size());
      part.begin = static_cast<uint16_t>(first_[k]);
      part.end = static_cast<uint16_t>(out[3][k]);
      part.cells = static_cast<uint32_t>(out[0][k]);
      part.side = {out[1][k], out[2][k], part.begin == 0 ? s_.filled[0][k] : 0,
                   part.end == 64 ? s_.filled[63][k] : 0};
      list.rows.resize(part.rows + part.end - part.begin);
      uint64_t* row = &list.rows[part.rows];
      for (size_t z = part.begin; z < part.end; ++z) *row++ = s_.filled[z][k];
    }
  }

 private:
  HWY_INLINE V Open(size_t z) const { return hn::Load(D(), s_.open[z].data()); }
  HWY_INLINE V Filled(size_t z) const { return hn::Load(D(), s_.filled[z].data()); }
  HWY_INLINE static bool IsNone(V v) { return hn::AllTrue(D(), hn::Eq(v, hn::Zero(D()))); }

  // From the first cells down; rows before `end_` are then filled, maybe with nothing.
  HWY_INLINE void FirstSweep() {
    const D d;
    const V first = hn::LoadU(d, first_);
    V above = hn::Zero(d);
    for (end_ = begin_; end_ < 64; ++end_) {
      const V open = Open(end_);
      const V lowest = hn::And(open, hn::Sub(hn::Zero(d), open));
      const V start = hn::IfThenElseZero(hn::Eq(first, hn::Set(d, end_)), lowest);
      const V seed = hn::Or(hn::And(above, open), start);
      if (IsNone(seed)) {
        if (end_ > last_first_) break;
        above = hn::Zero(d);
      } else {
        above = SpreadRuns(seed, open);
      }
      hn::Store(above, d, s_.filled[end_].data());
    }
  }

  // False if it finds nothing.
  HWY_INLINE bool Enter(size_t z, V from) {
    const V filled = Filled(z), open = Open(z);
    const V seed = hn::AndNot(filled, hn::And(from, open));
    if (IsNone(seed)) return false;
    hn::Store(hn::Or(filled, SpreadRuns(seed, open)), D(), s_.filled[z].data());
    return true;
  }

  HWY_INLINE bool SweepUp() {
    bool is_new = false;
    for (size_t z = end_ - 1; z-- > begin_;) is_new |= Enter(z, Filled(z + 1));
    return is_new;
  }

  HWY_INLINE bool SweepDown() {
    bool is_new = false;
    for (size_t z = begin_ + 1; z < end_; ++z) is_new |= Enter(z, Filled(z - 1));
    for (; end_ < 64 && !IsNone(hn::And(Filled(end_ - 1), Open(end_))); ++end_) {
      hn::Store(hn::Zero(D()), D(), s_.filled[end_].data());
      is_new |= Enter(end_, Filled(end_ - 1));
    }
    return is_new;
  }

  LaneScratch& s_;
  const uint64_t* first_;
  size_t begin_ = 0, end_ = 0, last_first_ = 0;
};

size_t LaneCount() { return hn::Lanes(D()); }

void FindParts(std::span<const world::CellRows* const> sets, LaneScratch& scratch) {
  const D d;
  const size_t lanes = hn::Lanes(d);
  for (size_t z = 0; z < 64; ++z) {
    for (size_t k = 0; k < lanes; ++k) {
      scratch.open[z][k] = k < sets.size() ? (*sets[k])[z] : 0;
    }
  }
  alignas(64) std::array<uint64_t, LaneScratch::kLanes> first{};
  for (;;) {
    bool is_any = false;
    for (size_t k = 0; k < lanes; ++k) {
      while (first[k] < 64 && scratch.open[first[k]][k] == 0) ++first[k];
      is_any |= first[k] < 64;
    }
    if (!is_any) break;
    Round round(scratch, first.data());
    round.Fill();
    round.Take(sets.size());
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace throng::graph
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace throng::graph {

HWY_EXPORT(LaneCount);
HWY_EXPORT(FindParts);

void find_parts_of(std::span<const world::CellRows* const> sets, LaneScratch& scratch,
                   PartList& list, std::span<uint32_t> first) {
  const size_t lanes = HWY_DYNAMIC_DISPATCH(LaneCount)();
  for (size_t s = 0; s < sets.size(); s += lanes) {
    const size_t count = std::min(lanes, sets.size() - s);
    for (size_t k = 0; k < count; ++k) scratch.found[k].clear();
    HWY_DYNAMIC_DISPATCH(FindParts)(sets.subspan(s, count), scratch);
    for (size_t k = 0; k < count; ++k) {
      first[s + k] = static_cast<uint32_t>(list.parts.size());
      const auto rows = static_cast<uint32_t>(list.rows.size());
      for (PartList::Part part : scratch.found[k].parts) {
        part.rows += rows;
        list.parts.push_back(part);
      }
      list.rows.insert(list.rows.end(), scratch.found[k].rows.begin(), scratch.found[k].rows.end());
    }
  }
  first[sets.size()] = static_cast<uint32_t>(list.parts.size());
}

}  // namespace throng::graph
#endif
