// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#if defined(THRONG_BAKE_CELL_BLOCKS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef THRONG_BAKE_CELL_BLOCKS_INL_H_
#undef THRONG_BAKE_CELL_BLOCKS_INL_H_
#else
#define THRONG_BAKE_CELL_BLOCKS_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <cstdint>

#include "bake/columns/vector_bits-inl.h"

/// The cells that one vector of spans holds; compiled once for each target, so it is included after
/// <hwy/highway.h> by files that use foreach_target.
HWY_BEFORE_NAMESPACE();
namespace throng::bake {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using DI = hn::CappedTag<int32_t, 16>;
using VI = hn::Vec<DI>;
using MI = hn::Mask<DI>;

/// The comparison that Highway leaves out.
HWY_INLINE MI at_least(VI a, VI b) { return hn::Not(hn::Lt(a, b)); }

/// A vector holds a block of cells, up to four columns wide: triangles touch two or three cells of
/// a row, so that vectors along a row would be next to empty. TileColumns::place says the same.
HWY_INLINE int32_t block_width() { return std::min(static_cast<int32_t>(hn::Lanes(DI())), 4); }
HWY_INLINE int32_t block_height() { return static_cast<int32_t>(hn::Lanes(DI())) / block_width(); }
/// Which column and row of its block a lane is.
HWY_INLINE VI column_in_block() {
  return hn::And(counting_from(DI(), 0), hn::Set(DI(), block_width() - 1));
}
HWY_INLINE VI row_in_block() {
  return hn::Lanes(DI()) < 4 ? hn::Zero(DI()) : hn::ShiftRight<2>(counting_from(DI(), 0));
}

}  // namespace HWY_NAMESPACE
}  // namespace throng::bake
HWY_AFTER_NAMESPACE();

#endif  // the toggle
