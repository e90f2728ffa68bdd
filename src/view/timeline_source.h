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

/// Moments made beside the window, a little ahead of what is shown: it never waits for a step.
namespace throng {

/// Where moments come from. One thread at a time.
class MomentSource {
 public:
  virtual ~MomentSource() = default;
  /// The moment after the last one; nothing at the end.
  virtual std::shared_ptr<const TimelineFrame> next() = 0;
  /// The last moment at or before a time, after which next() goes on. Nothing if the source cannot
  /// go back.
  virtual std::shared_ptr<const TimelineFrame> seek(double time) = 0;
  /// The last one again, as it is now that something was changed. Nothing if nothing can be.
  virtual std::shared_ptr<const TimelineFrame> again() { return nullptr; }
};

/// The two moments around a time, and where between them it lies.
struct MomentPair {
  std::shared_ptr<const TimelineFrame> a, b;
  double share = 0;  ///< [0 to 1]
};

class MomentFeed {
 public:
  explicit MomentFeed(std::unique_ptr<MomentSource> source);
  MomentFeed(const MomentFeed&) = delete;
  MomentFeed& operator=(const MomentFeed&) = delete;
  ~MomentFeed();

  /// What is known around `time`, or the nearest to it; asks for more if that is not enough. Empty
  /// until there is a first moment.
  MomentPair at(double time);
  /// Drops what is ahead and goes on from `time`, where the source can.
  void seek(double time);
  /// Runs `work` beside the window, between two moments. What is made after it shows its effect;
  /// `at_once` (while nothing plays) shows it in the moment that stands.
  void post(std::function<void(MomentSource&)> work, bool at_once);
  /// Waits until all work that was posted has been done.
  void finish_posted();
  /// Waits until that, and until all moments are there that at() has asked for.
  void finish();
  /// Waits until there is a moment after `time`, or no more come: then at(time) is the same however
  /// fast the source is.
  void wait_for(double time);
  /// Time of the last moment made.
  [[nodiscard]] double latest() const;
  /// Where there are no threads: makes moments for a while.
  void turn() { task_->turn(); }

 private:
  void run();
  [[nodiscard]] bool wants_more() const;  // With the lock held.

  std::unique_ptr<MomentSource> source_;
  mutable std::mutex mutex_;
  SideSignal wake_, idle_;
  std::deque<std::shared_ptr<const TimelineFrame>> made_;  // In order of time.
  struct Posted {
    std::function<void(MomentSource&)> work;
    bool at_once = false;
  };
  std::deque<Posted> posted_;
  double wanted_ = 0;
  double seek_to_ = 0;
  bool seeking_ = false, ended_ = false, stopping_ = false, working_ = false;
  std::optional<SideTask> task_;  // Last, so that it ends before what it uses.
};

}  // namespace throng
