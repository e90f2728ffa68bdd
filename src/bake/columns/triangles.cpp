// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "bake/columns/triangles.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/parallel.h"

// Puts a scene's triangles on the grid and gives each its surface code: slope bin and area kind,
// ordered by how much they restrict.
namespace throng::bake {
namespace {

constexpr double kPi = 3.14159265358979323846;

// Cosine of the steepest slope that each class stands on, with a hair of tolerance: a ramp modelled
// at exactly the limit is allowed.
std::vector<double> slope_limits(std::span<const AvatarClass> classes) {
  std::vector<double> cosines;
  for (const AvatarClass& avatar : classes) {
    cosines.push_back(std::cos(avatar.max_slope * kPi / 180) - 1e-5);
  }
  return cosines;
}

}  // namespace

double snap_mm(double metres) {
  const double mm = metres * 1000;
  const double whole = static_cast<double>(std::lrint(mm));
  return std::fabs(mm - whole) < 1e-3 ? whole : mm;
}

SurfaceCoder::SurfaceCoder(const Scene& scene, std::span<const AvatarClass> classes, bool one_sided,
                           int32_t workers) {
  const std::vector<double> cosines = slope_limits(classes);
  std::vector<double> bins = cosines;
  std::sort(bins.begin(), bins.end());
  bins.erase(std::unique(bins.begin(), bins.end()), bins.end());

  // A key orders surfaces by how much they restrict: steeper, then area; blocked comes last. What
  // faces down is no floor, but does not replace one at its height that is as steep (the same
  // floor, modelled from both sides): it comes right before these, as kAreaBlocked of their bin.
  static_assert(kAreaBlocked == 0);
  constexpr size_t kKinds = size_t{kAreaLast} + 1;
  const size_t bin_count = bins.size();
  const size_t blocked_key = bin_count * kKinds;
  std::vector<uint16_t> key(scene.triangles.size());
  std::vector<uint8_t> used(blocked_key + 1, 0);
  const auto make_key = [&](size_t t) {
    const auto& corner = scene.triangles[t];
    const Vec3d a = scene.positions[corner[0]];
    const Vec3d normal = cross(scene.positions[corner[1]] - a, scene.positions[corner[2]] - a);
    const double size = length(normal);
    const double cosine = size > 0 ? std::fabs(normal.y) / size : 0;
    const size_t exceeded = static_cast<size_t>(
        std::count_if(bins.begin(), bins.end(), [&](double limit) { return cosine < limit; }));
    const AreaKind area = scene.area.empty() ? kAreaWalkable : scene.area[t];
    const bool blocked = area == kAreaBlocked || exceeded == bin_count;
    const AreaKind kind = one_sided && normal.y < 0 ? kAreaBlocked : std::min(area, kAreaLast);
    key[t] = static_cast<uint16_t>(blocked ? blocked_key : exceeded * kKinds + kind);
  };
  constexpr size_t kGrain = 4096;  // triangles
  parallel_ranges(key.size(), kGrain, workers, [&](size_t begin, size_t end) {
    for (size_t t = begin; t < end; ++t) make_key(t);
  });
  for (const uint16_t k : key) used[k] = 1;

  std::vector<uint8_t> code_of_key(used.size(), 255);
  used[blocked_key] = 1;
  for (size_t k = 0; k < used.size(); ++k) {
    // More than 255 kinds of surface: the rest count as blocked, which loses area but is safe.
    if (used[k] == 0 || (codes_.codes.size() == 255 && k != blocked_key)) continue;
    const size_t bin = k / kKinds;
    const auto kind = static_cast<AreaKind>(k % kKinds);
    code_of_key[k] = static_cast<uint8_t>(codes_.codes.size());
    codes_.codes.push_back({static_cast<uint8_t>(bin), kind});
    uint32_t allowed = 0;
    for (size_t c = 0; c < cosines.size() && kind != kAreaBlocked; ++c) {
      // Limits ascend with the cosine: a surface that exceeds n limits exceeds the n largest.
      const auto rank = static_cast<size_t>(std::lower_bound(bins.begin(), bins.end(), cosines[c]) -
                                            bins.begin());
      if (bin_count - rank > bin) allowed |= 1u << c;
    }
    codes_.allowed.push_back(allowed);
  }
  triangle_code_.resize(key.size());
  for (size_t t = 0; t < key.size(); ++t) triangle_code_[t] = code_of_key[key[t]];
}

CellTriangle to_cell_triangle(const Scene& scene, uint32_t triangle, const Grid& grid,
                              uint8_t code) {
  CellTriangle out;
  out.code = code;
  std::array<Vec3d, 3> p;
  for (size_t i = 0; i < 3; ++i) {
    const Vec3d v = scene.positions[scene.triangles[triangle][i]];
    p[i] = {grid.to_cell_x(v.x), snap_mm(v.y), grid.to_cell_z(v.z)};
  }
  const auto less = [](const Vec3d& a, const Vec3d& b) {
    return a.z != b.z ? a.z < b.z : (a.x != b.x ? a.x < b.x : a.y < b.y);
  };
  if (less(p[1], p[0])) std::swap(p[0], p[1]);
  if (less(p[2], p[1])) std::swap(p[1], p[2]);
  if (less(p[1], p[0])) std::swap(p[0], p[1]);
  for (size_t i = 0; i < 3; ++i) {
    out.x[i] = p[i].x;
    out.y[i] = p[i].y;
    out.z[i] = p[i].z;
  }
  const double low = std::min({p[0].y, p[1].y, p[2].y}), high = std::max({p[0].y, p[1].y, p[2].y});
  out.low = static_cast<int32_t>(low);
  out.low -= out.low > low ? 1 : 0;
  out.high = static_cast<int32_t>(high);
  out.high += out.high < high ? 1 : 0;
  return out;
}

Grid make_grid(const Box3d& bounds, double cell, double phase) {
  const auto border_below = [&](double at) {
    return (std::floor(at / cell - phase + 1e-6) + phase) * cell;
  };
  Grid grid;
  grid.cell = cell;
  grid.origin_x = border_below(bounds.min.x);
  grid.origin_z = border_below(bounds.min.z);
  fit_grid(grid, bounds);
  return grid;
}

void fit_grid(Grid& grid, const Box3d& bounds) {
  grid.width = std::max(1, static_cast<int32_t>(std::ceil(grid.to_cell_x(bounds.max.x) - 1e-6)));
  grid.depth = std::max(1, static_cast<int32_t>(std::ceil(grid.to_cell_z(bounds.max.z) - 1e-6)));
}

TriangleBins bin_triangles(std::span<const CellTriangle> triangles, int32_t cell_x, int32_t cell_z,
                           int32_t squares_x, int32_t squares_z, int32_t side, int32_t apron) {
  const auto box = [&](size_t i) -> CellBox {
    const CellTriangle& t = triangles[i];
    return {std::min({t.x[0], t.x[1], t.x[2]}), std::max({t.x[0], t.x[1], t.x[2]}), t.z[0], t.z[2]};
  };
  return bin_boxes(triangles.size(), box, cell_x, cell_z, squares_x, squares_z, side, apron);
}

CellBox scene_box(const Scene& scene, uint32_t triangle, const Grid& grid) {
  CellBox box{1e300, -1e300, 1e300, -1e300};
  for (const uint32_t corner : scene.triangles[triangle]) {
    const double x = grid.to_cell_x(scene.positions[corner].x);
    const double z = grid.to_cell_z(scene.positions[corner].z);
    box.x0 = std::min(box.x0, x);
    box.x1 = std::max(box.x1, x);
    box.z0 = std::min(box.z0, z);
    box.z1 = std::max(box.z1, z);
  }
  return box;
}

}  // namespace throng::bake
