// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "command.h"
#include "run/avatar_group.h"
#include "run/caacd_options.h"
#include "run/checkpoint.h"
#include "run/run_times.h"
#include "throng/crowd.h"
#include "throng/surface.h"
#include "throng/world.h"

/// throng run with goals.
namespace throng::app {

struct CrowdRun {
  std::string world_name;
  std::string class_name;
  std::string goals = "random";  // or a file of places
  std::string goals_text;        // content of the file
  double near = 0;               // max distance of random goals, 0: anywhere [m]
  uint32_t avatars = 1000;
  std::vector<AvatarGroup> also;  // further classes and their counts
  uint64_t steps = 100;
  uint64_t check_every = 1;
  double speed = 0, radius = 0;
  std::vector<double> part = {};       // x0, z0, x1, z1 of a district; empty: the whole world [m]
  std::vector<SetChange> set_changes;  // in the order in which they are made
  CrowdConfig config;
  CheckpointOptions checkpoints;
};

/// Fills in goals_text. Fails with kNotFound.
Result<void> read_goals(CrowdRun& run);

/// A crowd whose avatars get one goal after the other. Equal runs have equal steps. Avatars that
/// fly begin in the air, and every other goal of theirs is there; those that climb begin on nodes,
/// and their goals are there.
class GoalCrowd {
 public:
  static Result<GoalCrowd> create(const World& world, const CrowdRun& run, Context& context);
  /// As it was when a checkpoint was taken, of a run with the same settings.
  static Result<GoalCrowd> restore(const World& world, const CrowdRun& run,
                                   const Checkpoint& checkpoint, Context& context);
  /// Between two steps; `settings` are of its run.
  [[nodiscard]] Checkpoint checkpoint(const Json& settings) const;
  CrowdReport step();
  /// Gives new goals to avatars that arrived in the last step, or found no path.
  void give_goals();
  [[nodiscard]] const Crowd& crowd() const { return crowd_; }
  [[nodiscard]] uint64_t steps() const { return steps_; }

 private:
  GoalCrowd(const World& world, const CrowdRun& run, Crowd&& crowd);
  static Result<GoalCrowd> create(const World& world, const CrowdRun& run,
                                  const Checkpoint* checkpoint, Context& context);
  Result<void> add_restored(const std::string& class_name, uint32_t count);
  Result<void> scatter(const std::string& class_name, uint32_t count, Context& context);
  Result<void> read_places();
  [[nodiscard]] bool goes_over_nodes(int32_t avatar_class) const;
  [[nodiscard]] bool flies(int32_t avatar_class) const;
  [[nodiscard]] Place goal(uint32_t slot, uint64_t nth, const Vec3d& from) const;
  [[nodiscard]] NodePlace goal_on_nodes(uint32_t slot, uint64_t nth, const Vec3d& from) const;
  [[nodiscard]] Place goal_in_air(uint32_t slot, uint64_t nth, const Vec3d& from) const;
  void give(std::span<const AvatarId> ids);
  void change_sets();

  World world_;
  CrowdRun run_;
  Crowd crowd_;
  std::vector<int32_t> class_of_;  // by slot
  std::vector<Place> places_;      // goals of a file
  std::vector<uint64_t> given_;    // goals, by slot
  uint64_t steps_ = 0;
  std::vector<Place> goals_;
  std::vector<AvatarId> all_, on_ground_, on_nodes_;
  std::vector<NodePlace> goals_on_nodes_;
};

/// The count of searches that ran out of memory, and the setting to raise; empty if 0.
std::string memory_text(uint64_t out_of_memory, const char* setting);
/// Adds the parts of a crowd's step to the times.
void add_step(const CrowdReport& report, RunTimes& times);

/// Runs the crowd and prints the result. `shown` is called at the start and after each step,
/// `finished` before anything is printed.
int run_crowd(Session& session, const CrowdRun& run, GoalCrowd& crowd, RunTimes& times,
              const std::function<Result<void>(uint64_t step)>& shown,
              const std::function<Result<void>()>& finished);

}  // namespace throng::app
