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
    if (set[lane] != 0)
      columns.spills.push_back({cell + lane, lows[lane], highs[lane], supports[lane]});
  }
}

// Adds a span to each cell of one vector where mask is set.
HWY_INLINE void insert(TileColumns& columns, int32_t cell, MI mask, VI low, VI high, VI support,
                       int32_t join) {
  const DI di;
  const size_t c = static_cast<size_t>(cell);
  const VI count = hn::Load(di, &columns.count[c]);
  uint8_t& depth = columns.depth[c / hn::Lanes(di)];
  const VI reach_low = hn::Sub(low, hn::Set(di, join));
  const VI reach_high = hn::Add(high, hn::Set(di, join));
  for (int32_t k = 0; k < depth; ++k) {
    SpanLayer& layer = *columns.layers[static_cast<size_t>(k)];
    const VI other_low = hn::Load(di, &layer.low[c]);
    const VI other_high = hn::Load(di, &layer.high[c]);
    const MI touch =
        hn::And(hn::And(mask, hn::Gt(count, hn::Set(di, k))),
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
  const int32_t last = std::min<int32_t>(depth, TileColumns::kMaxLayers - 1);
  for (int32_t k = 0; k <= last; ++k) {
    const MI here = hn::And(mask, hn::Eq(count, hn::Set(di, k)));
    if (hn::AllFalse(di, here)) continue;
    SpanLayer& layer = layer_at(columns, k);
    hn::BlendedStore(low, here, di, &layer.low[c]);
    hn::BlendedStore(high, here, di, &layer.high[c]);
    hn::BlendedStore(support, here, di, &layer.support[c]);
    if (k == depth) depth = static_cast<uint8_t>(k + 1);
  }
  const MI fits = hn::And(mask, hn::Lt(count, hn::Set(di, TileColumns::kMaxLayers)));
  hn::Store(hn::Add(count, hn::IfThenElseZero(fits, hn::Set(di, 1))), di, &columns.count[c]);
  if (HWY_LIKELY(depth < TileColumns::kMaxLayers)) return;
  const MI left = hn::AndNot(fits, mask);
  if (!hn::AllFalse(di, left)) spill(columns, cell, left, low, high, support);
}

// The edges of a row's cut: the triangle's three sides, and the two lines that cut it out.
enum Edge : size_t { kLong, kFirst, kSecond, kFrom, kTo, kEdges };

constexpr int32_t kBatch = 16;  // rows that are cut together
constexpr float kAbsent = 1e9f;

// Edges of a batch of rows, in the tile's frame: x in cells, y in mm from the base.
struct EdgeBatch {
  alignas(64) float x0[kBatch], x1[kBatch];  // x0 <= x1; kAbsent: the row has no such edge
  alignas(64) float low[kBatch], high[kBatch];
  alignas(64) float slope[kBatch];                  // mm per cell; 0 if too upright for one
  alignas(64) float y_low[kBatch], y_high[kBatch];  // at x0; the whole height of an upright edge
};

// What a triangle does in a batch of rows.
struct RowBatch {
  EdgeBatch edges[kEdges];
  alignas(64) int32_t x0[kBatch], x1[kBatch];  // cells touched, inclusive, not yet cut to the tile
  alignas(64) int32_t c0[kBatch], c1[kBatch];  // cells whose centre is covered; none if c0 > c1
  alignas(64) float centre_x[kBatch], centre_y[kBatch], centre_slope[kBatch];
};

// One triangle in one tile.
struct TileTriangle {
  int32_t low, high;  // mm from the base
  int32_t code;
  bool flat;
};

// A triangle in the tile's frame, ready to be cut into rows. T is float where the triangle is near
// enough for it: kWiden is ten times what a float errs at 256 cells.
template <class T>
struct Corners {
  T x[3], y[3], z[3];
  T kx02, ky02, kx01, ky01, kx12, ky12;

  HWY_INLINE void derive() {
    const T d02 = z[2] > z[0] ? 1 / (z[2] - z[0]) : 0;
    const T d01 = z[1] > z[0] ? 1 / (z[1] - z[0]) : 0;
    const T d12 = z[2] > z[1] ? 1 / (z[2] - z[1]) : 0;
    kx02 = (x[2] - x[0]) * d02;
    ky02 = (y[2] - y[0]) * d02;
    kx01 = (x[1] - x[0]) * d01;
    ky01 = (y[1] - y[0]) * d01;
    kx12 = (x[2] - x[1]) * d12;
    ky12 = (y[2] - y[1]) * d12;
  }
};

// The lanes of a vector of rows, so that one piece of code cuts rows in floats and in doubles.
template <class D>
class RowCutter {
 public:
  using V = hn::Vec<D>;
  using M = hn::Mask<D>;
  using T = hn::TFromD<D>;

  RowCutter(const Corners<T>& corners) : t_(corners) {}

  // Cuts rows [row, row + lanes), into the batch's entries from `at` on.
  HWY_INLINE void cut(int32_t row, size_t at, bool flat, RowBatch& out) const {
    const D d;
    const V rows = hn::Iota(d, static_cast<T>(row));
    const V from = hn::Max(hn::Sub(rows, set(kWiden)), set(t_.z[0]));
    const V to = hn::Min(hn::Add(rows, set(1 + kWiden)), set(t_.z[2]));
    const M has_first = hn::Le(from, set(t_.z[1]));
    const M has_second = hn::Ge(to, set(t_.z[1]));
    // The last corners are taken as they are: a side within one z has no point "at" it.
    const M to_end = hn::Ge(to, set(t_.z[2]));
    const Point l0 = on(0, from, t_.kx02, t_.ky02);
    const Point l1 = choose(to_end, corner(2), on(0, to, t_.kx02, t_.ky02));
    const Point a0 = on(0, from, t_.kx01, t_.ky01);
    const Point a1 = choose(has_second, corner(1), on(0, to, t_.kx01, t_.ky01));
    const Point b0 = choose(has_first, corner(1), on(1, from, t_.kx12, t_.ky12));
    const Point b1 = choose(to_end, corner(2), on(1, to, t_.kx12, t_.ky12));
    const Point s0 = choose(has_first, a0, b0);
    const Point s1 = choose(has_second, b1, a1);
    V x_low = hn::Min(hn::Min(l0.x, l1.x), hn::Min(s0.x, s1.x));
    V x_high = hn::Max(hn::Max(l0.x, l1.x), hn::Max(s0.x, s1.x));
    const M has_middle = hn::And(has_first, has_second);
    x_low = hn::IfThenElse(has_middle, hn::Min(x_low, set(t_.x[1])), x_low);
    x_high = hn::IfThenElse(has_middle, hn::Max(x_high, set(t_.x[1])), x_high);
    store_int(hn::Floor(hn::Sub(x_low, set(kWiden))), out.x0 + at);
    store_int(hn::Floor(hn::Add(x_high, set(kWiden))), out.x1 + at);
    if (!flat) {
      const M all = hn::Eq(rows, rows);
      add_edge(all, l0, l1, out.edges[kLong], at);
      add_edge(has_first, a0, a1, out.edges[kFirst], at);
      add_edge(has_second, b0, b1, out.edges[kSecond], at);
      add_edge(hn::Gt(from, set(t_.z[0])), l0, s0, out.edges[kFrom], at);
      add_edge(hn::Lt(to, set(t_.z[2])), l1, s1, out.edges[kTo], at);
    }
    cut_centre(rows, at, out);
  }

 private:
  struct Point {
    V x, y;
  };
  static HWY_INLINE V set(double value) { return hn::Set(D(), static_cast<T>(value)); }
  HWY_INLINE Point corner(size_t i) const { return {set(t_.x[i]), set(t_.y[i])}; }
  static HWY_INLINE Point choose(M mask, Point a, Point b) {
    return {hn::IfThenElse(mask, a.x, b.x), hn::IfThenElse(mask, a.y, b.y)};
  }
  // The point at z = at of the side that begins at corner i.
  HWY_INLINE Point on(size_t i, V at, T kx, T ky) const {
    const V along = hn::Sub(at, set(t_.z[i]));
    return {hn::Add(set(t_.x[i]), hn::Mul(along, set(kx))),
            hn::Add(set(t_.y[i]), hn::Mul(along, set(ky)))};
  }
  static HWY_INLINE void store(V v, float* out) {
    if constexpr (sizeof(T) == 4) {
      hn::StoreU(v, D(), out);
    } else {
      const hn::Rebind<float, D> df;
      hn::StoreU(hn::DemoteTo(df, v), df, out);
    }
  }
  static HWY_INLINE void store_int(V v, int32_t* out) {
    const V held = hn::Min(hn::Max(v, set(-1e6)), set(1e6));
    const hn::Rebind<int32_t, D> di;
    if constexpr (sizeof(T) == 4) {
      hn::StoreU(hn::ConvertTo(di, held), di, out);
    } else {
      hn::StoreU(hn::DemoteTo(di, held), di, out);
    }
  }

  HWY_INLINE void add_edge(M here, Point a, Point b, EdgeBatch& out, size_t at) const {
    const M swap = hn::Gt(a.x, b.x);
    const V xa = hn::IfThenElse(swap, b.x, a.x), xb = hn::IfThenElse(swap, a.x, b.x);
    const V ya = hn::IfThenElse(swap, b.y, a.y), yb = hn::IfThenElse(swap, a.y, b.y);
    const V dx = hn::Sub(xb, xa);
    const M upright = hn::Le(dx, set(1e-3));
    const V slope =
        hn::IfThenElse(upright, set(0), hn::Div(hn::Sub(yb, ya), hn::Max(dx, set(1e-3))));
    const V low = hn::Min(ya, yb), high = hn::Max(ya, yb);
    // Only the part over the tile: a far end would cost the float its precision.
    const V x0 = hn::Max(xa, set(-1)), x1 = hn::Min(xb, set(65));
    const V y0 = hn::Add(ya, hn::Mul(hn::Sub(x0, xa), slope));
    store(hn::IfThenElse(here, x0, set(kAbsent)), out.x0 + at);
    store(hn::IfThenElse(here, x1, set(-kAbsent)), out.x1 + at);
    store(low, out.low + at);
    store(high, out.high + at);
    store(slope, out.slope + at);
    store(hn::IfThenElse(upright, low, y0), out.y_low + at);
    store(hn::IfThenElse(upright, high, y0), out.y_high + at);
  }

  // Which centres of each row the triangle covers, and its surface there.
  HWY_INLINE void cut_centre(V rows, size_t at, RowBatch& out) const {
    const V centre = hn::Add(rows, set(0.5));
    const Point l = on(0, centre, t_.kx02, t_.ky02);
    const Point s = choose(hn::Le(centre, set(t_.z[1])), on(0, centre, t_.kx01, t_.ky01),
                           on(1, centre, t_.kx12, t_.ky12));
    const M swap = hn::Gt(l.x, s.x);
    const Point a = choose(swap, s, l), b = choose(swap, l, s);
    const V dx = hn::Sub(b.x, a.x);
    constexpr double kOn = kWiden / 2;  // A centre on a shared edge belongs to both triangles.
    const V first = hn::Ceil(hn::Sub(a.x, set(0.5 + kOn)));
    const V last = hn::Floor(hn::Sub(b.x, set(0.5 - kOn)));
    const M covers = hn::And(hn::And(hn::Ge(centre, set(t_.z[0])), hn::Le(centre, set(t_.z[2]))),
                             hn::Gt(dx, set(1e-6)));
    store_int(hn::IfThenElse(covers, first, set(1)), out.c0 + at);
    store_int(hn::IfThenElse(covers, last, set(0)), out.c1 + at);
    const V slope = hn::Div(hn::Sub(b.y, a.y), hn::Max(dx, set(1e-6)));
    const V x = hn::Max(a.x, set(-1));
    store(x, out.centre_x + at);
    store(hn::Add(a.y, hn::Mul(hn::Sub(x, a.x), slope)), out.centre_y + at);
    store(slope, out.centre_slope + at);
  }

  const Corners<T>& t_;
};

// The triangle's heights over one vector of cells of its row.
HWY_INLINE void row_heights(const RowBatch& rows, size_t r, VF x, VI& low, VI& high) {
  const DF df;
  const DI di;
  const float widen = static_cast<float>(kWiden);
  const VF cell_low = hn::Sub(x, hn::Set(df, widen));
  const VF cell_high = hn::Add(x, hn::Set(df, 1.0f + widen));
  VF y_low = hn::Set(df, 3e38f);
  VF y_high = hn::Set(df, -3e38f);
  for (const EdgeBatch& e : rows.edges) {
    if (e.x0[r] > e.x1[r]) continue;
    const VF x0 = hn::Set(df, e.x0[r]);
    const VF slope = hn::Set(df, e.slope[r]);
    const VF a = hn::Max(x0, cell_low);
    const VF b = hn::Min(hn::Set(df, e.x1[r]), cell_high);
    const auto meets = hn::Le(a, b);
    const bool rises = e.slope[r] >= 0;
    const VF at_low = hn::Mul(hn::Sub(rises ? a : b, x0), slope);
    const VF at_high = hn::Mul(hn::Sub(rises ? b : a, x0), slope);
    const VF lo = hn::Max(hn::Set(df, e.low[r]), hn::Add(hn::Set(df, e.y_low[r]), at_low));
    const VF hi = hn::Min(hn::Set(df, e.high[r]), hn::Add(hn::Set(df, e.y_high[r]), at_high));
    y_low = hn::IfThenElse(meets, hn::Min(y_low, lo), y_low);
    y_high = hn::IfThenElse(meets, hn::Max(y_high, hi), y_high);
  }
  // Float heights err by less than this many mm; the margin grows with the distance to the base.
  const VF far = hn::Max(hn::Abs(y_low), hn::Abs(y_high));
  const VF margin = hn::Add(hn::Set(df, 0.05f), hn::Mul(far, hn::Set(df, 0x1p-21f)));
  low = hn::Max(low, hn::ConvertTo(di, hn::Floor(hn::Sub(y_low, margin))));
  high = hn::Min(high, hn::ConvertTo(di, hn::Ceil(hn::Add(y_high, margin))));
}

HWY_INLINE void fill_row(TileColumns& columns, const TileTriangle& t, const RowBatch& rows,
                         size_t r, int32_t row, const TileRect& rect, int32_t join) {
  const DF df;
  const DI di;
  const int32_t lanes = static_cast<int32_t>(hn::Lanes(df));
  const int32_t x0 = std::max(rows.x0[r], rect.x0), x1 = std::min(rows.x1[r], rect.x1 - 1);
  const int32_t c0 = rows.c0[r], c1 = rows.c1[r];
  const VI tri_low = hn::Set(di, t.low);
  const VI tri_high = hn::Set(di, t.high);
  for (int32_t begin = x0 & ~(lanes - 1); begin <= x1; begin += lanes) {
    const VI index = hn::Iota(di, begin);
    const VF x = hn::ConvertTo(df, index);
    const MI mask = within(index, x0, x1);
    VI low = tri_low;
    VI high = tri_high;
    if (!t.flat) row_heights(rows, r, x, low, high);
    VI support = hn::Set(di, kNoSupport);
    if (c0 <= c1 && c1 >= begin && c0 < begin + lanes) {
      VI height = tri_low;
      if (!t.flat) {
        const VF along = hn::Sub(hn::Add(x, hn::Set(df, 0.5f)), hn::Set(df, rows.centre_x[r]));
        const VF y = hn::Add(hn::Set(df, rows.centre_y[r]),
                             hn::Mul(along, hn::Set(df, rows.centre_slope[r])));
        height = hn::Min(tri_high, hn::Max(tri_low, hn::NearestInt(y)));
      }
      // Over 8 km above the tile's lowest matter there is nothing to stand on.
      const MI near = hn::And(within(index, c0, c1), hn::Lt(height, hn::Set(di, 1 << 23)));
      const VI packed = hn::Or(hn::ShiftLeft<8>(height), hn::Set(di, t.code));
      support = hn::IfThenElse(near, packed, support);
    }
    insert(columns, row * kTileSide + begin, mask, low, high, support, join);
  }
}

// Fills the rows of one triangle, sixteen at a time.
template <class D, class T>
HWY_INLINE void fill_triangle(const Corners<T>& corners, const TileTriangle& t,
                              const TileRect& rect, int32_t join, TileColumns& columns) {
  const D d;
  const double z_first = std::floor(static_cast<double>(corners.z[0]) - kWiden);
  const double z_last = std::floor(static_cast<double>(corners.z[2]) + kWiden);
  const int32_t row0 = static_cast<int32_t>(std::max<double>(z_first, rect.z0));
  const int32_t row1 = static_cast<int32_t>(std::min<double>(z_last, rect.z1 - 1));
  const RowCutter<D> cutter(corners);
  RowBatch rows;
  for (int32_t begin = row0; begin <= row1; begin += kBatch) {
    const int32_t count = std::min(kBatch, row1 - begin + 1);
    for (int32_t i = 0; i < count; i += static_cast<int32_t>(hn::Lanes(d))) {
      cutter.cut(begin + i, static_cast<size_t>(i), t.flat, rows);
    }
    for (int32_t i = 0; i < count; ++i) {
      fill_row(columns, t, rows, static_cast<size_t>(i), begin + i, rect, join);
    }
  }
}

void RasteriseTile(std::span<const CellTriangle> triangles, std::span<const uint32_t> items,
                   int32_t cell_x, int32_t cell_z, const TileRect& rect, int32_t join,
                   TileColumns& columns) {
  columns.count.fill(0);
  std::fill_n(columns.depth.begin(), kTileArea / hn::Lanes(DI()), uint8_t{0});
  columns.spills.clear();
  columns.base = items.empty() ? 0 : INT32_MAX;
  for (const uint32_t item : items) columns.base = std::min(columns.base, triangles[item].low);

  for (const uint32_t item : items) {
    const CellTriangle& source = triangles[item];
    Corners<double> corners;
    double x_low = 1e300, x_high = -1e300;
    for (size_t i = 0; i < 3; ++i) {
      corners.x[i] = source.x[i] - cell_x;
      corners.y[i] = source.y[i] - columns.base;
      corners.z[i] = source.z[i] - cell_z;
      x_low = std::min(x_low, corners.x[i]);
      x_high = std::max(x_high, corners.x[i]);
    }
    if (x_high < rect.x0 - kWiden || x_low > rect.x1 + kWiden || corners.z[2] < rect.z0 - kWiden ||
        corners.z[0] > rect.z1 + kWiden) {
      continue;
    }
    TileTriangle t;
    t.low = source.low - columns.base;
    t.high = source.high - columns.base;
    t.code = source.code;
    t.flat = t.low == t.high;
    const bool near = x_low > -256 && x_high < 256 && corners.z[0] > -256 && corners.z[2] < 256;
    if (near) {
      Corners<float> small;
      for (size_t i = 0; i < 3; ++i) {
        small.x[i] = static_cast<float>(corners.x[i]);
        small.y[i] = static_cast<float>(corners.y[i]);
        small.z[i] = static_cast<float>(corners.z[i]);
      }
      small.derive();
      fill_triangle<DF>(small, t, rect, join, columns);
      continue;
    }
    corners.derive();
    fill_triangle<hn::CappedTag<double, 8>>(corners, t, rect, join, columns);
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
    support = hn::IfThenElse(apart, spans.support[k],
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
    const size_t n = columns.depth[c / hn::Lanes(di)];
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
