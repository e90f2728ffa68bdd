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
#include "throng/bake.h"
#include "throng/world.h"

/// The files that a run writes, step by step. Of several ranks rank 0 writes them; all call the
/// same.
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
    const bool records = !options_.record.empty();
    if (is_due && (records || !options_.trajectories.empty())) avatars.read(states_);
    const uint64_t hash = records ? avatars.state_hash() : 0;
    if (trajectories_.is_open() && is_due) write_trajectories(step);
    Result<void> written;
    if (recorder_.is_open()) {
      written = is_due ? recorder_.add(step, hash, states_) : recorder_.add_hash(step, hash);
    }
    return records ? agree_over_ranks(written) : written;
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
