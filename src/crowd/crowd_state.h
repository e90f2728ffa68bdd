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

#include "crowd/climb.h"
#include "crowd/climber_engine.h"
#include "crowd/climber_ground.h"
#include "crowd/crowd_engine.h"
#include "crowd/crowd_ground.h"
#include "crowd/flight.h"
#include "crowd/flyer_air.h"
#include "crowd/flyer_engine.h"
#include "crowd/obstacle_set.h"
#include "crowd/path_repair.h"
#include "crowd/placement.h"
#include "crowd/routes.h"
#include "crowd/target.h"
#include "path/flow_points.h"
#include "throng/crowd.h"
#include "throng/flight.h"
#include "throng/live_ground.h"
#include "throng/node_path.h"

/// What a crowd holds.
namespace throng {

inline constexpr uint32_t kNobody = UINT32_MAX;
inline constexpr std::array<int32_t, 3> kNeverLooked = {INT32_MIN / 2, 0, 0};

// What a class needs that somebody is of.
struct ClassParts {
  CrowdGround ground;
  std::optional<StandingDraw> standing;  // none: the ground has changed since
  std::vector<PathFinder> finders;       // one a worker
  std::vector<LiveGround> lives;         // one a worker, once ways mind obstacles or targets
  std::vector<Path> paths;
  std::vector<RepairScratch> repairs;
  std::vector<FlowPoints> flows;  // by target
  // Of a class that flies, in a world with air.
  std::optional<FlyerAir> air;
  std::vector<FlightFinder> flight_finders;  // one a worker
  std::vector<FlightPath> flights;
  // Of a class that goes over nodes.
  std::optional<ClimberGround> nodes;
  std::vector<NodePathFinder> node_finders;  // one a worker
  std::vector<NodePath> node_paths;
  // Of both, by target: where to land, or to climb to.
  std::vector<std::vector<Place>> landings;
};

struct Crowd::State {
  World world;
  CrowdConfig config;
  CrowdEngine engine;
  FlyerEngine flyers;
  ClimberEngine climbers;
  std::vector<std::unique_ptr<ClassParts>> classes;
  double unit = 0;  // [m]
  int32_t widest = 0, narrowest = INT32_MAX, tallest = 0;
  float fastest = 0;
  int32_t sub_steps = 1;
  uint64_t step = 0, sub_step = 0;
  uint64_t scattered = 0;  // draws of `scatter`
  ObstacleSet obstacles;
  bool cuts_ways = false;   // an obstacle that ways lead around is up, or closes
  bool some_leave = false;  // Body::leaves of some

  // By slot.
  std::vector<uint32_t> generation;
  std::vector<Route> routes;
  std::vector<Flight> flights;  // empty, if no class that is in use flies
  std::vector<Climb> climbs;    // empty, if none goes over nodes
  std::vector<uint32_t> free_slots;
  mutable std::vector<uint32_t> where;  // which of the engine's bodies; kNobody: none
  mutable bool where_is_old = false;
  // Events: what is watched, and by slot where each was.
  std::vector<Target> watched;
  std::vector<uint64_t> inside;                   // a bit for each watched area
  std::vector<std::array<int32_t, 3>> looked_at;  // [units, mm]
  std::vector<EngineDetail::View> views;
  std::vector<AreaEntry> entered;
  std::vector<AvatarId> no_progress;
  std::vector<Target> targets;  // TargetId less one
  bool flows_are_old = false;   // the ground has changed since
  std::vector<AvatarId> arrived, goal_unreachable, blockers;
  std::mutex stranding;
  mutable std::atomic<uint64_t> out_of_memory{0};  // searches of this step

  State(const World& a_world, const CrowdConfig& a_config, CrowdEngine&& an_engine,
        FlyerEngine&& a_flyer_engine, ClimberEngine&& a_climber_engine)
      : world(a_world),
        config(a_config),
        engine(std::move(an_engine)),
        flyers(std::move(a_flyer_engine)),
        climbers(std::move(a_climber_engine)),
        obstacles(a_world, a_world.data()->summary.classes.size()) {}

  [[nodiscard]] const AvatarClass& body_class(int32_t number) const {
    return world.data()->summary.classes[static_cast<size_t>(number)];
  }
  [[nodiscard]] AvatarId id_of(uint32_t slot) const { return {slot + 1, generation[slot]}; }
  [[nodiscard]] Body* body(AvatarId id) const;
  void find_bodies() const;
  Result<void> open_class(int32_t number, Context& context);
  Result<Body> body_of(const AvatarSpawn& spawn) const;
  /// The class's, or its own. [m]
  [[nodiscard]] double radius_of(const AvatarSpawn& spawn) const;
  void make_room(const Body& body);
  /// Makes room for so many more.
  void reserve(size_t more);
  AvatarId add(Body body, const Climb& climb = {});
  /// Those obstacles that wait and in whose way nobody stands come up or move on. Returns how many
  /// still wait.
  size_t settle_obstacles(std::span<const uint32_t> slots, std::vector<AvatarId>* in_their_path);
  /// Is any of these bodies in an obstacle that is to come up?
  [[nodiscard]] bool is_occupied(uint32_t slot,
                                 std::span<const std::pair<uint32_t, uint32_t>> found) const;

  // crowd_leaving.cpp
  /// These (obstacle, index of the body) are in obstacles that they are to leave; with `all`, no
  /// others are.
  void mark_leaving(std::span<const std::pair<uint32_t, uint32_t>> found, bool all);
  void begin_to_leave(Body& body, std::span<const uint32_t> slots);
  void end_leaving(Body& body);
  /// Of one on foot: on along its way, or to the nearest exit.
  void plan_exit(Body& body);
  bool tries_path_again(Body& body) const;
  [[nodiscard]] bool leads_out(const Body& body, std::span<const uint32_t> slots) const;
  /// Of one who flies; true: its way is not followed.
  bool plan_exit_in_air(Body& body, Flight& flight) const;
  /// Of one who goes over nodes.
  bool plan_exit_on_nodes(Body& body, Climb& climb, int32_t worker);
  bool find_exit_over_nodes(Body& body, Climb& climb, int32_t worker);

  /// Tells the ways of a class, or of all, what an obstacle is to them by now.
  void report_paths(uint32_t slot, size_t number);
  void report_paths(uint32_t slot);
  void cut_ways(std::span<const uint32_t> slots);
  /// The grounds are to be as the obstacles are.
  void ground_changed();
  /// Live grounds of a class, if there are none yet.
  void make_lives(size_t number);
  /// What a class lacks of the targets.
  Result<void> find_flows(int32_t number, Context& context);
  bool plan_path(Body& body, Route& route, const StrideGround& ground, int32_t worker);
  void renew_flows();
  void arrive_in_targets();
  void find_events();
  void find_entries();
  void find_no_progress();
  [[nodiscard]] AvatarState state_of(const Body& body) const;
  void plan(std::span<Body> bodies, int32_t worker, std::atomic<uint64_t>& planned);
  void strand(Body& body);
  /// Counts a search that would have taken more memory than it may.
  void note_spent(SpentBudget spent) const {
    if (spent == SpentBudget::kMemory) out_of_memory.fetch_add(1, std::memory_order_relaxed);
  }
  [[nodiscard]] SearchBudget search_budget(uint64_t max_nodes = UINT64_MAX) const {
    return {max_nodes, nullptr, config.search_bytes};
  }

  // crowd_flights.cpp
  /// What a class needs beside its ground if it flies, and the world has air.
  Result<void> open_air(int32_t number, ClassParts& parts, Context& context) const;
  [[nodiscard]] const FlyerAir* air_of(const Body& body) const {
    const auto& air = classes[body.avatar_class]->air;
    return air ? &*air : nullptr;
  }
  /// Puts a body into the air, or not: it may not be there.
  [[nodiscard]] bool put_in_air(Body& body, const Vec3d& feet) const;
  /// Of a body that flies or could: a goal of any kind. False: it is none.
  bool set_goal_of_flyer(Body& body, const Place& goal);
  /// What one who can fly does on foot before he walks. True: he need not ask for a way to walk.
  bool plan_on_foot(Body& body, Flight& flight, int32_t worker, std::atomic<uint64_t>& planned);
  bool take_off(Body& body, Flight& flight) const;
  void look_for_room(Body& body, const Flight& flight) const;
  [[nodiscard]] bool is_clear_of_obstacles(const Body& body, const AirSpot& from,
                                           const AirSpot& to) const;
  bool find_path_over(const Body& body, const AirSpot& from, const AirSpot& to,
                      std::vector<AirSpot>& points) const;
  void plan_flight(Body& body, Flight& flight, int32_t worker, std::atomic<uint64_t>& planned);
  [[nodiscard]] std::optional<AirSpot> open_spot(const Body& body, const AirSpot& at,
                                                 int32_t worker) const;
  [[nodiscard]] bool find_flight(const Body& body, Flight& flight, int32_t worker) const;
  void fly(EngineCounts& counts, CrowdEngine::Times& times, std::atomic<uint64_t>& planned);
  void tell_flyers_of_obstacles();
  /// Who flies where some obstacles would come or pass, beside those who stand there, in order.
  void add_flyer_blockers(std::span<const uint32_t> slots,
                          std::vector<std::pair<uint32_t, uint32_t>>& found) const;

  // crowd_climbs.cpp
  [[nodiscard]] bool goes_over_nodes(int32_t number) const;
  /// What a class needs that goes over nodes.
  Result<void> open_nodes(int32_t number, ClassParts& parts, Context& context) const;
  /// Puts a body there, or not: it may not be there. [m]
  [[nodiscard]] bool put_on_nodes(Body& body, Climb& climb, const NodePlace& place,
                                  double radius) const;
  /// What a place means to a class that goes over nodes; nowhere if there is nothing near.
  [[nodiscard]] NodePlace place_on_nodes(int32_t number, const Place& place) const;
  [[nodiscard]] NodePlace draw_on_nodes(int32_t number, uint64_t n) const;
  void set_goal_of_climber(Body& body, const NodePlace& goal);
  void stop_climber(Body& body);
  void aim_at_flow_target(const Body& body, Climb& climb) const;
  void turn_off(Body& body, Climb& climb, int32_t worker);
  void drive_climber(const Body& body, Climb& climb, int32_t worker);
  void plan_climb(Body& body, Climb& climb, int32_t worker, std::atomic<uint64_t>& planned);
  void move_climbers(EngineCounts& counts, CrowdEngine::Times& times,
                     std::atomic<uint64_t>& planned);
  [[nodiscard]] Body at_feet(const Body& body) const;
  /// Would a step with what was saved of it read what is not there?
  [[nodiscard]] bool is_sound_climb(const Body& body) const;
  [[nodiscard]] uint64_t count_off_nodes() const;
  [[nodiscard]] uint64_t count_climbers_inside() const;
  static void take_path(Climb& climb, const NodePath& path);
  bool step_off(Body& body, Climb& climb, int32_t worker, double beside);
  void cut_climbs(std::span<const uint32_t> slots);
};

}  // namespace throng
