// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "path/edits/live_mesh.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <optional>
#include <utility>

#include "core/access.h"
#include "path/edits/blocked_cells.h"
#include "path/edits/plan_shapes.h"
#include "path/ground/rects.h"
#include "world/place.h"
#include "world/tile_grid.h"

// Rectangles and portals of one level tile after the other, cut from its cells less those that
// obstacles block; a change makes the levels of its tiles again.
namespace throng::path {
namespace {

// Of one that costs less than its length: the cost of a metre of the straight line; else 1.
double link_factor(const LiveMesh::OffMeshLinkEnd& link) {
  const double length = distance_of(link.from, link.to);
  return link.cost < length ? link.cost / length : 1;
}

int64_t tile_key(int32_t x, int32_t z) { return (int64_t{z} << 32) | static_cast<uint32_t>(x); }

}  // namespace

uint16_t LiveLevel::rect_at(int32_t x, int32_t z) const {
  size_t r = 0;
  while (x < rects[r].x0 || x >= rects[r].x1 || z < rects[r].z0 || z >= rects[r].z1) ++r;
  return static_cast<uint16_t>(r);
}

LiveMesh::LiveMesh(World world, const PathConfig& config)
    : world_(std::move(world)),
      config_(config),
      step_(world::step_mm(
          data_of(world_)->summary.classes[static_cast<size_t>(config.avatar_class)])),
      levels_(data_of(world_)->level_count) {
  area_cost_.fill(1);
  for (size_t s = 0; s < slope_factor_.size(); ++s) {
    // The gentlest class holds level ground: no extra cost.
    slope_factor_[s] = 1 + (s == 0 ? 0 : config.slope_cost * kSteepestOf[s]);
  }
  plain_ = config.slope_cost == 0;
}

LiveMesh::LiveMesh(const LiveMesh& other)
    : world_(other.world_),
      config_(other.config_),
      step_(other.step_),
      area_cost_(other.area_cost_),
      slope_factor_(other.slope_factor_),
      min_factor_(other.min_factor_),
      min_link_factor_(other.min_link_factor_),
      plain_(other.plain_),
      levels_(other.levels_.size()),  // rebuilt when first used
      changes_(other.changes_),
      changes_of_tile_(other.changes_of_tile_),
      off_mesh_links_(other.off_mesh_links_) {}

void LiveMesh::set_area_cost(uint8_t kind, double cost) {
  ++version_;
  area_cost_[kind] = cost;
  min_factor_ = *std::min_element(area_cost_.begin(), area_cost_.end());
  plain_ = config_.slope_cost == 0 &&
           std::all_of(area_cost_.begin(), area_cost_.end(), [](double c) { return c == 1; });
}

ChangeId LiveMesh::add(Change change) {
  const WorldSummary& summary = world().summary;
  const AvatarClass& avatar = summary.classes[static_cast<size_t>(config_.avatar_class)];
  const SquareRange near =
      tiles_near(world(), change.solid.prism.corners, avatar.radius + summary.cell);
  const auto id = static_cast<ChangeId>(changes_.size() + 1);
  for (int32_t z = near.first_z; z <= near.last_z; ++z) {
    for (int32_t x = near.first_x; x <= near.last_x; ++x) {
      const auto tile = world().tile_levels(x, z);
      if (tile.first == tile.last) continue;
      change.tiles.push_back(tile_key(x, z));
      changes_of_tile_[tile_key(x, z)].push_back(id);
    }
  }
  changes_.push_back(std::move(change));
  for (const int64_t tile : changes_.back().tiles) forget(tile);
  return id;
}

bool LiveMesh::set_active(ChangeId id, bool active, bool remove) {
  if (id == 0 || id > changes_.size() || changes_[id - 1].removed) return false;
  Change& change = changes_[id - 1];
  if (change.active != active) {
    change.active = active;
    for (const int64_t tile : change.tiles) forget(tile);
    for (const LevelLinkEnd& link : change.links) switch_link(link, active);
    for (const LevelLinkEnd& link : change.links) {
      const double factor = link_factor(link.end);
      if (active) min_link_factor_ = std::min(min_link_factor_, factor);
      if (!active && factor < 1 && factor == min_link_factor_) find_min_link_factor();
    }
  }
  if (remove) {
    for (const int64_t tile : change.tiles) std::erase(changes_of_tile_[tile], id);
    change = Change{};  // Its id is never used again, its memory is freed.
    change.active = false;
    change.removed = true;
  }
  return true;
}

void LiveMesh::add_off_mesh_link(uint32_t level, const OffMeshLinkEnd& off_mesh_link) {
  changes_[off_mesh_link.change - 1].links.push_back({level, off_mesh_link});
  off_mesh_links_[level].push_back(off_mesh_link);
  min_link_factor_ = std::min(min_link_factor_, link_factor(off_mesh_link));
  ++version_;
}

void LiveMesh::find_min_link_factor() {
  min_link_factor_ = 1;
  for (const auto& [level, links] : off_mesh_links_) {
    for (const OffMeshLinkEnd& link : links) {
      min_link_factor_ = std::min(min_link_factor_, link_factor(link));
    }
  }
}

const std::vector<LiveMesh::OffMeshLinkEnd>& LiveMesh::links_from(uint32_t level) const {
  static const std::vector<OffMeshLinkEnd> none;
  const auto found = off_mesh_links_.find(level);
  return found == off_mesh_links_.end() ? none : found->second;
}

// Links are kept in the order in which they were made: paths must not depend on when each was
// switched.
void LiveMesh::switch_link(const LevelLinkEnd& link, bool active) {
  ++version_;
  std::vector<OffMeshLinkEnd>& here = off_mesh_links_[link.level];
  const ChangeId change = link.end.change;
  const auto after =
      std::upper_bound(here.begin(), here.end(), change,
                       [](ChangeId id, const OffMeshLinkEnd& other) { return id < other.change; });
  if (active) {
    here.insert(after, link.end);
  } else {
    // Of a link in both directions on one level, both are erased; the second time there is none.
    std::erase_if(here, [&](const OffMeshLinkEnd& other) { return other.change == change; });
  }
}

bool LiveMesh::stand(uint32_t index, world::GroundPoint at, uint16_t& rect) {
  const LiveLevel& of = *level(index);
  const int32_t x = at.cell_x(), z = at.cell_z();
  if (of.ground.zone == nullptr || world::tile_along(x) != of.tile_x ||
      world::tile_along(z) != of.tile_z || !of.is_legal(world::in_tile(x), world::in_tile(z)))
    return false;
  rect = of.rect_at(world::in_tile(x), world::in_tile(z));
  return std::isfinite(factor(of.rects[rect]));
}

// The tile's levels are rebuilt; those beside it find their portals again.
void LiveMesh::forget(int64_t key) {
  ++version_;
  const auto x = static_cast<int32_t>(key), z = static_cast<int32_t>(key >> 32);
  for (int32_t dz = -1; dz <= 1; ++dz) {
    for (int32_t dx = -1; dx <= 1; ++dx) {
      if (std::abs(dx) + std::abs(dz) > 1) continue;
      const auto tile = world().tile_levels(x + dx, z + dz);
      for (uint32_t i = tile.first; i < tile.last; ++i) {
        if (dx == 0 && dz == 0) levels_[i].reset();
        if (levels_[i] == nullptr) continue;
        levels_[i]->has_portals = false;
      }
    }
  }
}

const LiveLevel* LiveMesh::level(uint32_t index) {
  std::unique_ptr<LiveLevel>& level = levels_[index];
  if (level == nullptr) {
    level = std::make_unique<LiveLevel>();
    make(index, *level);
  }
  return level.get();
}

const LiveLevel* LiveMesh::level_with_portals(uint32_t index) {
  level(index);
  LiveLevel& level = *levels_[index];
  if (!level.has_portals) find_portals(level);
  return &level;
}

void LiveMesh::make(uint32_t index, LiveLevel& level) const {
  level.ground = world::ground_level(world(), index, config_.avatar_class);
  if (level.ground.zone == nullptr) {  // no avatar stands there
    level.ground.world_level = index;
    level.rects.emplace_back();
    level.has_portals = true;
    return;
  }
  std::tie(level.tile_x, level.tile_z) =
      world::tile_of(world(), *level.ground.zone, *level.ground.view.record);
  level.legal = graph::legal_rows(level.ground);
  block_cells(level);
  cut(level);
}

void LiveMesh::block_cells(LiveLevel& level) const {
  const auto found = changes_of_tile_.find(tile_key(level.tile_x, level.tile_z));
  if (found == changes_of_tile_.end()) return;
  const WorldSummary& summary = world().summary;
  const AvatarClass& avatar = summary.classes[static_cast<size_t>(config_.avatar_class)];
  const TileFloor floor{summary, level.ground.view, level.tile_x, level.tile_z};
  for (const ChangeId id : found->second) {
    const Change& change = changes_[id - 1];
    if (!change.active || change.is_area) continue;
    const world::CellRows blocked = blocked_cells(floor, avatar, change.solid.prism,
                                                  change.solid.triangles, level.legal.data());
    for (size_t z = 0; z < blocked.size(); ++z) level.legal[z] &= ~blocked[z];
  }
}

std::array<uint8_t, 4096> LiveMesh::kinds_of(const LiveLevel& level) const {
  std::array<uint8_t, 4096> kinds;
  const format::Level& record = *level.ground.view.record;
  kinds.fill(record.area_value());
  if (record.area_kind() == format::CellsKind::Blocks) {
    std::array<uint16_t, 4096> values;
    world::unpack_values(level.ground.zone->words(record.area_offset()), values.data());
    for (size_t c = 0; c < kinds.size(); ++c)
      kinds[c] = static_cast<uint8_t>(values[c] & world::kLastAreaKind);
  }
  const auto found = changes_of_tile_.find(tile_key(level.tile_x, level.tile_z));
  if (found == changes_of_tile_.end()) return kinds;
  const WorldSummary& summary = world().summary;
  const TileFloor floor{summary, level.ground.view, level.tile_x, level.tile_z};
  for (const ChangeId id : found->second) {
    const Change& change = changes_[id - 1];
    if (!change.active || !change.is_area) continue;
    const SquareRange cells = cells_near(floor, change.solid.prism.corners, kHeightRounding);
    for (int32_t z = cells.first_z; z <= cells.last_z; ++z) {
      for (int32_t x = cells.first_x; x <= cells.last_x; ++x) {
        if (!level.is_legal(x, z)) continue;
        const double feet = level.ground.view.sample(x, z) * 1e-3;
        if (feet < change.solid.prism.low || feet > change.solid.prism.high) continue;
        const double mx = summary.origin.x + (level.tile_x * kTileCells + x + 0.5) * summary.cell;
        const double mz = summary.origin.z + (level.tile_z * kTileCells + z + 0.5) * summary.cell;
        if (is_nearer({mx, mz, mx, mz}, change.solid.prism.corners, 1e-9))
          kinds[static_cast<size_t>(z * 64 + x)] = change.kind;
      }
    }
  }
  return kinds;
}

std::array<uint8_t, 4096> LiveMesh::slopes_of(const LiveLevel& level) const {
  std::array<uint8_t, 4096> slopes{};
  if (config_.slope_cost == 0) return slopes;
  const double cell = world().summary.cell * 1000;
  for (size_t c = 0; c < slopes.size(); ++c) {
    const auto x = world::x_of_cell(c), z = world::z_of_cell(c);
    if (!level.is_legal(x, z)) continue;
    const auto [gx, gz] = rise_at(level.ground.view, x, z);
    const double rise = std::sqrt(static_cast<double>(gx) * gx + static_cast<double>(gz) * gz);
    while (slopes[c] + 1 < kSlopeClasses && rise > kSteepestOf[slopes[c]] * cell) ++slopes[c];
  }
  return slopes;
}

// Rectangles of one kind of ground each.
void LiveMesh::cut(LiveLevel& level) const {
  const auto cuts = graph::step_cuts(level.ground, level.legal, step_);
  const std::array<uint8_t, 4096> kinds = kinds_of(level), slopes = slopes_of(level);
  std::array<bool, 64 * kSlopeClasses> done{};
  for (size_t c = 0; c < kinds.size(); ++c) {
    const size_t sort = kinds[c] * size_t{kSlopeClasses} + slopes[c];
    if (done[sort] || !level.is_legal(world::x_of_cell(c), world::z_of_cell(c))) continue;
    done[sort] = true;
    world::CellRows same{};
    for (size_t k = c; k < kinds.size(); ++k) {
      if (kinds[k] == kinds[c] && slopes[k] == slopes[c]) same[k / 64] |= uint64_t{1} << (k % 64);
    }
    for (size_t z = 0; z < same.size(); ++z) same[z] &= level.legal[z];
    for (const CellRect& r : tile_with_rects(same, cuts ? &*cuts : nullptr)) {
      level.rects.push_back({static_cast<int16_t>(r.x0), static_cast<int16_t>(r.z0),
                             static_cast<int16_t>(r.x1), static_cast<int16_t>(r.z1), kinds[c],
                             slopes[c], 0});
    }
  }
  level.rects.emplace_back();
}

void LiveMesh::find_portals(LiveLevel& level) {
  level.portals.clear();
  const Ground ground{*this};
  for (size_t r = 0; r + 1 < level.rects.size(); ++r) {
    LiveRect& rect = level.rects[r];
    rect.first_portal = static_cast<uint32_t>(level.portals.size());
    const auto side = [&](int32_t dx, int32_t dz) {
      const int32_t begin = dx == 0 ? rect.x0 : rect.z0, end = dx == 0 ? rect.x1 : rect.z1;
      bool joined = false;
      for (int32_t i = begin; i < end; ++i) {
        const int32_t x = level.tile_x * kTileCells + (dx == 0  ? i
                                                       : dx > 0 ? rect.x1 - 1
                                                                : rect.x0);
        const int32_t z = level.tile_z * kTileCells + (dz == 0  ? i
                                                       : dz > 0 ? rect.z1 - 1
                                                                : rect.z0);
        const auto there = world::step_to(ground, &level, x, z, x + dx, z + dz, step_);
        const auto back =
            there ? world::step_to(ground, *there, x + dx, z + dz, x, z, step_) : std::nullopt;
        if (!back || *back != &level) {
          joined = false;
          continue;
        }
        const uint16_t to_rect = (*there)->rect_at(world::in_tile(x + dx), world::in_tile(z + dz));
        const uint32_t to_level = (*there)->ground.world_level;
        if (joined && level.portals.back().to_level == to_level &&
            level.portals.back().to_rect == to_rect) {
          ++level.portals.back().to;
        } else {
          level.portals.push_back({to_level, to_rect, static_cast<int8_t>(dx),
                                   static_cast<int8_t>(dz), static_cast<int16_t>(i),
                                   static_cast<int16_t>(i + 1)});
        }
        joined = true;
      }
    };
    side(0, -1);
    side(1, 0);
    side(0, 1);
    side(-1, 0);
  }
  level.rects.back().first_portal = static_cast<uint32_t>(level.portals.size());
  level.has_portals = true;
}

}  // namespace throng::path
