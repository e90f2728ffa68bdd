// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "render/tile_slopes.h"

#include <cmath>
#include <numbers>

#include "world/surface.h"

namespace throng::render {
namespace {

// The slope of a cell along a row: the smaller of the two differences around it, or, if one of them
// is missing, of the two next to it.
template <class Sample, class Has>
int32_t slope_along(int32_t i, Sample sample, Has has) {
  const auto is_there = [&](int32_t k) { return k >= 0 && k < kTileCells && has(k); };
  for (const int32_t middle : {i, i + 1, i - 1}) {
    if (!is_there(middle - 1) || !is_there(middle) || !is_there(middle + 1)) continue;
    return world::minmod(sample(middle) - sample(middle - 1), sample(middle + 1) - sample(middle));
  }
  return 0;
}

}  // namespace

double TileSlopes::at(uint32_t level, int32_t x, int32_t z) {
  if (level != level_) {
    level_ = level;
    ground_ = world::ground_level(*world_, level, 0);
    if (ground_.zone != nullptr && ground_.view.floor != nullptr) {
      world::unpack_floor(ground_.view, samples_.data());
      ground_.view.samples = samples_.data();
    }
  }
  const world::LevelView& view = ground_.view;
  if (ground_.zone == nullptr || !view.has(x, z)) return 0;
  const int32_t gx = slope_along(
      x, [&](int32_t i) { return view.sample(i, z); }, [&](int32_t i) { return view.has(i, z); });
  const int32_t gz = slope_along(
      z, [&](int32_t i) { return view.sample(x, i); }, [&](int32_t i) { return view.has(x, i); });
  const double rise = std::hypot(static_cast<double>(gx), static_cast<double>(gz)) * 1e-3;
  return std::atan(rise / world_->summary.cell) * 180 / std::numbers::pi;
}

}  // namespace throng::render
