// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

#include "bake/columns/grid.h"
#include "core/parallel.h"
#include "throng/avatar.h"
#include "throng/base.h"
#include "throng/scene.h"

/// Triangles as the rasteriser needs them: in cells and millimetres, corners sorted by z.
namespace throng::bake {

struct CellTriangle {
  std::array<double, 3> x;  // cells from the grid's origin
  std::array<double, 3> z;  // cells, ascending
  std::array<double, 3> y;  // mm, snapped to a whole mm if within 1 um of it
  int32_t low = 0;          // mm, rounded outward
  int32_t high = 0;
  uint8_t code = 0;  // index into SurfaceCodes
};

/// What a surface is to the classes: how steep and of which area kind, as one byte. Larger codes
/// are more restrictive, so that of two surfaces at one height the worse one counts.
struct SurfaceCode {
  uint8_t slope_bin = 0;          // number of distinct slope limits that it exceeds
  AreaKind area = kAreaWalkable;  // kAreaBlocked also of what faces down, if that is no floor
};

struct SurfaceCodes {
  std::vector<SurfaceCode> codes;  // at most 256; the last is "no class stands here"
  std::vector<uint32_t> allowed;   // per code: bit c is set if class c may stand on it
};

/// Steepness limits of the classes, and the codes in use by a scene.
class SurfaceCoder {
 public:
  /// [one_sided: BakeConfig]
  SurfaceCoder(const Scene& scene, std::span<const AvatarClass> classes, bool one_sided,
               int32_t workers);
  [[nodiscard]] uint8_t code(uint32_t triangle) const { return triangle_code_[triangle]; }
  [[nodiscard]] const SurfaceCodes& codes() const { return codes_; }

 private:
  SurfaceCodes codes_;
  std::vector<uint8_t> triangle_code_;
};

/// Millimetres of a height in metres: whole if within 1 um of whole.
double snap_mm(double metres);

CellTriangle to_cell_triangle(const Scene& scene, uint32_t triangle, const Grid& grid,
                              uint8_t code);

/// The grid that covers a scene; cells begin at (n + phase) cells, n whole. [0 <= phase < 1]
Grid make_grid(const Box3d& bounds, double cell, double phase);

/// Gives a grid the width and depth that a scene takes from its origin on.
void fit_grid(Grid& grid, const Box3d& bounds);

/// Triangles by square of `side` cells, conservatively by their boxes: square s = z * squares_x + x
/// owns items[first[s]] to items[first[s + 1]], in order of triangles.
struct TriangleBins {
  int32_t squares_x = 0;
  int32_t squares_z = 0;
  std::vector<uint32_t> first;
  std::vector<uint32_t> items;

  [[nodiscard]] std::span<const uint32_t> square(size_t s) const {
    return std::span(items).subspan(first[s], first[s + 1] - first[s]);
  }
};

/// What a triangle covers of the grid. [cells]
struct CellBox {
  double x0, x1, z0, z1;
};

/// Squares cover cells [cell_x, cell_x + squares_x * side) and likewise in z; `apron` widens each
/// square on all sides. `box(i)` gives the box of triangle i of `count`.
template <class Box>
TriangleBins bin_boxes(size_t count, Box box, int32_t cell_x, int32_t cell_z, int32_t squares_x,
                       int32_t squares_z, int32_t side, int32_t apron, int32_t workers = 1) {
  TriangleBins bins;
  bins.squares_x = squares_x;
  bins.squares_z = squares_z;
  bins.first.assign(static_cast<size_t>(squares_x) * static_cast<size_t>(squares_z) + 1, 0);
  const double inverse = 1.0 / side;
  const double margin = apron + 1e-3;  // A box that close to a square touches it.
  const auto square_of = [&](double v, int32_t squares) {
    return static_cast<int32_t>(std::clamp(v * inverse, -1.0, squares + 1.0) + 2) - 2;  // floor
  };
  const auto for_each_square = [&](size_t i, auto&& visit) {
    const CellBox b = box(i);
    const int32_t x0 = std::max(0, square_of(b.x0 - cell_x - margin, squares_x));
    const int32_t x1 = std::min(squares_x - 1, square_of(b.x1 - cell_x + margin, squares_x));
    const int32_t z0 = std::max(0, square_of(b.z0 - cell_z - margin, squares_z));
    const int32_t z1 = std::min(squares_z - 1, square_of(b.z1 - cell_z + margin, squares_z));
    for (int32_t z = z0; z <= z1; ++z) {
      for (int32_t x = x0; x <= x1; ++x) {
        visit(static_cast<size_t>(z) * static_cast<size_t>(squares_x) + static_cast<size_t>(x));
      }
    }
  };
  // Boxes are tested once, since triangles and corners lie far apart; what they touch is kept.
  struct Touch {
    uint32_t square, item;
  };
  constexpr size_t kRun = size_t{1} << 18;
  std::vector<std::vector<Touch>> runs((count + kRun - 1) / kRun);
  parallel_for(runs.size(), workers, [&](size_t run) {
    const size_t begin = run * kRun, end = std::min(count, begin + kRun);
    std::vector<Touch>& touched = runs[run];
    touched.reserve(end - begin + (end - begin) / 4);
    for (size_t i = begin; i < end; ++i) {
      for_each_square(i, [&](size_t square) {
        touched.push_back({static_cast<uint32_t>(square), static_cast<uint32_t>(i)});
      });
    }
  });
  for (const std::vector<Touch>& touched : runs) {
    for (const Touch& touch : touched) ++bins.first[touch.square + 1];
  }
  std::inclusive_scan(bins.first.begin(), bins.first.end(), bins.first.begin());
  bins.items.resize(bins.first.back());
  std::vector<uint32_t> next(bins.first.begin(), bins.first.end() - 1);
  for (const std::vector<Touch>& touched : runs) {
    for (const Touch& touch : touched) bins.items[next[touch.square]++] = touch.item;
  }
  return bins;
}

/// The same for prepared triangles.
TriangleBins bin_triangles(std::span<const CellTriangle> triangles, int32_t cell_x, int32_t cell_z,
                           int32_t squares_x, int32_t squares_z, int32_t side, int32_t apron);

/// Box of a triangle of a scene on a grid.
CellBox scene_box(const Scene& scene, uint32_t triangle, const Grid& grid);

}  // namespace throng::bake
