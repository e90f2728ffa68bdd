// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "validate/arrivals.h"
#include "validate/door_crowd.h"
#include "validate/statistics.h"
#include "validate/tests.h"

// How people move before a door, as recorded people are measured, and flow through doors by the
// desired speed.
namespace throng::validate {
namespace {

// What the file 040_c_56_h-.txt of [ABHSS20] gives with measure_paths: 75 people before a gate of
// 0.5 m, up to the line in its middle. `laboratory` measures it again.
constexpr PathMeasures kRecorded{
    .people = 75, .detour = 1.37, .turns = 0.017, .speed_change = 0.09, .walked_away = 0.17};

// The highest values that pass.
constexpr double kMaxDetour = 1.35;
constexpr double kMaxTurns = 2;           // [%]
constexpr double kMaxSpeedChange = 0.13;  // [m/s]
constexpr double kMaxWalkedAway = 0.25;   // [m]
constexpr double kMaxTurningRate = 90;    // [degrees/s]
constexpr double kMaxFlowByWidth = 2.6;   // [p/(m s)]

constexpr double kNoLimit = std::numeric_limits<double>::infinity();

void add_paths(const PathMeasures& paths, const std::string& of, bool is_judged,
               ValidationResult& result) {
  const auto add = [&](const char* what, double value, const char* unit, double high) {
    result.measures.push_back({.name = std::string(what) + ", " + of,
                               .value = value,
                               .unit = unit,
                               .high = is_judged ? high : kNoLimit});
  };
  add("path by straight line", paths.detour, "", kMaxDetour);
  add("turns of more than 90 degrees", 100 * paths.turns, "%", kMaxTurns);
  add("change of speed in 0.4 s", paths.speed_change, "m/s", kMaxSpeedChange);
  add("walked away from the door", paths.walked_away, "m", kMaxWalkedAway);
}

Result<ValidationResult> before_door(const ValidationConfig& config, Context& context) {
  ValidationResult result;
  const DoorConfig door{.width = 0.9, .people = config.brief ? 60u : 150u};
  const uint64_t runs = config.brief ? 1 : 3;
  for (uint64_t k = 0; k < runs; ++k) {
    const auto run = pass_door(door, config_of_run(config, runs, k), result, context);
    if (!run) return run.error();
    const std::string of = "run " + std::to_string(k + 1);
    result.measures.push_back({.name = "left behind, " + of,
                               .value = static_cast<double>(door.people - run->times.size()),
                               .low = 0,
                               .high = 0});
    result.measures.push_back(
        {.name = "flow, " + of, .value = flow_rate(run->times), .unit = "p/s"});
    add_paths(measure_paths(run->paths, run->line), of, /*is_judged=*/true, result);
    result.measures.push_back({.name = "turning rate of orientations, " + of,
                               .value = mean_turning_rate(run->orientations, PlaneCrowd::kStep),
                               .unit = "degrees/s",
                               .high = kMaxTurningRate});
  }
  add_paths(kRecorded, "people recorded", /*is_judged=*/false, result);
  return result;
}

// How a crowd passes a door at each of some desired speeds.
struct HasteRuns {
  std::vector<double> flows;  // by width [p/(m s)]
  std::vector<double> times;  // until the last has passed; NaN: some are left behind [s]
};

Result<HasteRuns> pass_in_haste(DoorConfig door, const std::vector<double>& speeds,
                                const ValidationConfig& config, ValidationResult& result,
                                Context& context) {
  HasteRuns runs;
  door.people = config.brief ? 80 : 200;
  for (const double speed : speeds) {
    door.speed = speed;
    const auto run = pass_door(door, config, result, context);
    if (!run) return run.error();
    const size_t left_behind = door.people - run->times.size();
    const std::string at = fmt::format(", {:.1f} m, {:g} m/s", door.width, speed);
    runs.flows.push_back(flow_rate(run->times) / door.width);
    runs.times.push_back(left_behind == 0 ? run->times.back() : std::nan(""));
    result.measures.push_back({.name = "flow by width" + at,
                               .value = runs.flows.back(),
                               .unit = "p/(m s)",
                               .high = kMaxFlowByWidth});
    result.measures.push_back({.name = "left behind" + at,
                               .value = static_cast<double>(left_behind),
                               .low = 0,
                               .high = 0});
    result.measures.push_back(
        {.name = "time to empty" + at, .value = runs.times.back(), .unit = "s"});
  }
  return runs;
}

Result<ValidationResult> haste(const ValidationConfig& config, Context& context) {
  ValidationResult result;
  std::vector<double> widths{0.8, 1.2, 2.4, 5}, speeds{1, 2, 3, 5};
  if (config.brief) {
    widths = {0.8, 2.4};
    speeds = {1, 5};
  }
  ValidationChart chart;
  chart.name = "motion_haste";
  chart.chart.title = "Flow through a door by the desired speed";
  chart.chart.x_title = "desired speed, m/s";
  chart.chart.y_title = "flow by width, p/(m s)";
  chart.chart.x = speeds;
  chart.chart.lines = {{.name = "limit",
                        .values = std::vector<double>(speeds.size(), kMaxFlowByWidth),
                        .kind = LineKind::kDashed}};
  for (const double width : widths) {
    auto runs = pass_in_haste({.width = width}, speeds, config, result, context);
    if (!runs) return runs.error();
    chart.chart.lines.push_back(
        {.name = at_width("door", width), .values = std::move(runs->flows)});
  }
  result.charts.push_back(std::move(chart));
  return result;
}

// Time to empty a room, at those speeds at which none was left behind.
ValidationChart time_chart(const std::vector<double>& speeds, const std::vector<double>& times) {
  ValidationChart chart;
  chart.name = "motion_flow";
  chart.chart.title = "Time to empty a room by the desired speed";
  chart.chart.x_title = "desired speed, m/s";
  chart.chart.y_title = "time, s";
  ChartLine line{.name = "door of 1 m", .kind = LineKind::kStrong};
  for (size_t i = 0; i < speeds.size(); ++i) {
    if (!std::isfinite(times[i])) continue;
    chart.chart.x.push_back(speeds[i]);
    line.values.push_back(times[i]);
  }
  chart.chart.lines = {std::move(line)};
  return chart;
}

Result<ValidationResult> flow(const ValidationConfig& config, Context& context) {
  ValidationResult result;
  const double walking = AvatarClass{}.speed;
  std::vector<double> speeds{0.5, 0.75, 1, walking, 2, 3, 4, 5};
  if (config.brief) speeds = {0.5, walking, 5};
  const auto runs = pass_in_haste({.width = 1}, speeds, config, result, context);
  if (!runs) return runs.error();
  const auto at_walking = static_cast<size_t>(std::ranges::find(speeds, walking) - speeds.begin());
  result.measures.push_back({.name = "flow at the speed of a walk by flow at 0.5 m/s",
                             .value = runs->flows[at_walking] / runs->flows[0],
                             .low = 1});
  ValidationChart chart = time_chart(speeds, runs->times);
  if (chart.chart.x.size() >= 2) result.charts.push_back(std::move(chart));
  return result;
}

const std::array<Test, 3> kMotionTests{
    Test{{.name = "motion.door",
          .title = "How people move before a door of 0.9 m, beside recorded people",
          .method =
              "150 people wait as in bottleneck, three runs. Paths up to the line in the middle of "
              "the door, in moves of 0.4 s: length by straight line, mean; share of moves that "
              "turn by more than 90 degrees from the one before, where both are 5 cm or longer; "
              "root mean square of the change of speed; sum of moves away from the door, a person. "
              "Turning rate of the orientations of exports, mean over people and steps. Beside "
              "them, 75 people before a gate of 0.5 m.",
          .source = "[ABHSS20]; the limits are ours"},
         before_door},
    Test{
        {.name = "motion.haste",
         .title = "Flow through doors 0.8 to 5 m wide at desired speeds from 1 to 5 m/s",
         .method = "200 people as in bottleneck, all with the same desired speed; time until the "
                   "last has passed.",
         .source =
             "ours: at most 2.6 p/(m s), none left behind; bottleneck has the range of experiments",
         .in_work = true},
        haste},
    Test{{.name = "motion.flow",
          .title = "Time to empty a room through a door of 1 m at desired speeds from 0.5 to 5 m/s",
          .method = "200 people as in motion.haste.",
          .source = "ours: at most 2.6 p/(m s), none left behind, no less flow at the speed of a "
                    "walk than at 0.5 m/s",
          .in_work = true},
         flow}};

}  // namespace

std::span<const Test> motion_tests() { return kMotionTests; }

}  // namespace throng::validate
