// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "crowd/ground/stride_ground.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "crowd/ground/leaving_ground.h"
#include "world/tile_grid.h"
#include "world/walk.h"

// Moves and lines of sight over the ground: block by block where blocks decide, else row by row,
// else cell by cell ([ML06], algorithm 1). Linear in the blocks, rows or cells crossed.
namespace throng::crowd {

bool StrideGround::move(uint32_t level, int32_t y, world::GroundPoint from, world::GroundPoint to,
                        Landing& landing) const {
  const int32_t x0 = from.cell_x(), z0 = from.cell_z(), x1 = to.cell_x(), z1 = to.cell_z();
  if (std::abs(x1 - x0) <= LevelLine::kBlock && std::abs(z1 - z0) <= LevelLine::kBlock) {
    const LevelLine& line = ground_->line(level);
    if (line.box_is_flat(x0, z0, x1, z1)) {
      landing = {level, y};
      return true;
    }
    const uint32_t beyond = line.cross(x0, z0, x1, z1);
    if (beyond != LevelLine::kNone) {
      landing = {beyond, y};
      return true;
    }
  }
  if (leaves(level, from)) return leave(level, y, from, to, landing);
  uint32_t end = level;
  if (!walk_open(end, from, to) && !world::walk(*ground_, end, from, to, step_mm_)) return false;
  landing = {end, ground_->feet(end, to)};
  return true;
}

bool StrideGround::leaves(uint32_t level, world::GroundPoint from) const {
  return is_leaving(*ground_, level, from.cell_x(), from.cell_z());
}

bool StrideGround::leave(uint32_t level, int32_t y, world::GroundPoint from, world::GroundPoint to,
                         Landing& landing) const {
  const LeavingGround leaving(*ground_, level, from.cell_x(), from.cell_z());
  uint32_t end = level;
  if (!world::walk(leaving, end, from, to, step_mm_)) return false;
  landing = {end, ground_->feet(end, to)};
  const auto position = [](world::GroundPoint p, int32_t feet) {
    return AirPosition{static_cast<int32_t>(p.x), static_cast<int32_t>(p.z), feet};
  };
  return !ground_->left().enters(
      {level, world::in_tile(from.cell_x()), world::in_tile(from.cell_z())}, position(from, y),
      position(to, landing.y));
}

namespace {

// Bits of a row or column of a tile's blocks, from one cell to another.
uint32_t blocks_between(int32_t low, int32_t high) {
  return (~uint32_t{0} >> (31 - (high >> 2 & 15))) & (~uint32_t{0} << (low >> 2 & 15));
}

}  // namespace

// Of one tile.
bool StrideGround::box_is_open(uint32_t level, int32_t x0, int32_t z0, int32_t x1,
                               int32_t z1) const {
  return ground_->open_line(level).has_all(z0 >> 2 & 15, z1 >> 2 & 15, blocks_between(x0, x1));
}

// The level beyond a side, if all blocks there between two cells are joined to it.
uint32_t StrideGround::beyond(uint32_t level, LevelLine::Side side, int32_t low,
                              int32_t high) const {
  const OpenLine& line = ground_->open_line(level);
  const uint32_t wanted = blocks_between(low, high);
  return (line.joined[side] & wanted) == wanted ? line.beyond[side] : LevelLine::kNone;
}

bool StrideGround::is_open_around(uint32_t level, world::GroundPoint from, int32_t range) const {
  if (range > 31) return false;  // of a tile's 64
  const int32_t x = from.cell_x(), z = from.cell_z();
  const int32_t x0 = x - range, z0 = z - range, x1 = x + range, z1 = z + range;
  const bool is_wide = world::tile_along(x0) != world::tile_along(x1),
             is_deep = world::tile_along(z0) != world::tile_along(z1);
  // Of the body's tile, and of the other one across and down.
  const int32_t edge_x = is_wide ? world::tile_begin(x1) : x1 + 1,
                edge_z = is_deep ? world::tile_begin(z1) : z1 + 1;
  const bool is_right = x >= edge_x, is_low = z >= edge_z;
  const int32_t own_x0 = is_right ? edge_x : x0, own_x1 = is_right ? x1 : edge_x - 1;
  const int32_t own_z0 = is_low ? edge_z : z0, own_z1 = is_low ? z1 : edge_z - 1;
  if (!box_is_open(level, own_x0, own_z0, own_x1, own_z1)) return false;
  const int32_t far_x0 = is_right ? x0 : edge_x, far_x1 = is_right ? edge_x - 1 : x1;
  const int32_t far_z0 = is_low ? z0 : edge_z, far_z1 = is_low ? edge_z - 1 : z1;
  const auto side_x = LevelLine::side(true, !is_right);
  const auto side_z = LevelLine::side(false, !is_low);
  uint32_t across = level, down = level;
  if (is_wide) {
    across = beyond(level, side_x, own_z0, own_z1);
    if (across == LevelLine::kNone) return false;
    if (!box_is_open(across, far_x0, own_z0, far_x1, own_z1)) return false;
  }
  if (is_deep) {
    down = beyond(level, side_z, own_x0, own_x1);
    if (down == LevelLine::kNone) return false;
    if (!box_is_open(down, own_x0, far_z0, own_x1, far_z1)) return false;
  }
  if (!is_wide || !is_deep) return true;
  // The fourth tile is the same over both sides.
  const uint32_t fourth = beyond(across, side_z, far_x0, far_x1);
  return fourth != LevelLine::kNone && fourth == beyond(down, side_x, far_z0, far_z1) &&
         box_is_open(fourth, far_x0, far_z0, far_x1, far_z1);
}

// As throng::walk_far, block by block. False, and the level is unchanged: blocks cannot decide.
bool StrideGround::walk_open(uint32_t& level, world::GroundPoint from,
                             world::GroundPoint to) const {
  constexpr int32_t kShift = world::kUnitBits + 2;  // units of a block
  auto x = static_cast<int32_t>(from.x >> kShift), z = static_cast<int32_t>(from.z >> kShift);
  const auto end_x = static_cast<int32_t>(to.x >> kShift);
  const auto end_z = static_cast<int32_t>(to.z >> kShift);
  const int64_t dx = std::llabs(to.x - from.x), dz = std::llabs(to.z - from.z);
  const int32_t sx = to.x > from.x ? 1 : -1, sz = to.z > from.z ? 1 : -1;
  // Distances along each axis to the next line of blocks, multiplied out: the smaller is crossed
  // first.
  const auto to_line = [](int64_t at, int32_t block, int32_t toward) {
    const int64_t line = int64_t{toward > 0 ? block + 1 : block} << kShift;
    return std::llabs(line - at);
  };
  int64_t ax = to_line(from.x, x, sx) * dz, az = to_line(from.z, z, sz) * dx;
  const int64_t next_x = dz << kShift, next_z = dx << kShift;
  const OpenLine* line = &ground_->open_line(level);
  if (!line->is_open(x, z)) return false;
  uint32_t on = level;
  while (x != end_x || z != end_z) {
    const bool cross_x = x != end_x && (z == end_z || ax <= az);
    const bool cross_z = z != end_z && (x == end_x || az <= ax);
    if (cross_x && cross_z) return false;  // through a corner
    const int32_t nx = cross_x ? x + sx : x, nz = cross_z ? z + sz : z;
    if ((x ^ nx) >> 4 == 0 && (z ^ nz) >> 4 == 0) {
      if (!line->is_open(nx, nz)) return false;
    } else {
      const auto side = LevelLine::side(cross_x, (cross_x ? sx : sz) > 0);
      if ((line->joined[side] >> ((cross_x ? z : x) & 15) & 1) == 0) return false;
      on = line->beyond[side];
      line = &ground_->open_line(on);
    }
    (cross_x ? ax : az) += cross_x ? next_x : next_z;
    x = nx;
    z = nz;
  }
  level = on;
  return true;
}

namespace {

// 64 rows of cells as far as they lie in the window: those of a tile that begins at (x, z) of it.
void add_rows(const uint64_t* legal, int32_t x, int32_t z, int32_t size,
              std::array<uint64_t, kTileCells>& window) {
  const int32_t first = std::max(z, 0), last = std::min(z + kTileCells, size);
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

StrideGround::Around StrideGround::query_walls(uint32_t level, int32_t y, world::GroundPoint from,
                                               int32_t range, int32_t rise,
                                               WallWindow& window) const {
  const int32_t x = from.cell_x(), z = from.cell_z();
  if (leaves(level, from)) return Around::kSteps;
  // Squares of one cell, or of two for longer ranges.
  const int32_t scale = range < WallWindow::kMiddle ? 1 : 2;
  if (range >= 2 * WallWindow::kMiddle) return Around::kSteps;
  const int32_t size = scale * WallWindow::kSize, middle = scale * WallWindow::kMiddle;
  const int32_t x0 = x - middle, z0 = z - middle;
  std::array<uint64_t, kTileCells> cells{};  // rows of the window
  for (int32_t tile_z = world::tile_along(z0); tile_z <= world::tile_along(z0 + size - 1);
       ++tile_z) {
    for (int32_t tile_x = world::tile_along(x0); tile_x <= world::tile_along(x0 + size - 1);
         ++tile_x) {
      const auto add = [&](uint32_t on) {
        add_rows(ground_->legal(on), world::first_cell(tile_x) - x0, world::first_cell(tile_z) - z0,
                 size, cells);
      };
      if (tile_x == world::tile_along(x) && tile_z == world::tile_along(z)) {
        add(level);
      } else {
        ground_->for_tile(tile_x, tile_z, y - step_mm_ - rise, y + step_mm_ + rise, add);
      }
    }
  }
  const uint64_t wanted = ((uint64_t{2} << (2 * range)) - 1) << (middle - range);
  uint64_t all = wanted;
  for (int32_t row = middle - range; row <= middle + range; ++row) all &= cells[row];
  if (all == wanted) return Around::kOpen;
  const CrowdGround::Walk walk = ground_->walk(level);
  if (!walk.is_step_safe || !walk.is_isolated) return Around::kSteps;
  window.shift = world::kUnitBits + scale - 1;
  window.x = static_cast<int32_t>(from.x - (int64_t{x0} << world::kUnitBits));
  window.z = static_cast<int32_t>(from.z - (int64_t{z0} << world::kUnitBits));
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

// As throng::walk_far, row by row: of a row the line crosses some adjacent cells, which is one test
// of its bits. Lines through a corner of cells are left to walk_far.
world::WalkStop StrideGround::walk_rows(uint32_t& level, world::GroundPoint from,
                                        world::GroundPoint to) const {
  int32_t x = from.cell_x(), z = from.cell_z();
  const uint32_t start = level;
  const int32_t end_x = to.cell_x(), end_z = to.cell_z();
  const int32_t sx = to.x > from.x ? 1 : -1, sz = to.z > from.z ? 1 : -1;
  const auto dx = static_cast<double>(to.x - from.x), dz = static_cast<double>(to.z - from.z);
  CrowdGround::Walk walk = ground_->walk(level);
  const auto step = [&](int32_t nx, int32_t nz) {
    const bool across_x = world::tile_along(x) != world::tile_along(nx),
               across_z = world::tile_along(z) != world::tile_along(nz);
    if (across_x || across_z) {
      const auto side = LevelLine::side(across_x, (across_x ? sx : sz) > 0);
      const OpenLine& line = ground_->open_line(level);
      if ((line.cells[side] >> world::in_tile(across_x ? z : x) & 1) != 0) {
        level = line.beyond[side];
        walk = ground_->walk(level);
        return true;
      }
    } else if (walk.is_isolated &&
               (walk.legal[world::in_tile(nz)] >> world::in_tile(nx) & 1) == 0) {
      return false;
    }
    const auto next = world::step_to(*ground_, level, x, z, nx, nz, step_mm_);
    if (!next) return false;
    level = *next;
    walk = ground_->walk(level);
    return true;
  };
  for (;; z += sz) {
    int32_t last = end_x;
    if (z != end_z) {  // where the line leaves the row
      const int64_t border = int64_t{sz > 0 ? z + 1 : z} << world::kUnitBits;
      // The product is exact, and so is a whole quotient.
      const double at =
          static_cast<double>(from.x) + static_cast<double>(border - from.z) * dx / dz;
      const auto whole = static_cast<int64_t>(at);
      if (static_cast<double>(whole) == at && (whole & (world::kUnitsPerCell - 1)) == 0 &&
          dx != 0) {
        level = start;
        return world::walk_far(*ground_, level, from, to, step_mm_);
      }
      last = static_cast<int32_t>(whole >> world::kUnitBits);
      last = sx > 0 ? std::clamp(last, x, std::max(x, end_x))
                    : std::clamp(last, std::min(x, end_x), x);
    }
    while (x != last) {
      if (walk.is_step_safe) {  // on this level as far as it goes
        const int32_t edge =
            sx > 0 ? std::min(last, world::tile_last(x)) : std::max(last, world::tile_begin(x));
        const int32_t low = world::in_tile(std::min(x, edge)),
                      high = world::in_tile(std::max(x, edge));
        const uint64_t wanted = (~uint64_t{0} >> (63 - high)) & (~uint64_t{0} << low);
        const uint64_t missing = wanted & ~walk.legal[world::in_tile(z)];
        const int32_t first = missing == 0 ? world::in_tile(edge) + sx
                              : sx > 0     ? std::countr_zero(missing)
                                           : 63 - std::countl_zero(missing);
        x = world::tile_begin(x) + first - sx;
        if (x == last) break;
      }
      if (!step(x + sx, z)) return {false, x, z, sx, 0};
      x += sx;
    }
    if (z == end_z) return {true, x, z, 0, 0};
    const bool stays = walk.is_step_safe && world::in_tile(z) != (sz > 0 ? world::kInTile : 0);
    const bool is_free =
        stays && (walk.legal[world::in_tile(z + sz)] >> world::in_tile(x) & 1) != 0;
    if (!is_free && !step(x, z + sz)) return {false, x, z, 0, sz};
  }
}

bool StrideGround::sees(uint32_t level, world::GroundPoint from, world::GroundPoint to,
                        uint32_t end, float max_range) const {
  const auto dx = static_cast<float>(to.x - from.x), dz = static_cast<float>(to.z - from.z);
  const float far = std::sqrt(dx * dx + dz * dz);
  if (far > max_range) {
    const float part = max_range / far;
    to = {from.x + std::lrint(dx * part), from.z + std::lrint(dz * part)};
  }
  if (leaves(level, from)) {
    const LeavingGround leaving(*ground_, level, from.cell_x(), from.cell_z());
    return world::walk(leaving, level, from, to, step_mm_) && (far > max_range || level == end);
  }
  const bool arrives = walk_open(level, from, to) || walk_rows(level, from, to).arrived;
  return arrives && (far > max_range || level == end);
}

float StrideGround::free_distance(uint32_t level, world::GroundPoint from, steer::Plane direction,
                                  float max_range) const {
  const world::GroundPoint to{from.x + std::lrint(direction.x * max_range),
                              from.z + std::lrint(direction.z * max_range)};
  world::WalkStop stop;
  if (leaves(level, from)) {
    const LeavingGround leaving(*ground_, level, from.cell_x(), from.cell_z());
    stop = world::walk_far(leaving, level, from, to, step_mm_);
  } else {
    if (walk_open(level, from, to)) return max_range;
    stop = walk_rows(level, from, to);
  }
  if (stop.arrived) return max_range;
  // To the border of the last cell that could not be crossed.
  const auto part = [](int32_t cell, int32_t toward, int64_t begin, int64_t end) {
    const int64_t border = int64_t{cell + (toward > 0 ? 1 : 0)} << world::kUnitBits;
    return static_cast<float>(border - begin) / static_cast<float>(end - begin);
  };
  float part_free = 1;
  if (stop.toward_x != 0)
    part_free = std::min(part_free, part(stop.x, stop.toward_x, from.x, to.x));
  if (stop.toward_z != 0)
    part_free = std::min(part_free, part(stop.z, stop.toward_z, from.z, to.z));
  return std::max(part_free, 0.0f) * max_range;
}

}  // namespace throng::crowd
