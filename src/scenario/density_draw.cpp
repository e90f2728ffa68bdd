// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "scenario/density_draw.h"

#include <algorithm>
#include <cmath>
#include <string>

// Draws points by the weights of a density map: prefix sums of the pixels, and a binary search for
// each point.
namespace throng::scenario {

Result<void> check_hours(const DensityMap& map) {
  const auto bad = [&](const char* what) {
    return Error{Errc::kBadInput, "density '" + map.name + "': " + what};
  };
  double before = -1;
  for (const DensityHour& hour : map.hours) {
    if (hour.weights.size() != size_t(map.width) * size_t(map.height)) {
      return bad("an hour has not one weight a pixel");
    }
    if (std::all_of(hour.weights.begin(), hour.weights.end(), [](uint8_t w) { return w == 0; })) {
      return bad("all weights of an hour are 0; give at least one pixel a weight");
    }
    if (!(hour.at >= 0 && hour.at > before && std::isfinite(hour.at))) {
      return bad("give the hours in the order of their times");
    }
    before = hour.at;
  }
  if (map.hours.empty() || map.period == 0) return {};
  if (!(map.period > before && std::isfinite(map.period))) {
    return bad("the period must be longer than the last hour");
  }
  return {};
}

std::vector<uint8_t> weights_at(const DensityMap& map, double time) {
  const std::vector<DensityHour>& hours = map.hours;
  if (hours.empty()) return map.weights;
  if (map.period > 0) time -= map.period * std::floor(time / map.period);
  const auto after =
      std::upper_bound(hours.begin(), hours.end(), time,
                       [](double t, const DensityHour& hour) { return t < hour.at; });
  const DensityHour *a = &hours.front(), *b = a;
  double begin = 0, end = 0;
  if (after != hours.begin() && after != hours.end()) {
    a = &after[-1];
    b = &after[0];
    begin = a->at;
    end = b->at;
  } else if (map.period > 0) {
    // From the last to the first of the next period.
    a = &hours.back();
    begin = after == hours.begin() ? a->at - map.period : a->at;
    end = begin + map.period - a->at + b->at;
  } else if (after == hours.end()) {
    return hours.back().weights;
  }
  if (!(end > begin)) return a->weights;
  const double part = (time - begin) / (end - begin);
  std::vector<uint8_t> weights(a->weights.size());
  std::transform(a->weights.begin(), a->weights.end(), b->weights.begin(), weights.begin(),
                 [&](uint8_t from, uint8_t to) {
                   return static_cast<uint8_t>(std::floor(from + (to - from) * part + 0.5));
                 });
  return weights;
}

DensityDraw::DensityDraw(const DensityMap& map, std::span<const uint8_t> weights) : map_(&map) {
  before_.reserve(weights.size() + 1);
  uint64_t sum = 0;
  for (const uint8_t weight : weights) {
    before_.push_back(sum);
    sum += weight;
  }
  before_.push_back(sum);
}

std::array<double, 2> DensityDraw::point(double which, double along_x, double along_z) const {
  const auto n = static_cast<uint64_t>(which * static_cast<double>(before_.back()));
  const auto pixel = static_cast<size_t>(std::upper_bound(before_.begin(), before_.end() - 1, n) -
                                         before_.begin() - 1);
  const auto width = static_cast<size_t>(map_->width);
  const auto column = static_cast<double>(pixel % width), row = static_cast<double>(pixel / width);
  return {map_->x0 + (column + along_x) * (map_->x1 - map_->x0) / map_->width,
          map_->z0 + (row + along_z) * (map_->z1 - map_->z0) / map_->height};
}

}  // namespace throng::scenario
