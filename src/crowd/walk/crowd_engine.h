// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/arrays/huge_array.h"
#include "core/arrays/release.h"
#include "core/function_ref.h"
#include "crowd/ground/body.h"
#include "crowd/ground/stride_ground.h"
#include "crowd/mode/avatar_names.h"
#include "crowd/mode/engine_counts.h"
#include "crowd/mode/given_moves.h"
#include "crowd/mode/orientation.h"
#include "crowd/walk/move_config.h"
#include "crowd/walk/neighbour_grid.h"
#include "crowd/walk/queue.h"
#include "crowd/walk/step_exchange.h"
#include "crowd/walk/step_units.h"
#include "steer/lanes.h"
#include "steer/models.h"
#include "steer/sampled.h"
#include "steer/turning_radius.h"

/// The step of a crowd with goals as passes over arrays: sort, sense and steer, resolve conflicts,
/// settle. test/support/plain_crowd.h does the same in the simplest code.
namespace throng::crowd {

/// The capacity for `needed` elements in an array of `capacity`: doubling, as vectors do, would
/// leave up to half of the memory unused.
inline size_t grown(size_t capacity, size_t needed) {
  return needed <= capacity ? capacity : std::max(needed, capacity + capacity / 4);
}

/// How many cells to each side a query range covers.
inline int32_t cells_of(float query_range) {
  return static_cast<int32_t>(query_range) / world::kUnitsPerCell + 1;
}

/// Which bodies are in low detail, and what that means. docs/design/008-engine.md, "Levels of
/// detail".
struct EngineDetail {
  struct View {
    float x = 0, z = 0, y = 0;  ///< From the world's corner. [m]
    float radius = 0;           ///< Bodies within are in full detail. [m]
  };
  std::span<const View> views;  ///< None: all bodies are in full detail.
  int32_t steps = 1;            ///< At once, at most.
  float reaction = 1;           ///< [s]
  int32_t narrowest = 0;        ///< No move is longer. [units]
};

class CrowdEngine {
 public:
  /// For a world of width x depth cells and classes; grounds of those that are used must be set.
  CrowdEngine(const MoveConfig& config, int32_t width, int32_t depth, size_t classes);

  void set_ground(size_t avatar_class, const StrideGround& ground);
  /// Bounds the turns of a class. [m; 0: no bound]
  void set_turning_radius(size_t avatar_class, float radius);
  /// Slopes slow one class as they do another.
  void copy_slope_factors(size_t to, size_t from);
  /// No body may be wider or faster. To be called before the first such body is added.
  void fit(int32_t widest, float fastest, float dt);
  /// A body may become that tall. [mm]
  void expect_height(int32_t tallest) { highest_ = highest_ < tallest ? tallest : highest_; }
  /// From the next step on; the views must stay until it is over.
  void set_detail(const EngineDetail& detail);
  /// Steps turn these, by slot; they must stay until the next call. At first there are none.
  void set_orientations(std::span<Orientation> by_slot) { orientations_ = by_slot; }
  /// What avatars are called, where it is not their slot; it must stay.
  void set_names(const AvatarNames& names) { names_ = &names; }
  /// What a body does may depend on it.
  [[nodiscard]] uint32_t name_of(const Body& body) const {
    return names_ == nullptr ? body.slot : names_->name_of(body.slot);
  }
  /// Reserves memory for so many bodies. The bodies stay.
  void reserve(size_t bodies);
  [[nodiscard]] std::span<Body> bodies() const { return {bodies_.data(), size_}; }
  void add(const Body& body);
  /// Removes the last bodies.
  void shrink(size_t size) { size_ = size; }

  // crowd_engine_slopes.cpp: MoveConfig::slope_factors slow bodies, others' speeds are these.
  /// Its desired speed on level ground. [m/s]
  [[nodiscard]] float level_speed(const Body& body) const {
    return body.slowed ? level_speeds_[body.slot] : body.speed;
  }
  /// Sets it. The slope where the body is slows it as before.
  void set_level_speed(Body& body, float speed);
  /// No slope slows it, until it decides again.
  void end_slowing(Body& body) { slow_down(body, level_speed(body), 1); }
  /// By slot, of all slots; those of slowed bodies count.
  [[nodiscard]] std::vector<float>& level_speeds() { return level_speeds_; }
  [[nodiscard]] const std::vector<float>& level_speeds() const { return level_speeds_; }

  /// One step. `step`: its number, for the order of proposed moves. `before` is called first for
  /// all bodies, some at a time, on any worker.
  using Before = FunctionRef<void(std::span<Body>, int32_t worker)>;
  /// With an exchange the crowd is shared with other engines of the same settings.
  void step(uint64_t step, Before before, EngineCounts& counts, EngineTimes& times,
            StepExchange* exchange = nullptr);

  // crowd_engine_ghosts.cpp, for StepExchange::exchange_bodies.
  /// Others see the n-th of bodies() in this step.
  void show_to_others(size_t n) { bodies_[n].is_shown = true; }
  /// The n-th of bodies() as others see it in this step.
  [[nodiscard]] Ghost ghost_of(size_t n, uint64_t step) const;
  /// What it chose when it last decided: a body that another engine moves from now on takes it
  /// along. [m/s]
  [[nodiscard]] steer::Plane choice(uint32_t slot) const { return choices_[slot]; }
  /// Does its preferred velocity follow from all else that a ghost has?
  [[nodiscard]] static bool finds_preferred(const Body& body) {
    return !body.has(Body::kExternal) && !body.has(Body::kMovedElsewhere) && body.steps > 0;
  }
  [[nodiscard]] StepUnits units() const { return config_.units; }
  /// Moves a body from now on, as it was before a step, that another engine has moved.
  void take_over(const Ghost& ghost, steer::Plane choice, uint64_t step);
  /// How far bodies see, at most. [units]
  [[nodiscard]] int32_t sight() const { return sight_; }
  /// After how many steps a body that continues decides again.
  [[nodiscard]] uint64_t steps_of_reaction(const Body& body) const;
  // Rows by slot.
  void reserve_rows(size_t rows) {
    progress_.reserve(rows);
    choices_.reserve(rows);
    if (!config_.queues) return;
    for (auto& requests : requests_) requests.reserve(rows);
  }
  void fit_rows(size_t rows) {
    if (rows <= progress_.size()) return;
    progress_.resize(rows);
    choices_.resize(rows);
    if (!config_.queues) return;
    for (auto& requests : requests_) requests.resize(rows);
  }
  void forget_rows() {
    release(progress_);
    release(choices_);
    for (auto& requests : requests_) release(requests);
  }
  void clear_rows(uint32_t slot) {
    fit_rows(slot + size_t{1});
    progress_[slot] = {};
    choices_[slot] = {};
  }
  /// Bytes of a saved row.
  static constexpr size_t row_bytes(bool queues) {
    return sizeof(QueueProgress) + sizeof(steer::Plane) + (queues ? sizeof(RoomRequest) : 0);
  }
  void save_rows(size_t rows, std::vector<uint8_t>& out) const;
  /// Could a crowd have saved the rows of a body?
  [[nodiscard]] bool has_sound_rows(const Body& body) const;
  const uint8_t* restore_rows(const uint8_t* saved, size_t rows);
  /// A body that rests does not any more: it heads to another place.
  void wake(Body& body) {
    body.at_rest = false;
    progress_[body.slot].wake();
  }
  /// Length of a body's path after its local target. [m]
  void set_path_after(uint32_t slot, float length) { progress_[slot].after = length; }
  /// Do its bodies queue? None does with another model than kSampled.
  [[nodiscard]] bool queues() const { return config_.queues; }
  /// From a body's local target to its path some metres on; 0 at the end of the path. [m]
  void set_onward(uint32_t slot, steer::Plane onward) { progress_[slot].onward = onward; }
  /// How long a body has stood. [s]
  [[nodiscard]] float stood(uint32_t slot) const { return progress_[slot].stood; }
  [[nodiscard]] float path_after(uint32_t slot) const { return progress_[slot].after; }
  /// Could another like it stand beside it, across its path?
  [[nodiscard]] bool has_room_for_two(const Body& body) const;
  /// Slots of the bodies that arrived in the last step, in no order.
  [[nodiscard]] std::span<const uint32_t> arrived() const { return arrived_; }
  [[nodiscard]] uint64_t bytes() const;

  /// Two bodies can touch only if the heights of their feet differ by less than a body's height and
  /// what both can rise in a step. [mm]
  static constexpr int32_t kMaxRise = 450;
  /// The longest step. [units]
  static constexpr int32_t kLongestStep = 32000;

 private:
  // Displacements of a contest and the bodies that it could touch are words of four bytes. What
  // does not fit into a proposed move lies in the list of the worker that decided.
  static constexpr size_t kWords = 10;
  struct Displacement {
    int16_t x, z;  // [units]
  };
  // Where a body would move in this step. If it could touch others: which, and its candidate
  // displacements, the best first. Those after the first are found when they are needed.
  struct Proposal {
    Stand place;
    uint8_t round;  // in which it was proposed, from 1; 0: before
    uint8_t flags;  // Body::kContinues
    uint8_t candidate_count : 4;
    bool has_all : 1;
    bool asks : 1;                       // Body::asks, from the next step on
    bool yields : 1;                     // to an oncoming body that asks
    bool in_stream : 1;                  // that meets another
    bool may_rest : 1;                   // near its goal
    Rest rest : 2;                       // then: from the next step on
    bool in_counterflow : 1;             // Body::in_counterflow, from the next step on
    bool forgets : 1;                    // No space is left for the candidates: they are found
                                         // again.
    bool is_in_list : 1;                 // The last words state where in which worker's list the
                                         // others lie.
    uint32_t others;                     // how many
    std::array<uint32_t, kWords> words;  // candidates from the front, others from the back

    [[nodiscard]] Displacement displacement(uint32_t w) const {
      return std::bit_cast<Displacement>(words[w]);
    }
    void add_displacement(Displacement displacement) {
      words[candidate_count++] = std::bit_cast<uint32_t>(displacement);
    }
    [[nodiscard]] bool has_room(size_t more) const {
      return more + (is_in_list ? 2 : others) <= kWords;
    }
  };
  static_assert(sizeof(Proposal) == sizeof(Body) && std::is_trivially_copyable_v<Proposal>);
  // A bit for each body.
  struct Contests {
    uint64_t open = 0;        // it could touch others, and is undecided
    uint64_t unproposed = 0;  // of these: it has proposed no move for the first round
  };
  struct Worker {
    std::vector<float> squares;
    std::vector<uint32_t> entries, touched;
    std::vector<uint32_t> others;
    steer::Situation situation;
    bool waits = false;           // it yields to another, instead of its preferred velocity
    bool in_counterflow = false;  // a stream comes towards it
    bool follows = false;         // Body::follows
    QueueOrder own;               // own_order(), once it was needed
    bool is_close = false;        // a neighbour is within QueueSettings::ahead_range
    bool in_stream = false;       // that meets another
    steer::Plane not_left;        // to its right, if it must keep to its half; else 0
    std::optional<steer::Plane> makes_room;  // in this direction: another asks it to
    std::optional<RoomRequest> asks;
    bool yields = false;  // the one that asks comes towards it
    EngineCounts counts;

    // What it sensed of the last body.
    void forget() {
      waits = in_counterflow = follows = in_stream = yields = false;
      own = {};
      is_close = false;
      not_left = {};
      makes_room.reset();
      asks.reset();
    }
  };
  using Displacements = std::array<Displacement, steer::kChoices>;
  // What is tried if no candidate is clear: parts of the first.
  static constexpr std::array<float, 3> kShorterParts = {0.5f, 0.25f, 0.1f};
  static Displacement shorter(Displacement displacement, float part) {
    return {static_cast<int16_t>(std::lrint(static_cast<float>(displacement.x) * part)),
            static_cast<int16_t>(std::lrint(static_cast<float>(displacement.z) * part))};
  }

  void fit_grid();
  void choose_detail(Body& body, uint64_t step) const;
  [[nodiscard]] bool is_near(const Body& body) const;
  [[nodiscard]] uint64_t steps_in_low_detail(const Body& body) const;
  // To convert between its velocity and its move in this step.
  [[nodiscard]] StepUnits units_of(const Body& body) const {
    const auto steps = static_cast<float>(body.steps);
    return {config_.units.unit, body.steps < 2 ? config_.units.dt : config_.units.dt * steps};
  }
  // No move of it in this step is longer. [units]
  [[nodiscard]] int32_t stride_of(const Body& body) const {
    if (body.steps == 0) return 0;
    return units_of(body).stride(body.speed) + (body.has(Body::kExternal) ? 1 : 0);
  }
  // A body that takes several steps at once relies on conflict resolution alone. One in low detail
  // that takes a single step is steered in full: without that, it would block others so often that
  // it costs more than the query.
  static bool ignores_neighbours(const Body& body) { return body.steps > 1; }
  // Steered by the model of our own, and in full.
  [[nodiscard]] bool is_sampled(const Body& body) const {
    return config_.model == SteeringModel::kSampled && !ignores_neighbours(body);
  }
  [[nodiscard]] steer::Plane preferred_of(const Body& body, float detour_angle) const;
  [[nodiscard]] bool continues(const Body& body, uint64_t step) const;
  void slow_down(Body& body, float level_speed, float factor);
  void slow_on_slope(Body& body);
  [[nodiscard]] float turned_aside(const Body& body) const;
  void prefer_all(uint64_t step, Before before);
  void decide_all(EngineCounts& counts);
  bool decide(uint32_t i, uint16_t w, const NeighbourGrid::Around& around);
  void prefetch_ground(size_t i) const;
  std::optional<bool> try_to_continue(uint32_t i, uint16_t w, uint32_t square);
  void list_touched(const Body& body, const SeenLists& lists, Worker& worker) const;
  static void fit_lists(const NeighbourGrid::Around& around, Worker& worker);
  [[nodiscard]] float touch_of(const Body& body) const;
  [[nodiscard]] std::span<uint32_t> find_nearest(uint32_t i, const NeighbourGrid::Around& around,
                                                 bool lists_others, Worker& worker) const;
  void sense(uint32_t i, Worker& worker, const NeighbourGrid::Around& around, bool lists_others);
  static void step_back(const Body& body, steer::Plane apart, float room, Worker& worker);
  void prefer(uint32_t i, std::span<uint32_t> nearest, Worker& worker) const;
  bool find_open_preferred(uint32_t i, Worker& worker, const NeighbourGrid::Around& around);
  bool go_straight(const Body& body, steer::Situation& situation) const;
  struct Sides {
    float left, right;  // [m]
  };
  // The vector to its local target; of a body without one, its preferred velocity.
  [[nodiscard]] steer::Plane path_ahead(const Body& body) const {
    const bool is_led = body.has(Body::kExternal) || !body.has(Body::kHasGoal);
    return is_led
               ? body.preferred
               : config_.units.metres(body.local_target_x - body.x, body.local_target_z - body.z);
  }
  [[nodiscard]] Sides sides_of(const Body& body) const;
  [[nodiscard]] bool has_oncoming(const Body& body, const Worker& worker) const;
  [[nodiscard]] steer::Plane path_beyond(const Body& body) const;
  [[nodiscard]] bool go_on_alike(const Body& body, const Body& other) const;
  [[nodiscard]] bool comes_towards(const Body& body, const Body& other, steer::Plane apart) const {
    const steer::Plane own = body.preferred, others = other.preferred;
    const int against = own.x * others.x + own.z * others.z < 0 ? 1 : 0;
    const int comes = steer::comes_towards(apart, path_ahead(body), path_ahead(other),
                                           config_.lanes.narrow_opposed)
                          ? 1
                          : 0;
    return (against & comes) != 0 && !(config_.queues && go_on_alike(body, other));
  }
  void keep_right(const Body& body, Worker& worker) const;
  bool choose_lane(uint32_t i, Worker& worker, const NeighbourGrid::Around& around);
  [[nodiscard]] steer::Plane if_blocked(steer::Plane displacement,
                                        const steer::Situation& situation) const;

  // crowd_engine_queue.cpp
  [[nodiscard]] QueueOrder order_of(const Body& body) const;
  const QueueOrder& own_order(const Body& body, Worker& worker) const;
  [[nodiscard]] bool meets_stream(const Body& body, std::span<const uint32_t> nearest,
                                  const Worker& worker) const;
  [[nodiscard]] bool is_close(steer::Plane apart, float room) const {
    const float range = room + config_.queue.ahead_range;
    return apart.x * apart.x + apart.z * apart.z < range * range;
  }
  float room_in_queue(const Body& body, const Body& other, float room, Worker& worker) const;
  void query_queue(uint32_t i, std::span<const uint32_t> nearest,
                   const NeighbourGrid::Around& around, Worker& worker) const;
  [[nodiscard]] steer::Plane aside_of(const Body& body, steer::Plane away, steer::Plane from,
                                      steer::Plane asked, float room) const;
  [[nodiscard]] bool takes_turn(const Body& body, const Body* asker, const QueueOrder& first) const;
  [[nodiscard]] bool has_turn(const Body& body, std::span<const uint32_t> nearest) const;
  bool is_head(const Body& body, std::span<const uint32_t> nearest, Worker& worker) const;
  [[nodiscard]] static steer::Plane unless_left(const Worker& worker, steer::Plane velocity);
  [[nodiscard]] steer::Plane unless_back(const Body& body, const Worker& worker,
                                         steer::Plane velocity) const;
  [[nodiscard]] bool can_move(const Body& body, Displacement displacement,
                              std::span<const uint32_t> others) const;
  [[nodiscard]] bool find_room(const Body& body, steer::Plane best, const Worker& worker,
                               std::span<const uint32_t> others, Displacements& candidates) const;
  [[nodiscard]] bool stands(const Body& body) const;
  void settle_queue(Body& body, bool stood, const Proposal& proposal, float dt);
  [[nodiscard]] bool is_paused(const Body& body) const;
  [[nodiscard]] steer::Plane reachable(const Body& body, steer::Plane velocity) const;
  [[nodiscard]] bool may_turn_aside(const Body& body) const;
  [[nodiscard]] bool queues(const Body& body) const;
  // Without queues all push; with them those in a stream that meets another.
  [[nodiscard]] bool pushes(const Body& body) const { return !config_.queues || body.in_stream; }

  // crowd_engine_rest.cpp
  [[nodiscard]] bool may_rest(const Body& body) const;
  [[nodiscard]] bool rests(const Body& body) const;
  template <typename Is>
  bool any_at_rest(uint32_t i, const NeighbourGrid::Around& around, Is is) const;
  [[nodiscard]] bool is_goal_taken(uint32_t i, const NeighbourGrid::Around& around) const;
  [[nodiscard]] bool touches_resting(uint32_t i, const NeighbourGrid::Around& around) const;
  [[nodiscard]] Rest next_rest(uint32_t i, const NeighbourGrid::Around& around) const;

  [[nodiscard]] float wall_distance(const Body& body, float displacement, float query_range) const;
  void query_wall_ahead(const Body& body, steer::Situation& situation) const;
  void query_walls(const Body& body, steer::Situation& situation) const;
  // Walls count by the time until they are reached, and a body that comes too near slows down to
  // 0.118 s of its speed before one. Faster bodies than this would not reach a goal beside a wall
  // to 0.3 m, and in a small room not move at all. They stop as well as others do, within a step:
  // to them walls are as near as to a body of this speed. [m/s]
  static constexpr float kMaxWallSpeed = 2.5f;
  [[nodiscard]] static float wall_scale(const Body& body) {
    return std::max(1.0f, speed_limit(body) / kMaxWallSpeed);
  }
  [[nodiscard]] float wall_range(const Body& body) const {  // [units]
    return std::min(speed_limit(body), kMaxWallSpeed) * config_.steering.wall_horizon /
           config_.units.unit;
  }
  void find_candidates(const Body& body, Worker& worker, bool open, Displacements& candidates);
  // Its turns are read from its last move: were that rounded to the nearest unit, those of short
  // steps would all be lost.
  [[nodiscard]] bool is_turn_bounded(const Body& body) const {
    return !turning_radii_.empty() && turning_radii_[body.avatar_class] > 0;
  }
  // Moves are whole units. A body whose moves are of few units decides in each step, and its moves
  // are rounded up or down in turn: else it would be too slow, or stand.
  [[nodiscard]] bool has_short_moves(const Body& body) const {
    return is_turn_bounded(body) || units_of(body).is_short(body.speed);
  }
  // One that is externally controlled is never moved farther than it was given.
  [[nodiscard]] Displacement given_displacement(const Body& body, steer::Plane velocity) const {
    const StepUnits units = units_of(body);
    if (velocity.x == body.preferred.x && velocity.z == body.preferred.z) {
      const GivenMove given(body, units.units_by_speed());
      return {static_cast<int16_t>(given.x.units), static_cast<int16_t>(given.z.units)};
    }
    const steer::Plane cut = cut_to(velocity, size_of(body.preferred));
    const uint64_t n = step_ + name_of(body);
    return {static_cast<int16_t>(units.displacement_within(cut.x, n)),
            static_cast<int16_t>(units.displacement_within(cut.z, n))};
  }
  [[nodiscard]] Displacement displacement_of(const Body& body, steer::Plane velocity) const {
    const StepUnits units = units_of(body);
    if (is_turn_bounded(body)) {
      velocity = steer::within_turning_radius(body.velocity, velocity, units.dt,
                                              turning_radii_[body.avatar_class]);
    }
    if (body.has(Body::kExternal)) return given_displacement(body, velocity);
    if (has_short_moves(body) || gains_little_) {
      const uint64_t n = step_ + name_of(body);
      return {static_cast<int16_t>(units.small_displacement(velocity.x, n)),
              static_cast<int16_t>(units.small_displacement(velocity.z, n))};
    }
    return displacement_again(body, velocity);
  }
  // Of a velocity that a move gave: the same move again.
  [[nodiscard]] Displacement displacement_again(const Body& body, steer::Plane velocity) const {
    const StepUnits units = units_of(body);
    return {static_cast<int16_t>(units.displacement(velocity.x)),
            static_cast<int16_t>(units.displacement(velocity.z))};
  }
  [[nodiscard]] Displacement chosen_displacement(const Body& body) const;
  void add_ghosts(std::span<const Ghost> ghosts);
  void add_with_rows(const Body& body, const Ghost& ghost, uint64_t step);
  void list_shared();
  struct Shared {
    uint32_t name = 0, body = 0;
  };
  [[nodiscard]] const Shared* find_ghost(uint32_t name) const;
  void exchange_moves(uint8_t round);
  void exchange_accepted(uint8_t round);
  void drop_ghosts();
  void resolve_conflicts(uint64_t step);
  void settle_all(EngineCounts& counts);
  void propose(uint32_t i, Worker& scratch, uint8_t round);
  [[nodiscard]] std::span<const uint32_t> others_of(const Proposal& proposal) const;
  void store_others(Proposal& proposal, uint16_t worker, size_t first);
  [[nodiscard]] bool is_clear(const Body& body, const Stand& place,
                              std::span<const uint32_t> others, bool any_moved) const;
  [[nodiscard]] bool is_accepted(uint32_t i, uint64_t step) const;
  template <class Do>
  void for_contests(uint64_t Contests::*which, Do act);
  bool try_displacement(const Body& body, Displacement displacement, Stand& place) const;
  bool try_displacements(const Body& body, const Displacements& candidates,
                         std::span<const uint32_t> others, Stand& place) const;
  /// Proposed moves lie where the bodies were before they were sorted.
  [[nodiscard]] Proposal* proposals() const {
    return static_cast<Proposal*>(static_cast<void*>(spare_.data()));
  }

  MoveConfig config_;
  uint64_t step_ = 0;                  // the current one
  std::vector<StrideGround> grounds_;  // by class
  std::vector<float> turning_radii_;   // by class, 0: no bound [m]; empty: none has any
  int32_t width_, depth_;
  int32_t widest_ = 0, longest_ = 0, sight_ = 0;
  uint64_t every_ = 1;  // steps of a reaction
  float fastest_ = 0;   // of all bodies [m/s]
  EngineDetail detail_;
  int32_t highest_ = 0;  // of all bodies there ever were [mm]
  size_t size_ = 0;
  HugeArray<Body> bodies_;
  HugeArray<Body> spare_;           // while sorting: the source; then: proposed moves
  std::vector<Contests> contests_;  // of bodies in order
  std::optional<NeighbourGrid> grid_;
  std::vector<Worker> workers_;
  std::vector<uint32_t> arrived_;
  std::vector<float> level_speeds_;
  const AvatarNames* names_ = nullptr;   // null: names are slots
  std::span<Orientation> orientations_;  // by slot
  bool gains_little_ = false;            // of speed in a step: all moves are rounded in turn
  std::vector<QueueProgress> progress_;  // by slot
  std::vector<steer::Plane> choices_;    // by slot: velocities that bodies chose [m/s]
  // By slot: those of this step, which bodies write that ask, and those of the step before, which
  // all read. Valid where Body::asks is set.
  std::array<std::vector<RoomRequest>, 2> requests_;
  StepExchange* exchange_ = nullptr;    // of the current step; null: no other has bodies
  std::vector<Shared> ghosts_, shown_;  // by name, once bodies are sorted
  std::vector<GhostMove> moves_;        // of those shown
  std::vector<uint32_t> accepted_;      // likewise
};

}  // namespace throng::crowd
