// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "view/replay_player.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

// A frame per frame of a recording.
namespace throng::view {

ReplayPlayer::ReplayPlayer(Replay replay, Vec3d origin)
    : replay_(std::move(replay)), origin_(origin) {}

std::shared_ptr<const TimelineFrame> ReplayPlayer::next() {
  // Frames of a corrupt chunk are skipped: the rest can still be shown.
  while (next_ < replay_.frame_count()) {
    if (auto frame = read(next_++)) return frame;
  }
  return nullptr;
}

std::shared_ptr<const TimelineFrame> ReplayPlayer::seek(double time) {
  if (replay_.frame_count() == 0) return nullptr;
  const Result<uint64_t> index = replay_.find(time);
  next_ = index ? *index : 0;
  return next();
}

std::shared_ptr<const TimelineFrame> ReplayPlayer::read(uint64_t index) {
  if (!replay_.read(index, recorded_)) return nullptr;
  const auto frame = std::make_shared<TimelineFrame>();
  frame->time = recorded_.time;
  frame->resize(recorded_.size());
  frame->ids = recorded_.ids;
  frame->classes = recorded_.classes;
  const bool lean =
      std::any_of(recorded_.up_vectors.begin(), recorded_.up_vectors.end(), [](Vec3d up) {
        return !(up == Vec3d{0, 1, 0});
      });
  if (lean) frame->ups = recorded_.up_vectors;
  for (size_t i = 0; i < recorded_.size(); ++i) {
    const Vec3d p = recorded_.positions[i] - origin_;
    frame->x[i] = static_cast<float>(p.x);
    frame->y[i] = static_cast<float>(p.y);
    frame->z[i] = static_cast<float>(p.z);
    const Heading& h = recorded_.headings[i];
    const double turns = std::atan2(h.x, h.z) / (2 * std::numbers::pi);
    frame->heading[i] = static_cast<float>(turns - std::floor(turns));
  }
  follow(last_ ? *last_ : TimelineFrame{}, *frame);
  last_ = frame;
  return frame;
}

ReplaySpan replay_span(Replay& replay) {
  ReplaySpan span;
  const uint64_t frames = replay.frame_count();
  bool any = false;
  for (uint64_t f = 0; f < frames && !any; ++f) {
    if (const auto info = replay.frame_info(f)) span = {info->time, info->time}, any = true;
  }
  for (uint64_t f = frames; f > 0; --f) {
    const auto info = replay.frame_info(f - 1);
    if (!info) continue;
    span.last = info->time;
    break;
  }
  return span;
}

}  // namespace throng::view
