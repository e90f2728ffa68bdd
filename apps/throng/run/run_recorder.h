// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "command.h"
#include "throng/avatar.h"
#include "throng/recording.h"
#include "throng/world.h"

/// Records a run of the program, for each kind of crowd.
namespace throng::app {

class RunRecorder {
 public:
  /// Begins the file; its classes are those of the world.
  Result<void> open(const std::string& path, RecordingInfo info, const World& world);
  [[nodiscard]] bool is_open() const { return recorder_.has_value(); }
  /// One frame.
  Result<void> add(uint64_t step, uint64_t state_hash, std::span<const AvatarState> avatars);
  /// A step without a frame.
  Result<void> add_hash(uint64_t step, uint64_t state_hash) {
    return recorder_->append_hash(step, state_hash);
  }
  Result<void> finish(const std::string& outcome) { return recorder_->finish(outcome); }
  [[nodiscard]] uint64_t bytes() const { return recorder_->bytes(); }

 private:
  std::optional<Recorder> recorder_;
  double dt_ = 0.1;
  bool leans_ = false;
  RecordedFrame frame_;
};

}  // namespace throng::app
