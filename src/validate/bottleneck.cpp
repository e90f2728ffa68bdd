// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <array>
#include <string>
#include <utility>
#include <vector>

#include "validate/door_crowd.h"
#include "validate/statistics.h"
#include "validate/tests.h"

// Flow of a crowd through a door, by the width of the door, as in laboratory experiments:
// [Kretz06], [Seyfried09].
namespace throng::validate {
namespace {

ValidationChart flow_chart(const std::vector<double>& widths, const std::vector<double>& flows) {
  ValidationChart chart;
  chart.name = "bottleneck";
  chart.chart.title = "Flow through a door by its width";
  chart.chart.x_title = "width, m";
  chart.chart.y_title = "flow, p/s";
  chart.chart.x = widths;
  ChartLine low{.name = "1.8 b", .kind = LineKind::kDashed};
  ChartLine high{.name = "2.3 b", .kind = LineKind::kDashed};
  for (const double width : widths) {
    low.values.push_back(1.8 * width);
    high.values.push_back(2.3 * width);
  }
  chart.chart.lines = {std::move(low),
                       std::move(high),
                       {.name = "throng", .values = flows, .kind = LineKind::kStrong}};
  return chart;
}

Result<ValidationResult> bottleneck(const ValidationConfig& config, Context& context) {
  ValidationResult result;
  std::vector<double> widths{0.8, 0.9, 1.0, 1.2, 1.4, 1.6, 1.8, 2.0, 2.2, 2.5};
  if (config.brief) widths = {0.8, 1.0, 1.2, 1.8, 2.5};
  std::vector<double> flows;
  for (const double width : widths) {
    const DoorConfig door{.width = width, .people = config.brief ? 120u : 200u};
    const auto run = pass_door(door, config, result, context);
    if (!run) return run.error();
    flows.push_back(flow_rate(run->times));
    result.measures.push_back({.name = at_width("flow by width", width),
                               .value = flow_rate(run->times) / width,
                               .unit = "p/(m s)",
                               .low = 1.8,
                               .high = 2.3});
    result.measures.push_back({.name = at_width("left behind", width),
                               .value = static_cast<double>(door.people - run->times.size()),
                               .low = 0,
                               .high = 0});
  }
  const ProportionalFit fit = fit_proportional(widths, flows);  // J = k b
  result.measures.push_back(
      {.name = "k of J = k b", .value = fit.slope, .unit = "p/(m s)", .low = 1.8, .high = 2.3});
  result.measures.push_back(
      {.name = "share of the variance that J = k b explains", .value = fit.explained, .low = 0.95});
  result.charts.push_back(flow_chart(widths, flows));
  return result;
}

// What `laboratory` measures of recorded people, and a tenth above and below.
struct RecordedFlow {
  double width, low, high;  // [m, p/s, p/s]
};
constexpr std::array kRecordedFlows{RecordedFlow{0.5, 1.16, 1.29}, RecordedFlow{0.7, 1.64, 1.64}};

Result<ValidationResult> narrow_doors(const ValidationConfig& config, Context& context) {
  ValidationResult result;
  std::vector<double> widths{0.5, 0.6, 0.7, 0.8};
  if (config.brief) widths = {0.5, 0.7};
  for (const double width : widths) {
    const DoorConfig door{.width = width, .people = config.brief ? 60u : 150u};
    const auto run = pass_door(door, config, result, context);
    if (!run) return run.error();
    const double flow = flow_rate(run->times);
    ValidationMeasure measure{.name = at_width("flow", width), .value = flow, .unit = "p/s"};
    for (const RecordedFlow& recorded : kRecordedFlows) {
      if (recorded.width != width) continue;
      measure.low = 0.9 * recorded.low;
      measure.high = 1.1 * recorded.high;
      result.measures.push_back({.name = measure.name + ", people recorded",
                                 .value = (recorded.low + recorded.high) / 2,
                                 .unit = "p/s"});
    }
    result.measures.push_back(std::move(measure));
    result.measures.push_back(
        {.name = at_width("flow by width", width), .value = flow / width, .unit = "p/(m s)"});
    result.measures.push_back({.name = at_width("left behind", width),
                               .value = static_cast<double>(door.people - run->times.size()),
                               .low = 0,
                               .high = 0});
  }
  return result;
}

const std::array<Test, 2> kBottleneckTests{
    Test{{"bottleneck", "Flow through doors 0.8 to 2.5 m wide",
          "200 people wait at 3.3 /m2 before a door through a wall 1 m thick. Times at the line in "
          "its middle, without the first and the last tenth: people by time and width [SS10].",
          "1.8 to 2.3 p/(m s), linear in the width: [Seyfried09], [Kretz06]"},
         bottleneck},
    Test{
        {.name = "motion.narrow",
         .title = "Flow through doors 0.5 to 0.8 m wide, where one passes at a time",
         .method = "150 people as in bottleneck. Recorded people: through entrances and a gate of "
                   "0.5 m and an exit of 0.7 m, as laboratory measures them.",
         .source =
             "[ZKSS11], [ABHSS20], and a tenth above and below; by width the flow falls as long as "
             "one passes at a time: [Kretz06]",
         .in_work = true},
        narrow_doors}};

}  // namespace

std::span<const Test> bottleneck_tests() { return kBottleneckTests; }

}  // namespace throng::validate
