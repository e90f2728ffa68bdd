// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "core/huge_array.h"
#include "crowd/body.h"
#include "crowd/neighbour_grid.h"
#include "crowd/step_units.h"
#include "crowd/stride_ground.h"
#include "steer/lanes.h"
#include "steer/sampled.h"

/// The step of a crowd with goals as passes over arrays: sort, sense and steer, commit in rounds,
/// settle. test/support/plain_crowd.h is the same, as plainly as it can be written.
namespace throng {

struct EngineConfig {
  StepUnits units;
  float sight = 5;  ///< [m]
  int32_t rounds = 3;
  bool patient = true;
  float reaction = 0.2f;  ///< Whoever does as he decided decides again after that. [s]
  uint64_t seed = 1;
  int32_t workers = 0;
  steer::SampledSettings steering;
  steer::Patience patience;
  steer::LaneSettings lanes;
  steer::RoomSettings room;
};

/// What a step did, summed over all bodies.
struct EngineCounts {
  uint64_t contested = 0;  // could touch somebody
  uint64_t stood = 0;
  int64_t progress = 0;  // speeds towards aims by those wished, millionths

  void add(const EngineCounts& other);
};

class CrowdEngine {
 public:
  /// For a world of width x depth cells and classes; grounds of those that are used must be set.
  CrowdEngine(const EngineConfig& config, int32_t width, int32_t depth, size_t classes);

  void set_ground(size_t avatar_class, const StrideGround& ground);
  /// No body may be wider than so many units, nor faster. Before the first body that is.
  void fit(int32_t widest, float fastest, float dt);
  /// Makes room for so many. Bodies stay.
  void reserve(size_t bodies);
  [[nodiscard]] std::span<Body> bodies() const { return {bodies_.data(), size_}; }
  void add(const Body& body);
  /// Takes the last ones away.
  void shrink(size_t size) { size_ = size; }

  struct Times {
    double plan = 0, sort = 0, steer = 0, commit = 0, settle = 0;  // [s]
  };
  /// One step. `step`: its number, for the order of claims. `before` is called for all bodies
  /// first, some at a time, on any worker.
  using Before = std::function<void(std::span<Body>, int32_t worker)>;
  void step(uint64_t step, const Before& before, EngineCounts& counts, Times& times);
  /// Who keeps to what he decided decides again after so many.
  [[nodiscard]] uint64_t steps_of_reaction() const { return every_; }
  /// Slots of those who arrived in the last step, in no order.
  [[nodiscard]] std::span<const uint32_t> arrived() const { return arrived_; }
  [[nodiscard]] uint64_t bytes() const;

  /// Heights of two bodies' feet between which, and of what they can rise in a step, they could
  /// touch. [mm]
  static constexpr int32_t kMostRise = 450;

 private:
  // Somebody who could touch others: whom, and where he would go, the best first; the others are
  // found when they are needed.
  struct Contest {
    uint32_t body;
    uint32_t first, last;  // of `others`
    uint32_t ways;
    bool has_all;
    bool keeps;  // its only way is what it did before
    struct Way {
      int32_t x, z;
    };
    std::array<Way, steer::kChoices + 3> way;
  };
  struct Worker {
    std::vector<float> squares;
    std::vector<uint32_t> entries, touched;
    std::vector<uint32_t> others;
    std::vector<Contest> contests;
    steer::Situation situation;
    bool waits = false;  // for another, instead of doing as he wishes
    EngineCounts counts;
  };

  [[nodiscard]] bool keeps(const Body& body, uint64_t step) const;
  void wish_all(uint64_t step, const Before& before);
  void decide_all(EngineCounts& counts);
  void decide(uint32_t i, Worker& worker, const NeighbourGrid::Around& around);
  void prefetch_ground(size_t i) const;
  bool keep_on(uint32_t i, Worker& worker, uint32_t square);
  void list_touched(const Body& body, const SeenLists& lists, Worker& worker) const;
  size_t fit_lists(const NeighbourGrid::Around& around, Worker& worker) const;
  [[nodiscard]] float touch_of(const Body& body) const;
  void sense(uint32_t i, Worker& worker, const NeighbourGrid::Around& around, bool lists_others);
  bool find_open_wish(uint32_t i, Worker& worker, const NeighbourGrid::Around& around);
  bool go_straight(const Body& body, steer::Situation& situation) const;
  bool take_lane(uint32_t i, Worker& worker, const NeighbourGrid::Around& around);
  [[nodiscard]] steer::Plane if_blocked(steer::Plane way, const steer::Situation& situation) const;
  [[nodiscard]] float metres(float way, float look) const;
  void look_ahead(const Body& body, steer::Situation& situation) const;
  void look_around(const Body& body, steer::Situation& situation) const;
  [[nodiscard]] float wall_look(const Body& body) const {  // [units]
    return body.speed * config_.steering.wall_horizon / config_.units.unit;
  }
  void find_ways(const steer::Situation& situation, bool open, Contest& contest);
  void commit(uint64_t step);
  void settle_all(EngineCounts& counts);
  void name(Contest& contest, const Worker& owner, Worker& scratch, uint8_t round);
  [[nodiscard]] bool is_clear(const Contest& contest, const Worker& owner, const Body& place,
                              bool somebody_moved) const;
  [[nodiscard]] bool holds(const Contest& contest, const Worker& owner, uint8_t round,
                           uint64_t step) const;
  template <class Do>
  void for_contests(Do act);
  bool try_place(const Body& body, int32_t x, int32_t z, Body& place) const;

  EngineConfig config_;
  std::vector<StrideGround> grounds_;  // by class
  int32_t width_, depth_;
  int32_t widest_ = 0, longest_ = 0, sight_ = 0;
  uint64_t every_ = 1;   // steps of a reaction
  int32_t highest_ = 0;  // of all bodies there ever were [mm]
  size_t size_ = 0;
  HugeArray<Body> bodies_;
  HugeArray<Body> spare_;  // while sorting: where from; then: where to
  std::optional<NeighbourGrid> grid_;
  std::vector<Worker> workers_;
  std::vector<uint32_t> arrived_;
};

}  // namespace throng
