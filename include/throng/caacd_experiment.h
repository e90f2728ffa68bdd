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

/// The experiment of [CAACD] section V: avatars walk to random targets on a plane with circular
/// obstacles, and collisions of pairs are counted. Lengths are the paper's "float units", time is
/// in frames; coordinates are x and z, y is 0.
namespace throng::caacd {

/// Settings of a random space. The paper gives none of these numbers; they are ours:
/// docs/design/007-caacd.md.
struct SpaceConfig {
  int32_t avatars = 50;          ///< [1 to 2000]
  double side = 400;             ///< Starts and targets lie in a square of this side. [> 0]
  Fields fields{5, 7.5, 12};     ///< Of every avatar. [> 0, ascending]
  int32_t obstacles = 6;         ///< [0 to 1000]
  double min_obstacle = 8;       ///< Smallest repulsive radius of an obstacle. [> 0]
  double largest_obstacle = 24;  ///< [>= min_obstacle]
  double obstacle_precaution =
      5;                       ///< Precaution radius less repulsive radius, of an obstacle. [>= 0]
  double obstacle_alert = 15;  ///< Alert radius less repulsive radius. [>= obstacle_precaution]
  uint64_t seed = 1;
};

/// A space: avatars, their targets and obstacles. targets[i] belongs to bodies[i], whose id is i.
struct Space {
  std::vector<Body> bodies;
  std::vector<Vec3d> targets;
  std::vector<Obstacle> obstacles;
};

/// Makes a random space: obstacles, starts (no two in each other's precaution field), headings,
/// speeds and targets. Starts and targets lie outside of all alert fields of obstacles. The same
/// seed gives the same places for every model. Fails with kBadConfig, or with kLimit if they do not
/// fit.
[[nodiscard]] THRONG_API Result<Space> random_space(const SpaceConfig& config, const Model& model);

/// What an avatar does now.
enum class Activity : uint8_t {
  kTravelling,  ///< To its target.
  kAvoiding,    ///< Its greatest threat.
  kArriving,    ///< Braking, within psi of its target.
  kWaiting,     ///< Until another avatar has left the place to which both head.
  kArrived,     ///< It stands.
};

/// Counts of a run so far.
struct Counts {
  int64_t frames = 0;
  int64_t collisions = 0;           ///< Entries of a pair into r_rep.
  int64_t obstacle_collisions = 0;  ///< Entries of an avatar into an obstacle's r_rep.
  int64_t arrived = 0;              ///< Avatars that stand at their targets now.
  int64_t waiting = 0;              ///< Avatars that wait for another one to leave now.
  double walked = 0;                ///< Summed over avatars. [length]
};

/// One run of the experiment. Each frame takes all forces from the state of the frame before,
/// applies eq. 15, and updates positions, arrivals and collisions.
class THRONG_API Simulation {
 public:
  /// Begins a run. Fails with kBadConfig (model, dt) or kBadInput (not finite, sizes differ, ids
  /// not in order).
  static Result<Simulation> create(Space space, const Model& model, double dt = 1);

  void step();
  /// Does each avatar stand at its target, or wait for good?
  [[nodiscard]] bool finished() const;

  [[nodiscard]] std::span<const Body> bodies() const { return space_.bodies; }
  [[nodiscard]] std::span<const Vec3d> targets() const { return space_.targets; }
  [[nodiscard]] std::span<const Obstacle> obstacles() const { return space_.obstacles; }
  [[nodiscard]] std::span<const Activity> activities() const { return activities_; }
  /// The greatest threat of each avatar now.
  [[nodiscard]] std::span<const Threat> threats() const { return threats_; }
  [[nodiscard]] const Counts& counts() const { return counts_; }
  [[nodiscard]] const Model& model() const { return model_; }
  /// Hash of all positions and velocities, bit by bit.
  [[nodiscard]] uint64_t state_hash() const;
  /// Gives an avatar a new target. Fails with kNotFound (no such body) or kBadInput. Time:
  /// quadratic in the bodies.
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
  std::vector<double> stop_before_;    // Avatars that wait stop so far from the target; others 0.
  std::vector<uint8_t> claims_;        // 1 if the avatar may go on to its target.
  std::vector<uint32_t> rival_first_;  // n + 1 offsets into rivals_.
  std::vector<uint32_t> rivals_;       // Avatars whose targets are too near to one's own.
  std::vector<uint8_t> inside_;        // Pair (i, j < i) at i (i - 1) / 2 + j: is it in r_rep now?
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

/// The name of a set as the paper writes it: "2.0/0.4/0.06".
[[nodiscard]] THRONG_API std::string name_of(const ParameterSet& set);
/// A model with the set's mass, speed and force.
[[nodiscard]] THRONG_API Model with_set(Model model, const ParameterSet& set);

/// The sets that the paper names: the two bad ones, then the best one.
[[nodiscard]] THRONG_API std::vector<ParameterSet> named_sets();

/// A grid over the paper's ranges: masses 1, 1.5, 2; speeds 0.4 to 1.2 by 0.2; forces 0.02, 0.06,
/// 0.10, 0.20. It contains the named sets. The paper does not say which sets it ran.
[[nodiscard]] THRONG_API std::vector<ParameterSet> grid_sets();

/// The number of collisions that the paper reports at most, by the number of avatars.
struct Reported {
  int32_t bad = 0;     ///< Figure 10: 1.0/1.0/0.06 and 1.0/0.8/0.06.
  int32_t others = 0;  ///< Figure 11: all other sets.
};
/// The paper's numbers of collisions for a number of avatars.
[[nodiscard]] THRONG_API Reported reported_collisions(int32_t avatars);

/// Settings of a study: one run for each set, number of avatars and seed.
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

/// Results of one set with one number of avatars, over all seeds.
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
  uint64_t hash = 0;  ///< Hash of the last states of all runs, in order.
  [[nodiscard]] const StudyCell& at(size_t set, size_t count) const {
    return cells[set * avatars.size() + count];
  }
};

/// Runs a study, several runs in parallel. Fails with kBadConfig, kLimit (the avatars do not fit),
/// kCancelled.
[[nodiscard]] THRONG_API Result<Study> run_study(const StudyConfig& config, Context& context);

}  // namespace throng::caacd
