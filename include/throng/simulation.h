// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "throng/avatar_state.h"
#include "throng/base.h"
#include "throng/context.h"
#include "throng/crowd.h"
#include "throng/result.h"
#include "throng/scenario.h"
#include "throng/world.h"

/// A running scenario: avatars enter, do the stages of their journeys, and leave.
namespace throng {

/// What one step of a simulation did, and its state afterwards.
struct SimulationReport {
  CrowdReport crowd;
  double time = 0;                ///< After the step. [s]
  uint64_t entered = 0;           ///< So far.
  uint64_t left = 0;              ///< So far.
  uint64_t goal_unreachable = 0;  ///< Now: avatars that stand because no path leads to their goals.
  uint64_t outside = 0;           ///< Now: due to enter, but without free space yet.
  uint64_t in_links = 0;          ///< Now: in lifts and on escalators, so not in the crowd.
};

/// A trip: one avatar from entering to leaving.
struct Visit {
  uint64_t person = 0;   ///< From 0, in order of entering.
  int32_t source = 0;    ///< Of the scenario.
  int32_t profile = -1;  ///< -1: none.
  int32_t journey = -1;  ///< -1: none.
  double entered = -1;   ///< -1: not yet, for lack of free space. [s]
  double started = 0;    ///< After the premovement time. [s]
  double left = -1;      ///< -1: not yet. [s]
  int32_t exit = -1;     ///< Area by which it left.
  double speed = 0;      ///< Desired. [m/s]
};

/// Times of an obstacle of the scenario.
struct ObstacleTimes {
  double asked = -1;  ///< When it was requested; -1: not yet. [s]
  double up = -1;     ///< When it came up: no body is in it since then; -1: not yet, or never. [s]
  double gone = -1;   ///< When it was removed; -1: not yet. [s]
  uint32_t inside = 0;     ///< Avatars inside at the request.
  uint32_t waits_for = 0;  ///< Avatars inside now, for which it waits.
};

/// A simulation of a scenario. Movable, not copyable. One thread at a time. The same scenario gives
/// the same steps on any machine with any number of workers.
class THRONG_API Simulation {
 public:
  /// Makes a simulation. If a class climbs or drops, the nodes beside the world are opened or, for
  /// a world baked from models, made from these. Fails with kBadInput (an area in which a class
  /// cannot stand, ...), kNotFound (a class that the world does not have), and as load_scene,
  /// Nodes::make, Nodes::open, Crowd::create, add and add_target do.
  [[nodiscard]] static Result<Simulation> make(const World& world, const Scenario& scenario,
                                               int32_t workers, Context& context);
  Simulation(Simulation&&) noexcept;
  Simulation& operator=(Simulation&&) noexcept;
  ~Simulation();

  /// Advances by the scenario's dt. Fails as Crowd::add does.
  [[nodiscard]] Result<SimulationReport> step();
  /// Are all avatars gone, and will no more enter? None is in the crowd, outside or in a link.
  [[nodiscard]] bool is_over() const;

  [[nodiscard]] const Crowd& crowd() const;
  /// Reads the avatars of the crowd in ascending order of id, which is the person's number modulo
  /// 2^32.
  void read(std::vector<AvatarState>& out) const;
  /// XXH3 of the crowd and of the state of all journeys.
  [[nodiscard]] uint64_t state_hash() const;
  /// All trips so far, in order of entering.
  [[nodiscard]] std::span<const Visit> visits() const;

  /// The times of each obstacle of the scenario, in its order.
  [[nodiscard]] std::span<const ObstacleTimes> obstacle_times() const;

  /// Replaces the weights of a density map, from the next draw on. Fails with kNotFound, kBadInput
  /// (another number of pixels, or all are 0).
  [[nodiscard]] Result<void> set_density(const std::string& name, std::span<const uint8_t> weights);

 private:
  struct State;
  explicit Simulation(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace throng
