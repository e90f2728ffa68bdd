// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "scenario/arrivals.h"
#include "scenario/density_draw.h"
#include "scenario/door_queue.h"
#include "throng/simulation.h"

/// What a simulation holds.
namespace throng {

inline constexpr uint32_t kNoSlot = UINT32_MAX;

// What somebody does at present.
enum class Doing : uint8_t {
  kNothing,          // the journey is over, or there is none
  kWaiting,          // until a time
  kWalking,          // to a region
  kToSpot,           // to a place of his own
  kToQueue,          // to the tail of a line
  kInQueue,          // in a line
  kBoarding,         // stands where a link leaves from
  kGathering,        // for the others of his group
  kGoalUnreachable,  // no way
};

struct Person {
  AvatarId id;  // of nobody: he is in a link, or not yet here
  uint64_t number = 0;
  int32_t profile = -1, journey = -1;
  uint32_t stage = 0;
  Doing doing = Doing::kNothing;
  bool has_started = false;  // his premovement is over
  double until = 0;          // kWaiting: when it ends; kToSpot: since when he is near [s]
  double speed = 0;          // his own wish [m/s]
  uint64_t draws = 0;        // random choices so far
  int32_t group = -1;
  int32_t area = -1;   // which he chose among areas; -1: all the same to him
  uint32_t comes = 0;  // tick of DoorQueue: when he would be there, were he alone
  double pace = 1;     // of the area in which he is
  Place spot;          // kToSpot, kToQueue, kInQueue
};

// People before a counter, by number.
struct WaitingLine {
  std::vector<uint64_t> people;  // the head first
  std::vector<double> served;    // of each until when; below 0: not begun
  std::vector<uint64_t> coming;  // on their ways to the tail
};

// Who waits for a link, by number, in order of coming.
struct Landing {
  std::deque<uint64_t> people;
  double next = 0;  // it leaves then [s]
};

// Somebody who is to be put somewhere.
struct Coming {
  Person person;
  double due = 0;       // [s]
  int32_t source = -1;  // or
  int32_t link = -1;
  uint64_t companion = UINT64_MAX;  // number of him beside whom he comes
  uint64_t nth = 0;                 // of its source
};

/// People a second who get out by an area, as who chooses the quickest one takes it.
double door_flow(const ScenarioArea& area);

struct Simulation::State {
  State(const World& a_world, const Scenario& a_scenario, Crowd&& a_crowd)
      : world(a_world), scenario(a_scenario), crowd(std::move(a_crowd)) {}

  World world;
  Scenario scenario;
  Crowd crowd;
  uint64_t steps = 0;

  // What the scenario's names mean.
  std::vector<AvatarClass> kinds;     // of the world
  std::vector<int32_t> classes;       // by profile; the last: of who has none
  std::vector<TargetId> area_target;  // by area
  // By journey and stage: where to: one target for all areas alike, or one for each.
  std::vector<std::vector<std::vector<TargetId>>> stage_targets;
  std::vector<DensityDraw> densities;
  std::map<std::pair<TargetId, int32_t>, std::vector<Place>> places;  // of targets and classes

  std::vector<Arrivals> arrivals;             // by source
  std::vector<uint64_t> called;               // by source: how many so far
  std::deque<Coming> coming;                  // out of sources, in order
  std::deque<Coming> riding;                  // out of links, in order of coming out
  std::vector<Visit> visits;                  // by number
  std::vector<uint32_t> slot_of;              // by number; kNoSlot: not in the crowd
  std::vector<Person> persons;                // by slot
  std::vector<WaitingLine> lines;             // by queue
  std::vector<Landing> landings;              // by link
  std::vector<std::vector<uint64_t>> groups;  // numbers
  std::vector<DoorQueue> doors;               // by area: who chose it
  std::vector<ObstacleId> obstacles;  // by obstacle; none before it begins, and after it ends
  std::vector<ObstacleTimes> obstacle_times;
  uint64_t entered = 0, left = 0;

  [[nodiscard]] double time() const { return static_cast<double>(steps) * scenario.dt; }
  [[nodiscard]] int32_t class_of(const Person& p) const {
    return classes[p.profile < 0 ? classes.size() - 1 : static_cast<size_t>(p.profile)];
  }
  [[nodiscard]] const Stage& stage_of(const Person& p) const {
    return scenario.journeys[static_cast<size_t>(p.journey)].stages[p.stage];
  }
  [[nodiscard]] const std::vector<TargetId>& targets_of(const Person& p) const {
    return stage_targets[static_cast<size_t>(p.journey)][p.stage];
  }
  [[nodiscard]] bool is_here(uint32_t slot) const {
    return slot < persons.size() && static_cast<bool>(persons[slot].id);
  }
  [[nodiscard]] Person* person(uint64_t number) {
    const uint32_t slot = slot_of[number];
    return slot == kNoSlot ? nullptr : &persons[slot];
  }
  /// The person's next random number, [0, 1).
  double unit(Person& p) const;

  static Result<Nodes> nodes_for(const World& world, const Scenario& scenario, int32_t workers,
                                 Context& context);

  // simulation.cpp: what the scenario's names mean.
  Result<void> prepare(Context& context);
  Result<TargetId> target_of(std::span<const int32_t> areas, Context& context);
  Result<void> prepare_stage(const Stage& stage, std::vector<TargetId>& targets, Context& context);
  Result<void> find_places(int32_t area, int32_t avatar_class, const std::string& who,
                           Context& context);

  void mind_obstacles();
  void note_obstacles();

  // coming.cpp
  void call_in();
  Result<void> let_in(std::deque<Coming>& queue, Context& context);
  Place place_for(Coming& coming);
  Place place_in_rows(const Source& source, uint64_t nth, Person& p);
  Place random_spot(std::span<const int32_t> areas, int32_t density, Person& p);
  void enter(const Coming& coming, AvatarId id);

  // journeys.cpp
  void begin_stage(Person& p);
  void finish_stage(Person& p);
  void next_stage(Person& p);
  void stand(Person& p, Doing doing);
  void walk_to(Person& p, const Place& place, Doing doing);
  void choose_area(Person& p);
  void line_up(Person& p, int32_t area, double way);
  void line_up_anew(Person& p);
  void arrive(Person& p);
  void leave(Person& p);
  void take_out(Person& p);
  void end_waits();
  void look_around();
  [[nodiscard]] int32_t area_under(const Person& p) const;

  // lines.cpp
  [[nodiscard]] Place in_line(const Queue& queue, size_t index, int32_t avatar_class) const;
  void move_lines();
  void run_links();

  // paces.cpp
  void mind_paces();

  // groups.cpp
  [[nodiscard]] bool group_is_ready(const Person& p);
  void keep_together();
};

}  // namespace throng
