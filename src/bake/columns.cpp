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

#include "bake/cell_blocks-inl.h"

HWY_BEFORE_NAMESPACE();
namespace throng {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using DF = hn::CappedTag<float, 16>;
using VF = hn::Vec<DF>;

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

// Keeps the spans for which no layer is left; (x, z) is the block's first cell.
void spill(TileColumns& columns, int32_t x, int32_t z, MI mask, VI low, VI high, VI support) {
  const DI di;
  alignas(64) int32_t lows[16], highs[16], supports[16], set[16];
  hn::Store(low, di, lows);
  hn::Store(high, di, highs);
  hn::Store(support, di, supports);
  hn::Store(hn::IfThenElseZero(mask, hn::Set(di, 1)), di, set);
  for (int32_t lane = 0; lane < static_cast<int32_t>(hn::Lanes(di)); ++lane) {
    if (set[lane] == 0) continue;
    const int32_t cell = (z + lane / block_width()) * kTileSide + x + lane % block_width();
    columns.spills.push_back({cell, lows[lane], highs[lane], supports[lane]});
  }
}

// Adds a span to each cell of one block where mask is set; (x, z) is its first cell.
HWY_INLINE void insert(TileColumns& columns, int32_t x, int32_t z, MI mask, VI low, VI high,
                       VI support, int32_t join) {
  const DI di;
  const auto c = static_cast<size_t>(z * kTileSide + x * block_height());
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
    spill(columns, x, z, mask, low, high, support);
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

// What the rows of a block are cut by: lane i has what its row has.
struct BlockRows {
  VI x0, x1, c0, c1;
  VF y_low, y_high;
  // Points on the lines that bound the highest and the lowest, moved to the ends of cells.
  VF high_x, high_y, low_x, low_y;
  VF centre_x, centre_y;
};

// Takes rows [r, r + block height) of a batch.
HWY_INLINE BlockRows take_rows(const TileTriangle& t, const RowBatch& rows, size_t r) {
  const DF df;
  const DI di;
  // Whole vectors as they were stored: others would have to wait for the store.
  const size_t lanes = hn::Lanes(di);
  const size_t from = r & ~(lanes - 1);
  const VI lane = hn::Add(row_in_block(), hn::Set(di, static_cast<int32_t>(r - from)));
  const auto in_floats = hn::IndicesFromVec(df, lane);
  const auto in_ints = hn::IndicesFromVec(di, lane);
  const auto floats = [&](const float* values) {
    return hn::TableLookupLanes(hn::Load(df, values + from), in_floats);
  };
  const auto ints = [&](const int32_t* values) {
    return hn::TableLookupLanes(hn::Load(di, values + from), in_ints);
  };
  BlockRows out;
  out.x0 = ints(rows.x0);
  out.x1 = ints(rows.x1);
  out.c0 = ints(rows.c0);
  out.c1 = ints(rows.c1);
  if (t.flat) return out;
  const size_t above = t.rises_in_z ? 1 : 0, below = 1 - above;
  out.y_low = floats(rows.y_low);
  out.y_high = floats(rows.y_high);
  out.high_x = hn::Sub(floats(rows.cap_x[above]), hn::Set(df, t.highest_end));
  out.high_y = floats(rows.cap_y[above]);
  out.low_x = hn::Sub(floats(rows.cap_x[below]), hn::Set(df, t.lowest_end));
  out.low_y = floats(rows.cap_y[below]);
  out.centre_x = floats(rows.centre_x);
  out.centre_y = floats(rows.centre_y);
  return out;
}

// The bound by the sides over the columns of a block, the same in all its rows.
HWY_INLINE VF side_bound(const float* bounds) {
#if HWY_TARGET == HWY_SCALAR
  return hn::Load(DF(), bounds);
#else
  return hn::LoadDup128(DF(), bounds);
#endif
}

// The triangle's heights over one block of cells that begins at column `begin`.
HWY_INLINE void block_heights(const TileTriangle& t, const BlockRows& rows, int32_t begin, VF x,
                              VI& low, VI& high) {
  const DF df;
  const DI di;
  VF y_low = hn::Max(side_bound(t.side_low + begin), rows.y_low);
  VF y_high = hn::Min(side_bound(t.side_high + begin), rows.y_high);
  if (!t.upright) {
    const VF slope = hn::Set(df, t.gradient);
    const VF to_high = hn::Sub(x, rows.high_x);
    const VF to_low = hn::Sub(x, rows.low_x);
    y_high = hn::Min(y_high, hn::Add(rows.high_y, hn::Mul(to_high, slope)));
    y_low = hn::Max(y_low, hn::Add(rows.low_y, hn::Mul(to_low, slope)));
  }
  // Where the cell is only touched for being widened, the bounds may have crossed.
  const VF margin = hn::Set(df, t.margin);
  const VF bottom = hn::Sub(hn::Min(y_low, y_high), margin);
  const VF top = hn::Add(hn::Max(y_low, y_high), margin);
  const VI tall = hn::Sub(high, low);
  high = hn::Add(low, hn::Min(tall, hn::ConvertTo(di, hn::Ceil(top))));
  low = hn::Add(low, hn::Max(hn::Zero(di), hn::ConvertTo(di, hn::Floor(bottom))));
}

// Fills the rows of a triangle that lie in one row of blocks: entry r of the batch is row `row`,
// those outside `within_rows` are not to be filled.
HWY_INLINE void fill_blocks(TileColumns& columns, const TileTriangle& t, const RowBatch& batch,
                            size_t r, int32_t row, const TileRect& part, int32_t join) {
  const DF df;
  const DI di;
  const int32_t from = std::max(row, part.z0), to = std::min(row + block_height(), part.z1);
  int32_t x_first = part.x1, x_last = -1;
  for (int32_t z = from; z < to; ++z) {
    const size_t i = r + static_cast<size_t>(z - row);
    x_first = std::min(x_first, batch.x0[i]);
    x_last = std::max(x_last, batch.x1[i]);
  }
  x_first = std::max(x_first, part.x0);
  x_last = std::min(x_last, part.x1 - 1);
  if (x_first > x_last) return;
  const BlockRows rows = take_rows(t, batch, r);
  const VI z = hn::Add(row_in_block(), hn::Set(di, row));
  const VI x0 = hn::Max(rows.x0, hn::Set(di, part.x0));
  const VI x1 = hn::IfThenElse(within(z, from, to - 1), hn::Min(rows.x1, hn::Set(di, part.x1 - 1)),
                               hn::Set(di, -1));
  const VI tri_low = hn::Set(di, t.low);
  const VI tri_high = hn::Set(di, t.high);
  const VI tri_tall = hn::Set(di, t.high - t.low);
  for (int32_t begin = x_first & ~(block_width() - 1); begin <= x_last; begin += block_width()) {
    const VI index = hn::Add(column_in_block(), hn::Set(di, begin));
    const MI mask = hn::And(at_least(index, x0), at_least(x1, index));
    if (hn::AllFalse(di, mask)) continue;
    const VF x = hn::ConvertTo(df, index);
    VI low = tri_low;
    VI high = tri_high;
    if (!t.flat) block_heights(t, rows, begin, x, low, high);
    VI support = hn::Set(di, kNoSupport);
    const MI covered = hn::And(at_least(index, rows.c0), at_least(rows.c1, index));
    if (!hn::AllFalse(di, covered)) {
      VI height = tri_low;
      if (!t.flat) {
        const VF along = hn::Sub(hn::Add(x, hn::Set(df, 0.5f)), rows.centre_x);
        const VF y = hn::Add(rows.centre_y, hn::Mul(along, hn::Set(df, t.gradient)));
        const VI above = hn::Min(tri_tall, hn::Max(hn::Zero(di), hn::NearestInt(y)));
        height = hn::Add(tri_low, above);
      }
      // Over 8 km above the tile's lowest matter there is nothing to stand on.
      const MI near = hn::And(covered, hn::Lt(height, hn::Set(di, 1 << 23)));
      const VI packed = hn::Or(hn::ShiftLeft<8>(height), hn::Set(di, t.code));
      support = hn::IfThenElse(near, packed, support);
    }
    insert(columns, begin, row, mask, low, high, support, join);
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
  const TileRect part{rect.x0, row0, rect.x1, row1 + 1};
  const RowCutter<D> cutter(corners);
  RowBatch rows;
  for (int32_t begin = row0 & ~(block_height() - 1); begin <= row1; begin += kBatch) {
    const int32_t count = std::min(kBatch, row1 - begin + 1);
    for (int32_t i = 0; i < count; i += static_cast<int32_t>(hn::Lanes(d))) {
      cutter.cut(begin + i, static_cast<size_t>(i), t.flat, rows);
    }
    for (int32_t i = 0; i < count; i += block_height()) {
      fill_blocks(columns, t, rows, static_cast<size_t>(i), begin + i, part, join);
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

}  // namespace HWY_NAMESPACE
}  // namespace throng
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace throng {

HWY_EXPORT(RasteriseTile);

void rasterise_tile(std::span<const CellTriangle> triangles, std::span<const uint32_t> items,
                    int32_t cell_x, int32_t cell_z, const TileRect& rect, int32_t join,
                    TileColumns& columns) {
  HWY_DYNAMIC_DISPATCH(RasteriseTile)(triangles, items, cell_x, cell_z, rect, join, columns);
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
    const auto c = static_cast<size_t>(cell);
    const size_t p = columns.place(c);
    column.clear();
    for (int32_t k = 0; k < columns.depth[p / static_cast<size_t>(columns.lanes)]; ++k) {
      const SpanLayer& layer = *columns.layers[static_cast<size_t>(k)];
      if (layer.low[p] == kNoSpan) continue;
      column.emplace_back(layer.low[p] + columns.base, layer.high[p] + columns.base);
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
