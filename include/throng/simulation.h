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

/// A scenario as it runs: people come, go through the stages of their journeys, and leave.
namespace throng {

/// What one step of a simulation did, and how things stand.
struct SimulationReport {
  CrowdReport crowd;
  double time = 0;                ///< After the step. [s]
  uint64_t entered = 0;           ///< So far.
  uint64_t left = 0;              ///< So far.
  uint64_t goal_unreachable = 0;  ///< Now: no way leads to where they are bound for; they stand.
  uint64_t outside = 0;           ///< Now: due to come, but there is no room yet.
  uint64_t in_links = 0;          ///< Now: in lifts and on escalators, so not in the crowd.
};

/// Who came, and what became of him.
struct Visit {
  uint64_t person = 0;   ///< From 0, in order of coming.
  int32_t source = 0;    ///< Of the scenario.
  int32_t profile = -1;  ///< -1: none.
  int32_t journey = -1;  ///< -1: none.
  double entered = -1;   ///< -1: there was no room for him yet. [s]
  double started = 0;    ///< After his premovement. [s]
  double left = -1;      ///< -1: he is still here. [s]
  int32_t exit = -1;     ///< Area by which he left.
  double speed = 0;      ///< Wished. [m/s]
};

/// What became of an obstacle of the scenario.
struct ObstacleTimes {
  double asked = -1;  ///< When it was to come; -1: not yet. [s]
  double up = -1;     ///< When it was up: since then no body was in it; -1: not yet, or never. [s]
  double gone = -1;   ///< When it went; -1: it is still there, or not yet. [s]
  uint32_t inside = 0;     ///< Avatars that stood in its way when it was to come.
  uint32_t waits_for = 0;  ///< Avatars that stand in its way now, so that it is not up.
};

/// Movable, not copyable. One thread at a time. The same scenario gives the same steps on any
/// machine with any number of workers.
class THRONG_API Simulation {
 public:
  /// Where a class climbs or lets itself down over edges, nodes are opened beside the world or, if
  /// it is baked of models, made from these. Fails with kBadInput (an area in which nobody of a
  /// class can stand, ...), kNotFound (a class that the world does not have), and as load_scene,
  /// Nodes::make, Nodes::open, Crowd::create, add and add_target do.
  [[nodiscard]] static Result<Simulation> make(const World& world, const Scenario& scenario,
                                               int32_t workers, Context& context);
  Simulation(Simulation&&) noexcept;
  Simulation& operator=(Simulation&&) noexcept;
  ~Simulation();

  /// One step of the scenario's dt. Fails as Crowd::add does.
  [[nodiscard]] Result<SimulationReport> step();
  /// True once nobody is here, outside or in a link, and nobody will come.
  [[nodiscard]] bool is_over() const;

  [[nodiscard]] const Crowd& crowd() const;
  /// All who are in the crowd, in ascending order of id, which is the number of the person (modulo
  /// 2^32).
  void read(std::vector<AvatarState>& out) const;
  /// XXH3 of the crowd and of what all are about to do.
  [[nodiscard]] uint64_t state_hash() const;
  /// Everybody who ever came, in order of coming.
  [[nodiscard]] std::span<const Visit> visits() const;

  /// Of each obstacle of the scenario, in its order.
  [[nodiscard]] std::span<const ObstacleTimes> obstacle_times() const;

  /// Puts other weights in place of a density map's, as many, from the next draw on. Fails with
  /// kNotFound, kBadInput (another number of pixels, or all are 0).
  [[nodiscard]] Result<void> set_density(const std::string& name, std::span<const uint8_t> weights);

 private:
  struct State;
  explicit Simulation(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace throng
