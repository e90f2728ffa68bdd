// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "throng/result.h"
#include "world/ground.h"

/// The ground as a step reads it: one small record a level, found by tile without a search.
namespace throng {

class CrowdGround {
 public:
  using Level = uint32_t;  // of the world

  /// Opens every zone of the world. Fails with kBadFile.
  static Result<CrowdGround> make(const WorldData& world, int32_t avatar_class);

  [[nodiscard]] bool is_legal(Level level, int32_t x, int32_t z) const {
    const Record& r = records_[level];
    return ((r.legal[z & r.row_mask] >> x) & 1) != 0;
  }
  [[nodiscard]] int32_t sample(Level level, int32_t x, int32_t z) const {
    return records_[level].view.sample(x, z);
  }
  [[nodiscard]] bool step_safe(Level level) const { return records_[level].step_safe; }
  template <class Visit>
  void for_tile(int32_t tile_x, int32_t tile_z, Visit visit) const {
    if (tile_x < 0 || tile_z < 0 || tile_x >= tiles_x_ || tile_z >= tiles_z_) return;
    const Range& range = tiles_[static_cast<size_t>(tile_z) * static_cast<size_t>(tiles_x_) +
                                static_cast<size_t>(tile_x)];
    for (uint32_t i = range.first; i < range.last; ++i) visit(i);
  }

  void prefetch_record(Level level) const { __builtin_prefetch(&records_[level]); }
  void prefetch_row(Level level, int32_t z_units) const {
    const Record& r = records_[level];
    __builtin_prefetch(&r.legal[((z_units >> kUnitBits) & 63) & r.row_mask]);
  }

  /// True if every cell of the box is legal on one level of one tile without a step in it: then any
  /// walk inside the box is legal, and stays on the level. Cells of the tile, inclusive.
  [[nodiscard]] bool box_is_free(Level level, int32_t x0, int32_t x1, int32_t z0,
                                 int32_t z1) const {
    const Record& r = records_[level];
    if (!r.step_safe) return false;
    uint64_t rows = ~uint64_t{0};
    for (int32_t z = z0; z <= z1; ++z) rows &= r.legal[z & r.row_mask];
    const uint64_t columns = (~uint64_t{0} >> (63 - (x1 - x0))) << x0;
    return (rows & columns) == columns;
  }
  [[nodiscard]] int32_t feet(Level level, GroundPoint p) const {
    const LevelView& view = records_[level].view;
    if (view.is_constant()) return view.floor_base;
    return view.feet(p.cell_x() & 63, p.cell_z() & 63,
                     static_cast<int32_t>(p.x & (kUnitsPerCell - 1)),
                     static_cast<int32_t>(p.z & (kUnitsPerCell - 1)));
  }

  /// Legal rows of a level: 64 words; and the level's tile.
  struct Record {
    const uint64_t* legal = nullptr;  // rows; one shared row where all are alike
    LevelView view;
    int32_t row_mask = 63;  // 0 where legal holds one row for all
    uint32_t legal_cells = 0;
    int32_t tile_x = 0, tile_z = 0;
    bool step_safe = false;
  };
  [[nodiscard]] const std::vector<Record>& records() const { return records_; }
  [[nodiscard]] uint64_t bytes() const {
    return records_.size() * sizeof(Record) + tiles_.size() * sizeof(Range);
  }
  [[nodiscard]] int32_t tiles_x() const { return tiles_x_; }
  [[nodiscard]] int32_t tiles_z() const { return tiles_z_; }

 private:
  struct Range {
    uint32_t first = 0, last = 0;
  };
  int32_t tiles_x_ = 0, tiles_z_ = 0;
  std::vector<Range> tiles_;
  std::vector<Record> records_;
};

}  // namespace throng
