// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include "throng/recording.h"
#include "view/timeline_source.h"

namespace throng::view {

/// Plays a recording, forwards; seeks by time.
class ReplayPlayer final : public TimelinePlayer {
 public:
  ReplayPlayer(Replay replay, Vec3d origin);
  std::shared_ptr<const TimelineFrame> next() override;
  std::shared_ptr<const TimelineFrame> seek(double time) override;

 private:
  std::shared_ptr<const TimelineFrame> read(uint64_t index);

  Replay replay_;
  Vec3d origin_;
  uint64_t next_ = 0;
  RecordedFrame recorded_;
  std::shared_ptr<const TimelineFrame> last_;
};

/// First and last time of a recording; equal if it has no or one frame.
struct ReplaySpan {
  double first = 0, last = 0;
};
[[nodiscard]] ReplaySpan replay_span(Replay& replay);

}  // namespace throng::view
