// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <fmt/format.h>

#include <string>
#include <vector>

#include "command.h"
#include "output_file.h"
#include "run/run_recorder.h"
#include "throng/avatar.h"
#include "throng/world.h"

/// The files that a run writes, step by step.
namespace throng::app {

struct SinkOptions {
  std::string trajectories;  // CSV; empty: none
  std::string record;        // a recording; empty: none
  uint64_t every = 1;        // frame
};

class Sinks {
 public:
  explicit Sinks(const SinkOptions& options) : options_(options) {}

  /// `run`: all that is not in the world; its settings are all that rerun.h needs to repeat it.
  Result<void> open(const World& world, const RecordingInfo& run);
  /// For a crowd that walks in no world: trajectories alone. `class_names`: by AvatarState's index.
  Result<void> open(std::vector<std::string> class_names);
  /// Between frames, the recorder gets the hash alone.
  template <class Avatars>
  Result<void> add(uint64_t step, const Avatars& avatars) {
    const bool is_due = step % options_.every == 0;
    if (is_due && (trajectories_.is_open() || recorder_.is_open())) avatars.read(states_);
    if (trajectories_.is_open() && is_due) write_trajectories(step);
    if (!recorder_.is_open()) return {};
    if (!is_due) return recorder_.add_hash(step, avatars.state_hash());
    return recorder_.add(step, avatars.state_hash(), states_);
  }
  /// `outcome`: what the recording keeps of it, as JSON, or nothing.
  Result<void> finish(const std::string& outcome = {});

 private:
  // One line an avatar: kCsvColumns.
  void write_trajectories(uint64_t step);

  SinkOptions options_;
  bool leans_ = false;
  OutputFile trajectories_;
  RunRecorder recorder_;
  std::vector<std::string> class_names_;
  std::vector<AvatarState> states_;
  fmt::memory_buffer text_;
};

}  // namespace throng::app
