// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "throng/world.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <system_error>
#include <tuple>

#include "core/hash.h"
#include "core/random.h"
#include "world/air_data.h"
#include "world/cell_blocks.h"
#include "world/ground.h"
#include "world/place.h"
#include "world/sealed_file.h"
#include "world/tile_grid.h"
#include "world/world_part.h"
#include "world/zone_data.h"

// The public queries of a world: places, moves, levels, random places.
namespace throng {
namespace {

bool good_class(const world::WorldData& world, int32_t avatar_class) {
  return avatar_class >= 0 && static_cast<size_t>(avatar_class) < world.summary.classes.size();
}

// Legal cells of a class before each level, and in all at the end.
const std::vector<uint64_t>& cells_before(const world::WorldData& world, int32_t avatar_class) {
  world::ClassIndex& index = *world.class_index[static_cast<size_t>(avatar_class)];
  std::call_once(index.once, [&] {
    index.cells_before.push_back(0);
    for (size_t s = 0; s < world.slots.size(); ++s) {
      const world::Zone* zone = world.zone(s);
      for (uint32_t i = 0; i < world.slots[s]->entry.levels(); ++i) {
        const uint64_t cells =
            zone == nullptr ? 0
                            : zone->clearance(i, static_cast<uint32_t>(avatar_class)).legal_cells();
        index.cells_before.push_back(index.cells_before.back() + cells);
      }
    }
  });
  return index.cells_before;
}

}  // namespace

Result<World> World::open(const std::string& path, const WorldConfig& config) {
  const std::string name = path + "/manifest.thm";
  auto map = FileMap::open(name);
  if (!map) {
    std::error_code failed;  // What is there must not be written over.
    const std::string output = std::filesystem::exists(path, failed) ? "WORLD.throng" : path;
    return Error{Errc::kBadFile, path +
                                     ": not a baked world (no manifest.thm); make one with "
                                     "`throng bake MODEL -o " +
                                     output + "`"};
  }
  auto world = world::read_manifest(map->bytes(), name);
  if (!world) return world.error();
  (*world)->path = path;
  (*world)->budget = config.resident_bytes;
  if (config.part) {
    if (auto ok = world::keep_part(**world, *config.part); !ok) return ok.error();
  }
  const auto manifest = world::unsealed(map->bytes(), name);
  if (!manifest) return manifest.error();
  (*world)->manifest_hash = hash_span(*manifest);
  (*world)->summary.hash = (*world)->manifest_hash;
  const std::string air_name = path + "/" + world::kAirManifest;
  if (const auto air_map = FileMap::open(air_name)) {
    auto air =
        world::read_air_manifest(air_map->bytes(), air_name, **world, (*world)->manifest_hash);
    if (!air) return air.error();
    if (const auto whole = world::unsealed(air_map->bytes(), air_name); !whole)
      return whole.error();
    (*air)->path = path;
    if ((*world)->part) world::keep_part(**air, *(*world)->part);
    for (size_t c = 0; c < (*world)->summary.classes.size(); ++c) {
      (*world)->summary.classes[c].flies = ((*air)->shape.flies >> c & 1) != 0;
    }
    (*world)->air = std::move(*air);
  }
  return World(std::move(*world));
}

Result<void> World::check_ground() const {
  THRONG_ASSERT(state_);
  for (size_t s = 0; s < state_->slots.size(); ++s) {
    if (state_->zone(s) == nullptr) return Error{Errc::kBadFile, state_->slots[s]->error};
  }
  return {};
}

Result<void> World::check_touched() const {
  THRONG_ASSERT(state_);
  for (const auto& slot : state_->slots) {
    if (!slot->error.empty()) return Error{Errc::kBadFile, slot->error};
  }
  return {};
}

Result<void> World::check_all() const {
  if (auto ok = check_ground(); !ok) return ok;
  if (state_->air == nullptr) return world::check_air_index(*state_);
  for (const auto& slot : state_->air->slots) {
    if (!state_->air->zone(slot->entry.x(), slot->entry.z()).usable) {
      return Error{Errc::kBadFile, slot->error};
    }
  }
  return {};
}

WorldSummary World::summary() const {
  THRONG_ASSERT(state_);
  return state_->summary;
}

WorldResidency World::residency() const {
  THRONG_ASSERT(state_);
  const std::lock_guard lock(state_->residency);
  return {state_->resident_zones, state_->resident_bytes};
}

std::optional<int32_t> World::find_class(const std::string& name) const {
  const auto& classes = state_->summary.classes;
  for (size_t c = 0; c < classes.size(); ++c) {
    if (classes[c].name == name) return static_cast<int32_t>(c);
  }
  return std::nullopt;
}

uint32_t World::level_tile_count() const { return state_->level_count; }

LevelTileContent World::level_tile(uint32_t index) const {
  THRONG_ASSERT(index < state_->level_count);
  LevelTileContent out;
  out.floor.assign(world::kTileArea, kNoFloor);
  out.ceiling.assign(world::kTileArea, kOpenSky);
  out.area.assign(world::kTileArea, 0);
  out.clearance.assign(state_->summary.classes.size(), std::vector<uint8_t>(world::kTileArea, 0));
  const size_t slot = state_->slot_of_level(index);
  const world::Zone* zone = state_->zone(slot);
  if (zone == nullptr) return out;
  const uint32_t local = index - state_->slots[slot]->first_level;
  const format::Level& level = zone->level(local);
  std::tie(out.tile_x, out.tile_z) = world::tile_of(*state_, *zone, level);
  const world::LevelView view = zone->view(local);
  const uint64_t* ceilings = level.ceiling_kind() == format::HeightKind::Blocks
                                 ? zone->words(level.ceiling_offset())
                                 : nullptr;
  const uint64_t* areas =
      level.area_kind() == format::CellsKind::Blocks ? zone->words(level.area_offset()) : nullptr;
  for (int32_t c = 0; c < world::kTileArea; ++c) {
    const int32_t x = world::x_of_cell(c), z = world::z_of_cell(c);
    const size_t i = static_cast<size_t>(c);
    if (!view.has(x, z)) continue;
    out.floor[i] = view.sample(x, z);
    out.area[i] = areas != nullptr
                      ? static_cast<uint8_t>(world::value_at(areas, x, z) & world::kLastAreaKind)
                      : level.area_value();
    if (level.ceiling_kind() == format::HeightKind::Constant) out.ceiling[i] = level.ceiling_base();
    if (ceilings == nullptr) continue;
    const uint16_t ceiling = world::value_at(ceilings, x, z);
    if (ceiling != world::kNoValue) out.ceiling[i] = level.ceiling_base() + ceiling;
  }
  for (size_t k = 0; k < out.clearance.size(); ++k) {
    const format::Clearance& clearance = zone->clearance(local, static_cast<uint32_t>(k));
    if (clearance.kind() == format::CellsKind::All) out.clearance[k].assign(world::kTileArea, 8);
    if (clearance.kind() != format::CellsKind::Blocks) continue;
    std::array<world::CellRows, 4> sets;  // legal, and the three bits of the margin
    const uint64_t* words = zone->words(clearance.offset());
    for (world::CellRows& rows : sets) {
      world::unpack_bits(words, rows);
      words += world::bit_words(words);
    }
    for (size_t c = 0; c < world::kTileArea; ++c) {
      const auto bit = [&](size_t set) {
        return static_cast<uint8_t>((sets[set][world::z_of_cell(c)] >> world::x_of_cell(c)) & 1);
      };
      if (bit(0) != 0) {
        out.clearance[k][c] = static_cast<uint8_t>(1 + bit(1) + 2 * bit(2) + 4 * bit(3));
      }
    }
  }
  return out;
}

Place World::find_place(int32_t avatar_class, Vec3d position, double vertical_tolerance) const {
  if (!good_class(*state_, avatar_class) || !std::isfinite(position.x + position.y + position.z))
    return {};
  const world::GroundPoint p = world::to_ground(*state_, position.x, position.z);
  if (!world::in_grid(*state_, p)) return {};
  const auto tile =
      state_->tile_levels(world::tile_along(p.cell_x()), world::tile_along(p.cell_z()));
  Place best;
  double best_distance = vertical_tolerance;
  for (uint32_t i = tile.first; i < tile.last; ++i) {
    const world::GroundLevel level =
        world::ground_level(*tile.zone, tile.zone_first + i - tile.first, i, avatar_class);
    if (!level.is_legal(world::in_tile(p.cell_x()), world::in_tile(p.cell_z()))) continue;
    const double feet_height = world::feet_at(level, p);
    const double distance = std::fabs(feet_height - position.y);
    if (distance > best_distance) continue;
    best_distance = distance;
    best = {{position.x, feet_height, position.z}, i + 1};
  }
  return best;
}

Place World::random_place(int32_t avatar_class, uint64_t seed, uint64_t n) const {
  if (!good_class(*state_, avatar_class)) return {};
  const std::vector<uint64_t>& before = cells_before(*state_, avatar_class);
  if (before.back() == 0) return {};
  const uint64_t pick = random_below(seed, n, 0, before.back());
  const auto level_index = static_cast<uint32_t>(
      std::upper_bound(before.begin(), before.end(), pick) - before.begin() - 1);
  auto rank = static_cast<uint32_t>(pick - before[level_index]);
  const world::GroundLevel level = world::ground_level(*state_, level_index, avatar_class);
  if (level.legal != nullptr) rank = world::nth_bit(level.legal, rank);
  const int32_t x = world::x_of_cell(rank), z = world::z_of_cell(rank);
  const auto [tile_x, tile_z] = world::tile_of(*state_, *level.zone, *level.view.record);
  const int64_t cell_x = int64_t{tile_x} * kTileCells + x,
                cell_z = int64_t{tile_z} * kTileCells + z;
  const world::GroundPoint p{(cell_x << world::kUnitBits) + static_cast<int64_t>(random_below(
                                                                seed, n, 1, world::kUnitsPerCell)),
                             (cell_z << world::kUnitBits) + static_cast<int64_t>(random_below(
                                                                seed, n, 2, world::kUnitsPerCell))};
  return world::place_at(*state_, level, p);
}

MoveResult World::move(int32_t avatar_class, const Place& from, double dx, double dz) const {
  MoveResult result{from, MoveEnd::kBlocked};
  if (!good_class(*state_, avatar_class) || !std::isfinite(dx + dz)) return result;
  const auto start = world::ground_point(*state_, from);
  if (!start) return result;
  const Vec3d goal{from.position.x + dx, 0, from.position.z + dz};
  const world::GroundPoint end = world::to_ground(*state_, goal.x, goal.z);
  if (!world::in_grid(*state_, end)) return result;
  world::GroundLevel level = world::ground_level(*state_, from.level1 - 1, avatar_class);
  if (!level.is_legal(world::in_tile(start->cell_x()), world::in_tile(start->cell_z())))
    return result;
  const int32_t step = world::step_mm(state_->summary.classes[static_cast<size_t>(avatar_class)]);
  if (!world::walk(world::WorldGround{*state_, avatar_class}, level, *start, end, step))
    return result;
  result.place = {{goal.x, world::feet_at(level, end), goal.z}, level.world_level + 1};
  result.end = MoveEnd::kArrived;
  return result;
}

double World::feet(const Place& place) const {
  if (!place || place.level1 > state_->level_count) return place.position.y;
  const world::GroundLevel level = world::ground_level(*state_, place.level1 - 1, 0);
  const world::GroundPoint p = world::to_ground(*state_, place.position.x, place.position.z);
  if (level.zone == nullptr || !world::in_grid(*state_, p)) return place.position.y;
  return world::feet_at(level, p);
}

}  // namespace throng
