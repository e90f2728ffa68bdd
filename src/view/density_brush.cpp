// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "view/density_brush.h"

#include <algorithm>
#include <cmath>
#include <utility>

// Density maps are painted pixel by pixel; points are drawn by binary search in the running sums of
// the weights, in O(log pixels).
namespace throng::view {
namespace {

constexpr double kPixel = 0.5;     // [m] Of maps made here; larger if a side would exceed kMaxSide.
constexpr double kMaxSide = 1024;  // [pixels]
constexpr double kHalfStorey = 1.25;  // [m] Half of the height that a map covers.

size_t index_of(const DensityMap& map, int32_t row, int32_t column) {
  return static_cast<size_t>(row) * static_cast<size_t>(map.width) + static_cast<size_t>(column);
}

}  // namespace

bool paint(DensityMap& map, Vec3d where, double radius, uint8_t weight) {
  if (where.y < map.low || where.y > map.high) return false;
  const double wide = (map.x1 - map.x0) / map.width, deep = (map.z1 - map.z0) / map.height;
  const auto first = [](double v) { return static_cast<int32_t>(std::max(0.0, std::floor(v))); };
  const auto last = [](double v, int32_t size) {
    return static_cast<int32_t>(std::clamp(std::ceil(v), 0.0, static_cast<double>(size)));
  };
  // A brush smaller than a pixel paints the one under it.
  const double brush = std::max(radius, 0.71 * std::max(wide, deep));
  bool changed = false;
  for (int32_t row = first((where.z - brush - map.z0) / deep);
       row < last((where.z + brush - map.z0) / deep, map.height); ++row) {
    for (int32_t column = first((where.x - brush - map.x0) / wide);
         column < last((where.x + brush - map.x0) / wide, map.width); ++column) {
      const double x = map.x0 + (column + 0.5) * wide, z = map.z0 + (row + 0.5) * deep;
      if (std::hypot(x - where.x, z - where.z) > brush) continue;
      uint8_t& pixel = map.weights[index_of(map, row, column)];
      changed = changed || pixel != weight;
      pixel = weight;
    }
  }
  return changed;
}

DensityMap& map_at(std::vector<DensityMap>& maps, const Box3d& bounds, double height) {
  for (DensityMap& map : maps) {
    if (height >= map.low && height <= map.high) return map;
  }
  DensityMap map;
  map.name = "painted";
  map.x0 = bounds.min.x, map.z0 = bounds.min.z;
  const double wide = std::max(1.0, bounds.max.x - bounds.min.x);
  const double deep = std::max(1.0, bounds.max.z - bounds.min.z);
  map.x1 = map.x0 + wide, map.z1 = map.z0 + deep;
  const double pixel = std::max(kPixel, std::max(wide, deep) / kMaxSide);
  map.width = static_cast<int32_t>(std::ceil(wide / pixel));
  map.height = static_cast<int32_t>(std::ceil(deep / pixel));
  map.low = height - kHalfStorey, map.high = height + kHalfStorey;
  map.weights.assign(static_cast<size_t>(map.width) * static_cast<size_t>(map.height), 0);
  // Maps of nearby storeys do not overlap.
  for (const DensityMap& other : maps) {
    if (other.high < height) map.low = std::max(map.low, other.high + 1e-6);
    if (other.low > height) map.high = std::min(map.high, other.low - 1e-6);
  }
  return maps.emplace_back(std::move(map));
}

WeightedPlaces::WeightedPlaces(std::vector<DensityMap> maps) : maps_(std::move(maps)) {
  uint64_t sum = 0;
  for (const DensityMap& map : maps_) {
    for (const uint8_t weight : map.weights) up_to_.push_back(sum += weight);
  }
}

WeightedPlaces::Point WeightedPlaces::draw(double which, double along_x, double along_z) const {
  const auto n = static_cast<uint64_t>(which * static_cast<double>(up_to_.back()));
  auto pixel =
      static_cast<size_t>(std::upper_bound(up_to_.begin(), up_to_.end(), n) - up_to_.begin());
  size_t m = 0;
  while (pixel >= maps_[m].weights.size()) pixel -= maps_[m++].weights.size();
  const DensityMap& map = maps_[m];
  const auto width = static_cast<size_t>(map.width);
  const auto column = static_cast<double>(pixel % width), row = static_cast<double>(pixel / width);
  return {
      .at = {map.x0 + (column + along_x) * (map.x1 - map.x0) / map.width,
             0.5 * (map.low + map.high), map.z0 + (row + along_z) * (map.z1 - map.z0) / map.height},
      .vertical_tolerance = 0.5 * (map.high - map.low)};
}

uint8_t WeightedPlaces::weight_at(Vec3d point) const {
  uint8_t max_weight = 0;
  for (const DensityMap& map : maps_) {
    if (point.y < map.low || point.y > map.high || point.x < map.x0 || point.x >= map.x1 ||
        point.z < map.z0 || point.z >= map.z1) {
      continue;
    }
    const auto column = static_cast<int32_t>((point.x - map.x0) / (map.x1 - map.x0) * map.width);
    const auto row = static_cast<int32_t>((point.z - map.z0) / (map.z1 - map.z0) * map.height);
    max_weight = std::max(
        max_weight,
        map.weights[index_of(map, std::min(row, map.height - 1), std::min(column, map.width - 1))]);
  }
  return max_weight;
}

}  // namespace throng::view
