// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "view/replay_player.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace throng {

ReplayPlayer::ReplayPlayer(Replay replay, Vec3d origin)
    : replay_(std::move(replay)), origin_(origin) {}

std::shared_ptr<const TimelineFrame> ReplayPlayer::next() {
  // Frames of a corrupt chunk are passed over: the rest can still be seen.
  while (next_ < replay_.frame_count()) {
    if (auto moment = read(next_++)) return moment;
  }
  return nullptr;
}

std::shared_ptr<const TimelineFrame> ReplayPlayer::seek(double time) {
  const Result<uint64_t> index = replay_.find(time);
  next_ = index ? *index : 0;
  return next();
}

std::shared_ptr<const TimelineFrame> ReplayPlayer::read(uint64_t index) {
  if (!replay_.read(index, frame_)) return nullptr;
  const auto moment = std::make_shared<TimelineFrame>();
  moment->time = frame_.time;
  moment->resize(frame_.size());
  moment->ids = frame_.ids;
  moment->classes = frame_.classes;
  const bool lean = std::any_of(frame_.up_vectors.begin(), frame_.up_vectors.end(), [](Vec3d up) {
    return !(up == Vec3d{0, 1, 0});
  });
  if (lean) moment->ups = frame_.up_vectors;
  for (size_t i = 0; i < frame_.size(); ++i) {
    const Vec3d p = frame_.positions[i] - origin_;
    moment->x[i] = static_cast<float>(p.x);
    moment->y[i] = static_cast<float>(p.y);
    moment->z[i] = static_cast<float>(p.z);
    const Heading& h = frame_.headings[i];
    const double turns = std::atan2(h.x, h.z) / (2 * std::numbers::pi);
    moment->heading[i] = static_cast<float>(turns - std::floor(turns));
  }
  follow(last_ ? *last_ : TimelineFrame{}, *moment);
  last_ = moment;
  return moment;
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

}  // namespace throng
