// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "world/surface.h"
#include "world/zone_generated.h"

/// One level tile as the moves read it: pointers into a mapped zone, nothing copied.
namespace throng {

struct LevelView {
  const format::Level* record = nullptr;
  const uint16_t* floor = nullptr;    // 4096 samples, or null
  const uint64_t* present = nullptr;  // 64 rows, or null: every cell has a floor
  int32_t floor_base = 0;             // [mm]
  int32_t floor_part = 0;             // [1/1024 mm]
  int32_t slope_x = 0;                // [1/1024 mm per cell], below 2^24
  int32_t slope_z = 0;

  [[nodiscard]] bool has(int32_t x, int32_t z) const {
    return present == nullptr || ((present[z] >> x) & 1) != 0;
  }
  /// Floor under the centre of a cell that has one. [mm]
  [[nodiscard]] int32_t sample(int32_t x, int32_t z) const {
    if (floor != nullptr) return floor_base + floor[z * 64 + x];
    if ((slope_x | slope_z) == 0) return floor_base;
    return floor_base + ((floor_part + slope_x * x + slope_z * z + 512) >> 10);
  }
  [[nodiscard]] bool is_constant() const { return floor == nullptr && (slope_x | slope_z) == 0; }

  /// Height of the feet in cell (x, z), `u` and `v` in 1/2048 cell from its corner. [mm]
  [[nodiscard]] int32_t feet(int32_t x, int32_t z, int32_t u, int32_t v) const {
    const int32_t middle = sample(x, z);
    if (is_constant()) return middle;
    const int32_t gx = sheet_slope(
        x, [&](int32_t i) { return sample(i, z); }, [&](int32_t i) { return has(i, z); });
    const int32_t gz = sheet_slope(
        z, [&](int32_t i) { return sample(x, i); }, [&](int32_t i) { return has(x, i); });
    // Slopes are below 2^16 mm a cell and offsets below 2^10, so this fits; shifts round down.
    return middle + ((gx * (u - 1024) + gz * (v - 1024) + 1024) >> 11);
  }
};

}  // namespace throng
