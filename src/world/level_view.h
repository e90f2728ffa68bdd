// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "core/arrays/prefetch.h"
#include "world/cell_blocks.h"
#include "world/surface.h"
#include "world/zone_generated.h"

/// One level tile as the moves read it: pointers into a mapped zone, nothing copied.
namespace throng::world {

struct LevelView {
  const format::Level* record = nullptr;
  const uint64_t* floor = nullptr;    // values in blocks, or null
  const uint64_t* present = nullptr;  // a set in blocks, or null: every cell has a floor
  const uint16_t* samples = nullptr;  // a copy of `floor` row by row, kNoValue for none, or null
  int32_t floor_base = 0;             // [mm]
  int32_t floor_part = 0;             // [1/1024 mm]
  int32_t slope_x = 0;                // [1/1024 mm per cell], below 2^24
  int32_t slope_z = 0;

  [[nodiscard]] bool has(int32_t x, int32_t z) const {
    if (samples != nullptr) return samples[z * 64 + x] != kNoValue;
    return present == nullptr || bit_at(present, x, z);
  }
  /// Floor under the centre of a cell that has one. [mm]
  [[nodiscard]] int32_t sample(int32_t x, int32_t z) const {
    if (samples != nullptr) return floor_base + samples[z * 64 + x];
    if (floor != nullptr) return floor_base + value_at(floor, x, z);
    return (slope_x | slope_z) == 0 ? floor_base : on_plane(x, z);
  }
  [[nodiscard]] bool is_constant() const { return floor == nullptr && (slope_x | slope_z) == 0; }

  /// For many heights at scattered cells, each of which would wait for memory twice: prefetch the
  /// heads of the cells' blocks, then what these point to, and no read waits.
  void ask_for_heads(int32_t x, int32_t z) const {
    if (floor != nullptr) prefetch(floor + block_of(x, z));
    if (present != nullptr) prefetch(present);
  }
  void ask_for_cells(int32_t x, int32_t z) const {
    if (floor != nullptr) prefetch(row_of_value(floor, x, z));
    if (present != nullptr) prefetch(block_word(present, block_of(x, z)));
  }

  /// Height of the feet in cell (x, z), `u` and `v` in 1/2048 cell from its corner. [mm]
  [[nodiscard]] int32_t feet(int32_t x, int32_t z, int32_t u, int32_t v) const {
    if (is_constant()) return floor_base;
    if (samples != nullptr) {
      return feet_by(
          x, z, u, v, [&](int32_t i, int32_t k) { return floor_base + samples[k * 64 + i]; },
          [&](int32_t i, int32_t k) { return samples[k * 64 + i] != kNoValue; });
    }
    if (floor == nullptr) {
      return feet_by(
          x, z, u, v, [&](int32_t i, int32_t k) { return on_plane(i, k); },
          [&](int32_t i, int32_t k) { return present == nullptr || bit_at(present, i, k); });
    }
    if (is_inside_block(x, z) && has_cross(x, z)) {
      const ValueCross cross = cross_at(floor, x, z);
      return slanted(floor_base + cross.middle,
                     minmod(cross.middle - cross.left, cross.right - cross.middle),
                     minmod(cross.middle - cross.up, cross.down - cross.middle), u, v);
    }
    return feet_by(
        x, z, u, v, [&](int32_t i, int32_t k) { return sample(i, k); },
        [&](int32_t i, int32_t k) { return has(i, k); });
  }

 private:
  [[nodiscard]] int32_t on_plane(int32_t x, int32_t z) const {
    return floor_base + ((floor_part + slope_x * x + slope_z * z + 512) >> 10);
  }
  template <class Sample, class Has>
  static int32_t feet_by(int32_t x, int32_t z, int32_t u, int32_t v, Sample sample, Has has) {
    const int32_t middle = sample(x, z);
    const int32_t gx = sheet_slope(
        x, [&](int32_t i) { return i == x ? middle : sample(i, z); },
        [&](int32_t i) { return has(i, z); });
    const int32_t gz = sheet_slope(
        z, [&](int32_t i) { return i == z ? middle : sample(x, i); },
        [&](int32_t i) { return has(x, i); });
    return slanted(middle, gx, gz, u, v);
  }
  // Slopes are below 2^16 mm a cell and offsets below 2^10, so this fits; shifts round down.
  static int32_t slanted(int32_t middle, int32_t gx, int32_t gz, int32_t u, int32_t v) {
    return middle + ((gx * (u - 1024) + gz * (v - 1024) + 1024) >> 11);
  }
  [[nodiscard]] bool has_cross(int32_t x, int32_t z) const {
    if (present == nullptr) return true;
    const uint64_t cross = cross_bits(x, z);
    return (block_cells(present, block_of(x, z)) & cross) == cross;
  }
};

}  // namespace throng::world
