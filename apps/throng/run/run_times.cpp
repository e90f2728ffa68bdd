// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "run/run_times.h"

#include <fmt/format.h>

#include <algorithm>

// Adds up the times of a run by parts. Median of steps: one sort at the end.
namespace throng::app {

void RunTimes::add(const char* part, double seconds) {
  const auto found = std::find_if(parts_.begin(), parts_.end(),
                                  [&](const auto& known) { return known.first == part; });
  if (found != parts_.end()) {
    found->second += seconds;
  } else {
    parts_.emplace_back(part, seconds);
  }
}

void RunTimes::add_step(double seconds, double avatars) {
  step_ns_.push_back(avatars > 0 ? seconds * 1e9 / avatars : 0);
  seconds_ += seconds;
  avatar_steps_ += avatars;
}

double RunTimes::mean_ns() const { return avatar_steps_ > 0 ? seconds_ * 1e9 / avatar_steps_ : 0; }

double RunTimes::median_ns() const {
  if (step_ns_.empty()) return 0;
  std::vector<double> sorted = step_ns_;
  std::sort(sorted.begin(), sorted.end());
  const size_t n = sorted.size();
  return (sorted[(n - 1) / 2] + sorted[n / 2]) / 2;
}

double RunTimes::wall() const {
  return std::chrono::duration<double>(Clock::now() - start_).count();
}

double RunTimes::rest(double wall) const {
  for (const auto& [name, seconds] : parts_) wall -= seconds;
  return std::max(wall, 0.0);
}

std::string RunTimes::text_of_steps() const {
  return fmt::format("{:.1f} ns an avatar a step (mean; {:.1f} median)", mean_ns(), median_ns());
}

std::string RunTimes::text_of_parts() const {
  const double whole = wall();
  std::string text = fmt::format("time {:.3f} s:", whole);
  const auto list = [&](const std::string& name, double seconds) {
    text += fmt::format(" {} {:.3f} s ({:.0f} %),", name, seconds, 100 * seconds / whole);
  };
  for (const auto& [name, seconds] : parts_) list(name, seconds);
  list("other", rest(whole));
  text.back() = '\n';
  return text;
}

void RunTimes::add_to(Json& json) const {
  const double whole = wall();
  json["ns_per_avatar_step"] = median_ns();
  json["ns_per_avatar_step_median"] = median_ns();
  json["ns_per_avatar_step_mean"] = mean_ns();
  for (const auto& [name, seconds] : parts_) json["seconds_" + name] = seconds;
  json["seconds_other"] = rest(whole);
  json["seconds_wall"] = whole;
}

}  // namespace throng::app
