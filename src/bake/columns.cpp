// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "bake/columns.h"

#include <algorithm>
#include <cmath>

// A triangle is cut into the rows of cells that it touches. The cut of a row is a convex polygon,
// so over a cell its heights are bounded by the lines of its edges, the same lines for all rows but
// two: a vector of cells takes them in a few instructions, and one rule serves border cells, inner
// cells and vertical walls. Rows and cells are widened by kWiden, far more than the arithmetic can
// err, so rounding only ever adds matter. After Hasselgren, Akenine-Moeller, Ohlsson. Conservative
// rasterization. GPU Gems 2, 2005.
//
// A span goes to the first layer of its column that it touches, or to a new one: no lists, no
// second pass.

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bake/columns.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
#include <hwy/highway.h>

#include "bake/vector_bits-inl.h"

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
  uint8_t& depth = columns.depth[c / hn::Lanes(di)];
  const VI reach_low = hn::Sub(low, hn::Set(di, join));
  const VI reach_high = hn::Add(high, hn::Set(di, join));
  const VI none = hn::Set(di, kNoSpan);
  // What touches no layer goes to the first in which all lanes that are left are free, so that
  // nothing depends on the lanes one by one.
  int32_t free = depth;
  for (int32_t k = 0; k < depth; ++k) {
    SpanLayer& layer = *columns.layers[static_cast<size_t>(k)];
    const VI other_low = hn::Load(di, &layer.low[c]);
    const VI other_high = hn::Load(di, &layer.high[c]);
    const MI touch =
        hn::And(mask, hn::And(at_least(other_high, reach_low), at_least(reach_high, other_low)));
    if (!hn::AllFalse(di, touch)) {
      hn::BlendedStore(hn::Min(low, other_low), touch, di, &layer.low[c]);
      hn::BlendedStore(hn::Max(high, other_high), touch, di, &layer.high[c]);
      hn::BlendedStore(hn::Max(support, hn::Load(di, &layer.support[c])), touch, di,
                       &layer.support[c]);
      mask = hn::AndNot(touch, mask);
      if (hn::AllFalse(di, mask)) return;
    }
    const bool is_free = hn::AllFalse(di, hn::And(mask, hn::Lt(other_low, none)));
    free = is_free ? std::min(free, k) : free;
  }
  if (free < depth) {
    SpanLayer& layer = *columns.layers[static_cast<size_t>(free)];
    hn::BlendedStore(low, mask, di, &layer.low[c]);
    hn::BlendedStore(high, mask, di, &layer.high[c]);
    hn::BlendedStore(support, mask, di, &layer.support[c]);
    return;
  }
  if (HWY_UNLIKELY(depth == TileColumns::kMaxLayers)) {
    spill(columns, cell, mask, low, high, support);
    return;
  }
  SpanLayer& layer = layer_at(columns, depth++);
  hn::Store(hn::IfThenElse(mask, low, none), di, &layer.low[c]);
  hn::Store(hn::IfThenElse(mask, high, hn::Set(di, INT32_MIN)), di, &layer.high[c]);
  hn::Store(hn::IfThenElse(mask, support, hn::Set(di, kNoSupport)), di, &layer.support[c]);
}

constexpr int32_t kBatch = 16;  // rows that are cut together

// What a triangle does in a batch of rows, in the tile's frame: x in cells, y in mm from the
// triangle's lowest corner, so that the floats do not feel what else the tile holds.
struct RowBatch {
  alignas(64) int32_t x0[kBatch], x1[kBatch];  // cells touched, inclusive, not yet cut to the tile
  alignas(64) int32_t c0[kBatch], c1[kBatch];  // cells whose centre is covered; none if c0 > c1
  alignas(64) float y_low[kBatch], y_high[kBatch];
  // A point on each of the two lines that cut the row out: [0] at its lower z, [1] at its higher.
  alignas(64) float cap_x[2][kBatch], cap_y[2][kBatch];
  alignas(64) float centre_x[kBatch], centre_y[kBatch];  // a point on the line of centres
};

// One triangle in one tile.
struct TileTriangle {
  int32_t low, high;  // mm from the base
  int32_t code;
  bool flat;
  bool upright;                   // no gradient worth the name
  bool rises_in_z;                // else it falls
  float gradient;                 // mm per cell along x
  float highest_end, lowest_end;  // of a cell, along the gradient
  float margin;                   // mm that the floats may err
  // Over each cell of a row, bounds by the triangle's sides: they are the same in all rows.
  alignas(64) float side_low[kTileSide], side_high[kTileSide];
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
    const V rows = counting_from(d, static_cast<T>(row));
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
      V y_low = hn::Min(hn::Min(l0.y, l1.y), hn::Min(s0.y, s1.y));
      V y_high = hn::Max(hn::Max(l0.y, l1.y), hn::Max(s0.y, s1.y));
      y_low = hn::IfThenElse(has_middle, hn::Min(y_low, set(t_.y[1])), y_low);
      y_high = hn::IfThenElse(has_middle, hn::Max(y_high, set(t_.y[1])), y_high);
      store(y_low, out.y_low + at);
      store(y_high, out.y_high + at);
      store(l0.x, out.cap_x[0] + at);
      store(l0.y, out.cap_y[0] + at);
      store(l1.x, out.cap_x[1] + at);
      store(l1.y, out.cap_y[1] + at);
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
    store(l.x, out.centre_x + at);
    store(l.y, out.centre_y + at);
  }

  const Corners<T>& t_;
};

// A row's cut is a convex polygon, so over a cell its highest point is the least of what the lines
// above it reach there, or the row's highest point if that is less; likewise the lowest. The lines
// are the triangle's sides and the two that cut the row out; a line reaches highest at the end of
// the cell towards which it rises. A line that is left out only adds matter.
// Nothing here branches on a triangle's shape: shapes are as good as random.
constexpr double kUnbound = 1e30;

// How far beyond a cell's low end a line of this slope reaches highest; lowest for its negative.
HWY_INLINE double highest_end(double slope) {
  return static_cast<double>(slope >= 0) * (1 + 2 * kWiden) - kWiden;
}

HWY_INLINE void bound_by_sides(const Corners<double>& corners, TileTriangle& t, int32_t x_first,
                               int32_t x_last) {
  const DF df;
  const int32_t lanes = static_cast<int32_t>(hn::Lanes(df));
  struct Line {
    float x, y, slope;
  };
  Line above[3], below[3];
  constexpr size_t kEnds[3][3] = {{0, 2, 1}, {0, 1, 2}, {1, 2, 0}};
  for (size_t side = 0; side < 3; ++side) {
    const auto& [i, j, k] = kEnds[side];
    const double dx = corners.x[j] - corners.x[i], dy = corners.y[j] - corners.y[i];
    const auto sloped = static_cast<double>(std::fabs(dx) >= 1e-3);
    const double slope = sloped * dy / (dx + (1 - sloped));
    const double over = corners.y[i] + slope * (corners.x[k] - corners.x[i]) - corners.y[k];
    // From a point near the tile on: a far one would cost the float its precision.
    const double x = std::clamp(corners.x[i], -1.0, kTileSide + 1.0);
    const double y = corners.y[i] + slope * (x - corners.x[i]);
    // Of a triangle seen edge-on, thinner than the floats tell, each side bounds both ways.
    constexpr double kThin = 0.01;  // mm
    const double is_above = sloped * static_cast<double>(over > -kThin);
    const double is_below = sloped * static_cast<double>(over < kThin);
    above[side] = {static_cast<float>(x - highest_end(slope)),
                   static_cast<float>(y + (1 - is_above) * kUnbound), static_cast<float>(slope)};
    below[side] = {static_cast<float>(x - highest_end(-slope)),
                   static_cast<float>(y - (1 - is_below) * kUnbound), static_cast<float>(slope)};
  }
  for (int32_t begin = x_first & ~(lanes - 1); begin <= x_last; begin += lanes) {
    const VF x = hn::ConvertTo(df, counting_from(DI(), begin));
    VF low = hn::Zero(df);
    VF high = hn::Set(df, static_cast<float>(t.high - t.low));
    const auto reach = [&](const Line& line) {
      return hn::Add(hn::Set(df, line.y),
                     hn::Mul(hn::Sub(x, hn::Set(df, line.x)), hn::Set(df, line.slope)));
    };
    for (size_t side = 0; side < 3; ++side) {
      high = hn::Min(high, reach(above[side]));
      low = hn::Max(low, reach(below[side]));
    }
    hn::Store(low, df, t.side_low + begin);
    hn::Store(high, df, t.side_high + begin);
  }
}

HWY_INLINE void set_gradient(const Corners<double>& c, TileTriangle& t) {
  constexpr double kSteepest = 1e6;  // mm per cell
  const double ax = c.x[1] - c.x[0], ay = c.y[1] - c.y[0], az = c.z[1] - c.z[0];
  const double bx = c.x[2] - c.x[0], by = c.y[2] - c.y[0], bz = c.z[2] - c.z[0];
  const double normal_y = az * bx - ax * bz;
  const double rise_x = az * by - ay * bz, rise_z = ay * bx - ax * by;
  t.upright = !(std::fabs(rise_x) < kSteepest * std::fabs(normal_y));
  t.gradient = t.upright ? 0 : static_cast<float>(rise_x / normal_y);
  t.highest_end = static_cast<float>(highest_end(t.gradient));
  t.lowest_end = static_cast<float>(highest_end(-static_cast<double>(t.gradient)));
  t.rises_in_z = (rise_z >= 0) == (normal_y > 0);
  t.margin = 0.05f + static_cast<float>(t.high - t.low) * 0x1p-20f;
}

// The triangle's heights over one vector of cells of its row.
HWY_INLINE void row_heights(const TileTriangle& t, const RowBatch& rows, size_t r, int32_t begin,
                            VF x, VI& low, VI& high) {
  const DF df;
  const DI di;
  VF y_low = hn::Max(hn::Load(df, t.side_low + begin), hn::Set(df, rows.y_low[r]));
  VF y_high = hn::Min(hn::Load(df, t.side_high + begin), hn::Set(df, rows.y_high[r]));
  if (!t.upright) {
    const size_t above = t.rises_in_z ? 1 : 0, below = 1 - above;
    const VF slope = hn::Set(df, t.gradient);
    const VF to_high = hn::Sub(x, hn::Set(df, rows.cap_x[above][r] - t.highest_end));
    const VF to_low = hn::Sub(x, hn::Set(df, rows.cap_x[below][r] - t.lowest_end));
    y_high = hn::Min(y_high, hn::Add(hn::Set(df, rows.cap_y[above][r]), hn::Mul(to_high, slope)));
    y_low = hn::Max(y_low, hn::Add(hn::Set(df, rows.cap_y[below][r]), hn::Mul(to_low, slope)));
  }
  // Where the cell is only touched for being widened, the bounds may have crossed.
  const VF margin = hn::Set(df, t.margin);
  const VF bottom = hn::Sub(hn::Min(y_low, y_high), margin);
  const VF top = hn::Add(hn::Max(y_low, y_high), margin);
  const VI tall = hn::Sub(high, low);
  high = hn::Add(low, hn::Min(tall, hn::ConvertTo(di, hn::Ceil(top))));
  low = hn::Add(low, hn::Max(hn::Zero(di), hn::ConvertTo(di, hn::Floor(bottom))));
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
  const VI tri_tall = hn::Set(di, t.high - t.low);
  for (int32_t begin = x0 & ~(lanes - 1); begin <= x1; begin += lanes) {
    const VI index = counting_from(di, begin);
    const VF x = hn::ConvertTo(df, index);
    const MI mask = within(index, x0, x1);
    VI low = tri_low;
    VI high = tri_high;
    if (!t.flat) row_heights(t, rows, r, begin, x, low, high);
    VI support = hn::Set(di, kNoSupport);
    if (c0 <= c1 && c1 >= begin && c0 < begin + lanes) {
      VI height = tri_low;
      if (!t.flat) {
        const VF along = hn::Sub(hn::Add(x, hn::Set(df, 0.5f)), hn::Set(df, rows.centre_x[r]));
        const VF y =
            hn::Add(hn::Set(df, rows.centre_y[r]), hn::Mul(along, hn::Set(df, t.gradient)));
        const VI above = hn::Min(tri_tall, hn::Max(hn::Zero(di), hn::NearestInt(y)));
        height = hn::Add(tri_low, above);
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
  columns.lanes = static_cast<int32_t>(hn::Lanes(DI()));
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
      corners.y[i] = source.y[i] - source.low;
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
    set_gradient(corners, t);
    if (!t.flat) {
      const auto x_first = static_cast<int32_t>(std::max<double>(x_low - 1, rect.x0));
      const auto x_last = static_cast<int32_t>(std::min<double>(x_high + 1, rect.x1 - 1));
      bound_by_sides(corners, t, x_first, x_last);
    }
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
  for (int32_t k = 0; k < columns.depth[c / static_cast<size_t>(columns.lanes)]; ++k) {
    const SpanLayer& layer = *columns.layers[static_cast<size_t>(k)];
    if (layer.low[c] == kNoSpan) continue;
    spans.push_back({cell, layer.low[c], layer.high[c], layer.support[c]});
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
HWY_INLINE VI find_vector(const TileColumns& columns, size_t c, size_t n, int32_t min_gap,
                          TileGaps& gaps) {
  static_assert(kNoSpan == kOpenSkyMm);  // A span that is not there sorts last, as the sky.
  const DI di;
  const VI sky = hn::Set(di, kOpenSkyMm);
  SpanVectors spans;
  for (size_t k = 0; k < n; ++k) {
    const SpanLayer& layer = *columns.layers[k];
    spans.low[k] = hn::Load(di, &layer.low[c]);
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
  const MI any = hn::Lt(spans.low[0], sky);
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
    const size_t n = columns.depth[c / hn::Lanes(di)];
    if (n > kNetwork) {
      for (int32_t i = cell; i < cell + lanes; ++i) {
        gaps.count[static_cast<size_t>(i)] = 0;
        gaps_of_deep_column(columns, i, min_gap, gaps, scratch);
      }
      continue;
    }
    VI found = hn::Zero(di);
    if (n > 0) found = find_vector(columns, c, n, min_gap, gaps);
    hn::Store(found, di, &gaps.count[c]);
    total = hn::Add(total, found);
    most = hn::Max(most, found);
  }
  gaps.spans += static_cast<uint64_t>(hn::GetLane(hn::SumOfLanes(di, total)));
  gaps.max_count = std::max(gaps.max_count, hn::GetLane(hn::MaxOfLanes(di, most)));
}

// Matter has at least the sky above it.
void BareColumns(const TileGaps& gaps, std::array<uint64_t, kTileSide>& bare) {
  const DI di;
  for (size_t z = 0; z < kTileSide; ++z) {
    bare[z] = 0;
    for (size_t x = 0; x < kTileSide; x += hn::Lanes(di)) {
      const VI count = hn::Load(di, &gaps.count[z * kTileSide + x]);
      bare[z] |= bits_of(di, hn::Eq(count, hn::Zero(di))) << x;
    }
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace throng
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace throng {

HWY_EXPORT(RasteriseTile);
HWY_EXPORT(FindGaps);
HWY_EXPORT(BareColumns);

void rasterise_tile(std::span<const CellTriangle> triangles, std::span<const uint32_t> items,
                    int32_t cell_x, int32_t cell_z, const TileRect& rect, int32_t join,
                    TileColumns& columns) {
  HWY_DYNAMIC_DISPATCH(RasteriseTile)(triangles, items, cell_x, cell_z, rect, join, columns);
}

void find_gaps(const TileColumns& columns, int32_t min_gap, TileGaps& gaps) {
  HWY_DYNAMIC_DISPATCH(FindGaps)(columns, min_gap, gaps);
}

std::array<uint64_t, kTileSide> bare_columns(const TileGaps& gaps) {
  std::array<uint64_t, kTileSide> bare;
  HWY_DYNAMIC_DISPATCH(BareColumns)(gaps, bare);
  return bare;
}

std::span<const TileColumns::Spill> TileColumns::spills_of(int32_t cell) const {
  if (spills.empty()) return {};
  const auto less = [](const Spill& a, const Spill& b) { return a.cell < b.cell; };
  const auto range = std::equal_range(spills.begin(), spills.end(), Spill{cell, 0, 0, 0}, less);
  return std::span(spills).subspan(static_cast<size_t>(range.first - spills.begin()),
                                   static_cast<size_t>(range.second - range.first));
}

void sort_spans(const TileColumns& columns, TileSpans& spans) {
  spans.first.assign(kTileArea + 1, 0);
  spans.low.clear();
  spans.high.clear();
  std::vector<std::pair<int32_t, int32_t>> column;
  for (int32_t cell = 0; cell < kTileArea; ++cell) {
    const size_t c = static_cast<size_t>(cell);
    column.clear();
    for (int32_t k = 0; k < columns.depth[c / static_cast<size_t>(columns.lanes)]; ++k) {
      const SpanLayer& layer = *columns.layers[static_cast<size_t>(k)];
      if (layer.low[c] == kNoSpan) continue;
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
