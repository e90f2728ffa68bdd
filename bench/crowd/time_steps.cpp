// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "time_steps.h"

#include <algorithm>
#include <vector>

// Sums the reports of steps, and checks the crowd between them.
namespace throng::bench {
namespace {

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values.empty() ? 0 : values[values.size() / 2];
}

}  // namespace

nlohmann::ordered_json time_steps(Crowd& crowd, const StepTiming& timing,
                                  const std::function<void(std::span<const AvatarId>)>& give) {
  const auto avatars = static_cast<double>(crowd.size());
  CrowdReport sum;
  std::vector<double> seconds;
  double progress = 0;
  CrowdCheck found;
  uint64_t checks = 0;
  for (uint64_t step = 1; step <= timing.warm + timing.steps; ++step) {
    const CrowdReport r = crowd.step();
    give(crowd.arrived());
    if (step % timing.check_every == 0) {
      ++checks;
      const CrowdCheck check = crowd.check();
      found.overlaps += check.overlaps;
      found.wall_entries += check.wall_entries;
    }
    if (step <= timing.warm) continue;
    seconds.push_back(r.seconds_total);
    progress += r.progress;
    sum.contested += r.contested;
    sum.low_detail += r.low_detail;
    sum.skipped += r.skipped;
    sum.seconds_plan += r.seconds_plan;
    sum.seconds_sort += r.seconds_sort;
    sum.seconds_steer += r.seconds_steer;
    sum.seconds_commit += r.seconds_commit;
    sum.seconds_settle += r.seconds_settle;
  }
  const auto steps = static_cast<double>(timing.steps);
  const double each = 1e9 / avatars, all = each / steps;
  return {{"ns", median(seconds) * each},
          {"ns_plan", sum.seconds_plan * all},
          {"ns_sort", sum.seconds_sort * all},
          {"ns_steer", sum.seconds_steer * all},
          {"ns_commit", sum.seconds_commit * all},
          {"ns_settle", sum.seconds_settle * all},
          {"contested", static_cast<double>(sum.contested) / avatars / steps},
          {"far", static_cast<double>(sum.low_detail) / avatars / steps},
          {"held", static_cast<double>(sum.skipped) / avatars / steps},
          {"progress", progress / steps},
          {"avatar_steps", (timing.warm + timing.steps) * crowd.size()},
          {"checked_avatar_steps", checks * crowd.size()},
          {"overlaps", found.overlaps},
          {"wall_entries", found.wall_entries},
          {"bytes_an_avatar", static_cast<double>(crowd.memory().avatars) / avatars},
          {"bytes_of_paths", static_cast<double>(crowd.memory().paths) / avatars},
          {"state_hash", crowd.state_hash()}};
}

}  // namespace throng::bench
