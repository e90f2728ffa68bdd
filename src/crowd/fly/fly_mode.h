// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "crowd/fly/flight.h"
#include "crowd/fly/flyer_air.h"
#include "crowd/fly/flyer_engine.h"
#include "crowd/fly/long_search.h"
#include "crowd/ground/obstacle_grid.h"
#include "crowd/mode/mode.h"
#include "crowd/walk/walk_mode.h"
#include "path/air/flight_finder.h"

/// Avatars of classes that fly: in the air their engine moves them, on foot WalkMode does, and this
/// decides when they take off. docs/design/012-flyers.md.
namespace throng::crowd {

class FlyMode final : public Mode, public TakesOff {
 public:
  static constexpr size_t kRowBytes = sizeof(Flight);

  /// `walk` outlives it.
  FlyMode(SharedState& shared, const MoveConfig& config, WalkMode& walk);

  /// By slot; none if no class in use ever flew.
  [[nodiscard]] std::span<const Flight> flights() const { return flights_; }
  /// Null if the class does not fly or is not in use.
  [[nodiscard]] const path::FlightFinder* finder(int32_t avatar_class) const;
  /// Searches that go on, in the order in which they are done.
  [[nodiscard]] std::span<const LongSearch> searches() const { return searches_; }
  /// Of a saved crowd, once its obstacles are known.
  void restore_searches(std::vector<LongSearch> searches) { searches_ = std::move(searches); }

  bool plan_on_foot(Body& body) override;
  bool take_off(Body& body) override;
  [[nodiscard]] bool is_at_link(uint32_t slot) const override {
    return !flights_.empty() && flights_[slot].to_link != 0;
  }

  Result<void> open_class(size_t number, Context& context) override;
  void close_class(size_t number) override;
  [[nodiscard]] bool put(NewAvatar& avatar, const AvatarSpawn& spawn) const override;
  Result<bool> begin_draws(const AvatarSpawn& like) override;
  [[nodiscard]] bool draw(NewAvatar& avatar, const AvatarSpawn& like, uint64_t n) const override;
  void add(const NewAvatar& avatar) override;
  void fit(const BodyExtent& all, float fastest) override;
  void set_goal(Body& body, const Place& goal) override;
  void set_target(Body& body) override;
  void set_velocity(Body& body, const Vec3d& velocity) override;
  void step(std::span<Body> bodies, EngineCounts& counts, EngineTimes& times) override;
  void sync_obstacle(CrowdObstacle& obstacle, size_t number, bool is_new) override;
  void forget_obstacle(const CrowdObstacle& obstacle) override;
  void cut_paths(std::span<const uint32_t> slots, std::span<Body> bodies) override;
  void add_blockers(std::span<const uint32_t> slots, std::span<const Body> bodies,
                    BlockerPairs& found) const override;
  [[nodiscard]] bool is_inside(const Body& body, const ObstacleGrid::Item& obstacle) const override;
  [[nodiscard]] bool leads_out(const Body& body, std::span<const uint32_t> slots) const override;
  void end_leaving(Body& body) override;
  [[nodiscard]] AvatarState state_of(const Body& body) const override;
  [[nodiscard]] uint64_t hash(const Body& body, uint64_t hash) const override;
  void add_memory(CrowdMemory& memory) const override;
  [[nodiscard]] size_t row_count() const override { return flights_.size(); }
  void save(std::vector<uint8_t>& out) const override;
  const uint8_t* restore(const uint8_t* saved, size_t rows) override;
  [[nodiscard]] bool is_sound(const Body& body) const override;
  [[nodiscard]] bool is_in_place(const Body& body) const override;

 private:
  /// Searches of a class that go on at the same time. A search needs memory of its own for as long
  /// as it goes on; the others wait.
  static constexpr size_t kSearchers = 4;
  static constexpr uint32_t kNoSlot = UINT32_MAX;

  /// Of one worker or search, so that a step allocates nothing.
  struct Buffers {
    std::vector<AirPosition> points, over;  // of a path that is found, and of one over it
    bool lands = false;                     // at the end of `points`
    std::vector<AirPosition> exits;
    std::vector<const ObstacleGrid::Item*> near;  // that close around a body
  };
  struct OfClass {
    OfClass(const World& world, const path::FlightFinder& finder, size_t workers,
            const CrowdGround& ground, int32_t number)
        : first_searcher(workers),
          finders(workers + kSearchers, finder),
          paths(workers + kSearchers),
          buffers(workers + kSearchers),
          air(world, finders[0].space(), ground, number) {
      slot_of_searcher.fill(kNoSlot);
    }
    size_t first_searcher;
    // One a worker, then those of searches that go on. Likewise the two below.
    std::vector<path::FlightFinder> finders;
    std::vector<Path> paths;
    std::vector<Buffers> buffers;
    std::array<uint32_t, kSearchers> slot_of_searcher;  // whose search each has begun
    // Of the step: searches that go on, and a bit for each searcher that has one.
    uint32_t active = 0, taken = 0;
    FlyerAir air;
  };
  /// Of the step: a search, its flyer, and the searcher that has it.
  struct ActiveSearch {
    size_t search = 0, body = 0, searcher = kSearchers;
    bool is_begun = false;
    uint64_t boxes = 0;  // that its slice has expanded
  };
  [[nodiscard]] const FlyerAir& air_of(const Body& body) const {
    return classes_[body.avatar_class]->air;
  }
  [[nodiscard]] bool put_in_air(Body& body, const Vec3d& feet) const;
  /// A flyer that reached the ground walks.
  void land(Body& body);

  // fly_plan.cpp
  void plan(Body& body, Flight& flight, int32_t worker);
  /// Of a flyer in a link or without a path. True: its path is not followed.
  bool plan_exit(Body& body, Flight& flight, int32_t worker) const;
  void follow_flight(Body& body, Flight& flight);
  void head_on(Body& body, Flight& flight) const;
  void ask_for_search(Flight& flight) {
    flight.search = kAsked;
    some_ask_.store(true, std::memory_order_relaxed);
  }
  [[nodiscard]] bool head_to_nearest_landing(const Body& body, Flight& flight) const;
  void find_landing_place(Body& body, const Flight& flight) const;

  // fly_on_foot.cpp
  bool take_off_into(Body& body, const AirPosition& there);
  void use_path_on_foot(Body& body, Flight& flight, size_t lane);

  // flight_search.cpp
  [[nodiscard]] bool find_straight(const Body& body, Flight& flight) const;
  /// Begins a search, into the path of a lane: of a worker or a searcher.
  void begin_search(OfClass& parts, size_t lane, const AirPosition& from, const AirPosition& to);
  /// One slice. Adds the boxes that it expands. False: it goes on.
  bool advance_search(OfClass& parts, size_t lane, uint64_t& boxes);
  [[nodiscard]] FlightEnds ends_of(const Body& body, const Flight& flight, const AirPosition& from,
                                   size_t lane) const;
  bool take_points(const Body& body, const Flight& flight, const FlightEnds& ends, size_t lane);
  static void add_points(const OfClass& parts, const FlightEnds& ends, size_t lane,
                         std::vector<AirPosition>& points, bool& lands);

  // flight_slices.cpp
  void advance_searches(std::span<Body> bodies);
  void list_searches(std::span<const Body> bodies);
  uint64_t begin_searches(std::span<Body> bodies, uint64_t left);
  [[nodiscard]] bool choose_searches(std::span<const Body> bodies, uint64_t left);
  void begin(ActiveSearch& active, Body& body, size_t lane);
  void advance(ActiveSearch& active, Body& body);
  void use_path(const LongSearch& search, Body& body, size_t lane);
  bool join_path(Body& body, Flight& flight, const AirPosition& from, size_t lane);
  void restart_searches();

  [[nodiscard]] bool is_clear_of_obstacles(const Body& body, const AirPosition& from,
                                           const AirPosition& to) const;
  bool find_path_over(const Body& body, const AirPosition& from, const AirPosition& to,
                      std::vector<AirPosition>& points) const;
  [[nodiscard]] std::optional<AirPosition> open_position(const Body& body, const AirPosition& at,
                                                         size_t lane) const;

  WalkMode& walk_;
  FlyerEngine engine_;
  std::vector<std::unique_ptr<OfClass>> classes_;  // null: not in use, or it does not fly
  std::vector<Flight> flights_;                    // by slot; empty, if no class in use flies
  std::vector<LongSearch> searches_;
  // Of the step.
  std::vector<size_t> body_of_search_;
  std::vector<ActiveSearch> active_;
  std::vector<std::pair<uint32_t, size_t>> searching_;  // slot and body
  std::atomic<bool> some_ask_{true};                    // Flight::search may be kAsked for some
};

}  // namespace throng::crowd
