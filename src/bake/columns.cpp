// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "bake/columns.h"

#include <algorithm>
#include <cmath>

// A triangle is cut into the rows of cells that it touches. The cut of a row is a convex polygon of
// at most five corners; over each cell of the row its lowest and highest point lie on the polygon's
// edges, so a vector of cells takes them edge by edge. One rule serves border cells, inner cells
// and vertical walls. Rows and cells are widened by kWiden, far more than the arithmetic can err,
// so rounding only ever adds matter. After Hasselgren, Akenine-Moeller, Ohlsson. Conservative
// rasterization. GPU Gems 2, 2005.
//
// A span goes to the first layer of its column that it touches, or to a new one: no lists, no
// second pass.

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bake/columns.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace throng {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using DF = hn::CappedTag<float, 16>;
using DI = hn::RebindToSigned<DF>;
using VF = hn::Vec<DF>;
using VI = hn::Vec<DI>;
using MI = hn::Mask<DI>;

// Integer comparisons that Highway leaves out.
HWY_INLINE MI at_least(VI a, VI b) { return hn::Not(hn::Lt(a, b)); }
HWY_INLINE MI within(VI index, int32_t first, int32_t last) {
  const DI di;
  return hn::And(at_least(index, hn::Set(di, first)), at_least(hn::Set(di, last), index));
}

// A corner of a row's cut: x in cells of the tile, y in mm from the base.
struct Corner {
  double x, y;
};

// One edge of a row's cut.
struct RowEdge {
  float x0, x1;  // x0 <= x1
  float y0;      // at x0
  float slope;   // mm per cell; unused if upright
  float low, high;
  bool upright;  // too short in x for a slope: its whole height counts
};

struct RowPolygon {
  RowEdge edges[5];
  int32_t edge_count = 0;

  HWY_INLINE void add_edge(Corner a, Corner b) {
    if (a.x > b.x) std::swap(a, b);
    RowEdge& e = edges[edge_count++];
    const double dx = b.x - a.x;
    // Only the part over the tile: a far end would cost the float its precision.
    const double x0 = std::max(a.x, -1.0);
    e.x0 = static_cast<float>(x0);
    e.x1 = static_cast<float>(std::min(b.x, 65.0));
    e.low = static_cast<float>(std::min(a.y, b.y));
    e.high = static_cast<float>(std::max(a.y, b.y));
    e.upright = !(dx > 1e-3);
    const double slope = e.upright ? 0 : (b.y - a.y) / dx;
    e.slope = static_cast<float>(slope);
    e.y0 = static_cast<float>(a.y + (x0 - a.x) * slope);
  }
};

HWY_INLINE SpanLayer& layer_at(TileColumns& columns, int32_t k) {
  while (static_cast<int32_t>(columns.layers.size()) <= k) {
    columns.layers.push_back(std::make_unique_for_overwrite<SpanLayer>());
  }
  return *columns.layers[static_cast<size_t>(k)];
}

// Keeps the spans for which no layer is left.
void spill(TileColumns& columns, int32_t cell, MI mask, VI low, VI high, VI support) {
  const DI di;
  alignas(64) int32_t lows[16], highs[16], supports[16], set[16];
  hn::Store(low, di, lows);
  hn::Store(high, di, highs);
  hn::Store(support, di, supports);
  hn::Store(hn::IfThenElseZero(mask, hn::Set(di, 1)), di, set);
  for (int32_t lane = 0; lane < static_cast<int32_t>(hn::Lanes(di)); ++lane) {
    if (set[lane] != 0) columns.spills.push_back({cell + lane, lows[lane], highs[lane], supports[lane]});
  }
}

// Adds a span to each cell of one vector where mask is set.
HWY_INLINE void insert(TileColumns& columns, int32_t cell, MI mask, VI low, VI high, VI support,
                       int32_t join) {
  const DI di;
  const size_t c = static_cast<size_t>(cell);
  const VI count = hn::Load(di, &columns.count[c]);
  const int32_t deepest = hn::GetLane(hn::MaxOfLanes(di, hn::IfThenElseZero(mask, count)));
  const VI reach_low = hn::Sub(low, hn::Set(di, join));
  const VI reach_high = hn::Add(high, hn::Set(di, join));
  for (int32_t k = 0; k < deepest; ++k) {
    SpanLayer& layer = *columns.layers[static_cast<size_t>(k)];
    const VI other_low = hn::Load(di, &layer.low[c]);
    const VI other_high = hn::Load(di, &layer.high[c]);
    const MI touch = hn::And(hn::And(mask, hn::Gt(count, hn::Set(di, k))),
                             hn::And(at_least(other_high, reach_low), at_least(reach_high, other_low)));
    if (hn::AllFalse(di, touch)) continue;
    hn::BlendedStore(hn::Min(low, other_low), touch, di, &layer.low[c]);
    hn::BlendedStore(hn::Max(high, other_high), touch, di, &layer.high[c]);
    hn::BlendedStore(hn::Max(support, hn::Load(di, &layer.support[c])), touch, di,
                     &layer.support[c]);
    mask = hn::AndNot(touch, mask);
    if (hn::AllFalse(di, mask)) return;
  }
  // What touched nothing is appended: mostly all lanes to the same layer.
  for (int32_t k = 0; k <= std::min(deepest, TileColumns::kMaxLayers - 1); ++k) {
    const MI here = hn::And(mask, hn::Eq(count, hn::Set(di, k)));
    if (hn::AllFalse(di, here)) continue;
    SpanLayer& layer = layer_at(columns, k);
    hn::BlendedStore(low, here, di, &layer.low[c]);
    hn::BlendedStore(high, here, di, &layer.high[c]);
    hn::BlendedStore(support, here, di, &layer.support[c]);
  }
  const MI fits = hn::And(mask, hn::Lt(count, hn::Set(di, TileColumns::kMaxLayers)));
  hn::Store(hn::Add(count, hn::IfThenElseZero(fits, hn::Set(di, 1))), di, &columns.count[c]);
  const MI left = hn::AndNot(fits, mask);
  if (HWY_UNLIKELY(!hn::AllFalse(di, left))) spill(columns, cell, left, low, high, support);
}

// What a triangle does in one row of the tile.
struct RowTask {
  int32_t row;
  int32_t x0, x1;  // cells touched, inclusive
  int32_t c0, c1;  // cells whose centre is covered, inclusive; none if c0 > c1
  float centre_x = 0, centre_y = 0, centre_slope = 0;  // the surface along the row's centre line
  int32_t low, high;                       // of the triangle, mm from the base
  int32_t code;
  bool flat;
};

// The triangle's heights over one vector of cells of its row.
HWY_INLINE void row_heights(const RowPolygon& row, VF x, VI& low, VI& high) {
  const DF df;
  const DI di;
  const float widen = static_cast<float>(kWiden);
  const VF cell_low = hn::Sub(x, hn::Set(df, widen));
  const VF cell_high = hn::Add(x, hn::Set(df, 1.0f + widen));
  VF y_low = hn::Set(df, 3e38f);
  VF y_high = hn::Set(df, -3e38f);
  for (int32_t i = 0; i < row.edge_count; ++i) {
    const RowEdge& e = row.edges[i];
    const VF x0 = hn::Set(df, e.x0);
    const VF a = hn::Max(x0, cell_low);
    const VF b = hn::Min(hn::Set(df, e.x1), cell_high);
    const auto meets = hn::Le(a, b);
    VF lo = hn::Set(df, e.low);
    VF hi = hn::Set(df, e.high);
    if (!e.upright) {
      const VF slope = hn::Set(df, e.slope);
      const VF y0 = hn::Set(df, e.y0);
      const VF ya = hn::Add(y0, hn::Mul(hn::Sub(a, x0), slope));
      const VF yb = hn::Add(y0, hn::Mul(hn::Sub(b, x0), slope));
      lo = hn::Max(lo, e.slope >= 0 ? ya : yb);
      hi = hn::Min(hi, e.slope >= 0 ? yb : ya);
    }
    y_low = hn::IfThenElse(meets, hn::Min(y_low, lo), y_low);
    y_high = hn::IfThenElse(meets, hn::Max(y_high, hi), y_high);
  }
  // Float heights err by less than this many mm; the margin grows with the distance to the base.
  const VF far = hn::Max(hn::Abs(y_low), hn::Abs(y_high));
  const VF margin = hn::Add(hn::Set(df, 0.05f), hn::Mul(far, hn::Set(df, 0x1p-21f)));
  low = hn::Max(low, hn::ConvertTo(di, hn::Floor(hn::Sub(y_low, margin))));
  high = hn::Min(high, hn::ConvertTo(di, hn::Ceil(hn::Add(y_high, margin))));
}

HWY_INLINE void fill_row(TileColumns& columns, const RowTask& task, const RowPolygon& row,
                         int32_t join) {
  const DF df;
  const DI di;
  const int32_t lanes = static_cast<int32_t>(hn::Lanes(df));
  const VI tri_low = hn::Set(di, task.low);
  const VI tri_high = hn::Set(di, task.high);
  for (int32_t begin = task.x0 & ~(lanes - 1); begin <= task.x1; begin += lanes) {
    const VI index = hn::Iota(di, begin);
    const VF x = hn::ConvertTo(df, index);
    const MI mask = within(index, task.x0, task.x1);
    VI low = tri_low;
    VI high = tri_high;
    if (!task.flat) row_heights(row, x, low, high);
    VI support = hn::Set(di, kNoSupport);
    if (task.c0 <= task.c1 && task.c1 >= begin && task.c0 < begin + lanes) {
      const MI covered = within(index, task.c0, task.c1);
      VI height = tri_low;
      if (!task.flat) {
        const VF along = hn::Sub(hn::Add(x, hn::Set(df, 0.5f)), hn::Set(df, task.centre_x));
        const VF y = hn::Add(hn::Set(df, task.centre_y),
                             hn::Mul(along, hn::Set(df, task.centre_slope)));
        height = hn::Min(tri_high, hn::Max(tri_low, hn::NearestInt(y)));
      }
      // Over 8 km above the tile's lowest matter there is nothing to stand on.
      const MI near = hn::And(covered, hn::Lt(height, hn::Set(di, 1 << 23)));
      const VI packed = hn::Or(hn::ShiftLeft<8>(height), hn::Set(di, task.code));
      support = hn::IfThenElse(near, packed, support);
    }
    insert(columns, task.row * kTileSide + begin, mask, low, high, support, join);
  }
}

// A triangle in the tile's frame, ready to be cut into rows.
struct Cutter {
  double x[3], y[3], z[3];
  double kx02, ky02, kx01, ky01, kx12, ky12;

  Cutter(const CellTriangle& t, int32_t cell_x, int32_t cell_z, int32_t base) {
    for (size_t i = 0; i < 3; ++i) {
      x[i] = t.x[i] - cell_x;
      y[i] = t.y[i] - base;
      z[i] = t.z[i] - cell_z;
    }
    const double d02 = z[2] > z[0] ? 1 / (z[2] - z[0]) : 0;
    const double d01 = z[1] > z[0] ? 1 / (z[1] - z[0]) : 0;
    const double d12 = z[2] > z[1] ? 1 / (z[2] - z[1]) : 0;
    kx02 = (x[2] - x[0]) * d02;
    ky02 = (y[2] - y[0]) * d02;
    kx01 = (x[1] - x[0]) * d01;
    ky01 = (y[1] - y[0]) * d01;
    kx12 = (x[2] - x[1]) * d12;
    ky12 = (y[2] - y[1]) * d12;
  }
  // The point at z = at of the side from the first to the last corner.
  HWY_INLINE Corner on_long(double at) const {
    return {x[0] + (at - z[0]) * kx02, y[0] + (at - z[0]) * ky02};
  }
  // The same on the two sides by way of the middle corner.
  HWY_INLINE Corner on_short(double at) const {
    if (at <= z[1]) return {x[0] + (at - z[0]) * kx01, y[0] + (at - z[0]) * ky01};
    return {x[1] + (at - z[1]) * kx12, y[1] + (at - z[1]) * ky12};
  }
};

// Which centres of the row the triangle covers, and its surface there.
HWY_INLINE void cut_centre(const Cutter& cut, const TileRect& rect, RowTask& task) {
  task.c0 = 1;
  task.c1 = 0;
  const double centre = task.row + 0.5;
  if (centre < cut.z[0] || centre > cut.z[2]) return;
  Corner a = cut.on_long(centre), b = cut.on_short(centre);
  if (a.x > b.x) std::swap(a, b);
  constexpr double kOn = 1e-6;  // A centre on a shared edge belongs to both triangles.
  const double first = std::ceil(a.x - 0.5 - kOn);
  const double last = std::floor(b.x - 0.5 + kOn);
  if (first > last || last < rect.x0 || first >= rect.x1 || !(b.x - a.x > 1e-9)) return;
  task.c0 = static_cast<int32_t>(std::max<double>(first, rect.x0));
  task.c1 = static_cast<int32_t>(std::min<double>(last, rect.x1 - 1));
  const double slope = (b.y - a.y) / (b.x - a.x);
  const double at = task.c0 + 0.5;
  task.centre_x = static_cast<float>(at);
  task.centre_y = static_cast<float>(a.y + (at - a.x) * slope);
  task.centre_slope = static_cast<float>(slope);
}

void RasteriseTile(std::span<const CellTriangle> triangles, std::span<const uint32_t> items,
                   int32_t cell_x, int32_t cell_z, const TileRect& rect, int32_t join,
                   TileColumns& columns) {
  columns.count.fill(0);
  columns.spills.clear();
  columns.base = items.empty() ? 0 : INT32_MAX;
  for (const uint32_t item : items) columns.base = std::min(columns.base, triangles[item].low);

  for (const uint32_t item : items) {
    const CellTriangle& t = triangles[item];
    const Cutter cut(t, cell_x, cell_z, columns.base);
    const double z_first = std::floor(cut.z[0] - kWiden);
    const double z_last = std::floor(cut.z[2] + kWiden);
    if (z_last < rect.z0 || z_first >= rect.z1) continue;
    const int32_t row0 = static_cast<int32_t>(std::max<double>(z_first, rect.z0));
    const int32_t row1 = static_cast<int32_t>(std::min<double>(z_last, rect.z1 - 1));

    RowTask task;
    task.low = t.low - columns.base;
    task.high = t.high - columns.base;
    task.code = t.code;
    task.flat = task.low == task.high;
    for (task.row = row0; task.row <= row1; ++task.row) {
      const double from = std::max(task.row - kWiden, cut.z[0]);
      const double to = std::min(task.row + 1 + kWiden, cut.z[2]);
      // The last corner is taken as it is: a triangle within one z has no point "at" it.
      const bool has_last = cut.z[2] <= to;
      const Corner last{cut.x[2], cut.y[2]};
      const Corner l0 = cut.on_long(from), l1 = has_last ? last : cut.on_long(to);
      const Corner s0 = cut.on_short(from), s1 = has_last ? last : cut.on_short(to);
      const bool has_middle = cut.z[1] >= from && cut.z[1] <= to;
      const Corner middle{cut.x[1], cut.y[1]};
      double x_low = std::min(std::min(l0.x, l1.x), std::min(s0.x, s1.x));
      double x_high = std::max(std::max(l0.x, l1.x), std::max(s0.x, s1.x));
      if (has_middle) {
        x_low = std::min(x_low, middle.x);
        x_high = std::max(x_high, middle.x);
      }
      const double touch_low = std::floor(x_low - kWiden);
      const double touch_high = std::floor(x_high + kWiden);
      if (touch_high < rect.x0 || touch_low >= rect.x1) continue;
      task.x0 = static_cast<int32_t>(std::max<double>(touch_low, rect.x0));
      task.x1 = static_cast<int32_t>(std::min<double>(touch_high, rect.x1 - 1));
      RowPolygon row;
      if (!task.flat) {
        row.add_edge(l0, l1);
        if (has_middle) {
          row.add_edge(s0, middle);
          row.add_edge(middle, s1);
        } else {
          row.add_edge(s0, s1);
        }
        row.add_edge(l0, s0);
        row.add_edge(l1, s1);
      }
      cut_centre(cut, rect, task);
      fill_row(columns, task, row, join);
    }
  }
  std::stable_sort(columns.spills.begin(), columns.spills.end(),
                   [](const auto& a, const auto& b) { return a.cell < b.cell; });
}

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

HWY_INLINE GapLayer& gap_layer_at(TileGaps& gaps, int32_t k) {
  while (static_cast<int32_t>(gaps.layers.size()) <= k) {
    gaps.layers.push_back(std::make_unique_for_overwrite<GapLayer>());
  }
  return *gaps.layers[static_cast<size_t>(k)];
}

// One deep column, by plain sorting.
void gaps_of_deep_column(const TileColumns& columns, int32_t cell, int32_t min_gap, TileGaps& gaps,
                         std::vector<TileColumns::Spill>& spans) {
  const size_t c = static_cast<size_t>(cell);
  spans.clear();
  for (int32_t k = 0; k < columns.count[c]; ++k) {
    const SpanLayer& layer = *columns.layers[static_cast<size_t>(k)];
    spans.push_back({cell, layer.low[c], layer.high[c], layer.support[c]});
  }
  const auto spilled = columns.spills_of(cell);
  spans.insert(spans.end(), spilled.begin(), spilled.end());
  std::sort(spans.begin(), spans.end(), [](const auto& a, const auto& b) {
    return a.low != b.low ? a.low < b.low : a.high < b.high;
  });
  int32_t found = 0;
  TileColumns::Spill run = spans.front();
  const auto emit = [&](int32_t ceiling) {
    GapLayer& layer = gap_layer_at(gaps, found++);
    layer.top[c] = run.high;
    layer.ceiling[c] = ceiling;
    layer.support[c] = run.support;
  };
  for (const auto& next : spans) {
    if (next.low - run.high >= min_gap) {
      emit(next.low);
      run = next;
    } else {
      run.high = std::max(run.high, next.high);
      run.support = std::max(run.support, next.support);
    }
  }
  emit(kOpenSkyMm);
  gaps.count[c] = found;
  gaps.max_count = std::max(gaps.max_count, found);
  gaps.spans += static_cast<uint64_t>(found);
}

// Writes one gap to each lane of `mask`, into the layer that the lane has reached.
HWY_INLINE void emit(TileGaps& gaps, size_t c, MI mask, VI found, int32_t deepest, VI top,
                     VI ceiling, VI support) {
  const DI di;
  for (int32_t k = 0; k <= deepest; ++k) {
    const MI here = hn::And(mask, hn::Eq(found, hn::Set(di, k)));
    if (hn::AllFalse(di, here)) continue;
    GapLayer& layer = gap_layer_at(gaps, k);
    hn::BlendedStore(top, here, di, &layer.top[c]);
    hn::BlendedStore(ceiling, here, di, &layer.ceiling[c]);
    hn::BlendedStore(support, here, di, &layer.support[c]);
  }
}

// Gaps of one vector of columns of at most kNetwork spans.
HWY_INLINE VI find_vector(const TileColumns& columns, size_t c, size_t n, VI count, int32_t min_gap,
                          TileGaps& gaps) {
  const DI di;
  const VI sky = hn::Set(di, kOpenSkyMm);
  SpanVectors spans;
  for (size_t k = 0; k < n; ++k) {
    const SpanLayer& layer = *columns.layers[k];
    const MI has = hn::Gt(count, hn::Set(di, static_cast<int32_t>(k)));
    spans.low[k] = hn::IfThenElse(has, hn::Load(di, &layer.low[c]), sky);
    spans.high[k] = hn::Load(di, &layer.high[c]);
    spans.support[k] = hn::Load(di, &layer.support[c]);
  }
  spans.sort(n);
  VI top = spans.high[0], support = spans.support[0], found = hn::Zero(di);
  int32_t deepest = 0;
  for (size_t k = 1; k < n; ++k) {
    const VI low = spans.low[k], high = spans.high[k];
    const MI has = hn::Lt(low, sky);
    // Spans lie within 2^31 mm of each other; the sentinel is masked by `has`.
    const MI apart = hn::And(has, at_least(hn::Sub(low, top), hn::Set(di, min_gap)));
    if (!hn::AllFalse(di, apart)) {
      emit(gaps, c, apart, found, deepest, top, low, support);
      found = hn::Add(found, hn::IfThenElseZero(apart, hn::Set(di, 1)));
      ++deepest;
    }
    const MI joined = hn::AndNot(apart, has);
    top = hn::IfThenElse(apart, high, hn::IfThenElse(joined, hn::Max(top, high), top));
    support = hn::IfThenElse(
        apart, spans.support[k],
        hn::IfThenElse(joined, hn::Max(support, spans.support[k]), support));
  }
  const MI any = hn::Gt(count, hn::Zero(di));
  emit(gaps, c, any, found, deepest, top, sky, support);
  return hn::IfThenElseZero(any, hn::Add(found, hn::Set(di, 1)));
}

void FindGaps(const TileColumns& columns, int32_t min_gap, TileGaps& gaps) {
  const DI di;
  const int32_t lanes = static_cast<int32_t>(hn::Lanes(di));
  gaps.base = columns.base;
  gaps.max_count = 0;
  gaps.spans = 0;
  std::vector<TileColumns::Spill> scratch;
  VI total = hn::Zero(di);
  VI most = hn::Zero(di);
  for (int32_t cell = 0; cell < kTileArea; cell += lanes) {
    const size_t c = static_cast<size_t>(cell);
    const VI count = hn::Load(di, &columns.count[c]);
    const size_t n = static_cast<size_t>(hn::GetLane(hn::MaxOfLanes(di, count)));
    if (n > kNetwork) {
      for (int32_t i = cell; i < cell + lanes; ++i) {
        gaps.count[static_cast<size_t>(i)] = 0;
        if (columns.count[static_cast<size_t>(i)] > 0) {
          gaps_of_deep_column(columns, i, min_gap, gaps, scratch);
        }
      }
      continue;
    }
    VI found = hn::Zero(di);
    if (n > 0) found = find_vector(columns, c, n, count, min_gap, gaps);
    hn::Store(found, di, &gaps.count[c]);
    total = hn::Add(total, found);
    most = hn::Max(most, found);
  }
  gaps.spans += static_cast<uint64_t>(hn::GetLane(hn::SumOfLanes(di, total)));
  gaps.max_count = std::max(gaps.max_count, hn::GetLane(hn::MaxOfLanes(di, most)));
}

}  // namespace HWY_NAMESPACE
}  // namespace throng
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace throng {

HWY_EXPORT(RasteriseTile);
HWY_EXPORT(FindGaps);

void rasterise_tile(std::span<const CellTriangle> triangles, std::span<const uint32_t> items,
                    int32_t cell_x, int32_t cell_z, const TileRect& rect, int32_t join,
                    TileColumns& columns) {
  HWY_DYNAMIC_DISPATCH(RasteriseTile)(triangles, items, cell_x, cell_z, rect, join, columns);
}

void find_gaps(const TileColumns& columns, int32_t min_gap, TileGaps& gaps) {
  HWY_DYNAMIC_DISPATCH(FindGaps)(columns, min_gap, gaps);
}

std::span<const TileColumns::Spill> TileColumns::spills_of(int32_t cell) const {
  if (count[static_cast<size_t>(cell)] < kMaxLayers) return {};
  const auto less = [](const Spill& a, const Spill& b) { return a.cell < b.cell; };
  const auto range = std::equal_range(spills.begin(), spills.end(), Spill{cell, 0, 0, 0}, less);
  return {range.first, range.second};
}

void sort_spans(const TileColumns& columns, TileSpans& spans) {
  spans.first.assign(kTileArea + 1, 0);
  spans.low.clear();
  spans.high.clear();
  std::vector<std::pair<int32_t, int32_t>> column;
  for (int32_t cell = 0; cell < kTileArea; ++cell) {
    const size_t c = static_cast<size_t>(cell);
    column.clear();
    for (int32_t k = 0; k < columns.count[c]; ++k) {
      const SpanLayer& layer = *columns.layers[static_cast<size_t>(k)];
      column.emplace_back(layer.low[c] + columns.base, layer.high[c] + columns.base);
    }
    for (const auto& spilled : columns.spills_of(cell)) {
      column.emplace_back(spilled.low + columns.base, spilled.high + columns.base);
    }
    std::sort(column.begin(), column.end());
    const size_t begin = spans.low.size();
    for (const auto& [low, high] : column) {
      if (spans.low.size() > begin && low <= spans.high.back()) {
        spans.high.back() = std::max(spans.high.back(), high);
      } else {
        spans.low.push_back(low);
        spans.high.push_back(high);
      }
    }
    spans.first[c + 1] = static_cast<uint32_t>(spans.low.size());
  }
}

}  // namespace throng
#endif  // HWY_ONCE
