// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "scenario/density_draw.h"
#include "scenario/door_queue.h"
#include "scenario/entry_queue.h"
#include "scenario/spawn_times.h"
#include "throng/path.h"
#include "throng/scenario.h"

/// The state of a simulation.
namespace throng {

inline constexpr uint32_t kNoSlot = UINT32_MAX;

// What an avatar does now.
enum class Doing : uint8_t {
  kNothing,          // the journey is over, or there is none
  kWaiting,          // until a time
  kWalking,          // to a region
  kToRandomPlace,    // to a random place of an area or density map
  kToQueue,          // to the tail of a line
  kInQueue,          // in a line
  kBoarding,         // stands where a link leaves from
  kGathering,        // waits for the others of its group
  kGoalUnreachable,  // no path leads there
  kToWaypoint,       // on its trip to a random place, by one that it sampled from its density map
};

struct ScenarioAvatar {
  AvatarId id;  // null: in a link, or not yet in the crowd
  uint64_t number = 0;
  int32_t profile = -1, journey = -1;
  int32_t follows = -1;  // the density map; -1: none
  uint32_t stage = 0;
  Doing doing = Doing::kNothing;
  bool has_started = false;   // the premovement time is over
  bool waits_before = false;  // kGoalUnreachable: before an obstacle
  double until = 0;           // kWaiting: when it ends; kToRandomPlace: since when it is near [s]
  double speed = 0;           // desired speed, before factors [m/s]
  uint64_t draws = 0;         // random choices so far
  int32_t group = -1;
  int32_t area = -1;        // the exit chosen by `quickest`; -1: none
  uint32_t door_tick = 0;   // tick of DoorQueue: expected arrival if no other were there
  double speed_factor = 1;  // of the area in which it is
  Place goal;               // kToRandomPlace, kToWaypoint, kToQueue, kInQueue
  Place waypoint;           // kToWaypoint
};

// Avatars before a counter, by number.
struct WaitingLine {
  std::vector<uint64_t> members;      // the head first
  std::vector<double> served;         // of each, when service ends; below 0: not begun [s]
  std::vector<uint64_t> approaching;  // on paths to the tail
  std::vector<size_t> covered;        // places that obstacles cover, by index, sorted
};

// Avatars that wait for a link, by number, in order of arrival.
struct BoardingQueue {
  std::deque<uint64_t> members;
  double next = 0;  // next departure [s]
};

// The weights of a density map that the crowd's classes know.
struct GivenDensity {
  std::vector<uint8_t> weights;
  double at = 0;  // [s]
};

// An attractor that Simulation::attract has fixed to an avatar.
struct CarriedAttractor {
  size_t density = 0;
  uint64_t number = 0;  // of the avatar
  double radius = 0;    // [m]
  uint8_t weight = 0;
};

// What attractors add to a density map now.
struct ShadedDensity {
  scenario::DensityDraw extra;  // of the added weights alone
  double share = 0;             // of these in all weights
};

// An avatar that waits to enter the crowd, from a source or out of a link.
struct PendingSpawn {
  ScenarioAvatar avatar;
  int32_t source = -1;  // or -1 and
  int32_t link = -1;
  uint64_t companion = UINT64_MAX;  // number of the avatar beside which it enters
  uint64_t nth = 0;                 // index in its source
};

/// The flow through an area that the choice of the quickest exit assumes. [avatars/s]
double door_flow(const ScenarioArea& area);

/// Of a horizontal vector. Not the C library's hypot, which differs between machines.
inline double plan_length(double x, double z) { return std::sqrt(x * x + z * z); }
/// Horizontal distance. [m]
inline double plan_distance(const Vec3d& a, const Vec3d& b) {
  return plan_length(a.x - b.x, a.z - b.z);
}

/// Horizontal distance of a point to a prism; 0 inside. [m]
double distance_to(const Prism& prism, double x, double z);

/// The n-th place of a line; beyond its end, on its last segment prolonged.
Vec3d place_along(const Queue& queue, size_t n);

struct Simulation::State {
  State(const World& a_world, const Scenario& a_scenario, const Edits& a_edits, Crowd&& a_crowd)
      : world(a_world), scenario(a_scenario), edits(a_edits), crowd(std::move(a_crowd)) {}

  World world;
  Scenario scenario;
  Edits edits;  // the crowd's: its obstacles
  Crowd crowd;
  uint64_t steps = 0;

  // Resolved names of the scenario.
  std::vector<AvatarClass> kinds;     // of the world
  std::vector<int32_t> classes;       // by profile; the last: of avatars without one
  std::vector<TargetId> area_target;  // by area
  // By journey and stage: one target for the union of the areas, or with `quickest` one for each.
  std::vector<std::vector<std::vector<TargetId>>> stage_targets;
  std::vector<scenario::DensityDraw> densities;
  // By target and class of the crowd.
  std::map<std::pair<TargetId, int32_t>, std::vector<Place>> places;
  // Classes of the crowd, by density map and class of the world.
  std::map<std::pair<int32_t, int32_t>, int32_t> density_classes;
  std::vector<std::vector<uint8_t>> from_outside;  // by source and map: find_sources_outside
  std::vector<GivenDensity> given;                 // by density map
  std::vector<CarriedAttractor> carried;
  std::map<size_t, ShadedDensity> shaded;  // by density map; where attractors are

  std::vector<scenario::SpawnTimes> spawn_times;  // by source
  std::vector<uint64_t> spawn_counts;             // by source: avatars so far
  scenario::EntryQueue<PendingSpawn> pending;     // out of sources
  scenario::EntryQueue<PendingSpawn> in_transit;  // out of links
  uint64_t entry_tries = 0;                       // SimulationReport::entry_tries
  std::vector<Trip> trips;                        // by number
  std::vector<uint32_t> slot_of;                  // by number; kNoSlot: not in the crowd
  std::vector<ScenarioAvatar> avatars;            // by slot
  std::vector<WaitingLine> lines;                 // by queue
  std::vector<BoardingQueue> boarding;            // by link
  std::vector<std::vector<uint64_t>> groups;      // numbers
  std::vector<scenario::DoorQueue> doors;         // by area: avatars that chose it
  std::vector<EditId> obstacles;  // by obstacle; 0 before it begins and after it ends
  std::vector<ObstacleTimes> obstacle_times;
  std::vector<double> moved;  // by obstacle: how far along its line, and back [m]
  std::vector<Prism> solids;  // the obstacles that are up
  std::map<int32_t, PathFinder> without_obstacles;  // by class, once needed
  bool solids_are_old = false;
  bool has_opened = false;  // an obstacle has gone in this step
  bool is_review = false;   // this step
  uint64_t entered = 0, left = 0;

  [[nodiscard]] double time() const { return static_cast<double>(steps) * scenario.dt; }
  [[nodiscard]] int32_t class_of(const ScenarioAvatar& p) const {
    return classes[p.profile < 0 ? classes.size() - 1 : static_cast<size_t>(p.profile)];
  }
  /// The class of the crowd: that of the world, or one that follows a density map.
  [[nodiscard]] int32_t crowd_class_of(const ScenarioAvatar& p) const {
    const auto found = density_classes.find({p.follows, class_of(p)});
    return found == density_classes.end() ? class_of(p) : found->second;
  }
  [[nodiscard]] const Stage& stage_of(const ScenarioAvatar& p) const {
    return scenario.journeys[static_cast<size_t>(p.journey)].stages[p.stage];
  }
  [[nodiscard]] const std::vector<TargetId>& targets_of(const ScenarioAvatar& p) const {
    return stage_targets[static_cast<size_t>(p.journey)][p.stage];
  }
  [[nodiscard]] bool is_here(uint32_t slot) const {
    return slot < avatars.size() && static_cast<bool>(avatars[slot].id);
  }
  [[nodiscard]] ScenarioAvatar* find_avatar(uint64_t number) {
    const uint32_t slot = slot_of[number];
    return slot == kNoSlot ? nullptr : &avatars[slot];
  }
  /// The avatar's next random number, [0, 1).
  double unit(ScenarioAvatar& p) const;

  using MakeCrowd = Result<Crowd> (*)(const World&, const CrowdConfig&);
  static Result<Simulation> create(const World& world, const Scenario& scenario, int32_t workers,
                                   MakeCrowd make_crowd, Context& context);
  static Result<Nodes> nodes_for(const World& world, const Scenario& scenario, int32_t workers,
                                 Context& context);

  // simulation.cpp
  Result<void> prepare(Context& context);
  Result<TargetId> target_of(std::span<const int32_t> areas, Context& context);
  Result<void> prepare_stage(const Stage& stage, std::vector<TargetId>& targets, Context& context);
  Result<void> find_places(int32_t area, int32_t crowd_class, int32_t avatar_class,
                           const std::string& owner, Context& context);
  Result<void> prepare_source(const Source& source, Context& context);

  void update_obstacles();
  void record_obstacle_times();
  void record_obstacle_times(size_t n);

  // spawning.cpp
  void queue_spawns();
  // What a round of tries has done.
  struct EntryTries {
    size_t placed = 0;   // at places where they might stand
    size_t entered = 0;  // of these
  };
  Result<void> spawn_due(scenario::EntryQueue<PendingSpawn>& queue, Context& context);
  Result<EntryTries> try_entries(scenario::EntryQueue<PendingSpawn>& queue, Context& context);
  [[nodiscard]] AvatarSpawn spawn_of(const ScenarioAvatar& p, const Place& place) const;
  Place choose_place(PendingSpawn& one);
  Place place_in_rows(const Source& source, uint64_t nth, ScenarioAvatar& p);
  Place random_place(std::span<const int32_t> areas, int32_t density, ScenarioAvatar& p);
  void enter(const PendingSpawn& one, AvatarId id);

  // following.cpp
  void find_sources_outside();
  [[nodiscard]] int32_t map_of(const Source& source, int32_t journey) const;
  Result<int32_t> class_that_follows(int32_t density, int32_t avatar_class, Context& context);
  void blend_densities();
  void give_density(size_t density);
  [[nodiscard]] Place random_place_of(int32_t density, ScenarioAvatar& p);
  [[nodiscard]] Place random_place_of(const DensityMap& map, const scenario::DensityDraw& draw,
                                      ScenarioAvatar& p);
  void go_on_trip(ScenarioAvatar& p);

  // attractors.cpp
  void move_obstacle(size_t n);
  [[nodiscard]] bool carries(const ScenarioAvatar& p) const;
  void shade(size_t density);
  void shade_densities();
  void redirect_attracted();

  // journeys.cpp
  void begin_stage(ScenarioAvatar& p);
  void finish_stage(ScenarioAvatar& p);
  void next_stage(ScenarioAvatar& p);
  void stand(ScenarioAvatar& p, Doing doing);
  void walk_to(ScenarioAvatar& p, const Place& place, Doing doing);
  void choose_area(ScenarioAvatar& p);
  void set_door(ScenarioAvatar& p, int32_t area, double distance);
  void update_door_time(ScenarioAvatar& p);
  void arrive(ScenarioAvatar& p);
  void leave(ScenarioAvatar& p);
  void remove_from_crowd(ScenarioAvatar& p);
  void end_waits();
  [[nodiscard]] bool is_near(const ScenarioAvatar& p, const Place& place) const;
  void review_stages();
  [[nodiscard]] int32_t area_under(const ScenarioAvatar& p) const;

  // unreachable.cpp
  [[nodiscard]] bool is_covered(const Vec3d& feet, const AvatarClass& body) const;
  void note_solids();
  [[nodiscard]] bool retries(const ScenarioAvatar& p) const;
  void retry_goals();
  [[nodiscard]] Place goal_of(const ScenarioAvatar& p, const Vec3d& from) const;
  [[nodiscard]] Place place_before_obstacle(const ScenarioAvatar& p);
  void walk_up(ScenarioAvatar& p);

  // lines.cpp
  [[nodiscard]] Place in_line(size_t line, size_t index, int32_t avatar_class) const;
  void move_lines();
  void run_links();

  // speed_factors.cpp
  void apply_speed_factors();

  // groups.cpp
  [[nodiscard]] bool group_is_ready(const ScenarioAvatar& p);
  void adjust_group_speeds();
};

}  // namespace throng
