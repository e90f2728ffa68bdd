// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "bake/layers/surface_planes.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "bake/layers/surface_triangle.h"

// Triangles give their planes to the cells whose centre they cover; then every triangle that
// touches a cell says how far it stands above the cell's plane. Over a cell, a triangle of gradient
// t stands above a plane of gradient g by at most what it does at the centre and
// (|t_x - g_x| + |t_z - g_z|) / 2, and anywhere by at most what one of its corners does: the first
// is next to nothing along a slope, the second across a ridge. Where neither settles it, what of
// the triangle lies in the cell is cut out.

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bake/layers/surface_planes.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
#include <hwy/highway.h>

#include "bake/columns/vector_bits-inl.h"

#ifndef THRONG_SURFACE_PLANES_ONCE
#define THRONG_SURFACE_PLANES_ONCE
namespace throng::bake {

struct CellRun {
  int32_t first, last;

  [[nodiscard]] bool empty() const { return first > last; }
};

// The part of the window that one of the nine tiles covers, in the frame of the middle one.
struct SurfaceSide {
  const LayerWindow* window;
  CellPlanes* cells;
  const CellRun* runs;     // of cells in question, by row
  int32_t x0, x1, z0, z1;  // the last included
  float limit;             // of excesses that matter [mm]
  float lowest, highest;   // tops that matter, the lowest less the limit
  std::vector<SurfaceTriangle> triangles;

  [[nodiscard]] CellRun run(int32_t z) const {
    return {std::max(runs[z].first, x0), std::min(runs[z].last, x1)};
  }
};

// Floats may err by that much: heights are up to 2^16 mm from their base. [mm]
inline constexpr float kPlaneMargin = 0.03f;

}  // namespace throng::bake
#endif

HWY_BEFORE_NAMESPACE();
namespace throng::bake {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using DF = hn::CappedTag<float, 16>;
using DI = hn::RebindToSigned<DF>;
using DH = hn::Rebind<uint16_t, DI>;
using VF = hn::Vec<DF>;
using MF = hn::Mask<DF>;

constexpr float kHalf = 0.51f;         // of a difference over a cell, and more than floats err
constexpr float kMinExcess = 1;        // an excess that is not refined [mm]
constexpr double kMaxDistance = 1000;  // beyond, floats do not resolve how high a plane is [cells]

HWY_INLINE VF set(double value) { return hn::Set(DF(), static_cast<float>(value)); }

HWY_INLINE VF load_tops(const uint16_t* tops) {
  return hn::ConvertTo(DF(), hn::PromoteTo(DI(), hn::LoadU(DH(), tops)));
}

int32_t floor_in(double x, int32_t low, int32_t high) {
  return static_cast<int32_t>(std::floor(std::clamp<double>(x, low, high)));
}

// The cells of a run that the interval touches.
CellRun touched(CellRun run, double low, double high) {
  return {floor_in(low, run.first, run.last + 1), floor_in(high, run.first - 1, run.last)};
}

// Vectors of cells that cover a run. They begin where the tile's do, so that none leaves the row.
struct Lanes {
  int32_t x;
  VF cells;
  MF inside;

  HWY_INLINE Lanes(int32_t at, CellRun run) : x(at) {
    const DF df;
    cells = hn::ConvertTo(df, counting_from(DI(), at));
    inside = hn::And(hn::Ge(cells, set(run.first)), hn::Le(cells, set(run.last)));
  }
  static int32_t count() { return static_cast<int32_t>(hn::Lanes(DF())); }
  static int32_t begin(CellRun run) { return run.first & ~(count() - 1); }
};

// One row of the planes; index 0 is the tile's cell 0.
struct PlaneRow {
  float *height, *slope_x, *slope_z, *steepness, *excess;
  const uint16_t* top;

  PlaneRow(const SurfaceSide& side, int32_t z) {
    const size_t i = side.window->index(0, z);
    CellPlanes& cells = *side.cells;
    height = &cells.height[i];
    slope_x = &cells.slope_x[i];
    slope_z = &cells.slope_z[i];
    steepness = &cells.steepness[i];
    excess = &cells.excess[i];
    top = &side.window->top[i];
  }
};

// Keeps, of the triangles under each centre, the highest that lies below the free span.
void FindPlanes(const SurfaceSide& side) {
  const DF df;
  for (const SurfaceTriangle& t : side.triangles) {
    if (!t.is_plane) continue;
    const double steepness = std::sqrt(t.slope_x * t.slope_x + t.slope_z * t.slope_z);
    // On a steeper plane no class stands, and it would reach below the solid that make() leaves
    // out.
    if (steepness > side.limit) continue;
    const int32_t first = floor_in(std::ceil(t.corner[0].z - 0.5), side.z0, side.z1 + 1);
    const int32_t last = floor_in(t.corner[2].z - 0.5, side.z0 - 1, side.z1);
    for (int32_t z = first; z <= last; ++z) {
      const CellRun all = side.run(z);
      if (all.empty()) continue;
      const Interval line = t.on_line(z + 0.5);
      const CellRun run =
          touched(all, std::ceil(line.low - 0.5 - kTouchMargin), line.high - 0.5 + kTouchMargin);
      if (run.empty()) continue;
      const PlaneRow row(side, z);
      const VF at_zero = set(t.at(0.5, z + 0.5)), slope = set(t.slope_x);
      for (int32_t x = Lanes::begin(run); x <= run.last; x += Lanes::count()) {
        const Lanes lanes(x, run);
        const VF y = hn::Add(at_zero, hn::Mul(slope, lanes.cells));
        const MF higher = hn::Or(hn::Lt(hn::LoadU(df, row.excess + x), hn::Zero(df)),
                                 hn::Gt(y, hn::LoadU(df, row.height + x)));
        const MF fits = hn::And(hn::Le(y, hn::Add(load_tops(row.top + x), set(kPlaneMargin))),
                                hn::Ge(y, set(side.lowest)));
        const MF mask = hn::And(lanes.inside, hn::And(higher, fits));
        hn::BlendedStore(y, mask, df, row.height + x);
        hn::BlendedStore(slope, mask, df, row.slope_x + x);
        hn::BlendedStore(set(t.slope_z), mask, df, row.slope_z + x);
        hn::BlendedStore(set(steepness * (1 + 1e-6)), mask, df, row.steepness + x);
        hn::BlendedStore(hn::Zero(df), mask, df, row.excess + x);
      }
    }
  }
}

// By how much the triangle may stand above the planes of the cells, where it lies below their free
// span.
struct Excess {
  VF most;
  MF below;
};

// A triangle, as it is compared with vectors of cells.
struct Comparison {
  const SurfaceTriangle& t;
  VF slope_x, slope_z, tilt, lowest, highest;
  VF corner_x[3], corner_y[3];
  bool is_near = true;

  HWY_INLINE explicit Comparison(const SurfaceTriangle& triangle) : t(triangle) {
    slope_x = set(t.slope_x);
    slope_z = set(t.slope_z);
    tilt = hn::Mul(set(kHalf), hn::Add(hn::Abs(slope_x), hn::Abs(slope_z)));
    lowest = set(t.lowest);
    highest = set(t.highest);
    for (size_t i = 0; i < 3; ++i) {
      const SurfacePoint& p = t.corner[i];
      corner_x[i] = set(p.x - 0.5);
      corner_y[i] = set(p.y);
      is_near &= std::fabs(p.x) < kMaxDistance && std::fabs(p.z) < kMaxDistance;
    }
  }

  HWY_INLINE Excess with(const PlaneRow& row, int32_t z, const Lanes& lanes) const {
    const DF df;
    const VF height = hn::LoadU(df, row.height + lanes.x);
    const VF gx = hn::LoadU(df, row.slope_x + lanes.x), gz = hn::LoadU(df, row.slope_z + lanes.x);
    VF least = lowest;
    VF most = hn::Add(highest, hn::Mul(set(kHalf), hn::Add(hn::Abs(gx), hn::Abs(gz))));
    if (t.is_plane) {
      const VF y = hn::Add(set(t.at(0.5, z + 0.5)), hn::Mul(slope_x, lanes.cells));
      const VF apart = hn::Add(hn::Abs(hn::Sub(slope_x, gx)), hn::Abs(hn::Sub(slope_z, gz)));
      most = hn::Min(most, hn::Add(y, hn::Mul(set(kHalf), apart)));
      least = hn::Max(least, hn::Sub(y, tilt));
    }
    if (is_near) {
      VF over = set(-1e30);
      for (size_t i = 0; i < 3; ++i) {
        const VF along = hn::Mul(gx, hn::Sub(corner_x[i], lanes.cells));
        const VF across = hn::Mul(gz, set(t.corner[i].z - (z + 0.5)));
        over = hn::Max(over, hn::Sub(corner_y[i], hn::Add(along, across)));
      }
      most = hn::Min(most, over);
    }
    const VF margin = set(kPlaneMargin);
    return {hn::Add(hn::Sub(most, height), margin),
            hn::Le(least, hn::Add(load_tops(row.top + lanes.x), margin))};
  }
};

// Widens the excess of one cell exactly. `strip` is what of the triangle lies in its row.
void widen_excess(const SurfacePart& strip, const PlaneRow& row, int32_t x, int32_t z) {
  const SurfacePart part = strip.cut<&SurfacePoint::x>(x - kTouchMargin, 1)
                               .cut<&SurfacePoint::x>(x + 1 + kTouchMargin, -1);
  double lowest = 1e30, most = -1e30;
  for (size_t k = 0; k < part.count; ++k) {
    const SurfacePoint& p = part.points[k];
    lowest = std::min(lowest, p.y);
    most =
        std::max(most, p.y - row.slope_x[x] * (p.x - x - 0.5) - row.slope_z[x] * (p.z - z - 0.5));
  }
  if (lowest > row.top[x] + kPlaneMargin) return;  // It hangs above the free span.
  row.excess[x] = std::max(row.excess[x], static_cast<float>(most - row.height[x] + kPlaneMargin));
}

// Widens the excess of each cell by all solids below its free span.
void FindExcess(const SurfaceSide& side) {
  const DF df;
  for (const SurfaceTriangle& t : side.triangles) {
    const Comparison triangle(t);
    const int32_t first = floor_in(t.corner[0].z - kTouchMargin, side.z0, side.z1 + 1);
    const int32_t last = floor_in(t.corner[2].z + kTouchMargin, side.z0 - 1, side.z1);
    for (int32_t z = first; z <= last; ++z) {
      const CellRun all = side.run(z);
      if (all.empty()) continue;
      const Interval reach = t.in_row(z);
      const CellRun run = touched(all, reach.low - kTouchMargin, reach.high + kTouchMargin);
      if (run.empty()) continue;
      const PlaneRow row(side, z);
      SurfacePart strip;
      for (int32_t x = Lanes::begin(run); x <= run.last; x += Lanes::count()) {
        const Lanes lanes(x, run);
        const VF excess = hn::LoadU(df, row.excess + x);
        const MF open = hn::And(
            lanes.inside, hn::And(hn::Ge(excess, hn::Zero(df)), hn::Le(excess, set(side.limit))));
        if (hn::AllFalse(df, open)) continue;
        const Excess raised = triangle.with(row, z, lanes);
        const MF mask = hn::And(open, hn::And(raised.below, hn::Gt(raised.most, excess)));
        const MF little = hn::Le(raised.most, set(kMinExcess));
        hn::BlendedStore(raised.most, hn::And(mask, little), df, row.excess + x);
        uint64_t cells = bits_of(df, hn::AndNot(little, mask));
        if (cells == 0) continue;
        if (strip.count == 0) strip = t.row_part(z);
        for (; cells != 0; cells &= cells - 1) {
          widen_excess(strip, row, x + std::countr_zero(cells), z);
        }
      }
    }
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace throng::bake
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace throng::bake {

HWY_EXPORT(FindPlanes);
HWY_EXPORT(FindExcess);

namespace {

// Row by row, from the first to the last cell that a body on one of `asked` reaches.
std::vector<CellRun> runs_around(const BitPlane& asked, int32_t reach) {
  std::vector<CellRun> runs(static_cast<size_t>(kTileSide + 2 * reach),
                            {kTileSide + reach, -1 - reach});
  for (int32_t z = 0; z < kTileSide; ++z) {
    const uint64_t cells = asked[static_cast<size_t>(z)];
    if (cells == 0) continue;
    for (int32_t near = z; near <= z + 2 * reach; ++near) {
      CellRun& run = runs[static_cast<size_t>(near)];
      run.first = std::min(run.first, std::countr_zero(cells) - reach);
      run.last = std::max(run.last, kTileSide - 1 - std::countl_zero(cells) + reach);
    }
  }
  return runs;
}

// Puts level planes at the tops, and finds what the runs span.
void clear(SurfaceSide& side, int32_t reach) {
  CellPlanes& cells = *side.cells;
  for (auto* values :
       {&cells.height, &cells.slope_x, &cells.slope_z, &cells.steepness, &cells.excess}) {
    values->resize(side.window->top.size());
  }
  side.x0 = side.z0 = kTileSide + reach;
  side.x1 = side.z1 = -1 - reach;
  int32_t low = kNone16, high = 0;
  for (int32_t z = -reach; z < kTileSide + reach; ++z) {
    const CellRun run = side.runs[z];
    if (run.empty()) continue;
    side.x0 = std::min(side.x0, run.first);
    side.x1 = std::max(side.x1, run.last);
    side.z0 = std::min(side.z0, z);
    side.z1 = z;
    const size_t begin = side.window->index(run.first, z);
    const auto count = static_cast<size_t>(run.last - run.first + 1);
    for (size_t i = begin; i < begin + count; ++i) {
      const uint16_t top = side.window->top[i];
      cells.height[i] = static_cast<float>(top);
      low = std::min<int32_t>(low, top);
      high = std::max<int32_t>(high, top == kNone16 ? 0 : top);
    }
    for (auto* values : {&cells.slope_x, &cells.slope_z, &cells.steepness}) {
      std::fill_n(values->begin() + static_cast<ptrdiff_t>(begin), count, 0.0f);
    }
    std::fill_n(cells.excess.begin() + static_cast<ptrdiff_t>(begin), count, -1.0f);
  }
  side.lowest = static_cast<float>(low) - side.limit;
  side.highest = static_cast<float>(high);
}

}  // namespace

void find_surface_planes(const LayerWindow& window, int32_t base, const BitPlane& asked,
                         const BodyWindow& body, const TileTriangles& triangles,
                         CellPlanes& cells) {
  const std::vector<CellRun> runs = runs_around(asked, body.reach);
  SurfaceSide all{};
  all.window = &window;
  all.cells = &cells;
  all.runs = runs.data() + body.reach;
  all.limit = static_cast<float>(body.hope);
  clear(all, body.reach);
  const auto lowest = static_cast<int32_t>(all.lowest) - body.hope;
  const auto highest = static_cast<int32_t>(all.highest) + 1;
  SurfaceSide side = all;
  for (int32_t i = 0; i < 9; ++i) {
    const int32_t x = (i % 3 - 1) * kTileSide, z = (i / 3 - 1) * kTileSide;
    side.x0 = std::max(all.x0, x);
    side.x1 = std::min(all.x1, x + kTileSide - 1);
    side.z0 = std::max(all.z0, z);
    side.z1 = std::min(all.z1, z + kTileSide - 1);
    if (side.x0 > side.x1 || side.z0 > side.z1) continue;
    side.triangles.clear();
    for (const uint32_t item : triangles.items[static_cast<size_t>(i)]) {
      const CellTriangle& t = triangles.all[item];
      // So far below, it stands above no plane; so far above, it is below no free span.
      if (t.high < base + lowest || t.low > base + highest) continue;
      const auto [x_low, x_high] = std::minmax({t.x[0], t.x[1], t.x[2]});
      const double cell_x = triangles.cell_x, cell_z = triangles.cell_z;
      if (x_high - cell_x < side.x0 - 1 || x_low - cell_x > side.x1 + 2) continue;
      if (t.z[2] - cell_z < side.z0 - 1 || t.z[0] - cell_z > side.z1 + 2) continue;
      side.triangles.emplace_back(t, cell_x, cell_z, base);
    }
    HWY_DYNAMIC_DISPATCH(FindPlanes)(side);
    HWY_DYNAMIC_DISPATCH(FindExcess)(side);
  }
}

}  // namespace throng::bake
#endif  // HWY_ONCE
