// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "crowd/ground/leaving_ground.h"

#include <array>
#include <bit>
#include <unordered_map>
#include <utility>
#include <vector>

#include "world/tile_grid.h"
#include "world/walk.h"

// A breadth-first search from outside: in cells, along the axes, backwards over steps that a body
// on such a cell may make. Linear in the blocked cells that are connected to what changed.
namespace throng::crowd {
namespace {

using Level = CrowdGround::Level;

constexpr std::array<std::pair<int32_t, int32_t>, 4> kSides = {{{-1, 0}, {1, 0}, {0, -1}, {0, 1}}};

struct WorldCell {
  Level level = 0;
  int32_t x = 0, z = 0;
};

bool is_out(const CrowdGround& ground, Level level, int32_t x, int32_t z) {
  return ground.is_legal(level, world::in_tile(x), world::in_tile(z));
}

}  // namespace

class ExitSearch {
 public:
  ExitSearch(CrowdGround& ground, int32_t step_mm) : ground_(ground), step_mm_(step_mm) {}

  size_t run(std::span<const Level> changed) {
    list_cells(changed);
    for (const WorldCell& cell : cells_) steps(cell) = LeftCells::kNone;
    std::vector<WorldCell> now, next;
    for (const WorldCell& cell : cells_) {
      if (!leads_out(cell)) continue;
      steps(cell) = 1;
      now.push_back(cell);
    }
    for (uint16_t count = 2; !now.empty() && count < LeftCells::kNone; ++count) {
      next.clear();
      for (const WorldCell& cell : now) look_back(cell, count, next);
      now.swap(next);
    }
    return cells_.size();
  }

 private:
  // Whatever a step from a cell depends on lies on that cell and on the four beside it. So a change
  // of a tile counts for the cells in it and at its rim, and on from there over cells that may be
  // left, whatever their heights.
  void list_cells(std::span<const Level> changed) {
    constexpr uint64_t kAll = ~uint64_t{0};
    const LeftCells& left = ground_.left();
    const auto add_rows = [&](int32_t tile_x, int32_t tile_z, int32_t first, int32_t last,
                              uint64_t columns) {
      ground_.for_tile(tile_x, tile_z, INT32_MIN, INT32_MAX, [&](Level level) {
        const LeftCells::OfLevel* of = left.find(level);
        for (int32_t z = first; of != nullptr && z <= last; ++z) {
          for (uint64_t row = of->held[static_cast<size_t>(z)] & columns; row != 0; row &= row - 1)
            add({level, world::first_cell(tile_x) + std::countr_zero(row),
                 world::first_cell(tile_z) + z});
        }
      });
    };
    for (const Level level : changed) {
      const auto& [legal_cells, x, z] = ground_.records()[level];
      add_rows(x, z, 0, world::kInTile, kAll);
      add_rows(x - 1, z, 0, world::kInTile, uint64_t{1} << world::kInTile);
      add_rows(x + 1, z, 0, world::kInTile, 1);
      add_rows(x, z - 1, world::kInTile, world::kInTile, kAll);
      add_rows(x, z + 1, 0, 0, kAll);
    }
    for (size_t i = 0; i < cells_.size(); ++i) {
      for (const auto& [dx, dz] : kSides) {
        const int32_t x = cells_[i].x + dx, z = cells_[i].z + dz;
        ground_.for_tile(world::tile_along(x), world::tile_along(z), INT32_MIN, INT32_MAX,
                         [&](Level level) {
                           if (left.holds({level, world::in_tile(x), world::in_tile(z)}))
                             add({level, x, z});
                         });
      }
    }
  }
  void add(const WorldCell& cell) {
    uint64_t& row = listed_[cell.level][static_cast<size_t>(world::in_tile(cell.z))];
    const uint64_t bit = uint64_t{1} << world::in_tile(cell.x);
    if ((row & bit) == 0) cells_.push_back(cell);
    row |= bit;
  }
  [[nodiscard]] uint16_t& steps(const WorldCell& cell) {
    return ground_.left()
        .levels_.at(cell.level)
        .steps[static_cast<size_t>(
            world::cell_index(world::in_tile(cell.x), world::in_tile(cell.z)))];
  }
  [[nodiscard]] bool leads_out(const WorldCell& cell) const {
    const LeavingGround leaving(ground_, cell.level, cell.x, cell.z);
    for (const auto& [dx, dz] : kSides) {
      const auto to =
          world::step_to(leaving, cell.level, cell.x, cell.z, cell.x + dx, cell.z + dz, step_mm_);
      if (to && is_out(ground_, *to, cell.x + dx, cell.z + dz)) return true;
    }
    return false;
  }
  void look_back(const WorldCell& to, uint16_t count, std::vector<WorldCell>& found) {
    const int32_t feet = ground_.sample(to.level, world::in_tile(to.x), world::in_tile(to.z));
    for (const auto& [dx, dz] : kSides) {
      const int32_t x = to.x + dx, z = to.z + dz;
      ground_.for_tile(world::tile_along(x), world::tile_along(z), feet - step_mm_, feet + step_mm_,
                       [&](Level level) {
                         const WorldCell from{level, x, z};
                         if (!ground_.left().holds({level, world::in_tile(x), world::in_tile(z)}) ||
                             steps(from) != LeftCells::kNone) {
                           return;
                         }
                         const LeavingGround leaving(ground_, level, x, z);
                         const auto there =
                             world::step_to(leaving, level, x, z, to.x, to.z, step_mm_);
                         if (!there || *there != to.level) return;
                         steps(from) = count;
                         found.push_back(from);
                       });
    }
  }

  CrowdGround& ground_;
  int32_t step_mm_;
  std::vector<WorldCell> cells_;
  std::unordered_map<Level, world::CellRows> listed_;  // which of a level are; looked up only
};

size_t find_exits(CrowdGround& ground, int32_t step_mm, std::span<const Level> changed) {
  return ground.left().is_empty() ? 0 : ExitSearch(ground, step_mm).run(changed);
}

bool find_exit(const CrowdGround& ground, int32_t step_mm, uint32_t max_steps, Level& level,
               int32_t& x, int32_t& z) {
  if (ground.left().steps_out({level, world::in_tile(x), world::in_tile(z)}) == LeftCells::kNone)
    return false;
  for (uint32_t n = 0; n < max_steps && !is_out(ground, level, x, z); ++n) {
    const LeavingGround leaving(ground, level, x, z);
    const uint16_t here = ground.left().steps_out({level, world::in_tile(x), world::in_tile(z)});
    bool found = false;
    for (const auto& [dx, dz] : kSides) {
      const auto to = world::step_to(leaving, level, x, z, x + dx, z + dz, step_mm);
      if (!to) continue;
      const int32_t nx = x + dx, nz = z + dz;
      found = is_out(ground, *to, nx, nz) ||
              ground.left().steps_out({*to, world::in_tile(nx), world::in_tile(nz)}) + 1 == here;
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

}  // namespace throng::crowd
