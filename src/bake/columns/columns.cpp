// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "bake/columns/columns.h"

#include <algorithm>
#include <cmath>

// A triangle is cut into the rows of cells that it touches. The cut of a row is a convex polygon,
// so over a cell its heights are bounded by the lines of its edges, the same lines for all rows but
// two: a vector of cells takes them in a few instructions, and one rule serves border cells, inner
// cells and vertical walls. Rows and cells are widened by kWiden, far more than the arithmetic can
// err, so rounding only ever adds to the solid. After Hasselgren, Akenine-Moeller, Ohlsson.
// Conservative rasterization. GPU Gems 2, 2005.
//
// A span goes to the first layer of its column that it touches, or to a new one: no lists, no
// second pass.

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bake/columns/columns.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
#include <hwy/highway.h>

#include "bake/columns/cell_blocks-inl.h"

HWY_BEFORE_NAMESPACE();
namespace throng::bake {
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
    // A centre on a shared edge belongs to both triangles.
    constexpr double kEdgeMargin = kWiden / 2;
    const V first = hn::Ceil(hn::Sub(a.x, set(0.5 + kEdgeMargin)));
    const V last = hn::Floor(hn::Sub(b.x, set(0.5 - kEdgeMargin)));
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
// the cell towards which it rises. A line that is left out only adds to the solid.
constexpr double kUnbound = 1e30;
// How far beyond a cell's low end a line that rises reaches highest; one that falls.
constexpr double kRisingEnd = 1 + kWiden, kFallingEnd = -kWiden;
constexpr size_t kGroup = 8;  // triangles that are set up together

// Triangles in the tile's frame, and what their rows and cells are bounded by. Nothing here
// branches on a triangle's shape: shapes are as good as random.
class TriangleGroup {
 public:
  struct Line {
    alignas(64) float x[kGroup], y[kGroup], slope[kGroup];
  };

  size_t size = 0;
  const CellTriangle* source[kGroup];
  double x_low[kGroup], x_high[kGroup];

  // Takes a triangle unless it misses the part of the tile.
  HWY_INLINE void take(const CellTriangle& triangle, int32_t cell_x, int32_t cell_z,
                       const TileRect& part) {
    for (size_t i = 0; i < 3; ++i) {
      x_[i][size] = triangle.x[i] - cell_x;
      y_[i][size] = triangle.y[i] - triangle.low;
      z_[i][size] = triangle.z[i] - cell_z;
    }
    source[size] = &triangle;
    x_low[size] = std::min({x_[0][size], x_[1][size], x_[2][size]});
    x_high[size] = std::max({x_[0][size], x_[1][size], x_[2][size]});
    const bool misses = x_high[size] < part.x0 - kWiden || x_low[size] > part.x1 + kWiden ||
                        z_[2][size] < part.z0 - kWiden || z_[0][size] > part.z1 + kWiden;
    size += misses ? 0 : 1;
  }

  HWY_INLINE void set_up() {
    for (size_t i = 0; i < kGroup; i += hn::Lanes(D())) {
      set_gradients(i);
      set_corners(i);
      for (size_t side = 0; side < 3; ++side) set_lines(side, i);
    }
  }

  HWY_INLINE TileTriangle triangle(size_t i, int32_t base) const {
    TileTriangle t;
    t.low = source[i]->low - base;
    t.high = source[i]->high - base;
    t.code = source[i]->code;
    t.flat = t.low == t.high;
    t.upright = upright_[i] != 0;
    t.rises_in_z = rises_in_z_[i] != 0;
    t.gradient = gradient_[i];
    t.highest_end =
        t.gradient >= 0 ? static_cast<float>(kRisingEnd) : static_cast<float>(kFallingEnd);
    t.lowest_end =
        t.gradient <= 0 ? static_cast<float>(kRisingEnd) : static_cast<float>(kFallingEnd);
    t.margin = 0.05f + static_cast<float>(t.high - t.low) * 0x1p-20f;
    return t;
  }

  // Bounds the heights over columns [x_first, x_last] by the triangle's sides.
  HWY_INLINE void bound_by_sides(size_t i, int32_t x_first, int32_t x_last, TileTriangle& t) const {
    const DF df;
    const auto lanes = static_cast<int32_t>(hn::Lanes(df));
    for (int32_t begin = x_first & ~(lanes - 1); begin <= x_last; begin += lanes) {
      const VF x = hn::ConvertTo(df, counting_from(DI(), begin));
      VF low = hn::Zero(df);
      VF high = hn::Set(df, static_cast<float>(t.high - t.low));
      const auto reach = [&](const Line& line) {
        return hn::Add(hn::Set(df, line.y[i]),
                       hn::Mul(hn::Sub(x, hn::Set(df, line.x[i])), hn::Set(df, line.slope[i])));
      };
      for (size_t side = 0; side < 3; ++side) {
        high = hn::Min(high, reach(above_[side]));
        low = hn::Max(low, reach(below_[side]));
      }
      hn::Store(low, df, t.side_low + begin);
      hn::Store(high, df, t.side_high + begin);
    }
  }

  [[nodiscard]] HWY_INLINE bool near(size_t i) const {
    return x_low[i] > -256 && x_high[i] < 256 && z_[0][i] > -256 && z_[2][i] < 256;
  }
  HWY_INLINE Corners<float> near_corners(size_t i) const {
    Corners<float> out;
    for (size_t k = 0; k < 3; ++k) {
      out.x[k] = corners_[k][i];
      out.y[k] = corners_[3 + k][i];
      out.z[k] = corners_[6 + k][i];
    }
    out.kx02 = along_[0][i];
    out.ky02 = along_[1][i];
    out.kx01 = along_[2][i];
    out.ky01 = along_[3][i];
    out.kx12 = along_[4][i];
    out.ky12 = along_[5][i];
    return out;
  }
  HWY_INLINE Corners<double> far_corners(size_t i) const {
    Corners<double> out;
    for (size_t k = 0; k < 3; ++k) {
      out.x[k] = x_[k][i];
      out.y[k] = y_[k][i];
      out.z[k] = z_[k][i];
    }
    out.derive();
    return out;
  }

 private:
  using D = hn::CappedTag<double, kGroup>;
  using V = hn::Vec<D>;
  using M = hn::Mask<D>;
  using DS = hn::Rebind<float, D>;
  using VS = hn::Vec<DS>;
  static HWY_INLINE V load(const double* from) { return hn::Load(D(), from); }
  static HWY_INLINE V set(double value) { return hn::Set(D(), value); }
  static HWY_INLINE void store(V v, float* to) { hn::StoreU(hn::DemoteTo(DS(), v), DS(), to); }
  static HWY_INLINE void store(M mask, double* to) {
    hn::Store(hn::IfThenElseZero(mask, set(1)), D(), to);
  }

  HWY_INLINE void set_gradients(size_t i) {
    const D d;
    constexpr double kMaxRise = 1e6;  // mm per cell
    const auto from_first = [&](const double(&of)[3][kGroup], size_t k) {
      return hn::Sub(load(&of[k][i]), load(&of[0][i]));
    };
    const V ax = from_first(x_, 1), ay = from_first(y_, 1), az = from_first(z_, 1);
    const V bx = from_first(x_, 2), by = from_first(y_, 2), bz = from_first(z_, 2);
    const V normal_y = hn::Sub(hn::Mul(az, bx), hn::Mul(ax, bz));
    const V rise_x = hn::Sub(hn::Mul(az, by), hn::Mul(ay, bz));
    const V rise_z = hn::Sub(hn::Mul(ay, bx), hn::Mul(ax, by));
    const M upright = hn::Not(hn::Lt(hn::Abs(rise_x), hn::Mul(set(kMaxRise), hn::Abs(normal_y))));
    const V gradient = hn::Div(rise_x, hn::IfThenElse(upright, set(1), normal_y));
    store(hn::IfThenElse(upright, hn::Zero(d), gradient), &gradient_[i]);
    store(upright, &upright_[i]);
    store(hn::Not(hn::Xor(hn::Ge(rise_z, hn::Zero(d)), hn::Gt(normal_y, hn::Zero(d)))),
          &rises_in_z_[i]);
  }

  // In floats, as Corners::derive.
  HWY_INLINE void set_corners(size_t i) {
    const DS ds;
    VS x[3], y[3], z[3];
    for (size_t k = 0; k < 3; ++k) {
      x[k] = hn::DemoteTo(ds, load(&x_[k][i]));
      y[k] = hn::DemoteTo(ds, load(&y_[k][i]));
      z[k] = hn::DemoteTo(ds, load(&z_[k][i]));
      hn::StoreU(x[k], ds, &corners_[k][i]);
      hn::StoreU(y[k], ds, &corners_[3 + k][i]);
      hn::StoreU(z[k], ds, &corners_[6 + k][i]);
    }
    constexpr size_t kEnds[3][2] = {{0, 2}, {0, 1}, {1, 2}};
    for (size_t side = 0; side < 3; ++side) {
      const auto& [a, b] = kEnds[side];
      const auto has_length = hn::Gt(z[b], z[a]);
      const VS length = hn::IfThenElse(has_length, hn::Sub(z[b], z[a]), hn::Set(ds, 1));
      const VS per_row = hn::IfThenElseZero(has_length, hn::Div(hn::Set(ds, 1), length));
      hn::StoreU(hn::Mul(hn::Sub(x[b], x[a]), per_row), ds, &along_[2 * side][i]);
      hn::StoreU(hn::Mul(hn::Sub(y[b], y[a]), per_row), ds, &along_[2 * side + 1][i]);
    }
  }

  HWY_INLINE void set_lines(size_t side, size_t i) {
    const D d;
    constexpr size_t kEnds[3][3] = {{0, 2, 1}, {0, 1, 2}, {1, 2, 0}};
    const auto& [a, b, c] = kEnds[side];
    const V x_a = load(&x_[a][i]), y_a = load(&y_[a][i]);
    const V dx = hn::Sub(load(&x_[b][i]), x_a), dy = hn::Sub(load(&y_[b][i]), y_a);
    const M sloped = hn::Ge(hn::Abs(dx), set(1e-3));
    const V slope = hn::IfThenElseZero(sloped, hn::Div(dy, hn::IfThenElse(sloped, dx, set(1))));
    const V to_c = hn::Sub(load(&x_[c][i]), x_a);
    const V over = hn::Sub(hn::Add(y_a, hn::Mul(slope, to_c)), load(&y_[c][i]));
    // From a point near the tile on: a far one would cost the float its precision.
    const V x = hn::Min(hn::Max(x_a, set(-1)), set(kTileSide + 1));
    const V y = hn::Add(y_a, hn::Mul(slope, hn::Sub(x, x_a)));
    // Of a triangle seen edge-on, thinner than floats resolve, each side is a lower and an upper
    // bound.
    constexpr double kHeightTolerance = 0.01;  // mm
    const M is_above = hn::And(sloped, hn::Gt(over, set(-kHeightTolerance)));
    const M is_below = hn::And(sloped, hn::Lt(over, set(kHeightTolerance)));
    const V rising = hn::Sub(x, set(kRisingEnd)), falling = hn::Sub(x, set(kFallingEnd));
    store(hn::IfThenElse(hn::Ge(slope, hn::Zero(d)), rising, falling), &above_[side].x[i]);
    store(hn::IfThenElse(hn::Le(slope, hn::Zero(d)), rising, falling), &below_[side].x[i]);
    store(hn::IfThenElse(is_above, y, set(kUnbound)), &above_[side].y[i]);
    store(hn::IfThenElse(is_below, y, set(-kUnbound)), &below_[side].y[i]);
    store(slope, &above_[side].slope[i]);
    store(slope, &below_[side].slope[i]);
  }

  // Zero at first, for the lanes of a last group that is not full.
  alignas(64) double x_[3][kGroup] = {}, y_[3][kGroup] = {}, z_[3][kGroup] = {};
  alignas(64) double upright_[kGroup], rises_in_z_[kGroup];
  alignas(64) float gradient_[kGroup];
  alignas(64) float corners_[9][kGroup];
  alignas(64) float along_[6][kGroup];  // x and y per row, along three sides
  Line above_[3], below_[3];
};

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
      // Over 8 km above the tile's lowest solid there is nothing to stand on.
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

HWY_INLINE void fill_triangle_of(const TriangleGroup& group, size_t i, const TileRect& rect,
                                 int32_t join, TileColumns& columns) {
  TileTriangle t = group.triangle(i, columns.base);
  if (!t.flat) {
    const auto x_first = static_cast<int32_t>(std::max<double>(group.x_low[i] - 1, rect.x0));
    const auto x_last = static_cast<int32_t>(std::min<double>(group.x_high[i] + 1, rect.x1 - 1));
    group.bound_by_sides(i, x_first, x_last, t);
  }
  if (group.near(i)) {
    fill_triangle<DF>(group.near_corners(i), t, rect, join, columns);
  } else {
    fill_triangle<hn::CappedTag<double, 8>>(group.far_corners(i), t, rect, join, columns);
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

  TriangleGroup group;
  for (size_t next = 0; next < items.size();) {
    group.size = 0;
    while (group.size < kGroup && next < items.size()) {
      group.take(triangles[items[next++]], cell_x, cell_z, rect);
    }
    group.set_up();
    for (size_t i = 0; i < group.size; ++i) fill_triangle_of(group, i, rect, join, columns);
  }
  std::stable_sort(columns.spills.begin(), columns.spills.end(),
                   [](const auto& a, const auto& b) { return a.cell < b.cell; });
}

}  // namespace HWY_NAMESPACE
}  // namespace throng::bake
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace throng::bake {

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

}  // namespace throng::bake
#endif  // HWY_ONCE
