// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <unordered_map>
#include <vector>

#include "core/access.h"
#include "graph/ground_parts.h"
#include "path/edits/solid.h"
#include "throng/path.h"
#include "world/ground.h"

/// The ground of a LiveFinder, level by level, made on first use.
namespace throng::path {

inline constexpr int32_t kSlopeClasses = 6;
inline constexpr std::array<double, kSlopeClasses> kSteepestOf{0.05, 0.1, 0.2, 0.35, 0.6, 1.2};

/// Cells [x0, x1) x [z0, z1) of a level tile, of one area kind and one class of inclination.
struct LiveRect {
  int16_t x0 = 0, z0 = 0, x1 = 0, z1 = 0;
  uint8_t area = 0, slope = 0;
  uint32_t first_portal = 0;  // its portals end where the next rectangle's begin
};

/// A stretch of a rectangle's side over which a step leads to another, and back.
struct LivePortal {
  uint32_t to_level = 0;  // of the world
  uint16_t to_rect = 0;
  int8_t toward_x = 0, toward_z = 0;  // the side
  int16_t from = 0, to = 0;           // cells along the side, of the tile: x, or z
};

struct LiveLevel {
  world::GroundLevel ground;
  int32_t tile_x = 0, tile_z = 0;
  world::CellRows legal{};
  bool has_portals = false;
  std::vector<LiveRect> rects;  // one more at the end, once there are portals
  std::vector<LivePortal> portals;

  [[nodiscard]] bool is_legal(int32_t x, int32_t z) const {
    return ((legal[static_cast<size_t>(z)] >> x) & 1) != 0;
  }
  [[nodiscard]] uint16_t rect_at(int32_t x, int32_t z) const;  // cell of the tile, legal
};

inline double distance_of(world::GroundPoint a, world::GroundPoint b) {  // [cells]
  const auto dx = static_cast<double>(a.x - b.x), dz = static_cast<double>(a.z - b.z);
  return std::sqrt(dx * dx + dz * dz) * (1.0 / world::kUnitsPerCell);
}

/// Levels and the changes made to them. Copies share nothing.
class LiveMesh {
 public:
  LiveMesh(World world, const PathConfig& config);
  LiveMesh(const LiveMesh& other);

  [[nodiscard]] const world::WorldData& world() const { return *data_of(world_); }
  [[nodiscard]] int32_t avatar_class() const { return config_.avatar_class; }
  [[nodiscard]] int32_t step() const { return step_; }

  /// Rises with every change.
  [[nodiscard]] uint64_t version() const { return version_; }
  /// Without legal cells if its zone cannot be used.
  const LiveLevel* level(uint32_t index);
  const LiveLevel* level_with_portals(uint32_t index);
  /// Cost of a metre.
  [[nodiscard]] double factor(const LiveRect& rect) const {
    return area_cost_[rect.area] * slope_factor_[rect.slope];
  }
  [[nodiscard]] bool is_plain() const { return plain_; }  // a metre costs 1 everywhere
  /// No path costs less than its length in the plane times this.
  [[nodiscard]] double min_factor() const { return std::min(min_factor_, min_link_factor_); }
  void set_area_cost(uint8_t kind, double cost);

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
  struct Change {
    bool active = true, removed = false;
    bool is_area = false;
    uint8_t kind = 0;
    Solid solid;                      // of an area: its prism
    std::vector<int64_t> tiles;       // that it touches
    std::vector<LevelLinkEnd> links;  // of an off-mesh link
  };
  ChangeId add(Change change);
  /// From a level. [links of a change are added right after it]
  void add_off_mesh_link(uint32_t level, const OffMeshLinkEnd& off_mesh_link);
  /// Those that are active now.
  [[nodiscard]] const std::vector<OffMeshLinkEnd>& links_from(uint32_t level) const;
  /// Can the class stand at a point of a level now? In which rectangle?
  bool stand(uint32_t level, world::GroundPoint at, uint16_t& rect);
  bool set_active(ChangeId change, bool active, bool remove);

  /// As world/walk.h needs it.
  struct Ground {
    using Level = const LiveLevel*;
    LiveMesh& mesh;
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
  void make(uint32_t index, LiveLevel& level) const;
  void block_cells(LiveLevel& level) const;
  void cut(LiveLevel& level) const;
  void find_portals(LiveLevel& level);
  void forget(int64_t tile);
  void switch_link(const LevelLinkEnd& link, bool active);
  void find_min_link_factor();
  [[nodiscard]] std::array<uint8_t, 4096> kinds_of(const LiveLevel& level) const;
  [[nodiscard]] std::array<uint8_t, 4096> slopes_of(const LiveLevel& level) const;

  World world_;
  PathConfig config_;
  int32_t step_ = 0;  // [mm]
  std::array<double, 64> area_cost_{};
  std::array<double, kSlopeClasses> slope_factor_{};
  double min_factor_ = 1;
  double min_link_factor_ = 1;  // of active off-mesh links that cost less than their length
  bool plain_ = true;
  uint64_t version_ = 0;
  std::vector<std::unique_ptr<LiveLevel>> levels_;  // of the world; null: not made yet
  std::vector<Change> changes_;
  std::unordered_map<int64_t, std::vector<ChangeId>> changes_of_tile_;  // in order; looked up only
  std::unordered_map<uint32_t, std::vector<OffMeshLinkEnd>>
      off_mesh_links_;  // active ones, by level, in order of change
};

}  // namespace throng::path
