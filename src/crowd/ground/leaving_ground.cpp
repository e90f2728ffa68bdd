// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "crowd/ground/leaving_ground.h"

#include <array>
#include <bit>
#include <utility>
#include <vector>

#include "world/walk.h"

// A breadth-first search from outside: in cells, along the axes, backwards over steps that a body
// on such a cell may make.
namespace throng {
namespace {

using Level = CrowdGround::Level;

constexpr std::array<std::pair<int32_t, int32_t>, 4> kSides = {{{-1, 0}, {1, 0}, {0, -1}, {0, 1}}};

struct WorldCell {
  Level level = 0;
  int32_t x = 0, z = 0;
};

bool is_out(const CrowdGround& ground, Level level, int32_t x, int32_t z) {
  return ground.is_legal(level, x & 63, z & 63);
}

}  // namespace

class ExitSearch {
 public:
  ExitSearch(CrowdGround& ground, int32_t step_mm) : ground_(ground), step_mm_(step_mm) {}

  void run() {
    LeftCells& left = ground_.left();
    for (auto& [level, of] : left.levels_) of.steps.fill(LeftCells::kNone);
    std::vector<WorldCell> now, next;
    for (const Level level : left.order_) {
      const LeftCells::OfLevel& of = left.levels_.at(level);
      const CrowdGround::Record& record = ground_.records()[level];
      for (int32_t z = 0; z < 64; ++z) {
        uint64_t row = 0;
        for (const LeftCells::Part& part : of.parts) row |= part.rows[static_cast<size_t>(z)];
        for (; row != 0; row &= row - 1) {
          const WorldCell cell{level, record.tile_x * 64 + std::countr_zero(row),
                               record.tile_z * 64 + z};
          if (!leads_out(cell)) continue;
          steps(cell) = 1;
          now.push_back(cell);
        }
      }
    }
    for (uint16_t count = 2; !now.empty() && count < LeftCells::kNone; ++count) {
      next.clear();
      for (const WorldCell& cell : now) look_back(cell, count, next);
      now.swap(next);
    }
  }

 private:
  [[nodiscard]] uint16_t& steps(const WorldCell& cell) {
    return ground_.left()
        .levels_.at(cell.level)
        .steps[static_cast<size_t>((cell.z & 63) * 64 + (cell.x & 63))];
  }
  [[nodiscard]] bool leads_out(const WorldCell& cell) const {
    const LeavingGround leaving(ground_, cell.level, cell.x, cell.z);
    for (const auto& [dx, dz] : kSides) {
      const auto to =
          step_to(leaving, cell.level, cell.x, cell.z, cell.x + dx, cell.z + dz, step_mm_);
      if (to && is_out(ground_, *to, cell.x + dx, cell.z + dz)) return true;
    }
    return false;
  }
  void look_back(const WorldCell& to, uint16_t count, std::vector<WorldCell>& found) {
    const int32_t feet = ground_.sample(to.level, to.x & 63, to.z & 63);
    for (const auto& [dx, dz] : kSides) {
      const int32_t x = to.x + dx, z = to.z + dz;
      ground_.for_tile(x >> 6, z >> 6, feet - step_mm_, feet + step_mm_, [&](Level level) {
        const WorldCell from{level, x, z};
        if (!ground_.left().holds({level, x & 63, z & 63}) || steps(from) != LeftCells::kNone) {
          return;
        }
        const LeavingGround leaving(ground_, level, x, z);
        const auto there = step_to(leaving, level, x, z, to.x, to.z, step_mm_);
        if (!there || *there != to.level) return;
        steps(from) = count;
        found.push_back(from);
      });
    }
  }

  CrowdGround& ground_;
  int32_t step_mm_;
};

void find_exits(CrowdGround& ground, int32_t step_mm) {
  if (!ground.left().is_empty()) ExitSearch(ground, step_mm).run();
}

bool find_exit(const CrowdGround& ground, int32_t step_mm, uint32_t max_steps, Level& level,
               int32_t& x, int32_t& z) {
  if (ground.left().steps_out({level, x & 63, z & 63}) == LeftCells::kNone) return false;
  for (uint32_t n = 0; n < max_steps && !is_out(ground, level, x, z); ++n) {
    const LeavingGround leaving(ground, level, x, z);
    const uint16_t here = ground.left().steps_out({level, x & 63, z & 63});
    bool found = false;
    for (const auto& [dx, dz] : kSides) {
      const auto to = step_to(leaving, level, x, z, x + dx, z + dz, step_mm);
      if (!to) continue;
      const int32_t nx = x + dx, nz = z + dz;
      found = is_out(ground, *to, nx, nz) ||
              ground.left().steps_out({*to, nx & 63, nz & 63}) + 1 == here;
      if (!found) continue;
      level = *to;
      x = nx;
      z = nz;
      break;
    }
    if (!found) return false;
  }
  return true;
}

}  // namespace throng
