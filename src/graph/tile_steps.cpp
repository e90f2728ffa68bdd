// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "graph/tile_steps.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>

#include "world/place.h"

// Distinguishes steps from slopes by the rises of three cells in a row. Constant time.
namespace throng::graph {
namespace {

constexpr int32_t kRounding = 3;  // of differences of floors in whole millimetres [mm]

}  // namespace

StepLimits step_limits(std::span<const AvatarClass> classes, double cell) {
  StepLimits limits{.step = INT32_MAX};
  double steepest = 0;
  for (const AvatarClass& avatar : classes) {
    limits.step = std::min(limits.step, world::step_mm(avatar));
    steepest = std::max(steepest, avatar.max_slope);
  }
  limits.slope =
      static_cast<int32_t>(std::ceil(1000 * cell * std::tan(steepest * std::numbers::pi / 180)));
  return limits;
}

bool is_step(const world::LevelView& a, int32_t x, int32_t z, const world::LevelView& b, int32_t nx,
             int32_t nz, const StepLimits& limits) {
  const int32_t here = a.sample(x, z), next = b.sample(nx, nz);
  const int32_t rise = std::abs(next - here);
  if (rise <= limits.step + kRounding) return false;
  const int32_t dx = z == nz ? 1 : 0, dz = 1 - dx, sign = next > here ? 1 : -1;
  // By how much the floor rises on from a cell to the next of its level, away from the border.
  const auto goes_on = [&](const world::LevelView& level, int32_t from_x, int32_t from_z,
                           int32_t direction) {
    const int32_t to_x = from_x + direction * dx, to_z = from_z + direction * dz;
    const auto is_there = [&](int32_t i, int32_t k) {
      return i >= 0 && k >= 0 && i < 64 && k < 64 && level.has(i, k);
    };
    if (!is_there(from_x, from_z) || !is_there(to_x, to_z)) return limits.slope;
    return sign * direction * (level.sample(to_x, to_z) - level.sample(from_x, from_z));
  };
  const int32_t before = goes_on(a, x, z, -1), after = goes_on(b, nx, nz, 1);
  const int32_t before2 = goes_on(a, x - dx, z - dz, -1);
  const int32_t after2 = goes_on(b, nx + dx, nz + dz, 1);
  const int32_t slope =
      std::max({std::min(before2, before), std::min(before, after), std::min(after, after2), 0});
  return rise - slope > limits.step + kRounding;
}

std::optional<TileSteps> tile_steps(const world::LevelView& view, const StepLimits& limits) {
  if (view.floor == nullptr) return std::nullopt;  // one plane
  std::optional<TileSteps> steps;
  const auto look = [&](int32_t x, int32_t z, int32_t nx, int32_t nz) {
    if (!view.has(x, z) || !view.has(nx, nz) || !is_step(view, x, z, view, nx, nz, limits)) return;
    if (!steps) steps.emplace();
    (x != nx ? steps->across : steps->along)[static_cast<size_t>(z)] |= uint64_t{1} << x;
  };
  // Most floors have no rise anywhere: rows are tested as a whole first, cells without floor too.
  const auto any_rise = [&](const uint16_t* low, const uint16_t* high, int32_t count) {
    int32_t max_rise = 0;
    for (int32_t i = 0; i < count; ++i) max_rise = std::max(max_rise, std::abs(high[i] - low[i]));
    return max_rise > limits.step;
  };
  for (int32_t z = 0; z < 64; ++z) {
    const uint16_t* row = view.samples + z * 64;
    const bool across = any_rise(row, row + 1, 63);
    for (int32_t x = 0; across && x < 63; ++x) look(x, z, x + 1, z);
    if (z == 63) break;
    const bool along = any_rise(row, row + 64, 64);
    for (int32_t x = 0; along && x < 64; ++x) look(x, z, x, z + 1);
  }
  return steps;
}

}  // namespace throng::graph
