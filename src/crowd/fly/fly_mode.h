// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "crowd/fly/flight.h"
#include "crowd/fly/flyer_air.h"
#include "crowd/fly/flyer_engine.h"
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

  bool plan_on_foot(Body& body, int32_t worker) override;
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
  [[nodiscard]] uint64_t hash(std::span<const Body> by_slot, uint64_t hash) const override;
  void add_memory(CrowdMemory& memory) const override;
  [[nodiscard]] size_t row_count() const override { return flights_.size(); }
  void save(std::vector<uint8_t>& out) const override;
  const uint8_t* restore(const uint8_t* saved, size_t rows) override;
  [[nodiscard]] bool is_sound(const Body& body) const override;
  [[nodiscard]] bool is_in_place(const Body& body) const override;

 private:
  /// Of one worker, so that a step allocates nothing.
  struct Buffers {
    std::vector<AirPosition> points, over;  // of a path that is found, and of one over it
    std::vector<AirPosition> exits;
    std::vector<const ObstacleGrid::Item*> near;  // that close around a body
  };
  struct OfClass {
    OfClass(const World& world, const path::FlightFinder& finder, size_t workers,
            const CrowdGround& ground, int32_t number)
        : finders(workers, finder),
          paths(workers),
          buffers(workers),
          air(world, finders[0].space(), ground, number) {}
    std::vector<path::FlightFinder> finders;  // one a worker
    std::vector<Path> paths;
    std::vector<Buffers> buffers;
    FlyerAir air;
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
  void follow_flight(Body& body, Flight& flight) const;
  [[nodiscard]] bool head_to_nearest_landing(const Body& body, Flight& flight) const;
  void find_landing_place(Body& body, const Flight& flight) const;

  // flight_search.cpp
  bool find_flight(const Body& body, Flight& flight, int32_t worker);
  void search(OfClass& parts, size_t worker, const AirPosition& from, const AirPosition& to);
  [[nodiscard]] bool is_clear_of_obstacles(const Body& body, const AirPosition& from,
                                           const AirPosition& to) const;
  bool find_path_over(const Body& body, const AirPosition& from, const AirPosition& to,
                      std::vector<AirPosition>& points) const;
  [[nodiscard]] std::optional<AirPosition> open_position(const Body& body, const AirPosition& at,
                                                         int32_t worker) const;

  WalkMode& walk_;
  FlyerEngine engine_;
  std::vector<std::unique_ptr<OfClass>> classes_;  // null: not in use, or it does not fly
  std::vector<Flight> flights_;                    // by slot; empty, if no class in use flies
};

}  // namespace throng::crowd
