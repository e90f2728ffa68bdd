// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <unordered_map>
#include <vector>

#include "core/access.h"
#include "graph/ground_parts.h"
#include "path/edits/blocked_cells.h"
#include "path/edits/density_cells.h"
#include "path/edits/ground_delays.h"
#include "path/edits/index_blocks.h"
#include "path/edits/solid.h"
#include "path/ground/cells.h"
#include "path/ground/mesh.h"
#include "path/ground/mesh_border.h"
#include "throng/path.h"
#include "world/ground.h"

/// The ground of a GroundFinder, level by level, made on first use.
namespace throng::path {

inline constexpr int32_t kSlopeClasses = 6;
inline constexpr std::array<double, kSlopeClasses> kSteepestOf{0.05, 0.1, 0.2, 0.35, 0.6, 1.2};

/// A level tile as it is now.
struct ViewLevel {
  world::GroundLevel ground;
  int32_t tile_x = 0, tile_z = 0;
  world::CellRows legal{};
  uint32_t first_rect = 0, rect_count = 0;  // of the mesh

  [[nodiscard]] bool is_legal(int32_t x, int32_t z) const {
    return ((legal[static_cast<size_t>(z)] >> x) & 1) != 0;
  }
};

inline double distance_of(world::GroundPoint a, world::GroundPoint b) {  // [cells]
  const auto dx = static_cast<double>(a.x - b.x), dz = static_cast<double>(a.z - b.z);
  return std::sqrt(dx * dx + dz * dz) * (1.0 / world::kUnitsPerCell);
}

inline world::GroundPoint middle_of_cell(int32_t x, int32_t z) {
  constexpr int64_t kHalf = world::kUnitsPerCell / 2;
  return {(int64_t{x} << world::kUnitBits) + kHalf, (int64_t{z} << world::kUnitBits) + kHalf};
}

/// Levels and the changes made to them, as a mesh whose parts are made when they are needed. Copies
/// share nothing.
class GroundView final : public PortalSource {
 public:
  GroundView(World world, const PathConfig& config);
  GroundView(const GroundView& other);
  GroundView(GroundView&&) = delete;
  GroundView& operator=(const GroundView&) = delete;
  GroundView& operator=(GroundView&&) = delete;
  ~GroundView() = default;

  [[nodiscard]] const world::WorldData& world() const { return *data_of(world_); }
  [[nodiscard]] int32_t avatar_class() const { return config_.avatar_class; }
  [[nodiscard]] int32_t step() const { return step_; }

  /// Rises where a change concerns what a search may have seen: cells of tiles whose levels, or
  /// those beside them, were made, off-mesh links, costs of ground that was made. Also where a cost
  /// changes what searches go by from their beginning: is_plain() or min_factor().
  [[nodiscard]] uint64_t version() const { return version_; }
  /// Without legal cells if its zone cannot be used.
  const ViewLevel* level(uint32_t index);
  /// Of the ground that was made, if PathConfig::counts_ground; else 0. [bytes]
  [[nodiscard]] uint64_t counted_bytes() const override {
    return config_.counts_ground ? made_bytes() : 0;
  }
  /// Forgets all ground that was made if that takes more. It is made again when it is needed.
  void trim(uint64_t max_bytes);
  /// The rectangles of the levels that were made, of one area kind and one class of inclination
  /// each. Their numbers are valid until the next change.
  [[nodiscard]] const PathMesh& rects() const { return mesh_; }
  [[nodiscard]] const MeshRect& rect(const ViewLevel& level, uint32_t n) const {
    return mesh_.rects[level.first_rect + size_t{n}];
  }
  /// Of a legal cell of the grid that lies on the level.
  [[nodiscard]] uint32_t rect_at(const ViewLevel& level, int32_t x, int32_t z) const;
  std::span<const MeshPortal> portals_of(uint32_t rect) override {
    if (!rect_states_[rect].has_corners) find_corners(rect);
    const IndexRange at = rect_states_[rect].portals;
    return {mesh_.portals.data() + at.first, at.count};
  }
  /// Of the mesh's portals, those of a rectangle, which are made now if they are not yet. Their
  /// corners may be missing: only paths over corners need them, and each takes some ten steps.
  struct IndexRange {
    uint32_t first = 0, count = 0;
  };
  IndexRange portal_range(uint32_t rect) {
    if (!rect_states_[rect].has_portals) find_portals(rect);
    return rect_states_[rect].portals;
  }
  /// Cost of a metre on a rectangle.
  [[nodiscard]] double factor(uint32_t rect) const {
    const RectState& state = rect_states_[rect];
    return area_cost_[state.area] * slope_factor_[state.slope] * DensityCells::cost(state.density);
  }
  [[nodiscard]] double factor(const ViewLevel& level, uint32_t n) const {
    return factor(level.first_rect + n);
  }
  [[nodiscard]] bool closes_kinds() const;  // does ground of some area kind cost infinity?
  /// Of a legal cell of a level's tile: does it?
  [[nodiscard]] bool is_closed(const ViewLevel& level, int32_t x, int32_t z) const;
  /// An active obstacle that blocks a cell of a level's tile, or the last of the active areas that
  /// hold it; 0: there is none.
  [[nodiscard]] ChangeId obstacle_at(const ViewLevel& level, int32_t x, int32_t z) const;
  [[nodiscard]] ChangeId area_at(const ViewLevel& level, int32_t x, int32_t z) const;
  [[nodiscard]] bool is_plain() const { return plain_; }  // a metre costs 1 everywhere
  [[nodiscard]] bool has_links() const { return active_links_ > 0; }
  /// No path costs less than its length in the plane times this.
  [[nodiscard]] double min_factor() const { return std::min(min_factor_, min_link_factor_); }
  /// While these are set, searches over points and costs of segments go by them. Null: none.
  void set_delays(const GroundDelays* delays) { delays_ = delays; }
  [[nodiscard]] const GroundDelays* delays() const { return delays_; }
  /// Of a segment within a level, times the delays there. [cells]
  [[nodiscard]] double length_now(uint32_t level, world::GroundPoint from,
                                  world::GroundPoint to) const {
    return delays_ == nullptr ? distance_of(from, to) : delays_->length(level, from, to);
  }
  void set_area_cost(uint8_t kind, double cost);
  [[nodiscard]] double area_cost(uint8_t kind) const { return area_cost_[kind]; }
  /// From now on this map applies, or none. Drops the tiles that differ.
  void set_density(std::shared_ptr<const DensityCells> density);

  /// An off-mesh link in one direction, as long as the change is active.
  struct OffMeshLinkEnd {
    ChangeId change = 0;
    world::GroundPoint from, to;
    uint32_t to_level = 0;
    double cost = 0;  // [cells]
  };
  struct LevelLinkEnd {
    uint32_t level = 0;  // from which it leads
    OffMeshLinkEnd end;
  };
  struct TileNear {
    int64_t tile = 0;
    std::optional<bool> is_touched;  // touches_tile(), once that was asked
  };
  struct Change {
    bool active = true, removed = false;
    bool is_area = false;
    uint8_t kind = 0;
    Solid solid;                      // of an area: its prism
    std::vector<TileNear> tiles;      // that it may touch
    std::vector<LevelLinkEnd> links;  // of an off-mesh link
  };
  ChangeId add(Change change);
  /// From a level. [links of a change are added right after it]
  void add_off_mesh_link(uint32_t level, const OffMeshLinkEnd& off_mesh_link);
  /// Those that are active now.
  [[nodiscard]] const std::vector<OffMeshLinkEnd>& links_from(uint32_t level) const;
  /// All that are active now, in the order in which they were made.
  [[nodiscard]] std::vector<LevelLinkEnd> active_links() const;
  /// Can the class stand at a point of a level now? In which rectangle?
  bool stand(uint32_t level, world::GroundPoint at, uint16_t& rect);
  bool set_active(ChangeId change, bool active, bool remove);
  [[nodiscard]] const Change& change(ChangeId id) const { return changes_[id - 1]; }
  /// Would an obstacle or an area change any cell where the class may stand? Time: the tiles that
  /// it touches.
  [[nodiscard]] bool touches(const Solid& solid, bool is_area) const;
  /// May a change touch a tile, active or not?
  [[nodiscard]] bool is_changed(int32_t tile_x, int32_t tile_z) const;
  /// Does a line lead over a tile that a change may touch, active or not?
  [[nodiscard]] bool is_changed_on(world::GroundPoint from, world::GroundPoint to) const;

  /// As world/walk.h needs it.
  struct Ground {
    using Level = const ViewLevel*;
    GroundView& mesh;
    [[nodiscard]] Level level(uint32_t number) const { return mesh.level(number); }
    [[nodiscard]] static uint32_t number(Level level) { return level->ground.world_level; }
    [[nodiscard]] static bool is_legal(Level level, int32_t x, int32_t z) {
      return level->is_legal(x, z);
    }
    [[nodiscard]] static int32_t sample(Level level, int32_t x, int32_t z) {
      return level->ground.view.sample(x, z);
    }
    [[nodiscard]] static bool step_safe(Level level) { return level->ground.step_safe; }
    template <class Visit>
    void for_tile(int32_t tile_x, int32_t tile_z, int32_t /*low*/, int32_t /*high*/,
                  Visit visit) const {
      const auto tile = mesh.world().tile_levels(tile_x, tile_z);
      for (uint32_t i = tile.first; i < tile.last; ++i) visit(mesh.level(i));
    }
  };
  [[nodiscard]] Ground ground() { return {*this}; }

 private:
  /// What a rectangle has beside its cells.
  struct RectState {
    uint8_t area = 0, slope = 0, density = 0;  // its kind of ground
    bool has_portals = false, has_corners = false;
    IndexRange portals;
  };
  struct HashCorner {
    size_t operator()(const CornerKey& key) const;
  };

  static int64_t tile_key(int32_t x, int32_t z) {
    return (int64_t{z} << 32) | static_cast<uint32_t>(x);
  }
  void begin_mesh();
  void make(uint32_t index, ViewLevel& level);
  [[nodiscard]] uint64_t made_bytes() const;
  void block_cells(ViewLevel& level) const;
  [[nodiscard]] bool differs_on(int32_t tile_x, int32_t tile_z, const DensityCells* before) const;
  void find_plain();
  void cut(ViewLevel& level);
  void find_portals(uint32_t rect);
  void find_corners(uint32_t rect);
  uint32_t number_of(const std::optional<CornerKey>& corner);
  void drop_portals(uint32_t rect);
  void drop_border(const ViewLevel& level, int32_t toward_x, int32_t toward_z);
  void drop(ViewLevel& level);
  void drop_unused_corners();
  [[nodiscard]] bool touches_tile(const Solid& solid, bool is_area, int32_t x, int32_t z) const;
  [[nodiscard]] bool is_seen(int64_t tile) const;
  [[nodiscard]] bool has_made(uint8_t kind) const;
  void forget(Change& change);
  void drop_tile(int64_t tile);
  void drop_around(int64_t tile, const SquareRange& reach);
  void switch_link(const LevelLinkEnd& link, bool active);
  void find_min_link_factor();
  [[nodiscard]] std::array<uint8_t, 4096> kinds_of(const ViewLevel& level) const;
  [[nodiscard]] std::array<uint8_t, 4096> slopes_of(const ViewLevel& level) const;
  [[nodiscard]] std::array<uint8_t, 4096> densities_of(const ViewLevel& level) const;

  World world_;
  PathConfig config_;
  int32_t step_ = 0;  // [mm]
  std::array<double, 64> area_cost_{};
  std::array<double, kSlopeClasses> slope_factor_{};
  double min_factor_ = 1;
  double min_link_factor_ = 1;  // of active off-mesh links that cost less than their length
  bool plain_ = true;
  const GroundDelays* delays_ = nullptr;         // a copy has none
  std::shared_ptr<const DensityCells> density_;  // null: none applies
  uint64_t version_ = 0;
  size_t active_links_ = 0;
  std::vector<std::unique_ptr<ViewLevel>> levels_;  // of the world; null: not made yet
  uint64_t made_levels_ = 0;                        // since all were forgotten

  PathMesh mesh_;
  std::vector<RectState> rect_states_;  // by rectangle
  IndexBlocks rect_blocks_, portal_blocks_;
  std::unordered_map<CornerKey, uint32_t, HashCorner> corner_numbers_;  // looked up only
  std::vector<CornerKey> corner_keys_;
  std::vector<uint32_t> free_corners_;
  size_t max_corners_ = 0;           // until unused ones are dropped
  std::vector<MeshRect> new_rects_;  // scratch
  std::vector<RectState> new_states_;
  std::vector<FoundPortal> new_portals_;
  std::vector<bool> used_corners_;
  std::vector<int64_t> touched_tiles_;

  std::vector<Change> changes_;
  std::unordered_map<int64_t, std::vector<ChangeId>> changes_of_tile_;  // in order; looked up only
  std::unordered_map<uint32_t, std::vector<OffMeshLinkEnd>>
      off_mesh_links_;  // active ones, by level, in order of change
};

/// The cells behind its rectangles.
class ViewCells final : public CellsOf<GroundView::Ground> {
 public:
  explicit ViewCells(GroundView& mesh) : CellsOf(mesh.ground(), mesh.step()), mesh_(mesh) {}
  [[nodiscard]] uint32_t rect_at(uint32_t level, int32_t x, int32_t z) const override {
    return mesh_.rect_at(*mesh_.level(level), x, z);
  }

 private:
  GroundView& mesh_;
};

}  // namespace throng::path
