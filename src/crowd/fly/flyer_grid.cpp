// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "crowd/fly/flyer_grid.h"

#include <algorithm>
#include <numeric>

#include "core/math/floor_div.h"

// Fills the grid of cubes with a counting sort. Linear in the bodies and cubes.
namespace throng::crowd {

void FlyerGrid::fit(int32_t width, int32_t height) {
  width_ = std::max(width, 1);
  height_ = std::max(height, 1);
}

FlyerGrid::Cube FlyerGrid::cube(int32_t x, int32_t z, int32_t y) const {
  return {floor_div(x, width_), floor_div(z, width_), floor_div(y, height_)};
}

void FlyerGrid::build(std::span<const Body> bodies, std::span<const uint32_t> flyers,
                      bool (*is_flyer)(const Body& body)) {
  bits_xz_ = 3;
  while ((size_t{1} << (2 * bits_xz_ + bits_y_)) < flyers.size() && bits_xz_ < 10) ++bits_xz_;
  const size_t cubes = size_t{1} << (2 * bits_xz_ + bits_y_);
  const auto number_of = [&](const Body& b) { return number(cube(b.x, b.z, b.y)); };
  first_.assign(cubes + 1, 0);
  for (const uint32_t i : flyers) ++first_[number_of(bodies[i]) + 1];
  walkers_.clear();
  if (flyers.size() < bodies.size()) {
    wanted_.assign(cubes, 0);
    for (const uint32_t i : flyers) {
      const Body& b = bodies[i];
      const Cube c = cube(b.x, b.z, b.y);
      for_columns(2, [&](int32_t dx, int32_t dz) {
        for (int32_t dy = -2; dy <= 2; ++dy) wanted_[number({c.x + dx, c.z + dz, c.y + dy})] = 1;
      });
    }
    for (size_t i = 0; i < bodies.size(); ++i) {
      if (is_flyer(bodies[i])) continue;
      const uint32_t n = number_of(bodies[i]);
      if (wanted_[n] == 0) continue;
      walkers_.push_back(static_cast<uint32_t>(i));
      ++first_[n + 1];
    }
  }
  std::inclusive_scan(first_.begin(), first_.end(), first_.begin());
  entries_.resize(flyers.size() + walkers_.size());
  // Filled from behind, first_ ends up where each cube begins.
  const auto fill = [&](std::span<const uint32_t> of) {
    for (size_t n = of.size(); n-- > 0;) {
      const Body& b = bodies[of[n]];
      entries_[--first_[number_of(b) + 1]] = {b.x, b.z, b.y, of[n], b.radius, b.height};
    }
  };
  fill(walkers_);
  fill(flyers);
  std::copy(first_.begin() + 1, first_.end(), first_.begin());
  first_.back() = static_cast<uint32_t>(entries_.size());
}

uint64_t FlyerGrid::bytes() const {
  return (first_.capacity() + walkers_.capacity()) * 4 + wanted_.capacity() +
         entries_.capacity() * sizeof(Entry);
}

}  // namespace throng::crowd
