// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/function_ref.h"
#include "crowd/fly/flight.h"
#include "crowd/fly/flyer_air.h"
#include "crowd/fly/flyer_grid.h"
#include "crowd/fly/mover_rounds.h"
#include "crowd/ground/body.h"
#include "crowd/ground/obstacle_grid.h"
#include "crowd/walk/crowd_engine.h"
#include "crowd/walk/step_units.h"
#include "steer/air.h"
#include "steer/sampled.h"

/// The step of flyers in the air, after that of walkers: sense, steer, resolve conflicts, settle.
/// docs/design/012-flyers.md.
namespace throng::crowd {

class FlyerEngine {
 public:
  /// `classes`: of the world.
  FlyerEngine(const MoveConfig& config, size_t classes);

  /// Required for each class of which there is a flyer. `radius`: the distance that the class keeps
  /// from walls. [m]
  void set_air(size_t avatar_class, const FlyerAir* air, double radius);
  /// As CrowdEngine::fit; no body is taller. [mm]
  void fit(int32_t widest, float fastest, int32_t tallest, float dt);
  /// The obstacles that are active or close, which outlive it.
  void set_obstacles(const ObstacleGrid* obstacles) { obstacles_ = obstacles; }
  [[nodiscard]] bool has_obstacles() const {
    return obstacles_ != nullptr && !obstacles_->is_empty();
  }
  /// Does an obstacle block a move there? One that closes lets a body continue inside it.
  [[nodiscard]] bool is_blocked(const Body& body, const AirPosition& position) const;
  /// Is the position inside an obstacle, so that no such body may be placed there?
  [[nodiscard]] bool is_obstructed(const Body& body, const AirPosition& position) const;
  /// The nearest positions beside, above and below the obstacles that close around a body, not
  /// tested further. `near` is memory.
  void list_exits(const Body& body, std::vector<const ObstacleGrid::Item*>& near,
                  std::vector<AirPosition>& exits) const;

  /// As of CrowdEngine.
  void set_orientations(std::span<Orientation> by_slot) { orientations_ = by_slot; }
  /// How far from its landing place a body comes down that waits for it. [m]
  [[nodiscard]] static float landing_radius(const Flight& flight);
  /// Called first for each flyer, on any worker: it finds and follows the path.
  using Before = FunctionRef<void(Body&, Flight&, int32_t worker)>;
  /// One step of all bodies that fly; `flights` by slot. Other bodies keep their places.
  void step(uint64_t step, std::span<Body> bodies, std::span<Flight> flights, Before before,
            EngineCounts& counts, EngineTimes& times);
  /// Slots of the bodies that arrived in the last step, and the bodies that reached the ground.
  /// These are still flying.
  [[nodiscard]] std::span<const uint32_t> arrived() const { return arrived_; }
  [[nodiscard]] std::span<const uint32_t> landed() const { return landed_; }
  [[nodiscard]] uint64_t bytes() const;

 private:
  static constexpr size_t kShorterMoves = 3;
  struct Contest : MoverContest {
    uint8_t candidate_count = 0;
    std::array<AirPosition, steer::kAirChoices + kShorterMoves + 1> displacement;  // of a step
  };
  struct Move : MoverState {
    AirPosition place;
  };
  using Rounds = MoverRounds<Contest, Move>;
  using Worker = Rounds::Worker;

  void preferred(Body& body, Flight& flight, uint64_t step) const;
  void decide(uint32_t flyer, Worker& worker);
  void sense(uint32_t flyer, Worker& worker, steer::AirSituation& situation, bool& column_is_clear,
             const FlyerAir::GroundAirLink* ground_air_link) const;
  bool query_walls(const Body& body, steer::AirSituation& situation) const;
  [[nodiscard]] bool leads_to_target(const Body& body, const steer::AirSituation& situation) const;
  [[nodiscard]] bool gives_precedence(const Body& body, const Flight& flight, const Body& other,
                                      const Flight& of_other) const;
  [[nodiscard]] int32_t stride_of(const Body& body) const;
  [[nodiscard]] int32_t rise_of(const Body& body, float velocity) const;
  [[nodiscard]] AirPosition displacement_of(const Body& body, steer::Space velocity) const;
  void find_candidates(const Body& body, const steer::AirSituation& situation, bool open,
                       Contest& contest) const;
  void find_curved_candidates(const Body& body, const steer::AirSituation& situation,
                              Contest& contest) const;
  [[nodiscard]] bool flies_curves() const {
    return config_.model == SteeringModel::kCurvilinear && config_.flyer_axes != FlyerAxes::kOurs;
  }
  [[nodiscard]] bool wants_down(const Body& body, const Flight& flight) const;
  [[nodiscard]] bool try_place(const Body& body, const AirPosition& displacement,
                               AirPosition& place) const;
  [[nodiscard]] bool is_clear(const Contest& contest, const Worker& owner,
                              const AirPosition& place) const;
  bool propose(const Contest& contest, const Worker& owner);
  void keep_rest(Body& body, Flight& flight, const AirPosition& to) const;
  void settle(uint32_t flyer, EngineCounts& counts);

  MoveConfig config_;
  uint64_t step_ = 0;  // the current one
  struct OfClass {
    const FlyerAir* air = nullptr;
    double radius = 0;  // [m]
  };
  std::vector<OfClass> classes_;
  const ObstacleGrid* obstacles_ = nullptr;
  float sight_metres_ = 5, near_metres_ = 5, fastest_ = 0;
  std::span<Body> bodies_;
  std::span<Flight> flights_;
  Rounds rounds_;
  FlyerGrid grid_;
  std::vector<uint32_t> arrived_, landed_;
  std::span<Orientation> orientations_;  // by slot
};

}  // namespace throng::crowd
