// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <string>
#include <utility>
#include <vector>

#include "command.h"

/// The time of a run by its parts: the median of steps alone hides the few that take most of it.
namespace throng::app {

/// Seconds by part of a run, and of its steps one by one. Starts with its clock running.
class RunTimes {
 public:
  using Clock = std::chrono::steady_clock;

  /// Calls `work` and counts its time as part of a run. [name: a literal]
  template <class Work>
  auto measure(const char* part, Work&& work) {
    const Timer timer{this, part, Clock::now()};
    return work();
  }
  /// Counts seconds that were measured elsewhere.
  void add(const char* part, double seconds);
  /// Counts a whole step of `avatars`; its parts are added by add().
  void add_step(double seconds, double avatars);

  /// Over all steps, planning included: their time by all avatars of all steps. [ns]
  [[nodiscard]] double mean_ns() const;
  /// Of the step in the middle. [ns an avatar]
  [[nodiscard]] double median_ns() const;
  [[nodiscard]] size_t steps() const { return step_ns_.size(); }
  /// "1234.5 ns an avatar a step (mean; 362.1 median)".
  [[nodiscard]] std::string text_of_steps() const;
  /// "time 137.2 s: plan 130.1 s (95 %), steer 3.2 s (2 %) ..., other 0.4 s (0 %)", with a new
  /// line.
  [[nodiscard]] std::string text_of_parts() const;
  /// Adds ns_per_avatar_step (of the median), _median and _mean; seconds_PART for each part,
  /// seconds_other for what is none of them, and seconds_wall, the sum of all.
  void add_to(Json& json) const;

 private:
  struct Timer {
    RunTimes* times;
    const char* part;
    Clock::time_point start;
    ~Timer() { times->add(part, std::chrono::duration<double>(Clock::now() - start).count()); }
  };

  [[nodiscard]] double wall() const;
  [[nodiscard]] double rest(double wall) const;

  Clock::time_point start_ = Clock::now();
  std::vector<std::pair<std::string, double>> parts_;  // in order of their first time
  std::vector<double> step_ns_;                        // an avatar
  double seconds_ = 0, avatar_steps_ = 0;
};

}  // namespace throng::app
