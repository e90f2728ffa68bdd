// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "throng/base.h"
#include "throng_view/viewer.h"
#include "view/crowd_player.h"
#include "view/plane_player.h"
#include "view/replay_player.h"
#include "view/scenario_player.h"
#include "view/side_task.h"
#include "view/timeline_source.h"

namespace throng::view {

/// The parts of a stage that have been loaded and not yet taken.
struct StageMail {
  std::optional<PreparedScene> scene;
  std::optional<World> world;
  std::optional<Nodes> nodes;
  std::optional<std::vector<double>> storeys;
  std::optional<std::vector<std::vector<ViewFigure>>> figures;
  std::optional<ReplaySpan> replay;
  std::optional<CrowdStart> crowd;
  std::optional<Scenario> scenario;
  std::optional<ExperimentStart> experiment;
  std::shared_ptr<const Occluders> occluders;
  std::vector<std::string> class_names;
  std::unique_ptr<TimelineSource> source;
};

/// The stage before a load, for loads that set no scene, and the user's settings.
struct StageBefore {
  Vec3d origin = {};
  World world = {};
  Nodes nodes = {};  // Of the world, if it has any.
  std::shared_ptr<const Occluders> occluders = {};
  bool only_seen = false, coarse_far = false;  // In addition to those of CrowdStart.
};

/// Loads a stage on a task beside the window.
class StageJob {
 public:
  StageJob(std::string name, LoadStage load, int32_t workers, StageBefore before);
  StageJob(const StageJob&) = delete;
  StageJob& operator=(const StageJob&) = delete;
  ~StageJob();  ///< Cancels and waits.

  [[nodiscard]] StageMail take();
  void cancel() { context_.cancel = true; }
  /// Without threads: loads for a share of the frame.
  void run_slice() { task_->run_slice(); }
  [[nodiscard]] bool done() const { return done_; }
  [[nodiscard]] std::string error() const;  ///< Of a load that failed, or empty.
  [[nodiscard]] const std::string& name() const { return name_; }
  /// The current stage of work and its progress [0 to 1], -1 if not known.
  [[nodiscard]] std::pair<std::string, double> progress() const;

 private:
  friend class throng::StageParts;
  void run(const LoadStage& load);
  Result<void> start_player();

  std::string name_;
  int32_t workers_;
  Context context_;
  mutable std::mutex mutex_;
  StageMail mail_;
  std::string error_, stage_;
  double share_ = -1;
  std::atomic<bool> done_ = false;
  // Used by the task only.
  StageBefore before_;
  std::optional<CrowdStart> crowd_;
  std::optional<Scenario> scenario_;
  std::optional<ExperimentStart> experiment_;
  std::optional<SideTask> task_;  // Last: it ends before the members that it uses.
};

}  // namespace throng::view
