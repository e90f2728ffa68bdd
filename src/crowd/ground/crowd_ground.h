// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <unordered_map>
#include <vector>

#include "core/arrays/huge_array.h"
#include "core/arrays/prefetch.h"
#include "core/function_ref.h"
#include "crowd/ground/ground_slope.h"
#include "crowd/ground/left_cells.h"
#include "crowd/ground/level_line.h"
#include "steer/sampled.h"
#include "throng/base.h"
#include "world/ground.h"
#include "world/tile_grid.h"

/// The ground as a step reads it: for each level a line and 64 rows of legal cells.
namespace throng::crowd {

class CrowdGround {
 public:
  using Level = uint32_t;  // of the world

  /// Is a tile near those on which bodies of this process walk?
  using IsNear = FunctionRef<bool(int32_t tile_x, int32_t tile_z)>;
  /// Opens every zone of the world. Heights far from where bodies walk are read from its zones,
  /// which is slower, and gives the same; null: they walk everywhere. Fails with kBadFile, also
  /// where floors are not between the world's lowest and highest triangle.
  static Result<CrowdGround> create(const world::WorldData& world, int32_t avatar_class,
                                    int32_t step_mm, const IsNear* is_near = nullptr);
  /// Bodies walk elsewhere from now on. Not while others read.
  void keep_near(IsNear is_near);

  [[nodiscard]] bool is_legal(Level level, int32_t x, int32_t z) const {
    return ((rows(lines_[level].legal_set)[z] >> x) & 1) != 0;
  }
  [[nodiscard]] int32_t sample(Level level, int32_t x, int32_t z) const {
    return views_[level].sample(x, z);
  }
  [[nodiscard]] bool step_safe(Level level) const {
    return (lines_[level].legal_set & kStepSafe) != 0;
  }
  template <class Visit>
  void for_tile(int32_t tile_x, int32_t tile_z, int32_t low, int32_t high, Visit visit) const {
    const Range* range = tile(tile_x, tile_z);
    if (range == nullptr) return;
    for (uint32_t i = range->first; i < range->last; ++i) {
      if (heights_[i].low <= high && heights_[i].high >= low) visit(i);
    }
  }

  [[nodiscard]] const LevelLine& line(Level level) const { return lines_[level]; }
  [[nodiscard]] const LevelLine* lines() const { return lines_.data(); }
  [[nodiscard]] const OpenLine& open_line(Level level) const { return open_[level]; }

  /// 64 rows of flat cells: legal, and level with the cells beside them. An avatar on one may move
  /// wherever all cells between are flat, and stays on the level, at the height of its feet.
  [[nodiscard]] const uint64_t* flat(Level level) const { return rows(lines_[level].flat_set); }

  /// What is known about walking on a level inside its tile.
  struct Walk {
    const uint64_t* legal;  // 64 rows
    bool is_step_safe;      // no two legal neighbours differ by more than the step
    bool is_isolated;       // step safe, and no other level of the tile is within a step of it
  };
  [[nodiscard]] Walk walk(Level level) const {
    const uint32_t word = lines_[level].legal_set;
    return {rows(word), (word & kStepSafe) != 0, (word & kIsolated) != 0};
  }
  /// Prefetches what is read of a level where its line gives no answer.
  void prefetch_level(Level level, int32_t z0, int32_t z1) const {
    throng::prefetch(&flat(level)[world::in_tile(z0)]);
    throng::prefetch(&flat(level)[world::in_tile(z1)]);
    throng::prefetch(&views_[level]);
  }
  /// Prefetches what a step from a cell of a level reads, and what is cached around it.
  void prefetch_cell(Level level, int32_t x, int32_t z) const {
    throng::prefetch(&rows(lines_[level].legal_set)[world::in_tile(z)]);
    const world::LevelView& view = views_[level];
    if (view.samples == nullptr) return;
    const uint16_t* sample = &view.samples[world::cell_index(world::in_tile(x), world::in_tile(z))];
    throng::prefetch(sample - 64);
    throng::prefetch(sample);
    throng::prefetch(sample + 64);
  }
  /// Prefetches what decides where an avatar may walk on a level.
  void prefetch_open(Level level) const {
    throng::prefetch(&open_[level]);
    throng::prefetch(&lines_[level]);
    throng::prefetch(&views_[level]);
  }
  /// Prefetches the tile's level lines, in two calls: the second reads what the first prefetched.
  void prefetch_tile(int32_t tile_x, int32_t tile_z) const {
    throng::prefetch(tile(tile_x, tile_z));
  }
  void prefetch_levels(int32_t tile_x, int32_t tile_z) const {
    const Range* range = tile(tile_x, tile_z);
    if (range == nullptr) return;
    throng::prefetch(&heights_[range->first]);
    throng::prefetch(&lines_[range->first]);
  }
  [[nodiscard]] int32_t feet(Level level, world::GroundPoint p) const {
    const world::LevelView& view = views_[level];
    if (view.is_constant()) return view.floor_base;
    return view.feet(world::in_tile(p.cell_x()), world::in_tile(p.cell_z()),
                     static_cast<int32_t>(p.x & (world::kUnitsPerCell - 1)),
                     static_cast<int32_t>(p.z & (world::kUnitsPerCell - 1)));
  }

  // ground_slope.cpp
  /// Is all ground that slope_along reads from here level, in every direction? A quick test: false
  /// may be wrong.
  [[nodiscard]] bool is_level_around(Level level, world::GroundPoint at) const {
    return (lines_[level].legal_set & kUneven) == 0 || box_is_level(level, at);
  }
  /// The slope of the ground from behind a body to before it, along a unit vector.
  [[nodiscard]] GroundSlope slope_along(Level level, world::GroundPoint at,
                                        steer::Plane direction) const;

  /// Blocks exactly these cells of a level, of all cells that were baked: an empty set frees all
  /// that were blocked before. Call join_tile then. Not while others read.
  void set_blocked(Level level, const world::CellRows& blocked);
  /// Updates what lies level beyond the edges of a tile, from both sides.
  void join_tile(int32_t x, int32_t z);
  /// Legal cells of a level of which some are blocked, as they were baked; null: none is blocked.
  [[nodiscard]] const world::CellRows* baked_legal(Level level) const;
  /// The blocked cells that bodies on them may leave.
  [[nodiscard]] LeftCells& left() { return left_; }
  [[nodiscard]] const LeftCells& left() const { return left_; }
  [[nodiscard]] const world::LevelView& view(Level level) const { return views_[level]; }

  /// 64 rows of legal cells.
  [[nodiscard]] const uint64_t* legal(Level level) const { return rows(lines_[level].legal_set); }

  /// What is needed only to place avatars.
  struct Record {
    uint32_t legal_cells = 0;
    int32_t tile_x = 0, tile_z = 0;
  };
  [[nodiscard]] const std::vector<Record>& records() const { return records_; }
  [[nodiscard]] uint64_t bytes() const {
    const uint64_t level = sizeof(Record) + sizeof(Heights) + sizeof(world::LevelView) +
                           sizeof(LevelLine) + sizeof(OpenLine);
    return records_.size() * level + tiles_.size() * sizeof(Range) +
           row_sets_ * 64 * sizeof(uint64_t) + sample_sets_ * 4096 * sizeof(uint16_t) +
           baked_.size() * sizeof(Baked) + sample_slot_.size() * sizeof(uint32_t);
  }
  [[nodiscard]] int32_t tiles_x() const { return tiles_x_; }
  [[nodiscard]] int32_t tiles_z() const { return tiles_z_; }

  /// The range of all feet. [mm]
  struct Heights {
    int32_t low = 0, high = 0;
  };
  [[nodiscard]] Heights feet_range() const { return feet_range_; }

 private:
  struct Range {
    uint32_t first = 0, last = 0;
  };
  // Flags beside the number of the legal set.
  static constexpr uint32_t kStepSafe = uint32_t{1} << 31;
  static constexpr uint32_t kIsolated = uint32_t{1} << 30;
  static constexpr uint32_t kUneven = uint32_t{1} << 29;  // It is, or ground near by.
  static constexpr uint32_t kSetBits = kUneven - 1;
  static constexpr uint32_t kNoneLegal = 0;  // Sets of rows that levels share.
  static constexpr uint32_t kAllLegal = 1;

  // Of a level with blocked cells, before these were.
  struct Baked {
    uint32_t legal_word = 0, flat_set = 0;
    world::CellRows legal{}, flat{};
  };
  void keep_baked(Level level, Baked& baked);

  void drop_samples(Level level);
  void find_isolated(int32_t step_mm);
  // ground_slope.cpp
  void find_uneven();
  [[nodiscard]] bool is_uneven_around(Level level) const;
  [[nodiscard]] bool box_is_level(Level level, world::GroundPoint at) const;
  struct FloorCell {
    Level level = 0;
    int32_t x = 0, z = 0;
    int32_t height = 0;  // [mm]
  };
  [[nodiscard]] std::optional<FloorCell> floor_beside(const FloorCell& from, int32_t x,
                                                      int32_t z) const;
  bool read_on_level(Level level, int32_t x, int32_t z, steer::Plane direction,
                     int32_t* middle) const;
  void join_blocks();
  void join_side(Level level, LevelLine::Side side);
  void find_open(Level level);
  void find_beyond(Level level, LevelLine::Side side);
  void join_open_side(Level level, LevelLine::Side side);
  [[nodiscard]] const Range* tile(int32_t x, int32_t z) const {
    if (x < 0 || z < 0 || x >= tiles_x_ || z >= tiles_z_) return nullptr;
    return &tiles_[static_cast<size_t>(z) * static_cast<size_t>(tiles_x_) + static_cast<size_t>(x)];
  }
  [[nodiscard]] const uint64_t* rows(uint32_t word) const {
    return rows_.data() + size_t{word & kSetBits} * 64;
  }

  int32_t tiles_x_ = 0, tiles_z_ = 0;
  int32_t step_mm_ = 0;
  SlopeRange slope_range_;
  std::vector<Range> tiles_;
  Heights feet_range_;
  std::vector<Heights> heights_;  // between which a level's legal floors lie [mm]
  std::vector<Record> records_;
  // Copied out of the zones, where the rows of one class lie pages apart: here the levels of a tile
  // are neighbours. Set 0 is empty and set 1 is full, for all such levels.
  HugeArray<LevelLine> lines_;
  HugeArray<OpenLine> open_;
  HugeArray<world::LevelView> views_;
  HugeArray<uint64_t> rows_;
  uint32_t row_sets_ = 0;
  std::unordered_map<Level, Baked> baked_;  // looked up only
  std::vector<uint32_t> spare_sets_;        // freed
  LeftCells left_;
  // Floors that are not flat, row by row: each step of an avatar on one reads five of its cells,
  // and decoding these from the zone's blocks takes a fifth of the step.
  HugeArray<uint16_t> samples_;
  size_t sample_sets_ = 0;             // in use
  std::vector<uint32_t> sample_slot_;  // by level; kNoSlot: its floor is not stored cell by cell
  static constexpr uint32_t kNoSlot = UINT32_MAX;
  [[nodiscard]] uint16_t* samples_of(uint32_t slot) const {
    return samples_.data() + size_t{slot} * 4096;
  }
};

}  // namespace throng::crowd
