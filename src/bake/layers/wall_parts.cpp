// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "bake/layers/wall_parts.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <utility>

// The cells in question lie near solids that may or may not reach into the body. What a triangle
// has at the body's height is a convex polygon; its plan is filled, conservatively, into the parts
// of those cells around that the window finds closed, and each asked cell is tested against the
// parts that lie nearer to it than the radius. Cells whose feet are about as high share a filling.

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bake/layers/wall_parts.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
#include <hwy/highway.h>

#include "bake/columns/vector_bits-inl.h"

#ifndef THRONG_WALL_PARTS_ONCE
#define THRONG_WALL_PARTS_ONCE
namespace throng::bake {

// An edge of a polygon in plan, upward in z. [cells]
struct PlanEdge {
  double z0, z1, x, slope;
};

// What of a triangle lies in a slab, from above: at most five corners.
struct PlanPart {
  std::array<PlanEdge, 8> edges;
  size_t count;
  double x0, x1, z0, z1;
};

// Parts of cells, the last included.
struct PartBox {
  int32_t x0, x1, z0, z1;

  [[nodiscard]] uint64_t of_cell(int32_t x, int32_t z) const {
    const auto range = [](int32_t first, int32_t last) {  // 1 to 8 bits
      return 0xFFU >> (7 - std::min(last, 7)) & 0xFFU << std::max(first, 0) & 0xFFU;
    };
    const uint64_t bytes = range(z0 - 8 * z, z1 - 8 * z);  // bit j: row j
    // Bit j of the eight to the lowest bit of byte j, then the row's bits into each such byte.
    uint64_t rows = 0;
    for (int32_t j = 0; j < 8; ++j) rows |= (bytes >> j & 1) << (8 * j);
    return rows * range(x0 - 8 * x, x1 - 8 * x);
  }
};

inline uint64_t bits_between(int32_t first, int32_t last) {
  return ~uint64_t{0} >> (63 - last) & ~uint64_t{0} << first;
}

}  // namespace throng::bake
#endif

HWY_BEFORE_NAMESPACE();
namespace throng::bake {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using DF = hn::CappedTag<double, 8>;
using DI = hn::Rebind<int32_t, DF>;
using DB = hn::Rebind<uint8_t, DF>;
using DW = hn::CappedTag<uint64_t, 8>;
using VF = hn::Vec<DF>;
using VI = hn::Vec<DI>;

constexpr double kPart = 1.0 / 8;  // [cells]

template <class V>
HWY_INLINE V clamped(V v, V low, V high) {
  return hn::Max(low, hn::Min(v, high));
}

// What the polygon covers, conservatively, of the eight rows of parts of row z of a tile's cells:
// from which part to which. [parts, the last included; -1 to 512]
struct PartRows {
  alignas(32) int32_t first[8], last[8];
  int32_t min_part = 511, max_part = 0;  // that lie in the row of tiles

  HWY_INLINE PartRows(const PlanPart& polygon, size_t z) {
    const DF df;
    const DI di;
    const double row_begin = static_cast<double>(z) - 2 * kWiden,
                 row_end = row_begin + 1 + 4 * kWiden;
    for (size_t j = 0; j < 8; j += hn::Lanes(df)) {
      const VF begin =
          hn::Add(hn::Set(df, static_cast<double>(z) + static_cast<double>(j) * kPart - kWiden),
                  hn::Mul(counting_from(df, 0.0), hn::Set(df, kPart)));
      const VF end = hn::Add(begin, hn::Set(df, kPart + 2 * kWiden));
      VF low = hn::Set(df, 1e9), high = hn::Set(df, -1e9);
      for (size_t i = 0; i < polygon.count; ++i) {
        const PlanEdge& e = polygon.edges[i];
        if (e.z0 > row_end || e.z1 < row_begin) continue;
        const VF z0 = hn::Set(df, e.z0), z1 = hn::Set(df, e.z1);
        const VF x = hn::Set(df, e.x), slope = hn::Set(df, e.slope);
        const auto touched = hn::And(hn::Ge(end, z0), hn::Le(begin, z1));
        const VF a = hn::Add(x, hn::Mul(slope, hn::Sub(clamped(begin, z0, z1), z0)));
        const VF b = hn::Add(x, hn::Mul(slope, hn::Sub(clamped(end, z0, z1), z0)));
        low = hn::IfThenElse(touched, hn::Min(low, hn::Min(a, b)), low);
        high = hn::IfThenElse(touched, hn::Max(high, hn::Max(a, b)), high);
      }
      const auto part_of = [&](VF v) {
        const VF part = hn::Mul(v, hn::Set(df, 8));
        return hn::DemoteTo(di, hn::Floor(clamped(part, hn::Set(df, -1), hn::Set(df, 512))));
      };
      const VI from = part_of(hn::Sub(low, hn::Set(df, kWiden)));
      const VI to = part_of(hn::Add(high, hn::Set(df, kWiden)));
      hn::Store(from, di, first + j);
      hn::Store(to, di, last + j);
      min_part = std::min(min_part, hn::GetLane(hn::MinOfLanes(di, from)));
      max_part = std::max(max_part, hn::GetLane(hn::MaxOfLanes(di, to)));
    }
    min_part = std::max(min_part, 0);
    max_part = std::min(max_part, 511);
  }

  // The parts of the row's cell x.
  [[nodiscard]] HWY_INLINE uint64_t of_cell(int32_t x) const {
    const DI di;
    const hn::RebindToUnsigned<DI> du;
    const DB db;
    const VI zero = hn::Zero(di), begin = hn::Set(di, 8 * x);
    uint8_t bytes[8];
    for (size_t j = 0; j < 8; j += hn::Lanes(di)) {
      const VI from = clamped(hn::Sub(hn::Load(di, first + j), begin), zero, hn::Set(di, 8));
      const VI to =
          clamped(hn::Sub(hn::Load(di, last + j), begin), hn::Set(di, -1), hn::Set(di, 7));
      const auto all = hn::Set(du, 0xFF);
      const auto bits = hn::And(hn::Shl(all, hn::BitCast(du, from)),
                                hn::Shr(all, hn::BitCast(du, hn::Sub(hn::Set(di, 7), to))));
      hn::StoreU(hn::DemoteTo(db, hn::BitCast(di, bits)), db, bytes + j);
    }
    uint64_t out;
    __builtin_memcpy(&out, bytes, 8);
    return out;
  }
};

// Fills every part of the wanted cells that the polygon touches. `first_cell` is the tile's,
// and `stride` is from row to row.
void FillParts(const PlanPart& polygon, const WallScratch::Near& near, const BitPlane& wanted,
               uint64_t* parts, ptrdiff_t first_cell, ptrdiff_t stride) {
  const auto part_of = [](double v) { return static_cast<int32_t>(std::floor(v * 8)); };
  const PartBox box{part_of(polygon.x0 - kWiden), part_of(polygon.x1 + kWiden),
                    part_of(polygon.z0 - kWiden), part_of(polygon.z1 + kWiden)};
  const int32_t z0 = std::max<int32_t>(box.z0 >> 3, near.z0);
  const int32_t z1 = std::min<int32_t>(box.z1 >> 3, near.z1);
  const int32_t x0 = std::max<int32_t>(box.x0 >> 3, near.x0);
  const int32_t x1 = std::min<int32_t>(box.x1 >> 3, near.x1);
  if (x0 > x1 || z0 > z1) return;
  const uint64_t columns = bits_between(x0, x1);
  // What is a part wide touches all of its box: walls along the grid, and small triangles.
  const bool is_box = box.x0 == box.x1 || box.z0 == box.z1;
  for (int32_t z = z0; z <= z1; ++z) {
    uint64_t cells = wanted[static_cast<size_t>(z)] & columns;
    if (cells == 0) continue;
    const ptrdiff_t row = first_cell + z * stride;
    if (is_box) {
      for (; cells != 0; cells &= cells - 1) {
        const int32_t x = std::countr_zero(cells);
        parts[row + x] |= box.of_cell(x, z);
      }
      continue;
    }
    const PartRows rows(polygon, static_cast<size_t>(z));
    if (rows.min_part > rows.max_part) continue;
    for (cells &= bits_between(rows.min_part / 8, rows.max_part / 8); cells != 0;
         cells &= cells - 1) {
      const int32_t x = std::countr_zero(cells);
      parts[row + x] |= rows.of_cell(x);
    }
  }
}

// Of the wanted cells of a tile, keeps those that the window finds closed to a body in the slab.
// `first` is the tile's first cell. Only vectors that hold a wanted cell are tested: others may lie
// outside of the window.
void KeepClosed(const LayerWindow& window, ptrdiff_t first, WallScratch::Slab slab,
                WallScratch::Side& side) {
  const hn::CappedTag<uint16_t, 32> du;
  constexpr uint64_t kAll = ~uint64_t{0};
  const size_t lanes = hn::Lanes(du);
  const auto set = [&](int32_t v, int32_t highest) {
    return hn::Set(du, static_cast<uint16_t>(std::clamp(v, 0, highest)));
  };
  const auto floor = set(slab.floor, kNone16 - 1), low = set(slab.low, kNone16 - 1);
  const auto high = set(slab.high, kNone16);
  for (uint64_t rows = side.rows; rows != 0; rows &= rows - 1) {
    const int32_t z = std::countr_zero(rows);
    uint64_t& wanted = side.wanted[static_cast<size_t>(z)];
    const ptrdiff_t row = first + z * window.stride();
    uint64_t open = 0;
    for (size_t x = 0; x < kTileSide; x += lanes) {
      if ((wanted >> x & kAll >> (64 - lanes)) == 0) continue;
      const auto top = hn::LoadU(du, &window.top[static_cast<size_t>(row) + x]);
      const auto ceiling = hn::LoadU(du, &window.ceiling[static_cast<size_t>(row) + x]);
      const auto headroom = hn::Eq(hn::Max(ceiling, high), ceiling);
      const auto fits = hn::And(headroom, hn::Eq(hn::Min(hn::Max(top, floor), low), top));
      open |= bits_of(du, fits) << x;
    }
    wanted &= ~open;
    if (wanted == 0) side.rows &= ~(uint64_t{1} << z);
    side.columns |= wanted;
  }
}

// Of some rows of a tile, marks the columns in which one free span holds the whole slab, but begins
// below its floor: drops. `base` is what the slab's heights are from. Nonzero if there are any.
uint64_t MarkDrops(const LayerList& tile, uint64_t rows, int32_t base, WallScratch::Slab slab,
                   BitPlane& drops) {
  uint64_t any = 0;
  const hn::CappedTag<uint16_t, 32> du;
  const size_t lanes = hn::Lanes(du);
  for (const Layer* layer : tile) {
    const int32_t floor = slab.floor + base - layer->base, high = slab.high + base - layer->base;
    if (floor <= layer->low_top) continue;
    const auto floors = hn::Set(du, static_cast<uint16_t>(std::min<int32_t>(floor, kNone16)));
    const auto ceilings = hn::Set(du, static_cast<uint16_t>(std::clamp<int32_t>(high, 0, kNone16)));
    for (uint64_t left = rows; left != 0; left &= left - 1) {
      const auto z = static_cast<size_t>(std::countr_zero(left));
      for (size_t x = 0; x < kTileSide; x += lanes) {
        const auto top = hn::Load(du, &layer->top[z * kTileSide + x]);
        const auto ceiling = hn::Load(du, &layer->ceiling[z * kTileSide + x]);
        const auto low = hn::Ne(hn::Max(top, floors), top);
        const uint64_t found =
            bits_of(du, hn::And(low, hn::Eq(hn::Max(ceiling, ceilings), ceiling))) << x;
        drops[z] |= found;
        any |= found;
      }
    }
  }
  return any;
}

// Makes legal the asked cells from where the body, anywhere on its cell, touches no part that is
// filled. True if there are any.
bool PassFree(std::span<const WallScratch::Asked> asked, const LayerWindow& window,
              const BodyWindow& body, const uint64_t* parts, BitPlane& legal) {
  const DW dw;
  const auto lanes = static_cast<int32_t>(hn::Lanes(dw));
  bool any = false;
  for (const WallScratch::Asked& a : asked) {
    const int32_t x = a.cell % kTileSide, z = a.cell / kTileSide;
    auto touched = hn::Zero(dw);
    const uint64_t* near = body.near_parts.data();
    const uint64_t* row = parts + window.index(x - body.reach, z - body.reach);
    for (int32_t i = 0; i <= 2 * body.reach; ++i) {
      for (int32_t dx = 0; dx < body.near_stride; dx += lanes) {
        const auto filled = hn::LoadU(dw, row + dx);
        touched = hn::Or(touched, hn::And(filled, hn::LoadU(dw, near + dx)));
      }
      near += body.near_stride;
      row += window.stride();
    }
    if (!hn::AllTrue(dw, hn::Eq(touched, hn::Zero(dw)))) continue;
    any = true;
    legal[static_cast<size_t>(z)] |= uint64_t{1} << x;
  }
  return any;
}

}  // namespace HWY_NAMESPACE
}  // namespace throng::bake
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace throng::bake {

HWY_EXPORT(FillParts);
HWY_EXPORT(KeepClosed);
HWY_EXPORT(MarkDrops);
HWY_EXPORT(PassFree);

namespace {

constexpr int32_t kLast = kTileSide - 1;
constexpr int32_t kBandZero = 1 << 29;  // Heights are far above its negative. [mm]
constexpr double kMinOverlap = 1e-4;  // A solid that enters a body by less does not block it. [mm]

// Where the triangle lies between two heights, in the frame of the tile at (cell_x, cell_z).
PlanPart cut_slab(const CellTriangle& t, double cell_x, double cell_z, double low, double high) {
  struct Point {
    double x, y, z;
  };
  std::array<Point, 8> corners, other;
  Point *from = corners.data(), *to = other.data();
  size_t count = 3;
  for (size_t i = 0; i < 3; ++i) from[i] = {t.x[i] - cell_x, t.y[i], t.z[i] - cell_z};
  const auto keep = [&](double at, double sign) {
    size_t kept = 0;
    for (size_t i = 0; i < count; ++i) {
      const Point& a = from[i];
      const Point& b = from[i + 1 == count ? 0 : i + 1];
      const double da = sign * (a.y - at), db = sign * (b.y - at);
      if (da >= 0) to[kept++] = a;
      if ((da < 0) == (db < 0)) continue;
      const double s = da / (da - db);
      to[kept++] = {a.x + s * (b.x - a.x), at, a.z + s * (b.z - a.z)};
    }
    std::swap(from, to);
    count = kept;
  };
  if (t.low < low) keep(low, 1);
  if (t.high > high) keep(high, -1);
  PlanPart out;
  out.count = 0;
  if (count == 0) return out;
  const auto add_edge = [&](const Point* a, const Point* b) {
    if (a->z > b->z) std::swap(a, b);
    const double slope = b->z > a->z ? (b->x - a->x) / (b->z - a->z) : 0;
    out.edges[out.count++] = {a->z, b->z, a->x, slope};
  };
  const Point *min_x = from, *max_x = from, *min_z = from, *max_z = from;
  for (const Point* p = from; p != from + count; ++p) {
    if (p->x < min_x->x) min_x = p;
    if (p->x > max_x->x) max_x = p;
    if (p->z < min_z->z) min_z = p;
    if (p->z > max_z->z) max_z = p;
  }
  out.x0 = min_x->x;
  out.x1 = max_x->x;
  out.z0 = min_z->z;
  out.z1 = max_z->z;
  const auto same = [&](size_t i, size_t k) { return t.x[i] == t.x[k] && t.z[i] == t.z[k]; };
  if (same(0, 1) || same(1, 2) || same(2, 0)) {  // Upright: a line from above.
    const bool along_x = out.x1 - out.x0 > out.z1 - out.z0;
    add_edge(along_x ? min_x : min_z, along_x ? max_x : max_z);
    return out;
  }
  for (size_t i = 0; i < count; ++i) add_edge(&from[i], &from[i + 1 == count ? 0 : i + 1]);
  return out;
}

bool touches_wanted(const WallScratch::Side& side, const WallScratch::Near& near) {
  const uint64_t columns = bits_between(near.x0, near.x1);
  if ((side.columns & columns) == 0) return false;
  for (uint64_t rows = side.rows & bits_between(near.z0, near.z1); rows != 0; rows &= rows - 1) {
    if ((side.wanted[static_cast<size_t>(std::countr_zero(rows))] & columns) != 0) return true;
  }
  return false;
}

// The lowest and the highest band of some wanted ones.
std::pair<int32_t, int32_t> bands_of(const std::vector<WallScratch::Asked>& asked) {
  const auto [low, high] = std::minmax_element(asked.begin(), asked.end());  // bands come first
  return {low->band, high->band};
}

class WallCheck {
 public:
  WallCheck(const Neighbourhood& tiles, size_t layer, const BodyWindow& body,
            const TileTriangles& triangles, const LegalityScratch& legality, WallScratch& scratch)
      : tiles_(tiles),
        layer_(*(*tiles[4])[layer]),
        body_(body),
        triangles_(triangles),
        window_(legality.window),
        tilt_(legality.tilt),
        scratch_(scratch) {}

  bool run(LegalCells& cells);

 private:
  using Asked = WallScratch::Asked;
  using Slab = WallScratch::Slab;

  void list(const LegalCells& cells);
  void leave_out_hopeless();
  void want(std::span<const Asked> asked, Slab slab);
  void list_around(size_t side);
  void gather(Slab slab);
  void fill(Slab slab);
  template <class Visit>
  void for_wanted(Visit visit);
  // First cell of one of the nine tiles, which may lie before the window's first.
  [[nodiscard]] ptrdiff_t first_of(size_t side) const {
    const auto s = static_cast<int32_t>(side);
    return static_cast<ptrdiff_t>(window_.index(0, 0)) +
           ((s / 3 - 1) * window_.stride() + s % 3 - 1) * kTileSide;
  }
  [[nodiscard]] Slab slab_of(int32_t first_band, int32_t last_band) const;

  const Neighbourhood& tiles_;
  const Layer& layer_;
  const BodyWindow& body_;
  const TileTriangles& triangles_;
  const LayerWindow& window_;
  const std::array<uint16_t, kTileArea>& tilt_;
  WallScratch& scratch_;
  int32_t band_ = std::max(1, body_.bottom / 4);  // of feet that share a filling [mm]
};

void WallCheck::list(const LegalCells& cells) {
  scratch_.asked.clear();
  for (int32_t z = 0; z < kTileSide; ++z) {
    uint64_t row = cells.hemmed[static_cast<size_t>(z)] & ~cells.legal[static_cast<size_t>(z)];
    for (; row != 0; row &= row - 1) {
      const auto cell = static_cast<size_t>(z * kTileSide + std::countr_zero(row));
      const int32_t feet = layer_.feet[cell], tilt = tilt_[cell];
      if (tilt > body_.gentle) continue;  // On steeper ground the slab meets the ground.
      const int32_t band = (layer_.base + feet - tilt + kBandZero) / band_;
      scratch_.asked.push_back({band, static_cast<int32_t>(cell)});
    }
  }
}

// Takes off the list what is within reach of a column without a solid at the height of any body
// asked for, and without a floor: nothing will excuse that one.
void WallCheck::leave_out_hopeless() {
  const auto [low, high] = bands_of(scratch_.asked);
  Slab slab = slab_of(low, low);
  slab.high = slab_of(high, high).high;
  const int32_t reach = body_.reach;
  uint64_t rows = 0, columns = 0;
  for (const Asked& a : scratch_.asked) {
    rows |= uint64_t{1} << a.cell / kTileSide;
    columns |= uint64_t{1} << a.cell % kTileSide;
  }
  // Of a row or column of tiles, the cells that are within reach of the asked ones.
  const auto near_of = [&](uint64_t cells) {
    std::array<uint64_t, 3> near{0, cells, 0};
    for (int32_t d = 1; d <= reach; ++d) {
      near[0] |= cells << (64 - d);
      near[2] |= cells >> (64 - d);
      if (d < 64) near[1] |= cells << d | cells >> d;
    }
    return near;
  };
  const std::array<uint64_t, 3> near_rows = near_of(rows), near_columns = near_of(columns);
  uint64_t any = 0;
  for (size_t s = 0; s < 9; ++s) {
    if (near_rows[s / 3] == 0 || near_columns[s % 3] == 0) continue;
    BitPlane& drops = scratch_.drops[s];
    const BitPlane* bare = triangles_.bare[s];
    const uint64_t all = tiles_[s] == nullptr || triangles_.items[s].empty() ? ~uint64_t{0} : 0;
    for (uint64_t left = near_rows[s / 3]; left != 0; left &= left - 1) {
      const auto z = static_cast<size_t>(std::countr_zero(left));
      drops[z] = bare != nullptr ? (*bare)[z] : all;
      any |= drops[z];
    }
    if (tiles_[s] == nullptr) continue;
    any |= HWY_DYNAMIC_DISPATCH(MarkDrops)(*tiles_[s], near_rows[s / 3], layer_.base, slab, drops);
  }
  if (any == 0) return;
  BitPlane hopeless{};
  for (int32_t z = -reach; z < kTileSide + reach; ++z) {
    const auto side = static_cast<size_t>(z < 0 ? 0 : (z > kLast ? 6 : 3));
    const auto r = static_cast<size_t>(z & kLast);
    if ((near_rows[side / 3] >> r & 1) == 0) continue;
    const auto row_of = [&](size_t i) {
      return near_columns[i] == 0 ? 0 : scratch_.drops[side + i][r];
    };
    const uint64_t left = row_of(0), middle = row_of(1), right = row_of(2);
    if ((left | middle | right) == 0) continue;
    // From the outermost rows, the narrowest, inward.
    int32_t w = 0;
    uint64_t near = middle;
    for (int32_t d = reach; d >= 0; --d) {
      while (w < body_.width[static_cast<size_t>(d)]) {
        ++w;
        near |= left >> (64 - w) | right << (64 - w);
        if (w < 64) near |= middle << w | middle >> w;
      }
      if (z - d >= 0 && z - d <= kLast) hopeless[static_cast<size_t>(z - d)] |= near;
      if (z + d >= 0 && z + d <= kLast) hopeless[static_cast<size_t>(z + d)] |= near;
    }
  }
  std::erase_if(scratch_.asked, [&](const Asked& a) {
    return (hopeless[static_cast<size_t>(a.cell / kTileSide)] >> a.cell % kTileSide & 1) != 0;
  });
}

// What bodies need whose feet are in one of the bands, anywhere on their cells.
WallCheck::Slab WallCheck::slab_of(int32_t first_band, int32_t last_band) const {
  const int32_t lowest = first_band * band_ - kBandZero - layer_.base;
  const int32_t highest = (last_band + 1) * band_ - 1 - kBandZero - layer_.base + 2 * body_.gentle;
  return {highest - body_.bottom, lowest + body_.bottom, highest + body_.height};
}

// Marks the cells that bodies on the asked cells can touch and that are closed to one of them.
void WallCheck::want(std::span<const Asked> asked, Slab slab) {
  for (WallScratch::Side& side : scratch_.sides) {
    if (side.rows == 0) continue;
    side = {};
  }
  for (size_t i = 0; i < asked.size();) {
    const int32_t z = asked[i].cell / kTileSide;
    uint64_t row = 0;
    for (; i < asked.size() && asked[i].cell / kTileSide == z; ++i) {
      row |= uint64_t{1} << asked[i].cell % kTileSide;
    }
    // From the outermost rows, the narrowest, inward.
    int32_t w = 0;
    uint64_t left = 0, middle = row, right = 0;
    for (int32_t d = body_.reach; d >= 0; --d) {
      while (w < body_.width[static_cast<size_t>(d)]) {
        ++w;
        left |= row << (64 - w);
        right |= row >> (64 - w);
        if (w < 64) middle |= row << w | row >> w;
      }
      const auto add = [&](int32_t to) {
        const auto r = static_cast<size_t>(to & kLast);
        const uint64_t bit = uint64_t{1} << r;
        WallScratch::Side* sides = &scratch_.sides[to < 0 ? 0 : (to > kLast ? 6 : 3)];
        sides[1].wanted[r] |= middle;
        sides[1].rows |= bit;
        if ((left | right) == 0) return;
        sides[0].wanted[r] |= left;
        sides[2].wanted[r] |= right;
        if (left != 0) sides[0].rows |= bit;
        if (right != 0) sides[2].rows |= bit;
      };
      add(z - d);
      if (d > 0) add(z + d);
    }
  }
  for (size_t s = 0; s < 9; ++s) {
    if (scratch_.sides[s].rows == 0) continue;
    HWY_DYNAMIC_DISPATCH(KeepClosed)(window_, first_of(s), slab, scratch_.sides[s]);
  }
}

// Lists the triangles of one of the nine tiles that some body on the middle one may touch, once for
// all layers and classes.
void WallCheck::list_around(size_t side) {
  const auto s = static_cast<int32_t>(side);
  std::vector<WallScratch::Near>& around = scratch_.around[side];
  around.clear();
  scratch_.known |= 1U << side;
  const double cell_x = triangles_.cell_x + (s % 3 - 1) * kTileSide;
  const double cell_z = triangles_.cell_z + (s / 3 - 1) * kTileSide;
  const auto cell_of = [](double v) {
    return static_cast<uint8_t>(std::clamp<double>(v, 0, kLast));
  };
  // The part of the tile that is near the middle one.
  const auto range = [&](int32_t d) -> std::pair<double, double> {
    return {d < 0 ? kTileSide - window_.reach() : 0, d > 0 ? window_.reach() : kTileSide};
  };
  const auto [first_x, end_x] = range(s % 3 - 1);
  const auto [first_z, end_z] = range(s / 3 - 1);
  for (const uint32_t item : triangles_.items[side]) {
    const CellTriangle& t = triangles_.all[item];
    const double z0 = t.z[0] - cell_z - kWiden, z1 = t.z[2] - cell_z + kWiden;
    if (z0 > end_z || z1 < first_z) continue;
    const double x0 = std::min({t.x[0], t.x[1], t.x[2]}) - cell_x - kWiden;
    const double x1 = std::max({t.x[0], t.x[1], t.x[2]}) - cell_x + kWiden;
    if (x0 > end_x || x1 < first_x) continue;
    around.push_back({&t, t.low, t.high, static_cast<uint8_t>(s), cell_of(x0), cell_of(x1),
                      cell_of(z0), cell_of(z1)});
  }
}

// Lists those that may touch a wanted cell, at some height between.
void WallCheck::gather(Slab slab) {
  scratch_.near.clear();
  const int32_t low = layer_.base + slab.low, high = layer_.base + slab.high;
  for (size_t s = 0; s < 9; ++s) {
    if (scratch_.sides[s].rows == 0) continue;
    if ((scratch_.known >> s & 1) == 0) list_around(s);
    for (const WallScratch::Near& near : scratch_.around[s]) {
      if (near.high <= low || near.low >= high) continue;
      if (touches_wanted(scratch_.sides[s], near)) scratch_.near.push_back(near);
    }
  }
}

template <class Visit>
void WallCheck::for_wanted(Visit visit) {
  for (size_t s = 0; s < 9; ++s) {
    const WallScratch::Side& side = scratch_.sides[s];
    for (uint64_t rows = side.rows; rows != 0; rows &= rows - 1) {
      const int32_t z = std::countr_zero(rows);
      const ptrdiff_t first = first_of(s) + z * window_.stride();
      for (uint64_t row = side.wanted[static_cast<size_t>(z)]; row != 0; row &= row - 1) {
        const int32_t x = std::countr_zero(row);
        visit(s, static_cast<size_t>(z * kTileSide + x),
              scratch_.parts[static_cast<size_t>(first + x)]);
      }
    }
  }
}

// Fills the parts of the wanted cells. All others stay empty.
void WallCheck::fill(Slab slab) {
  const double low = layer_.base + slab.low + kMinOverlap,
               high = layer_.base + slab.high - kMinOverlap;
  for (const WallScratch::Near& near : scratch_.near) {
    const WallScratch::Side& side = scratch_.sides[near.side];
    if (near.high < low || near.low > high || !touches_wanted(side, near)) continue;
    const int32_t x = (near.side % 3 - 1) * kTileSide, z = (near.side / 3 - 1) * kTileSide;
    const PlanPart part =
        cut_slab(*near.triangle, triangles_.cell_x + x, triangles_.cell_z + z, low, high);
    if (part.count == 0) continue;
    HWY_DYNAMIC_DISPATCH(FillParts)
    (part, near, side.wanted, scratch_.parts.data(), first_of(near.side), window_.stride());
  }
  // A cell that is closed, but not by a solid at the body's height, is no floor; or the window
  // follows the wrong layer there.
  const ColumnNeed need{layer_.base + slab.floor, layer_.base + slab.low, layer_.base + slab.high};
  for_wanted([&](size_t side, size_t cell, uint64_t& parts) {
    if (parts != 0) return;
    const LayerList* tile = tiles_[side];
    if (tile == nullptr || !column_is_free(*tile, cell, need)) parts = ~uint64_t{0};
  });
}

bool WallCheck::run(LegalCells& cells) {
  list(cells);
  std::vector<Asked>& all = scratch_.asked;
  if (all.empty()) return false;
  leave_out_hopeless();
  if (all.empty()) return false;
  scratch_.parts.resize(std::max(scratch_.parts.size(), window_.top.size() + 8), 0);
  const auto [low, high] = bands_of(all);
  const bool one_band = low == high;
  if (!one_band) {
    const Slab slab = slab_of(low, high);
    want(all, slab);
    gather(slab);
    std::sort(all.begin(), all.end());
  }
  bool any = false;
  for (size_t begin = 0, end = 0; begin < all.size(); begin = end) {
    const int32_t band = all[begin].band;
    end = one_band ? all.size() : begin + 1;
    while (end < all.size() && all[end].band == band) ++end;
    const std::span<const Asked> group(all.data() + begin, end - begin);
    const Slab slab = slab_of(band, band);
    want(group, slab);
    if (one_band) gather(slab);
    fill(slab);
    any |=
        HWY_DYNAMIC_DISPATCH(PassFree)(group, window_, body_, scratch_.parts.data(), cells.legal);
    for_wanted([](size_t, size_t, uint64_t& parts) { parts = 0; });
  }
  return any;
}

}  // namespace

bool recheck_walls(const Neighbourhood& tiles, size_t layer, const BodyWindow& body,
                   const TileTriangles& triangles, const LegalityScratch& legality,
                   WallScratch& scratch, LegalCells& cells) {
  return WallCheck(tiles, layer, body, triangles, legality, scratch).run(cells);
}

}  // namespace throng::bake
#endif  // HWY_ONCE
