// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "throng/base.h"
#include "throng/caacd.h"
#include "throng/context.h"
#include "throng/math.h"
#include "throng/result.h"

/// The experiment of [CAACD] section V: a plane with circular obstacles, on which avatars walk to
/// random targets, and how often two of them collide. Lengths are the paper's "float units", time
/// is in frames; coordinates are x and z, y is 0.
namespace throng::caacd {

/// A random space. The paper gives none of these numbers: ours, see docs/design/007-caacd.md.
struct SpaceConfig {
  int32_t avatars = 50;          ///< [1 to 2000]
  double side = 400;             ///< Starts and targets lie in a square of this side. [> 0]
  Fields fields{5, 7.5, 12};     ///< Of every avatar. [> 0, ascending]
  int32_t obstacles = 6;         ///< [0 to 1000]
  double min_obstacle = 8;       ///< Smallest repulsive radius of an obstacle. [> 0]
  double largest_obstacle = 24;  ///< [>= min_obstacle]
  double obstacle_precaution =
      5;                       ///< From an obstacle's repulsive to its precaution radius. [>= 0]
  double obstacle_alert = 15;  ///< From an obstacle's repulsive to its alert radius; not less.
  uint64_t seed = 1;
};

/// Who stands where, heading where. targets[i] belongs to bodies[i], whose id is i.
struct Space {
  std::vector<Body> bodies;
  std::vector<Vec3d> targets;
  std::vector<Obstacle> obstacles;
};

/// Draws obstacles, starts (no two in each other's precaution field), headings, speeds and targets;
/// starts and targets lie outside of all obstacles' alert fields. The same seed gives the same
/// places for every model. Fails with kBadConfig, or with kLimit if they do not fit.
[[nodiscard]] THRONG_API Result<Space> random_space(const SpaceConfig& config, const Model& model);

/// What an avatar is doing.
enum class Activity : uint8_t {
  kTravelling,  ///< To its target.
  kAvoiding,    ///< Its greatest threat.
  kArriving,    ///< Braking, within psi of its target.
  kWaiting,     ///< Until another one has left the place that both want.
  kArrived,     ///< It stands.
};

/// What has happened so far.
struct Counts {
  int64_t frames = 0;
  int64_t collisions = 0;           ///< Entries of a pair into r_rep.
  int64_t obstacle_collisions = 0;  ///< Entries of an avatar into an obstacle's r_rep.
  int64_t arrived = 0;              ///< Who stands at its target now.
  int64_t waiting = 0;              ///< Who waits for another to leave now.
  double walked = 0;                ///< By all together. [length]
};

/// One run. Every frame: forces from the state of the frame before act on all at once, eq. 15, then
/// positions, arrivals, collisions.
class THRONG_API Simulation {
 public:
  /// Fails with kBadConfig (model, dt) or kBadInput (not finite, sizes differ, ids not in order).
  static Result<Simulation> create(Space space, const Model& model, double dt = 1);

  void step();
  /// Does everybody stand at the target, or wait for good?
  [[nodiscard]] bool finished() const;

  [[nodiscard]] std::span<const Body> bodies() const { return space_.bodies; }
  [[nodiscard]] std::span<const Vec3d> targets() const { return space_.targets; }
  [[nodiscard]] std::span<const Obstacle> obstacles() const { return space_.obstacles; }
  [[nodiscard]] std::span<const Activity> activities() const { return activities_; }
  /// By whom each is threatened now.
  [[nodiscard]] std::span<const Threat> threats() const { return threats_; }
  [[nodiscard]] const Counts& counts() const { return counts_; }
  [[nodiscard]] const Model& model() const { return model_; }
  /// Of all positions and velocities, bit by bit.
  [[nodiscard]] uint64_t state_hash() const;
  /// Gives somebody a new target. Fails with kNotFound (no such body) or kBadInput. Time: the
  /// square of the bodies.
  [[nodiscard]] Result<void> send(uint32_t id, Vec3d target);

 private:
  Simulation() = default;
  void find_rivals();
  void negotiate();
  void sense(size_t i);
  void move(size_t i);
  void count();

  Space space_;
  Model model_;
  double dt_ = 1;
  double largest_alert_ = 0;
  std::vector<Activity> activities_;
  std::vector<Threat> threats_;
  std::vector<Vec3d> steer_;
  std::vector<double> stop_before_;    // Who waits stops so far from the target; others 0.
  std::vector<uint8_t> claims_;        // Who may go on to its target.
  std::vector<uint32_t> rival_first_;  // n + 1 offsets into rivals_.
  std::vector<uint32_t> rivals_;       // Whose targets are too near to one's own.
  std::vector<uint8_t> inside_;        // Pair (i, j < i) at i (i - 1) / 2 + j; in r_rep now?
  std::vector<uint8_t> inside_obstacle_;
  Counts counts_;
};

/// The paper's Mass/MaxSpeed/MaxForce.
struct ParameterSet {
  double mass = 2.0;
  double max_speed = 0.4;
  double max_force = 0.06;
  friend bool operator==(const ParameterSet&, const ParameterSet&) = default;
};

/// "2.0/0.4/0.06", as the paper writes it.
[[nodiscard]] THRONG_API std::string name_of(const ParameterSet& set);
/// The model with the set's mass, speed and force.
[[nodiscard]] THRONG_API Model with_set(Model model, const ParameterSet& set);

/// The sets that the paper names: its two bad ones, then its best.
[[nodiscard]] THRONG_API std::vector<ParameterSet> named_sets();

/// A grid over the paper's ranges: masses 1, 1.5, 2; speeds 0.4 to 1.2 by 0.2; forces 0.02, 0.06,
/// 0.10, 0.20. Which of them the paper ran it does not say. The named sets are in it.
[[nodiscard]] THRONG_API std::vector<ParameterSet> grid_sets();

/// What the paper reports for so many avatars: collisions, at most.
struct Reported {
  int32_t bad = 0;     ///< Figure 10: 1.0/1.0/0.06 and 1.0/0.8/0.06.
  int32_t others = 0;  ///< Figure 11: all other sets.
};
[[nodiscard]] THRONG_API Reported reported_collisions(int32_t avatars);

/// Many runs: every set with every number of avatars from every seed.
struct StudyConfig {
  std::vector<ParameterSet> sets = named_sets();
  std::vector<int32_t> avatars = {};  ///< Numbers of avatars. [each 1 to 2000]
  int32_t seeds = 30;                 ///< [1 to 100000]
  int64_t frames = 3000;              ///< A run ends here, or when all have arrived. [1 to 10^7]
  Model model = {};                   ///< All but mass, max_speed and max_force.
  SpaceConfig space = {};             ///< All but avatars; seeds count up from space.seed.
  double dt = 1;                      ///< [frames, 0.001 to 1000]
  int32_t workers = 0;  ///< Threads, 0 for all cores. Never changes the result. [>= 0]
};

/// One set with one number of avatars, over all seeds.
struct StudyCell {
  double mean = 0;       ///< Collisions a run.
  double deviation = 0;  ///< Standard deviation over seeds, n - 1; 0 for one seed.
  int64_t min_collisions = 0;
  int64_t max_collisions = 0;
  double obstacle_mean = 0;  ///< Entries into obstacles a run.
  double arrived = 0;        ///< Of the avatars, at the end. [0 to 1]
  double waiting = 0;        ///< Of the avatars, at the end. [0 to 1]
  double frames = 0;         ///< Mean.
  double walked = 0;         ///< An avatar, mean. [length]
};

/// cells[set * avatars.size() + count].
struct Study {
  std::vector<ParameterSet> sets;
  std::vector<int32_t> avatars;
  std::vector<StudyCell> cells;
  uint64_t hash = 0;  ///< Of the last states of all runs, in order.
  [[nodiscard]] const StudyCell& at(size_t set, size_t count) const {
    return cells[set * avatars.size() + count];
  }
};

/// Runs a study, runs in parallel. Fails with kBadConfig, kLimit (they do not fit), kCancelled.
[[nodiscard]] THRONG_API Result<Study> run_study(const StudyConfig& config, Context& context);

}  // namespace throng::caacd
