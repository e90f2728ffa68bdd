// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "path/edits/ground_view.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <optional>
#include <utility>

#include "core/access.h"
#include "path/edits/blocked_cells.h"
#include "path/edits/plan_shapes.h"
#include "path/ground/baked_cells.h"
#include "path/ground/rects.h"
#include "world/place.h"
#include "world/tile_grid.h"

// Rectangles and portals of one level tile after the other, cut from its cells less those that
// obstacles block; a change makes the levels of its tiles again. Time: linear in the cells of the
// levels that are made; a change also finds the portals of the tiles around its own again.
namespace throng::path {
namespace {

constexpr double kCornerCells = 2;  // by which a change is widened to find tiles across a corner

// Of one that costs less than its length: the cost of a metre of the straight line; else 1.
double link_factor(const GroundView::OffMeshLinkEnd& link) {
  const double length = distance_of(link.from, link.to);
  return link.cost < length ? link.cost / length : 1;
}

int32_t x_of(int64_t tile) { return static_cast<int32_t>(tile); }
int32_t z_of(int64_t tile) { return static_cast<int32_t>(tile >> 32); }

}  // namespace

size_t GroundView::HashCorner::operator()(const CornerKey& key) const {
  uint64_t hash = static_cast<uint32_t>(key.x) * uint64_t{0x9e3779b97f4a7c15};
  hash = (hash ^ static_cast<uint32_t>(key.z)) * 0xbf58476d1ce4e5b9;
  hash ^= uint64_t{key.level} << 4 ^ (key.away_x > 0 ? 2U : 0U) ^ (key.away_z > 0 ? 1U : 0U);
  return static_cast<size_t>(hash ^ hash >> 29);
}

uint32_t GroundView::rect_at(const ViewLevel& level, int32_t x, int32_t z) const {
  for (uint32_t r = level.first_rect; r < level.first_rect + level.rect_count; ++r) {
    const MeshRect& rect = mesh_.rects[r];
    if (x >= rect.x && x < rect.x + rect.width && z >= rect.z && z < rect.z + rect.depth) return r;
  }
  return kNoRect;
}

GroundView::GroundView(World world, const PathConfig& config)
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
  begin_mesh();
}

GroundView::GroundView(const GroundView& other)
    : world_(other.world_),
      config_(other.config_),
      step_(other.step_),
      area_cost_(other.area_cost_),
      slope_factor_(other.slope_factor_),
      min_factor_(other.min_factor_),
      min_link_factor_(other.min_link_factor_),
      plain_(other.plain_),
      density_(other.density_),
      active_links_(other.active_links_),
      levels_(other.levels_.size()),  // rebuilt when first used
      changes_(other.changes_),
      changes_of_tile_(other.changes_of_tile_),
      off_mesh_links_(other.off_mesh_links_) {
  begin_mesh();
}

void GroundView::begin_mesh() {
  mesh_ = {};
  mesh_.avatar_class = config_.avatar_class;
  mesh_.step = step_;
  mesh_.source = this;
}

void GroundView::set_area_cost(uint8_t kind, double cost) {
  if (area_cost_[kind] == cost) return;
  const double min_before = min_factor_;
  const bool was_plain = plain_;
  area_cost_[kind] = cost;
  min_factor_ = *std::min_element(area_cost_.begin(), area_cost_.end());
  find_plain();
  if (min_factor_ != min_before || plain_ != was_plain || has_made(kind)) ++version_;
}

void GroundView::find_plain() {
  plain_ = config_.slope_cost == 0 && (density_ == nullptr || density_->is_even()) &&
           std::all_of(area_cost_.begin(), area_cost_.end(), [](double c) { return c == 1; });
}

// All levels that are rebuilt are dropped first, as for other changes.
void GroundView::set_density(std::shared_ptr<const DensityCells> density) {
  const std::shared_ptr<const DensityCells> before = std::exchange(density_, std::move(density));
  find_plain();
  ++version_;
  touched_tiles_.clear();
  SquareRange all;
  if (before != nullptr && density_ != nullptr) all = density_->changed_tiles(world(), *before);
  if (before == nullptr && density_ != nullptr) all = density_->tiles(world());
  if (before != nullptr && density_ == nullptr) all = before->tiles(world());
  for (int32_t z = all.first_z; z <= all.last_z; ++z) {
    for (int32_t x = all.first_x; x <= all.last_x; ++x) {
      if (is_seen(tile_key(x, z)) && differs_on(x, z, before.get())) {
        touched_tiles_.push_back(tile_key(x, z));
      }
    }
  }
  for (const int64_t tile : touched_tiles_) drop_tile(tile);
  for (const int64_t tile : touched_tiles_) drop_around(tile, all);
  if (corner_numbers_.size() > max_corners_) drop_unused_corners();
}

// Does a map make other ground of a tile than the present one?
bool GroundView::differs_on(int32_t tile_x, int32_t tile_z, const DensityCells* before) const {
  const auto tile = world().tile_levels(tile_x, tile_z);
  for (uint32_t i = tile.first; i < tile.last; ++i) {
    const world::GroundLevel level = world::ground_level(world(), i, config_.avatar_class);
    if (level.zone == nullptr) continue;
    const TileFloor floor{world().summary, level.view, tile_x, tile_z};
    const auto zero = [&](const DensityCells* map) {
      return map == nullptr ? world::CellRows{} : map->zero_cells(floor);
    };
    const auto steps = [&](const DensityCells* map) {
      return map == nullptr ? std::array<uint8_t, 4096>{} : map->steps(floor);
    };
    if (zero(before) != zero(density_.get()) || steps(before) != steps(density_.get())) return true;
  }
  return false;
}

// Is a rectangle that a search may have seen of this kind?
bool GroundView::has_made(uint8_t kind) const {
  return std::any_of(levels_.begin(), levels_.end(), [&](const std::unique_ptr<ViewLevel>& level) {
    if (level == nullptr) return false;
    const auto first = rect_states_.begin() + level->first_rect;
    return std::any_of(first, first + level->rect_count,
                       [&](const RectState& rect) { return rect.area == kind; });
  });
}

bool GroundView::closes_kinds() const {
  return std::any_of(area_cost_.begin(), area_cost_.end(), [](double c) { return std::isinf(c); });
}

ChangeId GroundView::add(Change change) {
  const WorldSummary& summary = world().summary;
  const AvatarClass& avatar = summary.classes[static_cast<size_t>(config_.avatar_class)];
  const SquareRange near =
      tiles_near(world(), change.solid.prism.corners, avatar.radius + summary.cell);
  const auto id = static_cast<ChangeId>(changes_.size() + 1);
  for (int32_t z = near.first_z; z <= near.last_z; ++z) {
    for (int32_t x = near.first_x; x <= near.last_x; ++x) {
      const auto tile = world().tile_levels(x, z);
      if (tile.first == tile.last) continue;
      change.tiles.push_back({tile_key(x, z), {}});
      changes_of_tile_[tile_key(x, z)].push_back(id);
    }
  }
  changes_.push_back(std::move(change));
  forget(changes_.back());
  return id;
}

bool GroundView::set_active(ChangeId id, bool active, bool remove) {
  if (id == 0 || id > changes_.size() || changes_[id - 1].removed) return false;
  Change& change = changes_[id - 1];
  if (change.active != active) {
    change.active = active;
    forget(change);
    for (const LevelLinkEnd& link : change.links) switch_link(link, active);
    for (const LevelLinkEnd& link : change.links) {
      const double factor = link_factor(link.end);
      if (active) min_link_factor_ = std::min(min_link_factor_, factor);
      if (!active && factor < 1 && factor == min_link_factor_) find_min_link_factor();
    }
  }
  if (remove) {
    for (const TileNear& near : change.tiles) std::erase(changes_of_tile_[near.tile], id);
    change = Change{};  // Its id is never used again, its memory is freed.
    change.active = false;
    change.removed = true;
  }
  return true;
}

void GroundView::add_off_mesh_link(uint32_t level, const OffMeshLinkEnd& off_mesh_link) {
  changes_[off_mesh_link.change - 1].links.push_back({level, off_mesh_link});
  off_mesh_links_[level].push_back(off_mesh_link);
  ++active_links_;
  min_link_factor_ = std::min(min_link_factor_, link_factor(off_mesh_link));
  ++version_;
}

void GroundView::find_min_link_factor() {
  min_link_factor_ = 1;
  for (const auto& [level, links] : off_mesh_links_) {
    for (const OffMeshLinkEnd& link : links) {
      min_link_factor_ = std::min(min_link_factor_, link_factor(link));
    }
  }
}

const std::vector<GroundView::OffMeshLinkEnd>& GroundView::links_from(uint32_t level) const {
  static const std::vector<OffMeshLinkEnd> none;
  const auto found = off_mesh_links_.find(level);
  return found == off_mesh_links_.end() ? none : found->second;
}

std::vector<GroundView::LevelLinkEnd> GroundView::active_links() const {
  std::vector<LevelLinkEnd> links;
  for (const Change& change : changes_) {
    if (change.active) links.insert(links.end(), change.links.begin(), change.links.end());
  }
  return links;
}

// Links are kept in the order in which they were made: paths must not depend on when each was
// switched.
void GroundView::switch_link(const LevelLinkEnd& link, bool active) {
  ++version_;
  std::vector<OffMeshLinkEnd>& here = off_mesh_links_[link.level];
  const ChangeId change = link.end.change;
  const auto after =
      std::upper_bound(here.begin(), here.end(), change,
                       [](ChangeId id, const OffMeshLinkEnd& other) { return id < other.change; });
  if (active) {
    here.insert(after, link.end);
    ++active_links_;
  } else {
    // Of a link in both directions on one level, both are erased; the second time there is none.
    active_links_ -=
        std::erase_if(here, [&](const OffMeshLinkEnd& other) { return other.change == change; });
  }
}

bool GroundView::stand(uint32_t index, world::GroundPoint at, uint16_t& rect) {
  const ViewLevel& of = *level(index);
  const int32_t x = at.cell_x(), z = at.cell_z();
  if (of.ground.zone == nullptr || world::tile_along(x) != of.tile_x ||
      world::tile_along(z) != of.tile_z || !of.is_legal(world::in_tile(x), world::in_tile(z)))
    return false;
  const uint32_t number = rect_at(of, x, z);
  rect = static_cast<uint16_t>(number - of.first_rect);
  return std::isfinite(factor(number));
}

// Row by row of tiles, those between the ends of the line's part in the row.
bool GroundView::is_changed(int32_t tile_x, int32_t tile_z) const {
  if (density_ != nullptr) return true;
  const auto found = changes_of_tile_.find(tile_key(tile_x, tile_z));
  return found != changes_of_tile_.end() && !found->second.empty();
}

bool GroundView::is_changed_on(world::GroundPoint from, world::GroundPoint to) const {
  if (changes_of_tile_.empty() && density_ == nullptr) return false;
  constexpr int64_t kSide = int64_t{kTileCells} << world::kUnitBits, kMargin = 2;  // units
  if (to.z < from.z) std::swap(from, to);
  const double slope =
      to.z > from.z ? static_cast<double>(to.x - from.x) / static_cast<double>(to.z - from.z) : 0;
  for (int64_t z = from.z / kSide; z <= to.z / kSide; ++z) {
    int64_t first = from.x, last = to.x;
    if (z * kSide > from.z) first += std::llround(slope * static_cast<double>(z * kSide - from.z));
    if ((z + 1) * kSide < to.z)
      last = from.x + std::llround(slope * static_cast<double>((z + 1) * kSide - from.z));
    if (last < first) std::swap(first, last);
    const int64_t end = (last + kMargin) / kSide;
    for (int64_t x = std::max<int64_t>(first - kMargin, 0) / kSide; x <= end; ++x) {
      if (is_changed(static_cast<int32_t>(x), static_cast<int32_t>(z))) return true;
    }
  }
  return false;
}

// Was a level of a tile made, or one beside it?
bool GroundView::is_seen(int64_t key) const {
  for (int32_t z = z_of(key) - 1; z <= z_of(key) + 1; ++z) {
    for (int32_t x = x_of(key) - 1; x <= x_of(key) + 1; ++x) {
      const auto tile = world().tile_levels(x, z);
      for (uint32_t i = tile.first; i < tile.last; ++i) {
        if (levels_[i] != nullptr) return true;
      }
    }
  }
  return false;
}

// Tiles that are as they were without the change are kept, and what searches know of them. All
// levels that are rebuilt are dropped first: then only others are left whose borders count.
void GroundView::forget(Change& change) {
  touched_tiles_.clear();
  for (TileNear& near : change.tiles) {
    if (!is_seen(near.tile)) continue;
    if (!near.is_touched) {
      near.is_touched =
          touches_tile(change.solid, change.is_area, x_of(near.tile), z_of(near.tile));
    }
    if (*near.is_touched) touched_tiles_.push_back(near.tile);
  }
  if (touched_tiles_.empty()) return;
  for (const int64_t tile : touched_tiles_) drop_tile(tile);
  const WorldSummary& summary = world().summary;
  const AvatarClass& avatar = summary.classes[static_cast<size_t>(config_.avatar_class)];
  const SquareRange reach = tiles_near(world(), change.solid.prism.corners,
                                       taking_reach(avatar) + kCornerCells * summary.cell);
  for (const int64_t tile : touched_tiles_) drop_around(tile, reach);
  ++version_;
  if (corner_numbers_.size() > max_corners_) drop_unused_corners();
}

// The tile's levels are rebuilt when they are needed.
void GroundView::drop_tile(int64_t key) {
  const auto tile = world().tile_levels(x_of(key), z_of(key));
  for (uint32_t i = tile.first; i < tile.last; ++i) {
    if (levels_[i] == nullptr) continue;
    drop(*levels_[i]);
    levels_[i].reset();
    --made_levels_;
  }
}

// What touches a rebuilt tile from beside finds its portals again: they lead to rectangles that get
// other numbers. What touches it at a corner has no portal into it, but a corner of the mesh
// depends on all four cells that share its point. So it counts only if the change can reach the
// cell of the rebuilt tile there, and then `reach`, a cell wider, holds the tile across.
void GroundView::drop_around(int64_t key, const SquareRange& reach) {
  const int32_t x = x_of(key), z = z_of(key);
  for (int32_t dz = -1; dz <= 1; ++dz) {
    for (int32_t dx = -1; dx <= 1; ++dx) {
      const bool is_in_reach = x + dx >= reach.first_x && x + dx <= reach.last_x &&
                               z + dz >= reach.first_z && z + dz <= reach.last_z;
      if (dx != 0 && dz != 0 && !is_in_reach) continue;
      const auto tile = world().tile_levels(x + dx, z + dz);
      for (uint32_t i = tile.first; i < tile.last; ++i) {
        if (levels_[i] != nullptr) drop_border(*levels_[i], -dx, -dz);
      }
    }
  }
}

bool GroundView::touches(const Solid& solid, bool is_area) const {
  const WorldSummary& summary = world().summary;
  const AvatarClass& avatar = summary.classes[static_cast<size_t>(config_.avatar_class)];
  const SquareRange near = tiles_near(world(), solid.prism.corners, avatar.radius + summary.cell);
  for (int32_t z = near.first_z; z <= near.last_z; ++z) {
    for (int32_t x = near.first_x; x <= near.last_x; ++x) {
      if (touches_tile(solid, is_area, x, z)) return true;
    }
  }
  return false;
}

bool GroundView::touches_tile(const Solid& solid, bool is_area, int32_t x, int32_t z) const {
  const WorldSummary& summary = world().summary;
  const AvatarClass& avatar = summary.classes[static_cast<size_t>(config_.avatar_class)];
  const auto tile = world().tile_levels(x, z);
  for (uint32_t i = tile.first; i < tile.last; ++i) {
    const world::GroundLevel level = world::ground_level(world(), i, config_.avatar_class);
    if (level.zone == nullptr) continue;
    const world::CellRows legal = graph::legal_rows(level);
    const TileFloor floor{summary, level.view, x, z};
    const world::CellRows rows =
        is_area ? cells_in(floor, solid.prism)
                : blocked_cells(floor, avatar, solid.prism, solid.triangles, legal.data());
    for (size_t row = 0; row < rows.size(); ++row) {
      if ((rows[row] & legal[row]) != 0) return true;
    }
  }
  return false;
}

const ViewLevel* GroundView::level(uint32_t index) {
  std::unique_ptr<ViewLevel>& level = levels_[index];
  if (level == nullptr) {
    level = std::make_unique<ViewLevel>();
    ++made_levels_;
    make(index, *level);
  }
  return level.get();
}

// The vectors hold up to twice what they need, and the old array beside the new one as they grow.
uint64_t GroundView::made_bytes() const {
  constexpr uint64_t kGrowth = 3, kInMap = 64;
  return made_levels_ * (sizeof(ViewLevel) + 16) +
         kGrowth *
             (mesh_.rects.size() * sizeof(MeshRect) + rect_states_.size() * sizeof(RectState) +
              mesh_.portals.size() * sizeof(MeshPortal) +
              mesh_.corners.size() * sizeof(MeshCorner) +
              mesh_.corner_rects.size() * sizeof(uint32_t) +
              corner_keys_.size() * sizeof(CornerKey)) +
         corner_numbers_.size() * kInMap;
}

void GroundView::trim(uint64_t max_bytes) {
  if (counted_bytes() <= max_bytes) return;
  for (std::unique_ptr<ViewLevel>& level : levels_) level.reset();
  made_levels_ = 0;
  begin_mesh();
  rect_states_ = {};
  rect_blocks_ = {};
  portal_blocks_ = {};
  corner_numbers_ = {};
  corner_keys_ = {};
  free_corners_ = {};
  max_corners_ = 0;
  ++version_;
}

void GroundView::make(uint32_t index, ViewLevel& level) {
  level.ground = world::ground_level(world(), index, config_.avatar_class);
  if (level.ground.zone == nullptr) {  // no avatar stands there
    level.ground.world_level = index;
    return;
  }
  std::tie(level.tile_x, level.tile_z) =
      world::tile_of(world(), *level.ground.zone, *level.ground.view.record);
  level.legal = graph::legal_rows(level.ground);
  block_cells(level);
  cut(level);
}

void GroundView::block_cells(ViewLevel& level) const {
  if (density_ != nullptr) {
    const world::CellRows zero =
        density_->zero_cells({world().summary, level.ground.view, level.tile_x, level.tile_z});
    for (size_t z = 0; z < zero.size(); ++z) level.legal[z] &= ~zero[z];
  }
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

std::array<uint8_t, 4096> GroundView::kinds_of(const ViewLevel& level) const {
  std::array<uint8_t, 4096> kinds = baked_kinds(level.ground);
  const auto found = changes_of_tile_.find(tile_key(level.tile_x, level.tile_z));
  if (found == changes_of_tile_.end()) return kinds;
  const WorldSummary& summary = world().summary;
  const TileFloor floor{summary, level.ground.view, level.tile_x, level.tile_z};
  for (const ChangeId id : found->second) {
    const Change& change = changes_[id - 1];
    if (!change.active || !change.is_area) continue;
    const world::CellRows cells = cells_in(floor, change.solid.prism);
    for (size_t c = 0; c < kinds.size(); ++c) {
      if ((cells[c / 64] >> (c % 64) & 1) != 0) kinds[c] = change.kind;
    }
  }
  return kinds;
}

std::array<uint8_t, 4096> GroundView::slopes_of(const ViewLevel& level) const {
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

std::array<uint8_t, 4096> GroundView::densities_of(const ViewLevel& level) const {
  if (density_ == nullptr || density_->is_even()) return {};
  return density_->steps({world().summary, level.ground.view, level.tile_x, level.tile_z});
}

// Rectangles of one kind of ground each.
void GroundView::cut(ViewLevel& level) {
  const auto cuts = graph::step_cuts(level.ground, level.legal, step_);
  const std::array<uint8_t, 4096> kinds = kinds_of(level), slopes = slopes_of(level),
                                  densities = densities_of(level);
  std::array<bool, size_t{64} * kSlopeClasses * DensityCells::kSteps> done{};
  new_rects_.clear();
  new_states_.clear();
  for (size_t c = 0; c < kinds.size(); ++c) {
    const size_t sort =
        (kinds[c] * size_t{kSlopeClasses} + slopes[c]) * DensityCells::kSteps + densities[c];
    if (done[sort] || !level.is_legal(world::x_of_cell(c), world::z_of_cell(c))) continue;
    done[sort] = true;
    world::CellRows same{};
    for (size_t k = c; k < kinds.size(); ++k) {
      const bool is_same =
          kinds[k] == kinds[c] && slopes[k] == slopes[c] && densities[k] == densities[c];
      if (is_same) same[k / 64] |= uint64_t{1} << (k % 64);
    }
    for (size_t z = 0; z < same.size(); ++z) same[z] &= level.legal[z];
    for (const CellRect& r : tile_with_rects(same, cuts ? &*cuts : nullptr)) {
      new_rects_.push_back({level.ground.world_level, level.tile_x * kTileCells + r.x0,
                            level.tile_z * kTileCells + r.z0, r.x1 - r.x0, r.z1 - r.z0});
      new_states_.push_back({kinds[c], slopes[c], densities[c], false, false, {}});
    }
  }
  level.rect_count = static_cast<uint32_t>(new_rects_.size());
  if (level.rect_count == 0) return;
  level.first_rect = rect_blocks_.take(level.rect_count);
  mesh_.rects.resize(rect_blocks_.end());
  rect_states_.resize(rect_blocks_.end());
  std::copy(new_rects_.begin(), new_rects_.end(), mesh_.rects.begin() + level.first_rect);
  std::copy(new_states_.begin(), new_states_.end(), rect_states_.begin() + level.first_rect);
}

void GroundView::find_portals(uint32_t number) {
  const MeshRect rect = mesh_.rects[number];  // Others may be made now.
  const ViewLevel* of = level(rect.level);
  const Ground ground{*this};
  const MeshBorder border(world(), ground, step_);
  const auto rect_at = [&](const ViewLevel* beyond, int32_t x, int32_t z) {
    return this->rect_at(*beyond, x, z);
  };
  new_portals_.clear();
  border.find_portals(of, rect, rect_at, new_portals_);
  const auto count = static_cast<uint32_t>(new_portals_.size());
  const uint32_t first = count > 0 ? portal_blocks_.take(count) : 0;
  mesh_.portals.resize(portal_blocks_.end());
  for (uint32_t p = 0; p < count; ++p) mesh_.portals[first + p] = new_portals_[p].portal;
  rect_states_[number].portals = {first, count};
  rect_states_[number].has_portals = true;
}

void GroundView::find_corners(uint32_t number) {
  const auto [first, count] = portal_range(number);
  const MeshRect rect = mesh_.rects[number];  // Others may be made now.
  const ViewLevel* of = level(rect.level);
  const Ground ground{*this};
  const MeshBorder border(world(), ground, step_);
  for (uint32_t p = first; p < first + count; ++p) {
    FoundPortal found{mesh_.portals[p], {}, {}};
    border.find_corners(of, rect, found);
    mesh_.portals[p].from_corner = number_of(found.from_corner);
    mesh_.portals[p].to_corner = number_of(found.to_corner);
  }
  rect_states_[number].has_corners = true;
}

uint32_t GroundView::number_of(const std::optional<CornerKey>& corner) {
  if (!corner) return kNoCorner;
  const auto [at, is_new] = corner_numbers_.try_emplace(*corner, kNoCorner);
  if (is_new) {
    if (free_corners_.empty()) {
      free_corners_.push_back(static_cast<uint32_t>(mesh_.corners.size()));
      mesh_.corners.emplace_back();
      corner_keys_.emplace_back();
    }
    at->second = free_corners_.back();
    free_corners_.pop_back();
    mesh_.corners[at->second] = {corner->x, corner->z, corner->away_x, corner->away_z};
    corner_keys_[at->second] = *corner;
  }
  return at->second;
}

void GroundView::drop_portals(uint32_t rect) {
  RectState& state = rect_states_[rect];
  if (!state.has_portals) return;
  state.has_portals = state.has_corners = false;
  if (state.portals.count > 0) portal_blocks_.give_back(state.portals.first, state.portals.count);
}

// The portals of rectangles that touch the side of a level, or the corner, if toward both.
void GroundView::drop_border(const ViewLevel& level, int32_t toward_x, int32_t toward_z) {
  const auto touches = [](int32_t toward, int32_t tile, int32_t first, int32_t cells) {
    return toward == 0 ||
           (toward < 0 ? first == tile * kTileCells : first + cells == (tile + 1) * kTileCells);
  };
  for (uint32_t r = level.first_rect; r < level.first_rect + level.rect_count; ++r) {
    const MeshRect& rect = mesh_.rects[r];
    if (touches(toward_x, level.tile_x, rect.x, rect.width) &&
        touches(toward_z, level.tile_z, rect.z, rect.depth))
      drop_portals(r);
  }
}

void GroundView::drop(ViewLevel& level) {
  if (level.rect_count == 0) return;
  for (uint32_t r = level.first_rect; r < level.first_rect + level.rect_count; ++r) drop_portals(r);
  rect_blocks_.give_back(level.first_rect, level.rect_count);
}

// Those that no portal has any more. Their numbers are used again.
void GroundView::drop_unused_corners() {
  constexpr size_t kMinCorners = 256;
  used_corners_.assign(mesh_.corners.size(), false);
  for (const std::unique_ptr<ViewLevel>& level : levels_) {
    if (level == nullptr) continue;
    for (uint32_t r = level->first_rect; r < level->first_rect + level->rect_count; ++r) {
      const RectState& state = rect_states_[r];
      if (!state.has_corners) continue;
      for (uint32_t p = state.portals.first; p < state.portals.first + state.portals.count; ++p) {
        for (const uint32_t c : {mesh_.portals[p].from_corner, mesh_.portals[p].to_corner})
          if (c != kNoCorner) used_corners_[c] = true;
      }
    }
  }
  for (uint32_t c = 0; c < mesh_.corners.size(); ++c) {
    if (used_corners_[c]) continue;
    const auto found = corner_numbers_.find(corner_keys_[c]);
    if (found == corner_numbers_.end() || found->second != c) continue;  // It is free.
    corner_numbers_.erase(found);
    free_corners_.push_back(c);
  }
  max_corners_ = std::max(kMinCorners, 2 * corner_numbers_.size());
}

}  // namespace throng::path
