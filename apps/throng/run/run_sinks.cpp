// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "run/run_sinks.h"

#include <iterator>
#include <utility>

#include "throng/recording.h"

// Writes the steps of a run to a CSV file and to a recording.
namespace throng::app {

Result<void> Sinks::open(const World& world, const RecordingInfo& run) {
  leans_ = run.leans;
  std::vector<std::string> names;
  for (const AvatarClass& avatar : world.summary().classes) names.push_back(avatar.name);
  Result<void> ok = open(std::move(names));
  if (ok && !options_.record.empty() && rank_info().rank == 0) {
    ok = recorder_.open(options_.record, run, world);
  }
  return agree_over_ranks(ok);
}

Result<void> Sinks::open(std::vector<std::string> class_names) {
  class_names_ = std::move(class_names);
  if (options_.trajectories.empty() || rank_info().rank > 0) return {};
  if (auto ok = trajectories_.open(options_.trajectories); !ok) return ok;
  trajectories_.write(fmt::format("{}{}\n", kCsvColumns, leans_ ? kCsvUpColumns : ""));
  return {};
}

void Sinks::write_trajectories(uint64_t step) {
  text_.clear();
  for (const AvatarState& state : states_) {
    const Vec3d& p = state.position;
    const auto out = std::back_inserter(text_);
    fmt::format_to(out, "{},{},{},{:.4f},{:.4f},{:.4f},{:.4f}", step, state.id,
                   class_names_[static_cast<size_t>(state.avatar_class)], p.x, p.y, p.z,
                   state.radius);
    if (leans_) fmt::format_to(out, ",{:.4f},{:.4f},{:.4f}", state.up.x, state.up.y, state.up.z);
    text_.push_back('\n');
  }
  trajectories_.write({text_.data(), text_.size()});
}

Result<void> Sinks::finish(const std::string& outcome) {
  if (trajectories_.is_open()) {
    if (auto ok = trajectories_.finish(); !ok) return ok;
  }
  return recorder_.is_open() ? recorder_.finish(outcome) : Result<void>();
}

}  // namespace throng::app
