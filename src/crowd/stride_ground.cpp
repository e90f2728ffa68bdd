// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "crowd/stride_ground.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "world/walk.h"

namespace throng {

bool StrideGround::move(uint32_t level, int32_t y, GroundPoint from, GroundPoint to,
                        Landing& landing) const {
  const int32_t x0 = from.cell_x(), z0 = from.cell_z(), x1 = to.cell_x(), z1 = to.cell_z();
  if (std::abs(x1 - x0) <= LevelLine::kBlock && std::abs(z1 - z0) <= LevelLine::kBlock) {
    const LevelLine& line = ground_->line(level);
    if (line.box_is_plain(x0, z0, x1, z1)) {
      landing = {level, y};
      return true;
    }
    const uint32_t beyond = line.cross(x0, z0, x1, z1);
    if (beyond != LevelLine::kNone) {
      landing = {beyond, y};
      return true;
    }
  }
  uint32_t end = level;
  if (!walk(*ground_, end, from, to, step_mm_)) return false;
  landing = {end, ground_->feet(end, to)};
  return true;
}

// Block by block; over the edge of a tile where the blocks there are joined to one level.
bool StrideGround::box_is_plain(uint32_t level, int32_t x0, int32_t z0, int32_t x1,
                                int32_t z1) const {
  const LevelLine& line = ground_->line(level);
  const auto blocks = [](int32_t low, int32_t high) {  // bits of a row or column of the tile
    return (~uint32_t{0} >> (31 - (high >> 2 & 15))) & (~uint32_t{0} << (low >> 2 & 15));
  };
  const auto joined = [&](LevelLine::Side side, int32_t low, int32_t high) {
    return (line.joined[side] & blocks(low, high)) == blocks(low, high);
  };
  if ((x0 ^ x1) >= 64 || (x0 ^ x1) < 0) {
    const int32_t edge = x1 & ~63;
    if ((edge - 1) >> 6 != x0 >> 6 || (z0 >> 6) != (z1 >> 6)) return false;
    if (!joined(LevelLine::kRight, z0, z1)) return false;
    return box_is_plain(level, x0, z0, edge - 1, z1) &&
           box_is_plain(line.beyond[LevelLine::kRight], edge, z0, x1, z1);
  }
  if ((z0 ^ z1) >= 64 || (z0 ^ z1) < 0) {
    const int32_t edge = z1 & ~63;
    if ((edge - 1) >> 6 != z0 >> 6) return false;
    if (!joined(LevelLine::kBelow, x0, x1)) return false;
    return box_is_plain(level, x0, z0, x1, edge - 1) &&
           box_is_plain(line.beyond[LevelLine::kBelow], x0, edge, x1, z1);
  }
  const uint32_t wanted = blocks(x0, x1);
  for (int32_t row = z0 >> 2 & 15; row <= (z1 >> 2 & 15); ++row) {
    if ((line.plain[static_cast<size_t>(row)] & wanted) != wanted) return false;
  }
  return true;
}

bool StrideGround::is_plain_around(uint32_t level, GroundPoint from, int32_t reach) const {
  if (reach > 31) return false;  // of a tile's 64
  const int32_t x = from.cell_x(), z = from.cell_z();
  // Joins lead to the right and down only, so begin at the left upper corner.
  const int32_t x0 = x - reach, z0 = z - reach;
  uint32_t first = level;
  if (x0 >> 6 != x >> 6) {
    const LevelLine& line = ground_->line(first);
    if ((line.joined[LevelLine::kLeft] >> (z >> 2 & 15) & 1) == 0) return false;
    first = line.beyond[LevelLine::kLeft];
  }
  if (z0 >> 6 != z >> 6) {
    const LevelLine& line = ground_->line(first);
    if ((line.joined[LevelLine::kAbove] >> ((x0 & 63) >> 2) & 1) == 0) return false;
    first = line.beyond[LevelLine::kAbove];
  }
  return box_is_plain(first, x0, z0, x + reach, z + reach);
}

namespace {

// 64 rows of cells as far as they lie in the window: those of a tile that begins at (x, z) of it.
void add_rows(const uint64_t* legal, int32_t x, int32_t z, int32_t size,
              std::array<uint64_t, 64>& window) {
  const int32_t first = std::max(z, 0), last = std::min(z + 64, size);
  if (x >= 0) {
    for (int32_t row = first; row < last; ++row) window[row] |= legal[row - z] << x;
  } else {
    for (int32_t row = first; row < last; ++row) window[row] |= legal[row - z] >> -x;
  }
}

// Bits 0, 2, 4 ... to 0, 1, 2 ...
uint32_t even_bits(uint64_t v) {
  v &= 0x5555555555555555u;
  v = (v | v >> 1) & 0x3333333333333333u;
  v = (v | v >> 2) & 0x0f0f0f0f0f0f0f0fu;
  v = (v | v >> 4) & 0x00ff00ff00ff00ffu;
  v = (v | v >> 8) & 0x0000ffff0000ffffu;
  return static_cast<uint32_t>(v | v >> 16);
}

}  // namespace

StrideGround::Around StrideGround::look_around(uint32_t level, int32_t y, GroundPoint from,
                                               int32_t reach, int32_t rise,
                                               WallWindow& window) const {
  const int32_t x = from.cell_x(), z = from.cell_z();
  // Squares of one cell, or of two where the look is longer.
  const int32_t scale = reach < WallWindow::kMiddle ? 1 : 2;
  if (reach >= 2 * WallWindow::kMiddle) return Around::kSteps;
  const int32_t size = scale * WallWindow::kSize, middle = scale * WallWindow::kMiddle;
  const int32_t x0 = x - middle, z0 = z - middle;
  std::array<uint64_t, 64> cells{};  // rows of the window
  for (int32_t tile_z = z0 >> 6; tile_z <= (z0 + size - 1) >> 6; ++tile_z) {
    for (int32_t tile_x = x0 >> 6; tile_x <= (x0 + size - 1) >> 6; ++tile_x) {
      const auto add = [&](uint32_t on) {
        add_rows(ground_->legal(on), tile_x * 64 - x0, tile_z * 64 - z0, size, cells);
      };
      if (tile_x == x >> 6 && tile_z == z >> 6) {
        add(level);
      } else {
        ground_->for_tile(tile_x, tile_z, y - step_mm_ - rise, y + step_mm_ + rise, add);
      }
    }
  }
  const uint64_t wanted = ((uint64_t{2} << (2 * reach)) - 1) << (middle - reach);
  uint64_t all = wanted;
  for (int32_t row = middle - reach; row <= middle + reach; ++row) all &= cells[row];
  if (all == wanted) return Around::kOpen;
  const CrowdGround::Walk walk = ground_->walk(level);
  if (!walk.is_step_safe || !walk.is_alone) return Around::kSteps;
  window.shift = kUnitBits + scale - 1;
  window.x = static_cast<int32_t>(from.x - (int64_t{x0} << kUnitBits));
  window.z = static_cast<int32_t>(from.z - (int64_t{z0} << kUnitBits));
  for (int32_t row = 0; row < WallWindow::kSize; ++row) {
    if (scale == 1) {
      window.rows[row] = static_cast<uint32_t>(cells[row]);
    } else {  // Of four cells any: walls are wider than two.
      const uint64_t both = cells[2 * row] | cells[2 * row + 1];
      window.rows[row] = even_bits(both | both >> 1);
    }
  }
  return Around::kWalls;
}

// As throng::walk_far, row by row: of a row the line needs some cells beside each other, which is
// one look at its bits. Lines through a corner of cells are left to that.
WalkStop StrideGround::walk_rows(uint32_t& level, GroundPoint from, GroundPoint to) const {
  int32_t x = from.cell_x(), z = from.cell_z();
  const uint32_t start = level;
  const int32_t end_x = to.cell_x(), end_z = to.cell_z();
  const int32_t sx = to.x > from.x ? 1 : -1, sz = to.z > from.z ? 1 : -1;
  const auto dx = static_cast<double>(to.x - from.x), dz = static_cast<double>(to.z - from.z);
  CrowdGround::Walk walk = ground_->walk(level);
  const auto step = [&](int32_t nx, int32_t nz) {
    const auto next = step_to(*ground_, level, x, z, nx, nz, step_mm_);
    if (!next) return false;
    level = *next;
    walk = ground_->walk(level);
    return true;
  };
  for (;; z += sz) {
    int32_t last = end_x;
    if (z != end_z) {  // where the line leaves the row
      const int64_t border = int64_t{sz > 0 ? z + 1 : z} << kUnitBits;
      // The product is exact, and so is a quotient that is whole.
      const double at =
          static_cast<double>(from.x) + static_cast<double>(border - from.z) * dx / dz;
      const auto whole = static_cast<int64_t>(at);
      if (static_cast<double>(whole) == at && (whole & (kUnitsPerCell - 1)) == 0 && dx != 0) {
        level = start;
        return walk_far(*ground_, level, from, to, step_mm_);
      }
      last = static_cast<int32_t>(whole >> kUnitBits);
      last = sx > 0 ? std::clamp(last, x, std::max(x, end_x))
                    : std::clamp(last, std::min(x, end_x), x);
    }
    while (x != last) {
      if (walk.is_step_safe) {  // on this level as far as it goes
        const int32_t edge = sx > 0 ? std::min(last, x | 63) : std::max(last, x & ~63);
        const int32_t low = std::min(x, edge) & 63, high = std::max(x, edge) & 63;
        const uint64_t wanted = (~uint64_t{0} >> (63 - high)) & (~uint64_t{0} << low);
        const uint64_t missing = wanted & ~walk.legal[z & 63];
        const int32_t first = missing == 0 ? (edge & 63) + sx
                              : sx > 0     ? std::countr_zero(missing)
                                           : 63 - std::countl_zero(missing);
        x = (x & ~63) + first - sx;
        if (x == last) break;
      }
      if (!step(x + sx, z)) return {false, x, z, sx, 0};
      x += sx;
    }
    if (z == end_z) return {true, x, z, 0, 0};
    const bool stays = walk.is_step_safe && (z & 63) != (sz > 0 ? 63 : 0);
    const bool is_free = stays && (walk.legal[(z + sz) & 63] >> (x & 63) & 1) != 0;
    if (!is_free && !step(x, z + sz)) return {false, x, z, 0, sz};
  }
}

bool StrideGround::sees(uint32_t level, GroundPoint from, GroundPoint to, uint32_t end,
                        float most) const {
  const auto dx = static_cast<float>(to.x - from.x), dz = static_cast<float>(to.z - from.z);
  const float far = std::sqrt(dx * dx + dz * dz);
  if (far > most) {
    const float part = most / far;
    to = {from.x + std::lrint(dx * part), from.z + std::lrint(dz * part)};
  }
  return walk_rows(level, from, to).arrived && (far > most || level == end);
}

float StrideGround::free_way(uint32_t level, GroundPoint from, steer::Plane direction,
                             float most) const {
  const GroundPoint to{from.x + std::lrint(direction.x * most),
                       from.z + std::lrint(direction.z * most)};
  const WalkStop stop = walk_rows(level, from, to);
  if (stop.arrived) return most;
  // To the border of the last cell that it could not cross.
  const auto part = [](int32_t cell, int32_t toward, int64_t begin, int64_t end) {
    const int64_t border = int64_t{cell + (toward > 0 ? 1 : 0)} << kUnitBits;
    return static_cast<float>(border - begin) / static_cast<float>(end - begin);
  };
  float way = 1;
  if (stop.toward_x != 0) way = std::min(way, part(stop.x, stop.toward_x, from.x, to.x));
  if (stop.toward_z != 0) way = std::min(way, part(stop.z, stop.toward_z, from.z, to.z));
  return std::max(way, 0.0f) * most;
}

}  // namespace throng
