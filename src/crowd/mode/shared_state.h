// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

#include "core/access.h"
#include "crowd/ground/air_position.h"
#include "crowd/ground/body.h"
#include "crowd/ground/crowd_ground.h"
#include "crowd/ground/obstacle_grid.h"
#include "crowd/ground/target.h"
#include "crowd/mode/avatar_names.h"
#include "crowd/mode/orientation.h"
#include "crowd/obstacles/obstacle_set.h"
#include "crowd/share/rank_share.h"
#include "path/edits/density_cells.h"
#include "path/edits/edit_list.h"
#include "throng/avatar.h"
#include "throng/crowd.h"
#include "throng/path.h"
#include "throng/world.h"

/// What the modes of a crowd share, so that none sees the others' tables.
namespace throng::crowd {

/// A class in use, whatever modes its avatars have.
struct SharedClass {
  CrowdGround ground;
  /// By target: places of it, where avatars land or climb to. None if the class only walks.
  std::vector<std::vector<Place>> landings;
};

/// A class whose avatars follow a density map. It is number `baked_classes() + index`.
struct DensityClass {
  size_t body = 0;  // class of the world, which it is otherwise
  std::shared_ptr<const path::DensityCells> cells;
};

struct SharedState {
  SharedState(const World& a_world, const CrowdConfig& a_config);

  World world;
  CrowdConfig config;
  double unit = 0;  // [m]
  int32_t sub_steps = 1;
  uint64_t step = 0;
  uint64_t sub_step = 0;  // while avatars move: the number of the next one
  /// Of this sub-step, whatever the number of sub-steps in those before. [step / kTimeUnits]
  uint64_t time = 0;
  static constexpr uint64_t kTimeUnits = uint64_t{1} << 20;  // as many as sub-steps at most
  /// Of the world, then those that follow density maps, to kMaxAvatarClasses; null: not in use.
  std::vector<std::unique_ptr<SharedClass>> classes;
  std::vector<DensityClass> density_classes;
  ObstacleSet obstacles;
  ObstacleGrid obstacle_grid;  // those that are active or close
  bool some_leave = false;     // Body::leaves is set for some
  AvatarNames names;
  std::unique_ptr<RankShare> share;       // null: no other rank has avatars of the crowd
  std::vector<Orientation> orientations;  // by slot
  std::vector<Target> targets;            // TargetId less one

  // Of the step.
  std::vector<AvatarId> arrived, goal_unreachable;
  std::atomic<uint64_t> planned{0}, out_of_memory{0};  // searches
  std::atomic<uint64_t> jam_searches{0}, changed_route{0};
  uint64_t flight_boxes = 0;
  std::mutex goal_mutex;

  [[nodiscard]] const AvatarClass& body_class(size_t number) const {
    return data_of(world)->summary.classes[baked_class(number)];
  }
  [[nodiscard]] size_t baked_classes() const { return data_of(world)->summary.classes.size(); }
  /// The class of the world that a class in use is, whatever map it follows.
  [[nodiscard]] size_t baked_class(size_t number) const {
    return number < baked_classes() ? number : density_classes[number - baked_classes()].body;
  }
  /// Null: it follows none.
  [[nodiscard]] const std::shared_ptr<const path::DensityCells>& density_of(size_t number) const {
    static const std::shared_ptr<const path::DensityCells> none;
    return number < baked_classes() ? none : density_classes[number - baked_classes()].cells;
  }
  [[nodiscard]] const CrowdGround& ground_of(const Body& body) const {
    return classes[body.avatar_class]->ground;
  }
  [[nodiscard]] const Vec3d& origin() const { return data_of(world)->summary.origin; }
  /// Does a class fly in this world?
  [[nodiscard]] bool flies(size_t number) const;
  /// Does a class walk over nodes? It never flies.
  [[nodiscard]] bool climbs(size_t number) const;

  [[nodiscard]] uint32_t name_of(const Body& body) const { return names.name_of(body.slot); }
  [[nodiscard]] AvatarId id_of(uint32_t slot) const { return names.id_of(slot); }
  [[nodiscard]] const path::EditList& edits() const { return *Access::state(config.edits); }
  /// Do paths on foot need a search that knows costs, over ground of these baked area kinds?
  [[nodiscard]] bool has_costs(uint64_t baked_kinds) const {
    return config.slope_cost > 0 || edits().has_costs(baked_kinds);
  }
  /// Is an off-mesh link of the edits in force?
  [[nodiscard]] bool has_links() const { return edits().active_links > 0; }
  [[nodiscard]] SearchBudget search_budget(uint64_t max_nodes = UINT64_MAX) const {
    return {max_nodes, nullptr, config.search_bytes};
  }
  /// The length of a sub-step. [s]
  [[nodiscard]] float sub_dt() const { return static_cast<float>(config.dt / sub_steps); }

  /// From a time to this sub-step. [s]
  [[nodiscard]] double seconds_since(uint64_t then) const {
    return static_cast<double>(time - then) / static_cast<double>(kTimeUnits) * config.dt;
  }

  /// Counts a search that exhausted its memory.
  void note_spent(SpentBudget spent) {
    if (spent == SpentBudget::kMemory) out_of_memory.fetch_add(1, std::memory_order_relaxed);
  }
  void note_planned(uint64_t searches = 1) {
    planned.fetch_add(searches, std::memory_order_relaxed);
  }
  /// No path leads to the body's goal. On any worker.
  void drop_goal(Body& body);
};

inline AirPosition feet_of(const Body& body) { return {body.x, body.z, body.y}; }

}  // namespace throng::crowd
