// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "bake/columns/free_spans.h"

#include <algorithm>

// Lists the free spans of a tile's columns. Spans come by blocks of cells and unsorted; free spans
// leave by rows and ascending. A run of blocks side by side is turned into rows as it is loaded,
// and each vector of a row is sorted by a network.

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bake/columns/free_spans.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
#include <hwy/highway.h>

#include "bake/columns/cell_blocks-inl.h"

HWY_BEFORE_NAMESPACE();
namespace throng::bake {
namespace HWY_NAMESPACE {

// Spans of one vector of columns, while they are sorted.
constexpr size_t kNetwork = 16;  // deepest column that the vector path sorts

struct SpanVectors {
  VI low[kNetwork], high[kNetwork], support[kNetwork];

  // Puts the lower of two spans first, lane by lane.
  HWY_INLINE void order(size_t a, size_t b) {
    const MI swap = hn::Gt(low[a], low[b]);
    exchange(swap, low[a], low[b]);
    exchange(swap, high[a], high[b]);
    exchange(swap, support[a], support[b]);
  }

  // Batcher's odd-even merge sort of the first n.
  HWY_INLINE void sort(size_t n) {
    for (size_t p = 1; p < n; p *= 2) {
      for (size_t k = p; k >= 1; k /= 2) {
        for (size_t j = k % p; j + k < n; j += 2 * k) {
          for (size_t i = 0; i < std::min(k, n - j - k); ++i) {
            if ((i + j) / (p * 2) == (i + j + k) / (p * 2)) order(i + j, i + j + k);
          }
        }
      }
    }
  }

 private:
  static HWY_INLINE void exchange(MI swap, VI& a, VI& b) {
    const VI old = a;
    a = hn::IfThenElse(swap, b, old);
    b = hn::IfThenElse(swap, old, b);
  }
};

HWY_INLINE FreeSpanLayer& free_span_layer_at(TileFreeSpans& free_spans, int32_t k) {
  while (static_cast<int32_t>(free_spans.layers.size()) <= k) {
    free_spans.layers.push_back(std::make_unique_for_overwrite<FreeSpanLayer>());
  }
  return *free_spans.layers[static_cast<size_t>(k)];
}

// One deep column, by std::sort.
void free_spans_of_deep_column(const TileColumns& columns, int32_t cell, int32_t min_free_span,
                               TileFreeSpans& free_spans, std::vector<TileColumns::Spill>& spans) {
  const auto c = static_cast<size_t>(cell);
  const size_t p = columns.place(c);
  spans.clear();
  for (int32_t k = 0; k < columns.depth[p / static_cast<size_t>(columns.lanes)]; ++k) {
    const SpanLayer& free_layer = *columns.layers[static_cast<size_t>(k)];
    if (free_layer.low[p] == kNoSpan) continue;
    spans.push_back({cell, free_layer.low[p], free_layer.high[p], free_layer.support[p]});
  }
  const auto spilled = columns.spills_of(cell);
  spans.insert(spans.end(), spilled.begin(), spilled.end());
  std::sort(spans.begin(), spans.end(), [](const auto& a, const auto& b) {
    return a.low != b.low ? a.low < b.low : a.high < b.high;
  });
  if (spans.empty()) return;
  int32_t found = 0;
  TileColumns::Spill run = spans.front();
  const auto emit = [&](int32_t ceiling) {
    FreeSpanLayer& free_layer = free_span_layer_at(free_spans, found++);
    free_layer.top[c] = run.high;
    free_layer.ceiling[c] = ceiling;
    free_layer.support[c] = run.support;
  };
  for (const auto& next : spans) {
    if (next.low - run.high >= min_free_span) {
      emit(next.low);
      run = next;
    } else {
      run.high = std::max(run.high, next.high);
      run.support = std::max(run.support, next.support);
    }
  }
  emit(kOpenSkyMm);
  free_spans.count[c] = found;
  free_spans.max_count = std::max(free_spans.max_count, found);
  free_spans.spans += static_cast<uint64_t>(found);
}

// Writes one free span to each lane of `mask`, into the free-span layer that the lane has reached.
HWY_INLINE void emit(TileFreeSpans& free_spans, size_t c, MI mask, VI found, int32_t deepest,
                     VI top, VI ceiling, VI support) {
  const DI di;
  for (int32_t k = 0; k <= deepest; ++k) {
    const MI here = hn::And(mask, hn::Eq(found, hn::Set(di, k)));
    if (hn::AllFalse(di, here)) continue;
    FreeSpanLayer& free_layer = free_span_layer_at(free_spans, k);
    hn::BlendedStore(top, here, di, &free_layer.top[c]);
    hn::BlendedStore(ceiling, here, di, &free_layer.ceiling[c]);
    hn::BlendedStore(support, here, di, &free_layer.support[c]);
  }
}

constexpr size_t kMaxBlocks = 4;  // side by side in one vector along a row

// Turns blocks side by side into rows, in place: vector i is row i of them afterwards.
HWY_INLINE void blocks_to_rows(VI (&v)[kMaxBlocks]) {
#if HWY_TARGET != HWY_SCALAR
  const DI di;
  if (hn::Lanes(di) == 16) {
    const VI even_01 = hn::OddEvenBlocks(hn::SwapAdjacentBlocks(v[1]), v[0]);
    const VI odd_01 = hn::OddEvenBlocks(v[1], hn::SwapAdjacentBlocks(v[0]));
    const VI even_23 = hn::OddEvenBlocks(hn::SwapAdjacentBlocks(v[3]), v[2]);
    const VI odd_23 = hn::OddEvenBlocks(v[3], hn::SwapAdjacentBlocks(v[2]));
    v[0] = hn::ConcatLowerLower(di, even_23, even_01);
    v[1] = hn::ConcatLowerLower(di, odd_23, odd_01);
    v[2] = hn::ConcatUpperUpper(di, even_23, even_01);
    v[3] = hn::ConcatUpperUpper(di, odd_23, odd_01);
  } else if (hn::Lanes(di) == 8) {
    const VI low = hn::ConcatLowerLower(di, v[1], v[0]);
    v[1] = hn::ConcatUpperUpper(di, v[1], v[0]);
    v[0] = low;
  }
#else
  (void)v;
#endif
}

// Free spans of one vector of columns, of n sorted spans each.
HWY_INLINE VI list_free_spans(const SpanVectors& spans, size_t c, size_t n, int32_t min_free_span,
                              TileFreeSpans& free_spans) {
  static_assert(kNoSpan == kOpenSkyMm);  // A span that is not there sorts last, as the sky.
  const DI di;
  const VI sky = hn::Set(di, kOpenSkyMm);
  VI top = spans.high[0], support = spans.support[0], found = hn::Zero(di);
  int32_t deepest = 0;
  for (size_t k = 1; k < n; ++k) {
    const VI low = spans.low[k], high = spans.high[k];
    const MI has = hn::Lt(low, sky);
    // Spans lie within 2^31 mm of each other; the sentinel is masked by `has`.
    const MI apart = hn::And(has, at_least(hn::Sub(low, top), hn::Set(di, min_free_span)));
    if (!hn::AllFalse(di, apart)) {
      emit(free_spans, c, apart, found, deepest, top, low, support);
      found = hn::Add(found, hn::IfThenElseZero(apart, hn::Set(di, 1)));
      ++deepest;
    }
    const MI joined = hn::AndNot(apart, has);
    top = hn::IfThenElse(apart, high, hn::IfThenElse(joined, hn::Max(top, high), top));
    support = hn::IfThenElse(apart, spans.support[k],
                             hn::IfThenElse(joined, hn::Max(support, spans.support[k]), support));
  }
  const MI any = hn::Lt(spans.low[0], sky);
  emit(free_spans, c, any, found, deepest, top, sky, support);
  return hn::IfThenElseZero(any, hn::Add(found, hn::Set(di, 1)));
}

// A row of blocks, one vector of columns wide: cells (x, z) on.
struct BlockRun {
  size_t place = 0;               // of its first block in a layer
  size_t depth[kMaxBlocks] = {};  // 0 for blocks too deep for vectors
  size_t deepest = 0;
  bool any_too_deep = false;
};

HWY_INLINE BlockRun run_of_blocks(const TileColumns& columns, int32_t x, int32_t z) {
  BlockRun run;
  run.place = static_cast<size_t>(z * kTileSide + x * block_height());
  const size_t first = run.place / hn::Lanes(DI());
  for (size_t b = 0; b < static_cast<size_t>(block_height()); ++b) {
    const size_t depth = columns.depth[first + b];
    run.any_too_deep |= depth > kNetwork;
    run.depth[b] = depth > kNetwork ? 0 : depth;
    run.deepest = std::max(run.deepest, run.depth[b]);
  }
  return run;
}

// The spans of a run of blocks, by rows.
HWY_INLINE void load_spans(const TileColumns& columns, const BlockRun& run,
                           SpanVectors (&rows)[kMaxBlocks]) {
  const DI di;
  const auto blocks = static_cast<size_t>(block_height());
  const VI none[3] = {hn::Set(di, kNoSpan), hn::Set(di, INT32_MIN), hn::Set(di, kNoSupport)};
  for (size_t k = 0; k < run.deepest; ++k) {
    const SpanLayer& free_layer = *columns.layers[k];
    VI low[kMaxBlocks], high[kMaxBlocks], support[kMaxBlocks];
    for (size_t b = 0; b < blocks; ++b) {
      const size_t at = run.place + b * hn::Lanes(di);
      const bool has = k < run.depth[b];
      low[b] = has ? hn::Load(di, &free_layer.low[at]) : none[0];
      high[b] = has ? hn::Load(di, &free_layer.high[at]) : none[1];
      support[b] = has ? hn::Load(di, &free_layer.support[at]) : none[2];
    }
    blocks_to_rows(low);
    blocks_to_rows(high);
    blocks_to_rows(support);
    for (size_t row = 0; row < blocks; ++row) {
      rows[row].low[k] = low[row];
      rows[row].high[k] = high[row];
      rows[row].support[k] = support[row];
    }
  }
}

void FindFreeSpans(const TileColumns& columns, int32_t min_free_span, TileFreeSpans& free_spans) {
  const DI di;
  const auto lanes = static_cast<int32_t>(hn::Lanes(di));
  free_spans.base = columns.base;
  free_spans.max_count = 0;
  free_spans.spans = 0;
  std::vector<TileColumns::Spill> scratch;
  SpanVectors rows[kMaxBlocks];
  VI total = hn::Zero(di);
  VI max_found = hn::Zero(di);
  for (int32_t z = 0; z < kTileSide; z += block_height()) {
    for (int32_t x = 0; x < kTileSide; x += lanes) {
      const BlockRun run = run_of_blocks(columns, x, z);
      load_spans(columns, run, rows);
      for (int32_t row = 0; row < block_height(); ++row) {
        const auto c = static_cast<size_t>((z + row) * kTileSide + x);
        VI found = hn::Zero(di);
        if (run.deepest > 0) {
          rows[row].sort(run.deepest);
          found = list_free_spans(rows[row], c, run.deepest, min_free_span, free_spans);
        }
        hn::Store(found, di, &free_spans.count[c]);
        total = hn::Add(total, found);
        max_found = hn::Max(max_found, found);
      }
      if (HWY_LIKELY(!run.any_too_deep)) continue;
      for (int32_t row = 0; row < block_height(); ++row) {
        for (int32_t i = 0; i < lanes; ++i) {
          const int32_t cell = (z + row) * kTileSide + x + i;
          const size_t block = columns.place(static_cast<size_t>(cell)) / hn::Lanes(di);
          if (columns.depth[block] > kNetwork) {
            free_spans_of_deep_column(columns, cell, min_free_span, free_spans, scratch);
          }
        }
      }
    }
  }
  free_spans.spans += static_cast<uint64_t>(hn::GetLane(hn::SumOfLanes(di, total)));
  free_spans.max_count = std::max(free_spans.max_count, hn::GetLane(hn::MaxOfLanes(di, max_found)));
}

// A column with a solid has at least the sky above it.
void BareColumns(const TileFreeSpans& free_spans, std::array<uint64_t, kTileSide>& bare) {
  const DI di;
  for (size_t z = 0; z < kTileSide; ++z) {
    bare[z] = 0;
    for (size_t x = 0; x < kTileSide; x += hn::Lanes(di)) {
      const VI count = hn::Load(di, &free_spans.count[z * kTileSide + x]);
      bare[z] |= bits_of(di, hn::Eq(count, hn::Zero(di))) << x;
    }
  }
}

void LendSupports(TileFreeSpans& free_spans) {
  const DI di;
  for (size_t c = 0; c < kTileArea; c += hn::Lanes(di)) {
    const VI count = hn::Load(di, &free_spans.count[c]);
    VI below = hn::Set(di, kNoSupport);
    for (int32_t k = 0; k < free_spans.max_count; ++k) {
      const MI has = hn::Gt(count, hn::Set(di, k));
      if (hn::AllFalse(di, has)) break;
      FreeSpanLayer& free_layer = *free_spans.layers[static_cast<size_t>(k)];
      below = hn::Max(hn::Load(di, &free_layer.support[c]), below);
      hn::BlendedStore(below, has, di, &free_layer.support[c]);
    }
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace throng::bake
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace throng::bake {

HWY_EXPORT(FindFreeSpans);
HWY_EXPORT(LendSupports);
HWY_EXPORT(BareColumns);

void find_free_spans(const TileColumns& columns, int32_t min_free_span, TileFreeSpans& free_spans) {
  HWY_DYNAMIC_DISPATCH(FindFreeSpans)(columns, min_free_span, free_spans);
}

void lend_supports(TileFreeSpans& free_spans) { HWY_DYNAMIC_DISPATCH(LendSupports)(free_spans); }

std::array<uint64_t, kTileSide> bare_columns(const TileFreeSpans& free_spans) {
  std::array<uint64_t, kTileSide> bare;
  HWY_DYNAMIC_DISPATCH(BareColumns)(free_spans, bare);
  return bare;
}

}  // namespace throng::bake
#endif  // HWY_ONCE
