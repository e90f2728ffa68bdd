// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "throng/context.h"
#include "throng_view/viewer.h"
#include "view/crowd_player.h"
#include "view/replay_player.h"
#include "view/scenario_player.h"
#include "view/side_task.h"
#include "view/timeline_source.h"

namespace throng {

/// What came of a load so far, and has not been taken yet.
struct StageMail {
  std::optional<PreparedScene> scene;
  std::optional<World> world;
  std::optional<Nodes> nodes;
  std::optional<std::vector<double>> storeys;
  std::optional<std::vector<std::vector<ViewFigure>>> figures;
  std::optional<ReplaySpan> replay;
  std::optional<CrowdStart> crowd;
  std::optional<Scenario> scenario;
  std::shared_ptr<const Occluders> occluders;
  std::vector<std::string> class_names;
  std::unique_ptr<MomentFeed> feed;
};

/// What a load that sets no scene goes on from, and what the user has set.
struct StageBefore {
  Vec3d origin = {};
  World world = {};
  Nodes nodes = {};  // Of the world, if it has any.
  std::shared_ptr<const Occluders> occluders = {};
  bool only_seen = false, coarse_far = false;  // Besides those of CrowdStart.
};

/// A load beside the window.
class StageJob {
 public:
  StageJob(std::string name, LoadStage load, int32_t workers, StageBefore before);
  StageJob(const StageJob&) = delete;
  StageJob& operator=(const StageJob&) = delete;
  ~StageJob();  ///< Cancels and waits.

  [[nodiscard]] StageMail take();
  void cancel() { context_.cancel = true; }
  /// Where there are no threads: loads for a while.
  void turn() { task_->turn(); }
  [[nodiscard]] bool done() const { return done_; }
  [[nodiscard]] std::string error() const;  ///< Of a load that failed, or empty.
  [[nodiscard]] const std::string& name() const { return name_; }
  /// What it does now and how far it is, -1 if that is not known.
  [[nodiscard]] std::pair<std::string, double> progress() const;

 private:
  friend class StageParts;
  void run(const LoadStage& load);
  Result<void> start_walking();

  std::string name_;
  int32_t workers_;
  Context context_;
  mutable std::mutex mutex_;
  StageMail mail_;
  std::string error_, stage_;
  double share_ = -1;
  std::atomic<bool> done_ = false;
  // Of the task.
  StageBefore before_;
  std::optional<CrowdStart> crowd_;
  std::optional<Scenario> scenario_;
  std::optional<SideTask> task_;  // Last, so that it ends before what it uses.
};

}  // namespace throng
