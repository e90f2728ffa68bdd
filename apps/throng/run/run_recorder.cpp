// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "run/run_recorder.h"

#include <utility>

// Copies the states of avatars into the frames of a recording.
namespace throng::app {

Result<void> RunRecorder::open(const std::string& path, RecordingInfo info, const World& world) {
  const WorldSummary summary = world.summary();
  info.world_hash = summary.hash;
  info.origin = recording_origin(summary.bounds);
  for (const AvatarClass& avatar : summary.classes) {
    info.classes.push_back({avatar.name, avatar.height, avatar.radius});
  }
  auto recorder = Recorder::create(path, info);
  if (!recorder) return recorder.error();
  recorder_.emplace(std::move(*recorder));
  dt_ = info.dt;
  leans_ = info.leans;
  return {};
}

Result<void> RunRecorder::add(uint64_t step, uint64_t state_hash,
                              std::span<const AvatarState> avatars) {
  frame_.time = static_cast<double>(step) * dt_;
  frame_.step = step;
  frame_.state_hash = state_hash;
  frame_.resize(avatars.size());
  frame_.up_vectors.resize(leans_ ? avatars.size() : 0);
  for (size_t i = 0; i < avatars.size(); ++i) {
    const AvatarState& state = avatars[i];
    frame_.ids[i] = state.id;
    frame_.classes[i] = static_cast<uint8_t>(state.avatar_class);
    frame_.positions[i] = state.position;
    frame_.radii[i] = static_cast<float>(state.radius);
    frame_.headings[i] = {static_cast<float>(state.heading_x), static_cast<float>(state.heading_z)};
    if (leans_) frame_.up_vectors[i] = state.up;
  }
  return recorder_->append(frame_.view());
}

}  // namespace throng::app
