// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>

#include "view/side_task.h"
#include "view/timeline_frame.h"

/// Frames made beside the window, a little ahead of the time shown: drawing waits for no step.
namespace throng::view {

/// Makes the frames of a timeline: a crowd, a scenario or a recording. One thread at a time.
class TimelinePlayer {
 public:
  virtual ~TimelinePlayer() = default;
  /// The frame after the last one; null at the end.
  virtual std::shared_ptr<const TimelineFrame> next() = 0;
  /// The last frame at or before a time; next() continues after it. Null if the player cannot seek.
  virtual std::shared_ptr<const TimelineFrame> seek(double time) = 0;
  /// The last frame made again, after a change; null if the player cannot be changed.
  virtual std::shared_ptr<const TimelineFrame> again() { return nullptr; }
  /// Gives one avatar, or all, a Mass, MaxSpeed and MaxForce of [CAACD]. Nothing happens if the
  /// player has none that it steers.
  virtual void set_curves(std::optional<uint64_t> id, const CurvilinearTuning& tuning) {
    (void)id;
    (void)tuning;
  }
};

/// The two frames around a time, and where between them it lies.
struct FramePair {
  std::shared_ptr<const TimelineFrame> a, b;
  double share = 0;  ///< [0 to 1]
};

/// Buffers the frames of a player, which runs on a task of its own.
class TimelineSource {
 public:
  explicit TimelineSource(std::unique_ptr<TimelinePlayer> player);
  TimelineSource(const TimelineSource&) = delete;
  TimelineSource& operator=(const TimelineSource&) = delete;
  ~TimelineSource();

  /// The frames around `time`, or the nearest ones made so far; requests more if needed. Empty
  /// until there is a first frame.
  FramePair at(double time);
  /// Drops the frames ahead and continues from `time`, if the player can seek.
  void seek(double time);
  /// Runs `work` on the player's task, between two frames. Later frames show its effect; `at_once`
  /// (while paused) makes the last frame again.
  void post(std::function<void(TimelinePlayer&)> work, bool at_once);
  /// Waits until all posted work is done.
  void finish_posted();
  /// Waits for the posted work and all frames that at() has requested.
  void finish();
  /// Waits until there is a frame after `time`, or the timeline ends: then at(time) does not depend
  /// on the speed of the player.
  void wait_for(double time);
  /// Time of the last frame made.
  [[nodiscard]] double latest() const;
  /// Without threads: makes frames for a share of the drawn frame.
  void run_slice() { task_->run_slice(); }

 private:
  void run();
  [[nodiscard]] bool wants_more() const;  // With the lock held.

  std::unique_ptr<TimelinePlayer> player_;
  mutable std::mutex mutex_;
  SideSignal wake_, idle_;
  std::deque<std::shared_ptr<const TimelineFrame>> made_;  // In order of time.
  struct Posted {
    std::function<void(TimelinePlayer&)> work;
    bool at_once = false;
  };
  std::deque<Posted> posted_;
  double wanted_ = 0;
  double seek_to_ = 0;
  bool seeking_ = false, ended_ = false, stopping_ = false, working_ = false;
  std::optional<SideTask> task_;  // Last: it ends before the members that it uses.
};

}  // namespace throng::view
