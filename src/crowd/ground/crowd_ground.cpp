// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "crowd/ground/crowd_ground.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <span>
#include <tuple>

#include "world/place.h"

// Copies the ground of one class out of the zones: rows of legal and of flat cells, a line for each
// level, and samples. Linear in the level tiles.
namespace throng::crowd {
namespace {

constexpr size_t kRows = 64;

using Heights = CrowdGround::Heights;

// Heights between which the floors of a level's legal cells lie. [mm]
Heights heights_of(const world::LevelView& view, const uint64_t* legal) {
  if (view.is_constant()) return {view.floor_base, view.floor_base};
  int32_t low = INT32_MAX, high = INT32_MIN;
  for (int32_t z = 0; z < static_cast<int32_t>(kRows); ++z) {
    for (uint64_t row = legal[z]; row != 0; row &= row - 1) {
      const int32_t sample = view.sample(std::countr_zero(row), z);
      low = std::min(low, sample);
      high = std::max(high, sample);
    }
  }
  return {low, high};
}

// How far feet can be above or below the sample of their cell, anywhere on the level. [mm]
int32_t max_rise(const world::LevelView& view) {
  if (view.is_constant()) return 0;
  if (view.samples == nullptr) return (std::abs(view.slope_x) + std::abs(view.slope_z)) / 1024 + 2;
  int32_t low = world::kNoValue, high = 0;
  for (size_t i = 0; i < kRows * 64; ++i) {
    const int32_t sample = view.samples[i];
    low = std::min(low, sample);
    high = std::max(high, sample == world::kNoValue ? 0 : sample);
  }
  return std::max(0, high - low) + 1;
}

// Heights between which the feet on a level's legal cells lie. [mm]
Heights feet_of(const world::LevelView& view, const uint64_t* legal) {
  Heights feet{INT32_MAX, INT32_MIN};
  for (int32_t z = 0; z < static_cast<int32_t>(kRows); ++z) {
    for (uint64_t row = legal[z]; row != 0; row &= row - 1) {
      const int32_t x = std::countr_zero(row);
      for (const int32_t u :
           {0, world::kUnitsPerCell}) {  // They are highest and lowest at the corners.
        for (const int32_t v : {0, world::kUnitsPerCell}) {
          const int32_t height = view.feet(x, z, u, v);
          feet = {std::min(feet.low, height), std::max(feet.high, height)};
        }
      }
    }
  }
  return feet;
}

// Heights between which the floors of a world lie, with a metre to spare. [mm]
Heights heights_of(const Box3d& bounds) {
  return {static_cast<int32_t>(std::floor(bounds.min.y * 1000)) - 1000,
          static_cast<int32_t>(std::ceil(bounds.max.y * 1000)) + 1000};
}

// Bit x: samples x and x + 1 of a row are the same.
uint64_t same_to_the_right(const uint16_t* row) {
  uint64_t same = 0;
  for (int32_t x = 0; x < 63; ++x) same |= uint64_t{row[x] == row[x + 1]} << x;
  return same;
}

uint64_t same(const uint16_t* row, const uint16_t* other) {
  uint64_t same = 0;
  for (int32_t x = 0; x < 64; ++x) same |= uint64_t{row[x] == other[x]} << x;
  return same;
}

// Legal cells that are as high as the four beside them, as far as those are on the tile. Slopes
// there are 0 (surface.h). False if there are none.
bool find_flat(const world::LevelView& view, const uint64_t* legal, uint64_t* flat) {
  if (view.samples == nullptr) return false;
  const uint64_t left_rim = 1, right_rim = uint64_t{1} << 63;
  uint64_t any = 0, above = ~uint64_t{0};
  for (size_t z = 0; z < kRows; ++z) {
    const uint16_t* row = view.samples + z * 64;
    const uint64_t right = same_to_the_right(row);
    const uint64_t below = z + 1 < kRows ? same(row, row + 64) : ~uint64_t{0};
    flat[z] = legal[z] & (right | right_rim) & (right << 1 | left_rim) & above & below;
    any |= flat[z];
    above = below;
  }
  return any != 0;
}

// True for levels with legal cells whose floor is stored cell by cell.
bool is_sampled(const world::Zone& zone, uint32_t level, int32_t avatar_class) {
  return zone.level(level).floor_kind() == format::HeightKind::Blocks &&
         zone.clearance(level, static_cast<uint32_t>(avatar_class)).kind() !=
             format::CellsKind::None;
}
size_t count_rough(const world::Zone& zone, int32_t avatar_class) {
  size_t count = 0;
  for (uint32_t i = 0; i < zone.level_count(); ++i)
    count += is_sampled(zone, i, avatar_class) ? 1 : 0;
  return count;
}

}  // namespace

Result<CrowdGround> CrowdGround::create(const world::WorldData& world, int32_t avatar_class,
                                        int32_t step_mm, const IsNear* is_near) {
  CrowdGround ground;
  ground.tiles_x_ = world.summary.tiles_x;
  ground.tiles_z_ = world.summary.tiles_z;
  ground.step_mm_ = step_mm;
  ground.slope_range_ = SlopeRange::of_cell(world.summary.cell);
  ground.tiles_.resize(static_cast<size_t>(ground.tiles_x_) * static_cast<size_t>(ground.tiles_z_));
  ground.records_.resize(world.level_count);
  ground.heights_.resize(world.level_count);
  ground.views_ = HugeArray<world::LevelView>(world.level_count);
  ground.lines_ = HugeArray<LevelLine>(world.level_count);
  ground.open_ = HugeArray<OpenLine>(world.level_count);
  // Capacity for all levels; the system allocates only what is written.
  ground.rows_ = HugeArray<uint64_t>((2 * size_t{world.level_count} + 2) * kRows);
  std::fill_n(ground.rows_.data() + kAllLegal * kRows, kRows, ~uint64_t{0});
  uint32_t& sets = ground.row_sets_;
  sets = 2;
  const Heights bounds = heights_of(world.summary.bounds);
  ground.feet_range_ = bounds;
  size_t rough = 0;
  for (size_t s = 0; s < world.slots.size(); ++s) {
    const world::Zone* zone = world.zone(s);
    if (zone == nullptr) return Error{Errc::kBadFile, world.slots[s]->error};
    rough += count_rough(*zone, avatar_class);
  }
  ground.samples_ = HugeArray<uint16_t>(rough * world::kBlocks * 64,
                                        is_near == nullptr ? Pages::kHuge : Pages::kSmall);
  ground.sample_slot_.assign(world.level_count, kNoSlot);
  uint32_t next_slot = 0;
  for (size_t s = 0; s < world.slots.size(); ++s) {
    const world::Zone* zone = world.zone(s);
    const uint32_t base = world.slots[s]->first_level;
    for (uint32_t i = 0; i < zone->level_count(); ++i) {
      const world::GroundLevel level = world::ground_level(*zone, i, base + i, avatar_class);
      Record& record = ground.records_[base + i];
      record.legal_cells = zone->clearance(i, static_cast<uint32_t>(avatar_class)).legal_cells();
      uint32_t set = level.kind == format::CellsKind::All ? kAllLegal : kNoneLegal;
      if (level.kind == format::CellsKind::Blocks) {
        set = sets++;
        world::CellRows legal;
        world::unpack_bits(level.legal, legal);
        std::copy_n(legal.data(), kRows, ground.rows_.data() + size_t{set} * kRows);
      }
      world::LevelView& view = ground.views_[base + i];
      view = level.view;
      if (is_sampled(*zone, i, avatar_class)) {
        ++ground.sample_sets_;
        ground.sample_slot_[base + i] = next_slot;
        uint16_t* samples = ground.samples_of(next_slot++);
        world::unpack_floor(view, samples);
        view.samples = samples;
      }
      LevelLine& line = ground.lines_[base + i];
      line = {};
      line.legal_set = set | (level.step_safe ? kStepSafe : 0);
      line.flat_set = set;
      if (set != kNoneLegal && !view.is_constant()) {
        const bool any =
            find_flat(view, ground.legal(base + i), ground.rows_.data() + size_t{sets} * kRows);
        line.flat_set = any ? sets++ : kNoneLegal;
      }
      line.flat = full_blocks(ground.flat(base + i));
      ground.find_open(base + i);
      const Heights heights = heights_of(view, ground.legal(base + i));
      ground.heights_[base + i] = heights;
      if (set != kNoneLegal && heights.low <= heights.high) {
        if (heights.low < bounds.low || heights.high > bounds.high) {
          return Error{Errc::kBadFile, world::zone_file_name(zone->root().x(), zone->root().z()) +
                                           ": has floors where the world has no triangles; bake "
                                           "the world again"};
        }
        const int32_t rise = max_rise(view);
        if (heights.low - rise < bounds.low || heights.high + rise > bounds.high) {
          const Heights feet = feet_of(view, ground.legal(base + i));
          ground.feet_range_ = {std::min(ground.feet_range_.low, feet.low),
                                std::max(ground.feet_range_.high, feet.high)};
        }
      }
      std::tie(record.tile_x, record.tile_z) = world::tile_of(world, *zone, *level.view.record);
      if (record.tile_x >= ground.tiles_x_ || record.tile_z >= ground.tiles_z_) {
        return Error{Errc::kBadFile, world::zone_file_name(zone->root().x(), zone->root().z()) +
                                         ": has levels outside the world; bake the world again"};
      }
      Range& range =
          ground.tiles_[static_cast<size_t>(record.tile_z) * static_cast<size_t>(ground.tiles_x_) +
                        static_cast<size_t>(record.tile_x)];
      if (range.last == 0) range.first = base + i;
      range.last = base + i + 1;
      if (view.samples != nullptr && is_near != nullptr &&
          !(*is_near)(record.tile_x, record.tile_z)) {
        ground.drop_samples(base + i);
      }
    }
  }
  ground.find_isolated(step_mm);
  ground.find_uneven();
  ground.join_blocks();
  return ground;
}

void CrowdGround::drop_samples(Level level) {
  --sample_sets_;
  views_[level].samples = nullptr;
  samples_.give_back(size_t{sample_slot_[level]} * 4096, 4096);
}

void CrowdGround::keep_near(IsNear is_near) {
  for (Level level = 0; level < sample_slot_.size(); ++level) {
    const uint32_t slot = sample_slot_[level];
    if (slot == kNoSlot) continue;
    world::LevelView& view = views_[level];
    const bool is_wanted = is_near(records_[level].tile_x, records_[level].tile_z);
    if (is_wanted == (view.samples != nullptr)) continue;
    if (!is_wanted) {
      drop_samples(level);
      continue;
    }
    ++sample_sets_;
    world::unpack_floor(view, samples_of(slot));
    view.samples = samples_of(slot);
  }
}

void CrowdGround::find_isolated(int32_t step_mm) {
  for (const Range& range : tiles_) {
    for (uint32_t i = range.first; i < range.last; ++i) {
      bool alone = step_safe(i);
      for (uint32_t j = range.first; j < range.last; ++j) {
        alone &= i == j || heights_[j].low > heights_[i].high + step_mm ||
                 heights_[j].high < heights_[i].low - step_mm;
      }
      lines_[i].legal_set |= alone ? kIsolated : 0;
    }
  }
}

}  // namespace throng::crowd
