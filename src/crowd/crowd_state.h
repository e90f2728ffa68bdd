// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

#include "core/access.h"
#include "crowd/climb/climb.h"
#include "crowd/climb/climber_engine.h"
#include "crowd/climb/climber_ground.h"
#include "crowd/fly/flight.h"
#include "crowd/fly/flyer_air.h"
#include "crowd/fly/flyer_engine.h"
#include "crowd/ground/crowd_ground.h"
#include "crowd/ground/obstacle_grid.h"
#include "crowd/ground/standing_draw.h"
#include "crowd/ground/target.h"
#include "crowd/obstacles/obstacle_set.h"
#include "crowd/obstacles/path_repair.h"
#include "crowd/walk/crowd_engine.h"
#include "crowd/walk/routes.h"
#include "path/edits/edit_list.h"
#include "path/edits/flow_points.h"
#include "path/edits/live_finder.h"
#include "path/flight_finder.h"
#include "path/mesh_finder.h"
#include "path/node_finder.h"
#include "throng/crowd.h"
#include "throng/path.h"

/// The state of a crowd.
namespace throng {

inline constexpr double kNoSpacing = 1e9;  // [m] points of a path only at its corners

inline crowd::AirPosition feet_of(const crowd::Body& body) { return {body.x, body.z, body.y}; }

inline constexpr uint32_t kNoBody = UINT32_MAX;
inline constexpr std::array<int32_t, 3> kNeverChecked = {INT32_MIN / 2, 0, 0};

// What is needed for each class in use.
struct ClassParts {
  crowd::CrowdGround ground;
  std::optional<crowd::StandingDraw> standing;  // none: the ground has changed since
  std::vector<path::MeshFinder> finders;        // one a worker
  std::vector<path::LiveFinder> lives;    // one a worker, once paths avoid obstacles or lead to
                                          // targets
  std::vector<path::AppliedEdits> areas;  // of `lives`
  std::vector<Path> paths;
  std::vector<crowd::RepairScratch> repairs;
  std::vector<path::FlowPoints> flows;  // by target
  // Of a class that flies, in a world with air.
  std::optional<crowd::FlyerAir> air;
  std::vector<path::FlightFinder> flight_finders;  // one a worker
  std::vector<Path> flights;
  // Of a class of climbers.
  std::optional<crowd::ClimberGround> nodes;
  std::vector<path::NodeFinder> node_finders;  // one a worker
  std::vector<Path> node_paths;
  // Of flyers and climbers, by target: where to land, or to climb to.
  std::vector<std::vector<Place>> landings;
};

struct Crowd::State {
  World world;
  CrowdConfig config;
  crowd::CrowdEngine engine;
  crowd::FlyerEngine flyers;
  crowd::ClimberEngine climbers;
  std::vector<std::unique_ptr<ClassParts>> classes;
  double unit = 0;  // [m]
  int32_t widest = 0, narrowest = INT32_MAX, tallest = 0;
  float fastest = 0;
  int32_t sub_steps = 1;
  uint64_t step = 0, sub_step = 0;
  uint64_t scattered = 0;  // draws of `scatter`
  crowd::ObstacleSet obstacles;
  crowd::ObstacleGrid obstacle_grid;  // those that are active or close
  bool some_leave = false;            // Body::leaves is set for some

  // By slot.
  std::vector<uint32_t> generation;
  std::vector<crowd::Route> routes;
  std::vector<crowd::Flight> flights;  // empty, if no class that is in use flies
  std::vector<crowd::Climb> climbs;    // empty, if there is no climber
  std::vector<uint32_t> free_slots;
  mutable std::vector<uint32_t> where;  // which of the engine's bodies; kNoBody: none
  mutable bool where_is_old = false;
  // Events: what is watched, and by slot where each avatar was.
  std::vector<crowd::Target> watched;
  std::vector<uint64_t> inside;                    // a bit for each watched area
  std::vector<std::array<int32_t, 3>> checked_at;  // [units, mm]
  std::vector<crowd::EngineDetail::View> views;
  std::vector<AreaEntry> entered;
  std::vector<AvatarId> no_progress;
  std::vector<crowd::Target> targets;  // TargetId less one
  bool flows_are_old = false;          // the ground has changed since
  uint64_t edits_version = 0;          // that is followed
  std::vector<ObstacleId> of_edit;     // by id - 1
  std::vector<AvatarId> arrived, goal_unreachable, blockers;
  std::mutex goal_mutex;
  mutable std::atomic<uint64_t> out_of_memory{0};  // searches of this step

  State(const World& a_world, const CrowdConfig& a_config, crowd::CrowdEngine&& an_engine,
        crowd::FlyerEngine&& a_flyer_engine, crowd::ClimberEngine&& a_climber_engine)
      : world(a_world),
        config(a_config),
        engine(std::move(an_engine)),
        flyers(std::move(a_flyer_engine)),
        climbers(std::move(a_climber_engine)),
        unit(data_of(a_world)->summary.cell / world::kUnitsPerCell),
        obstacles(a_world, data_of(a_world)->summary.classes.size()),
        obstacle_grid(unit) {
    flyers.set_obstacles(&obstacle_grid);
    climbers.set_obstacles(&obstacle_grid);
  }

  [[nodiscard]] const AvatarClass& body_class(int32_t number) const {
    return data_of(world)->summary.classes[static_cast<size_t>(number)];
  }
  [[nodiscard]] AvatarId id_of(uint32_t slot) const { return {slot + 1, generation[slot]}; }
  [[nodiscard]] crowd::Body* body(AvatarId id) const;
  /// Null if the class does not fly or has no avatar yet.
  [[nodiscard]] const path::FlightFinder* flight_finder(int32_t avatar_class) const;
  void find_bodies() const;
  Result<void> open_class(int32_t number, Context& context);
  Result<crowd::Body> body_of(const AvatarSpawn& spawn) const;
  /// The avatar's own radius, or its class's. [m]
  [[nodiscard]] double radius_of(const AvatarSpawn& spawn) const;
  void make_room(const crowd::Body& body);
  /// Reserves memory for so many more avatars.
  void reserve(size_t more);
  AvatarId add(crowd::Body body, const crowd::Climb& climb = {});
  /// Activates or moves the waiting obstacles that no avatar blocks. Returns how many still wait.
  size_t settle_obstacles(std::span<const uint32_t> slots, std::vector<AvatarId>* in_their_path);
  /// Is any of these bodies in an obstacle that is to become active?
  [[nodiscard]] bool is_occupied(uint32_t slot,
                                 std::span<const std::pair<uint32_t, uint32_t>> found) const;

  // crowd_leaving.cpp
  /// These (obstacle, index of the body) are in obstacles that they must leave; with `all`, no
  /// others are.
  void mark_leaving(std::span<const std::pair<uint32_t, uint32_t>> found, bool all);
  void begin_to_leave(crowd::Body& body, std::span<const uint32_t> slots);
  void end_leaving(crowd::Body& body);
  /// Of a walker: along its path, or to the nearest exit.
  void plan_exit(crowd::Body& body);
  bool tries_path_again(crowd::Body& body) const;
  [[nodiscard]] bool leads_out(const crowd::Body& body, std::span<const uint32_t> slots) const;
  /// Of a flyer. True: its path is not followed.
  bool plan_exit_in_air(crowd::Body& body, crowd::Flight& flight) const;
  /// Of a climber.
  bool plan_exit_on_nodes(crowd::Body& body, crowd::Climb& climb, int32_t worker);
  bool find_exit_over_nodes(crowd::Body& body, crowd::Climb& climb, int32_t worker);

  /// Updates the path finders of a class, or of all, to the obstacle's state.
  void sync_paths(uint32_t slot, size_t number);
  void sync_paths(uint32_t slot);
  void cut_paths(std::span<const uint32_t> slots);
  [[nodiscard]] const path::EditList& edits() const { return *Access::state(config.edits); }
  /// Do paths on foot need a search that knows costs?
  [[nodiscard]] bool has_costs() const { return config.slope_cost > 0 || edits().has_costs(); }
  /// Kinds of ground or their costs have changed.
  void areas_changed();
  /// Updates the grounds to the obstacles.
  void ground_changed();
  /// Creates the live grounds of a class, if there are none yet.
  void make_lives(size_t number);
  /// Makes the flow fields of the targets that a class lacks.
  Result<void> find_flows(int32_t number, Context& context);
  bool plan_path(crowd::Body& body, crowd::Route& route, const crowd::StrideGround& ground,
                 int32_t worker);
  void renew_flows();
  void arrive_in_targets();
  void find_events();
  void find_entries();
  void find_no_progress();
  [[nodiscard]] AvatarState state_of(const crowd::Body& body) const;
  void plan(std::span<crowd::Body> bodies, int32_t worker, std::atomic<uint64_t>& planned);
  void drop_goal(crowd::Body& body);
  /// Counts a search that exhausted its memory.
  void note_spent(SpentBudget spent) const {
    if (spent == SpentBudget::kMemory) out_of_memory.fetch_add(1, std::memory_order_relaxed);
  }
  [[nodiscard]] SearchBudget search_budget(uint64_t max_nodes = UINT64_MAX) const {
    return {max_nodes, nullptr, config.search_bytes};
  }

  // crowd_flights.cpp
  /// What a class needs beside its ground if it flies, and the world has air.
  Result<void> open_air(int32_t number, ClassParts& parts, Context& context) const;
  [[nodiscard]] const crowd::FlyerAir* air_of(const crowd::Body& body) const {
    const auto& air = classes[body.avatar_class]->air;
    return air ? &*air : nullptr;
  }
  /// Puts a body into the air; false if it may not be there.
  [[nodiscard]] bool put_in_air(crowd::Body& body, const Vec3d& feet) const;
  /// Sets any kind of goal of a body that flies or can fly. False: the goal is not valid.
  bool set_goal_of_flyer(crowd::Body& body, const Place& goal);
  /// What a flyer on the ground does before it walks. True: it needs no path to walk.
  bool plan_on_foot(crowd::Body& body, crowd::Flight& flight, int32_t worker,
                    std::atomic<uint64_t>& planned);
  bool take_off(crowd::Body& body, crowd::Flight& flight) const;
  void find_landing_place(crowd::Body& body, const crowd::Flight& flight) const;
  [[nodiscard]] bool is_clear_of_obstacles(const crowd::Body& body, const crowd::AirPosition& from,
                                           const crowd::AirPosition& to) const;
  bool find_path_over(const crowd::Body& body, const crowd::AirPosition& from,
                      const crowd::AirPosition& to, std::vector<crowd::AirPosition>& points) const;
  void plan_flight(crowd::Body& body, crowd::Flight& flight, int32_t worker,
                   std::atomic<uint64_t>& planned);
  [[nodiscard]] std::optional<crowd::AirPosition> open_position(const crowd::Body& body,
                                                                const crowd::AirPosition& at,
                                                                int32_t worker) const;
  [[nodiscard]] bool find_flight(const crowd::Body& body, crowd::Flight& flight,
                                 int32_t worker) const;
  void fly(crowd::EngineCounts& counts, crowd::EngineTimes& times, std::atomic<uint64_t>& planned);
  /// Updates what flyers and climbers test.
  void update_obstacle_grid();
  /// Adds flyers where obstacles would appear or pass to the walkers that stand there, in order.
  void add_flyer_blockers(std::span<const uint32_t> slots,
                          std::vector<std::pair<uint32_t, uint32_t>>& found) const;

  // crowd_climbs.cpp
  [[nodiscard]] bool is_climber_class(int32_t number) const;
  /// What a class of climbers needs.
  Result<void> open_nodes(int32_t number, ClassParts& parts, Context& context) const;
  /// Puts a body there; false if it may not be there. [m]
  [[nodiscard]] bool put_on_nodes(crowd::Body& body, crowd::Climb& climb, const NodePlace& place,
                                  double radius) const;
  /// The place of a climber nearest to a place on the ground; none if there is none near.
  [[nodiscard]] NodePlace place_on_nodes(int32_t number, const Place& place) const;
  [[nodiscard]] NodePlace draw_on_nodes(int32_t number, uint64_t n) const;
  void set_goal_of_climber(crowd::Body& body, const NodePlace& goal);
  void stop_climber(crowd::Body& body);
  void head_to_target_place(const crowd::Body& body, crowd::Climb& climb) const;
  void turn_aside(crowd::Body& body, crowd::Climb& climb, int32_t worker);
  void control_climber(const crowd::Body& body, crowd::Climb& climb, int32_t worker);
  void plan_climb(crowd::Body& body, crowd::Climb& climb, int32_t worker,
                  std::atomic<uint64_t>& planned);
  void move_climbers(crowd::EngineCounts& counts, crowd::EngineTimes& times,
                     std::atomic<uint64_t>& planned);
  [[nodiscard]] crowd::Body at_feet(const crowd::Body& body) const;
  /// Can a step use the saved state of this body without reading out of bounds?
  [[nodiscard]] bool is_sound_climb(const crowd::Body& body) const;
  [[nodiscard]] uint64_t count_off_nodes() const;
  [[nodiscard]] uint64_t count_climbers_inside() const;
  static void take_path(crowd::Climb& climb, const Path& path);
  bool step_aside(crowd::Body& body, crowd::Climb& climb, int32_t worker, double beside);
  void cut_climbs(std::span<const uint32_t> slots);
};

}  // namespace throng
