// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "naive_columns.h"

#include <algorithm>
#include <cmath>
#include <utility>

// Sutherland-Hodgman clipping of every triangle by every cell under it.
namespace throng::naive {
namespace {

using Span = std::pair<int32_t, int32_t>;

// Keeps the part of a convex polygon where side * (coordinate - limit) >= 0.
// Corners on the limit stay, so that touching counts. New corners lie exactly
// on the limit.
std::vector<Vec3d> clip(const std::vector<Vec3d>& polygon, double Vec3d::*axis, double limit,
                        double side) {
  std::vector<Vec3d> kept;
  for (size_t i = 0; i < polygon.size(); ++i) {
    const Vec3d a = polygon[i];
    const Vec3d b = polygon[(i + 1) % polygon.size()];
    const double da = side * (a.*axis - limit);
    const double db = side * (b.*axis - limit);
    if (da >= 0) kept.push_back(a);
    if ((da > 0 && db < 0) || (da < 0 && db > 0)) {
      Vec3d cut = a + (b - a) * (da / (da - db));
      cut.*axis = limit;
      kept.push_back(cut);
    }
  }
  return kept;
}

// Sorts and joins spans that overlap or touch.
void merge(std::vector<Span>& spans) {
  std::sort(spans.begin(), spans.end());
  std::vector<Span> merged;
  for (const Span& span : spans) {
    if (!merged.empty() && span.first <= merged.back().second) {
      merged.back().second = std::max(merged.back().second, span.second);
    } else {
      merged.push_back(span);
    }
  }
  spans = std::move(merged);
}

}  // namespace

std::span<const int32_t> Columns::lows(size_t cell) const {
  return std::span(low).subspan(first[cell], first[cell + 1] - first[cell]);
}

std::span<const int32_t> Columns::highs(size_t cell) const {
  return std::span(high).subspan(first[cell], first[cell + 1] - first[cell]);
}

int32_t floor_mm(double metres) {
  const double mm = metres * 1000;
  const double whole = std::round(mm);
  return static_cast<int32_t>(std::abs(mm - whole) <= 1e-3 ? whole : std::floor(mm));
}

int32_t ceil_mm(double metres) { return -floor_mm(-metres); }

Columns from_lists(int32_t width, int32_t depth, const std::vector<std::vector<Span>>& cells) {
  Columns columns{.width = width, .depth = depth, .first = {0}, .low = {}, .high = {}};
  for (std::vector<Span> spans : cells) {
    merge(spans);
    for (const auto& [low, high] : spans) {
      columns.low.push_back(low);
      columns.high.push_back(high);
    }
    columns.first.push_back(static_cast<uint32_t>(columns.low.size()));
  }
  return columns;
}

Columns make_columns(const Scene& scene, const Grid& grid) {
  std::vector<std::vector<Span>> cells(static_cast<size_t>(grid.width) *
                                       static_cast<size_t>(grid.depth));
  for (const auto& corners : scene.triangles) {
    std::vector<Vec3d> triangle;
    Box3d box;
    for (const uint32_t corner : corners) {
      const Vec3d local = scene.positions[corner] - grid.origin;
      triangle.push_back(local);
      box.add(local);
    }
    // One cell more on each side: the clip decides, not the rounding here.
    const auto begin = [&](double low) {
      return static_cast<int32_t>(std::max(0.0, std::floor(low / grid.cell - grid.widen) - 1));
    };
    const auto end = [&](double high, int32_t count) {
      const double last = std::floor(high / grid.cell + grid.widen) + 2;
      return static_cast<int32_t>(std::clamp(last, 0.0, static_cast<double>(count)));
    };
    for (int32_t z = begin(box.min.z); z < end(box.max.z, grid.depth); ++z) {
      const auto row = clip(clip(triangle, &Vec3d::z, (z - grid.widen) * grid.cell, 1), &Vec3d::z,
                            (z + 1 + grid.widen) * grid.cell, -1);
      if (row.empty()) continue;
      for (int32_t x = begin(box.min.x); x < end(box.max.x, grid.width); ++x) {
        const auto part = clip(clip(row, &Vec3d::x, (x - grid.widen) * grid.cell, 1), &Vec3d::x,
                               (x + 1 + grid.widen) * grid.cell, -1);
        if (part.empty()) continue;
        Box3d piece;
        for (const Vec3d& point : part) piece.add(point);
        cells[static_cast<size_t>(z) * static_cast<size_t>(grid.width) + static_cast<size_t>(x)]
            .emplace_back(floor_mm(piece.min.y), ceil_mm(piece.max.y));
      }
    }
  }
  return from_lists(grid.width, grid.depth, cells);
}

bool covers(const Columns& outer, const Columns& inner) {
  if (outer.width != inner.width || outer.depth != inner.depth) return false;
  for (size_t cell = 0; cell + 1 < inner.first.size(); ++cell) {
    for (uint32_t i = inner.first[cell]; i < inner.first[cell + 1]; ++i) {
      bool held = false;
      for (uint32_t o = outer.first[cell]; o < outer.first[cell + 1]; ++o) {
        held = held || (outer.low[o] <= inner.low[i] && inner.high[i] <= outer.high[o]);
      }
      if (!held) return false;
    }
  }
  return true;
}

}  // namespace throng::naive
