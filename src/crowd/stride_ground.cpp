// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "crowd/stride_ground.h"

#include <algorithm>
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

bool StrideGround::is_plain_around(uint32_t level, int32_t x, int32_t z, int32_t reach) const {
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

bool StrideGround::is_open_around(uint32_t level, int32_t y, int32_t x, int32_t z,
                                  int32_t reach) const {
  if (reach > 31) return false;  // of a tile's 64
  if (is_plain_around(level, x, z, reach)) return true;
  const int32_t x0 = x - reach, z0 = z - reach, x1 = x + reach, z1 = z + reach;
  for (int32_t tile_z = z0 >> 6; tile_z <= z1 >> 6; ++tile_z) {
    for (int32_t tile_x = x0 >> 6; tile_x <= x1 >> 6; ++tile_x) {
      const int32_t low_x = std::max(x0 - tile_x * 64, 0), high_x = std::min(x1 - tile_x * 64, 63);
      const int32_t low_z = std::max(z0 - tile_z * 64, 0), high_z = std::min(z1 - tile_z * 64, 63);
      const uint64_t wanted = (~uint64_t{0} >> (63 - high_x)) & (~uint64_t{0} << low_x);
      const auto is_open = [&](uint32_t on) {
        const uint64_t* legal = ground_->legal(on);
        uint64_t all = wanted;
        for (int32_t row = low_z; row <= high_z; ++row) all &= legal[row];
        return all == wanted;
      };
      bool open = false;
      if (tile_x == x >> 6 && tile_z == z >> 6) {
        open = is_open(level);
      } else {
        ground_->for_tile(tile_x, tile_z, y - step_mm_, y + step_mm_,
                          [&](uint32_t on) { open = open || is_open(on); });
      }
      if (!open) return false;
    }
  }
  return true;
}

bool StrideGround::sees(uint32_t level, GroundPoint from, GroundPoint to, uint32_t end,
                        float most) const {
  const auto dx = static_cast<float>(to.x - from.x), dz = static_cast<float>(to.z - from.z);
  const float far = std::sqrt(dx * dx + dz * dz);
  if (far > most) {
    const float part = most / far;
    to = {from.x + std::lrint(dx * part), from.z + std::lrint(dz * part)};
  }
  return walk(*ground_, level, from, to, step_mm_) && (far > most || level == end);
}

float StrideGround::free_way(uint32_t level, GroundPoint from, steer::Plane direction,
                             float most) const {
  const GroundPoint to{from.x + std::lrint(direction.x * most),
                       from.z + std::lrint(direction.z * most)};
  const WalkStop stop = walk_far(*ground_, level, from, to, step_mm_);
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
