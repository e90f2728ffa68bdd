// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/function_ref.h"
#include "crowd/climb/climb.h"
#include "crowd/climb/climber_ground.h"
#include "crowd/fly/flight.h"
#include "crowd/fly/flyer_engine.h"
#include "crowd/fly/flyer_grid.h"
#include "crowd/fly/mover_rounds.h"
#include "crowd/ground/body.h"
#include "crowd/walk/crowd_engine.h"
#include "crowd/walk/step_units.h"
#include "steer/air.h"

/// The step of climbers, after those of walkers and flyers: sense, steer, resolve conflicts,
/// settle. docs/design/013-climbers.md.
namespace throng::crowd {

class ClimberEngine {
 public:
  /// `classes`: of the world.
  ClimberEngine(const MoveConfig& config, size_t classes);

  /// Required for each class of which there is a climber.
  void set_ground(size_t avatar_class, const ClimberGround* ground) {
    grounds_[avatar_class] = ground;
  }
  /// As FlyerEngine::fit, for the cylinders that enclose bodies.
  void fit(int32_t widest, float fastest, int32_t tallest, float dt);
  /// The obstacles that are active or close, which outlive it.
  void set_obstacles(const ObstacleGrid* obstacles) { obstacles_ = obstacles; }
  /// Does an active obstacle meet the body? Only obstacles that meet its cylinder are tested.
  [[nodiscard]] bool is_blocked(const ClimberGround& ground, const ClimbCylinder& cylinder,
                                const ClimbPose& pose, double radius) const;

  /// The same for a body that moves there: an obstacle that closes lets a body continue inside it.
  [[nodiscard]] bool is_blocked(const ClimberGround& ground, const Body& body, const Climb& climb,
                                const ClimbCylinder& cylinder, const ClimbPose& pose) const;
  /// Is the body inside an active obstacle?
  [[nodiscard]] bool is_inside(const ClimberGround& ground, const ClimbCylinder& cylinder,
                               const ClimbPose& pose, double radius) const;
  /// Does a body meet an obstacle?
  [[nodiscard]] bool meets_obstacle(const ClimberGround& ground, const ClimbCylinder& cylinder,
                                    const ClimbPose& pose, double radius,
                                    const AirObstacle& obstacle, const path::Solid& solid) const;

  /// As of CrowdEngine.
  void set_orientations(std::span<Orientation> by_slot) { orientations_ = by_slot; }

  /// Called first for each climber, on any worker: it finds and follows the path.
  using Before = FunctionRef<void(Body&, Climb&, int32_t worker)>;
  /// One step of all climbers; `climbs` by slot, `flights` too, or none. Other bodies keep their
  /// places.
  void step(uint64_t step, std::span<Body> bodies, std::span<Climb> climbs,
            std::span<const Flight> flights, Before before, EngineCounts& counts,
            EngineTimes& times);
  /// Slots of the climbers that arrived in the last step.
  [[nodiscard]] std::span<const uint32_t> arrived() const { return arrived_; }
  [[nodiscard]] uint64_t bytes() const;

 private:
  static constexpr size_t kCandidates = 6;
  template <class Test>
  [[nodiscard]] bool any_meets(const ClimberGround& ground, const ClimbCylinder& cylinder,
                               const ClimbPose& pose, double radius, Test test) const;
  struct Displacement {
    ClimberGround::Step step;
    ClimbCylinder cylinder;
    bool on_path = false;  // it does not turn aside
  };
  struct Contest : MoverContest {
    size_t candidate_count = 0;
    std::array<Displacement, kCandidates> displacement;
  };
  struct Move : MoverState {
    Displacement displacement;
    bool yields = false;
  };
  using Rounds = MoverRounds<Contest, Move>;
  using Worker = Rounds::Worker;

  void preferred(Body& body, Climb& climb) const;
  void decide(uint32_t climber, Worker& worker);
  void sense(uint32_t climber, Worker& worker, steer::AirSituation& situation, bool& yields) const;
  [[nodiscard]] bool needs_space(const Body& body, const Climb& climb, const Body& other) const;
  void find_candidates(const Body& body, const Climb& climb, const steer::AirSituation& situation,
                       bool yields, Contest& contest) const;
  [[nodiscard]] bool is_clear(const Contest& contest, const Worker& owner,
                              const ClimbCylinder& cylinder) const;
  bool propose(const Contest& contest, const Worker& owner);
  void settle(uint32_t climber, uint64_t step, EngineCounts& counts);
  void turn(const Body& body, const Climb& climb, const Vec3d& last_axis) const;

  MoveConfig config_;
  std::vector<const ClimberGround*> grounds_;  // by class
  const ObstacleGrid* obstacles_ = nullptr;
  float sight_metres_ = 5, near_metres_ = 5, fastest_ = 0;
  int32_t widest_ = 0, tallest_ = 0;
  std::span<Body> bodies_;
  std::span<Climb> climbs_;
  std::span<const Flight> flights_;
  Rounds rounds_;
  FlyerGrid grid_;
  std::vector<uint32_t> arrived_;
  std::span<Orientation> orientations_;  // by slot
};

}  // namespace throng::crowd
