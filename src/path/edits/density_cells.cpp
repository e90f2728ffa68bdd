// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "path/edits/density_cells.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "world/ground.h"

// Source: [TC00] 5. Avatars decide their paths by the map, and weight 0 keeps them out. The paper
// gives no cost: here a metre costs half a metre more for each time that the weight is halved, to
// four times. Time: cells of a tile times the pixels of each.
namespace throng::path {
namespace {

double feet_of(const TileFloor& floor, int32_t x, int32_t z) {
  return floor.view.sample(x, z) * 1e-3;
}

}  // namespace

Result<void> check_density(const DensityGrid& map) {
  const auto bad = [](const char* what) {
    return Error{Errc::kBadInput, std::string("density map: ") + what};
  };
  constexpr int32_t kMaxSide = 16384;  // pixels
  if (map.width < 1 || map.height < 1 || map.width > kMaxSide || map.height > kMaxSide ||
      map.weights.size() != static_cast<size_t>(map.width) * static_cast<size_t>(map.height)) {
    return bad("it must have 1 to 16384 pixels a side, and a weight for each");
  }
  constexpr double kMinPixel = 1e-6;  // [m]
  const bool has_box = map.x1 - map.x0 >= kMinPixel * map.width &&
                       map.z1 - map.z0 >= kMinPixel * map.height && map.low <= map.high &&
                       std::isfinite(map.x1 - map.x0) && std::isfinite(map.z1 - map.z0) &&
                       std::isfinite(map.high - map.low);
  return has_box ? Result<void>() : bad("its box must be finite and not empty");
}

DensityCells::DensityCells(DensityGrid map) : map_(std::move(map)) {
  uint8_t largest = 0;
  for (const uint8_t weight : map_.weights) largest = std::max(largest, weight);
  for (int32_t weight = 1; weight < 256; ++weight) {
    uint8_t step = 0;
    while (step + 1 < kSteps && (weight << (step + 1)) <= largest) ++step;
    step_of_[static_cast<size_t>(weight)] = step;
  }
  is_even_ = std::all_of(map_.weights.begin(), map_.weights.end(),
                         [&](uint8_t weight) { return weight == 0 || step_of_[weight] == 0; });
}

std::pair<int32_t, int32_t> DensityCells::columns(double low, double high) const {
  const double size = (map_.x1 - map_.x0) / map_.width;
  const auto index = [&](double at) {
    return static_cast<int32_t>(
        std::clamp(std::floor((at - map_.x0) / size), -1.0, static_cast<double>(map_.width)));
  };
  return {std::max(index(low), 0), std::min(index(high), map_.width - 1)};
}

std::pair<int32_t, int32_t> DensityCells::rows(double low, double high) const {
  const double size = (map_.z1 - map_.z0) / map_.height;
  const auto index = [&](double at) {
    return static_cast<int32_t>(
        std::clamp(std::floor((at - map_.z0) / size), -1.0, static_cast<double>(map_.height)));
  };
  return {std::max(index(low), 0), std::min(index(high), map_.height - 1)};
}

bool DensityCells::applies(const TileFloor& floor, int32_t x, int32_t z) const {
  const double feet = feet_of(floor, x, z);
  return feet >= map_.low && feet <= map_.high;
}

SquareRange DensityCells::tiles_of(const world::WorldData& world, double x0, double z0, double x1,
                                   double z1) const {
  const std::array<std::array<double, 2>, 3> corners = {{{x0, z0}, {x1, z0}, {x1, z1}}};
  // Two cells wider, so that tiles across a corner are among them.
  return tiles_near(world, corners, 2 * world.summary.cell);
}

SquareRange DensityCells::tiles(const world::WorldData& world) const {
  return tiles_of(world, map_.x0, map_.z0, map_.x1, map_.z1);
}

SquareRange DensityCells::changed_tiles(const world::WorldData& world,
                                        const DensityCells& other) const {
  const DensityGrid &a = map_, &b = other.map_;
  const bool is_alike = a.x0 == b.x0 && a.z0 == b.z0 && a.x1 == b.x1 && a.z1 == b.z1 &&
                        a.low == b.low && a.high == b.high && a.width == b.width &&
                        a.height == b.height;
  if (!is_alike) {
    return tiles_of(world, std::min(a.x0, b.x0), std::min(a.z0, b.z0), std::max(a.x1, b.x1),
                    std::max(a.z1, b.z1));
  }
  int32_t first_x = a.width, last_x = -1, first_z = a.height, last_z = -1;
  for (size_t i = 0; i < a.weights.size(); ++i) {
    const uint8_t here = a.weights[i], there = b.weights[i];
    if ((here == 0) == (there == 0) && step_of_[here] == other.step_of_[there]) continue;
    const auto x = static_cast<int32_t>(i % static_cast<size_t>(a.width)),
               z = static_cast<int32_t>(i / static_cast<size_t>(a.width));
    first_x = std::min(first_x, x);
    last_x = std::max(last_x, x);
    first_z = std::min(first_z, z);
    last_z = std::max(last_z, z);
  }
  if (last_x < 0) return {};
  const double dx = (a.x1 - a.x0) / a.width, dz = (a.z1 - a.z0) / a.height;
  return tiles_of(world, a.x0 + first_x * dx, a.z0 + first_z * dz, a.x0 + (last_x + 1) * dx,
                  a.z0 + (last_z + 1) * dz);
}

world::CellRows DensityCells::zero_cells(const TileFloor& floor) const {
  world::CellRows cells{};
  const double cell = floor.summary.cell;
  // Middles of bodies lie half a unit inside their cell, so a pixel that only touches it from
  // outside does not count.
  const double inset = 0.25 * cell / world::kUnitsPerCell;
  for (int32_t z = 0; z < kTileCells; ++z) {
    const double z0 = floor.summary.origin.z + (floor.tile_z * kTileCells + z) * cell;
    const auto [first_row, last_row] = rows(z0 + inset, z0 + cell - inset);
    for (int32_t x = 0; x < kTileCells && first_row <= last_row; ++x) {
      const double x0 = floor.summary.origin.x + (floor.tile_x * kTileCells + x) * cell;
      const auto [first, last] = columns(x0 + inset, x0 + cell - inset);
      bool is_zero = false;
      for (int32_t row = first_row; row <= last_row && first <= last && !is_zero; ++row) {
        const auto at = map_.weights.begin() + static_cast<ptrdiff_t>(row) * map_.width;
        is_zero = std::find(at + first, at + last + 1, 0) != at + last + 1;
      }
      if (is_zero && applies(floor, x, z)) {
        cells[static_cast<size_t>(z)] |= uint64_t{1} << x;
      }
    }
  }
  return cells;
}

std::array<uint8_t, 4096> DensityCells::steps(const TileFloor& floor) const {
  std::array<uint8_t, 4096> steps{};
  const double cell = floor.summary.cell;
  for (int32_t z = 0; z < kTileCells; ++z) {
    const double at_z = floor.summary.origin.z + (floor.tile_z * kTileCells + z + 0.5) * cell;
    const auto [row, last_row] = rows(at_z, at_z);
    for (int32_t x = 0; x < kTileCells && row <= last_row; ++x) {
      const double at_x = floor.summary.origin.x + (floor.tile_x * kTileCells + x + 0.5) * cell;
      const auto [column, last] = columns(at_x, at_x);
      if (column > last || !applies(floor, x, z)) continue;
      const size_t pixel =
          static_cast<size_t>(row) * static_cast<size_t>(map_.width) + static_cast<size_t>(column);
      steps[static_cast<size_t>(z * kTileCells + x)] = step_of_[map_.weights[pixel]];
    }
  }
  return steps;
}

}  // namespace throng::path
