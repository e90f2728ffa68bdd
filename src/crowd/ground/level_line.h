// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>

#include "world/tile_grid.h"

/// What a step reads first of a level.
namespace throng::crowd {

/// One cache line a level tile, instead of the eight that its 64 rows fill. A block is 4 x 4 cells;
/// it is flat if all its cells are (see CrowdGround::flat), and then they are all equally high.
struct alignas(64) LevelLine {
  static constexpr int32_t kBlock = 4;  // cells; too few for longer steps to use blocks
  static constexpr uint32_t kNone = UINT32_MAX;
  enum Side : uint8_t { kLeft, kRight, kAbove, kBelow };  // -x, +x, -z, +z
  static constexpr std::array<Side, 4> kSides = {kLeft, kRight, kAbove, kBelow};
  /// The side that is crossed along an axis, and the one beyond it.
  static constexpr Side side(bool along_x, bool forward) {
    return along_x ? (forward ? kRight : kLeft) : (forward ? kBelow : kAbove);
  }
  static constexpr Side opposite(Side side) { return static_cast<Side>(side ^ 1); }

  std::array<uint16_t, 16> flat{};  // bit x of word z: block (x, z)
  // Where a flat block at the rim and the one beyond are equally high: the level beyond, the same
  // for a whole side, and a bit for each such block along it.
  std::array<uint32_t, 4> beyond = {kNone, kNone, kNone, kNone};
  std::array<uint16_t, 4> joined{};
  uint32_t flat_set = 0;   // of 64 rows, cell by cell
  uint32_t legal_set = 0;  // of 64 rows, and flags

  /// True if all cells of a box of up to kBlock + 1 x kBlock + 1 cells of the world lie in flat
  /// blocks of one tile. The box between two blocks has cells of no more than four.
  [[nodiscard]] bool box_is_flat(int32_t x0, int32_t z0, int32_t x1, int32_t z1) const {
    const uint32_t common = uint32_t{flat[(z0 >> 2) & 15]} & flat[(z1 >> 2) & 15];
    const bool on_tile = static_cast<uint32_t>((x0 ^ x1) | (z0 ^ z1)) < 64;
    return ((common >> ((x0 >> 2) & 15)) & (common >> ((x1 >> 2) & 15)) &
            static_cast<uint32_t>(on_tile)) != 0;
  }

  /// The level beyond one side of the tile on which a step over flat blocks arrives, or kNone.
  [[nodiscard]] uint32_t cross(int32_t x0, int32_t z0, int32_t x1, int32_t z1) const {
    const int32_t tiles_x = world::tile_along(x1) - world::tile_along(x0),
                  tiles_z = world::tile_along(z1) - world::tile_along(z0);
    if ((tiles_x != 0) == (tiles_z != 0)) return kNone;
    const Side side = LevelLine::side(tiles_x != 0, tiles_x + tiles_z > 0);
    const int32_t from = tiles_x != 0 ? z0 : x0, to = tiles_x != 0 ? z1 : x1;
    const uint32_t open = joined[side];
    return (open >> ((from >> 2) & 15) & open >> ((to >> 2) & 15) & 1) != 0 ? beyond[side] : kNone;
  }
};
static_assert(sizeof(LevelLine) == 64);

/// Where an avatar can walk on a level tile without a test of cells: two cache lines. A block is
/// open if all its cells are legal and no step between them, nor to cells of other open blocks of
/// the tile, is too high. A move from open block to open block, over edges of tiles where they are
/// joined, leads where a walk cell by cell would, and to the same level.
struct alignas(64) OpenLine {
  std::array<uint16_t, 16> open{};  // bit x of word z: block (x, z)
  // As those of LevelLine: the level beyond a side, and a bit for each open block there whose
  // neighbour beyond is open too, if all steps between the two lead from each to the other.
  std::array<uint32_t, 4> beyond = {LevelLine::kNone, LevelLine::kNone, LevelLine::kNone,
                                    LevelLine::kNone};
  std::array<uint16_t, 4> joined{};
  // Of a side, bit i: from the i-th cell along it, the step over the edge leads to `beyond`.
  std::array<uint64_t, 4> cells{};

  [[nodiscard]] bool is_open(int32_t x, int32_t z) const {
    return (open[z & 15] >> (x & 15) & 1) != 0;
  }
  /// Are these blocks of rows `first` to `last` all open? Four rows at a time: boxes are of all
  /// sizes, and loops over them are mispredicted.
  [[nodiscard]] bool has_all(int32_t first, int32_t last, uint32_t blocks) const {
    uint64_t missing = 0;
    for (int32_t w = 0; w < 4; ++w) {
      const auto begin = static_cast<uint32_t>(std::clamp(first - 4 * w, 0, 4));
      const auto end = static_cast<uint32_t>(std::clamp(last + 1 - 4 * w, 0, 4));
      missing |= ~std::bit_cast<std::array<uint64_t, 4>>(open)[static_cast<size_t>(w)] &
                 rows_before(end) & ~rows_before(begin);
    }
    return (missing & (blocks * uint64_t{0x0001000100010001})) == 0;
  }

 private:
  // Bits of the first `rows` of four rows.
  static uint64_t rows_before(uint32_t rows) {
    return rows == 4 ? ~uint64_t{0} : (uint64_t{1} << (16 * rows)) - 1;
  }
};
static_assert(sizeof(OpenLine) == 128 && std::endian::native == std::endian::little);

/// The blocks whose cells are all set in 64 rows.
std::array<uint16_t, 16> full_blocks(const uint64_t* rows);

}  // namespace throng::crowd
