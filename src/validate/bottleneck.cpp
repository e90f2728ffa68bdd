// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/random.h"
#include "validate/plane_crowd.h"
#include "validate/statistics.h"
#include "validate/tests.h"

// Flow of a crowd through a door, by the width of the door, as in laboratory experiments:
// [Kretz06], [Seyfried09].
namespace throng::validate {
namespace {

constexpr double kRoomLong = 12, kRoomWide = 12;  // [m] before the bottleneck
constexpr double kExitLength = 8;                 // [m] behind it
constexpr double kWallThickness = 1;              // [m] of the wall: how long the bottleneck is
constexpr double kStart = 3.3;                    // [1/m2] of the people that wait

struct Door {
  double width = 1;
  uint32_t people = 200;
};

PlaneConfig door_plane(double width) {
  PlaneConfig plane;
  const double all = kRoomLong + kWallThickness + kExitLength;
  plane.ground = box(-0.5, -0.5, all + 0.5, kRoomWide + 0.5);
  const double low = (kRoomWide - width) / 2, high = (kRoomWide + width) / 2;
  plane.obstacles = {box(kRoomLong, -0.5, kRoomLong + kWallThickness, low),
                     box(kRoomLong, high, kRoomLong + kWallThickness, kRoomWide + 0.5),
                     box(-0.5, -0.5, 0, kRoomWide + 0.5), box(0, -0.5, kRoomLong, 0),
                     box(0, kRoomWide, kRoomLong, kRoomWide + 0.5)};
  return plane;
}

// Start points in a half circle around the door, nearest first.
std::vector<Point2> waiting(const Door& door, double radius, uint64_t seed) {
  const double apart = 1 / std::sqrt(kStart), spare = apart - 2 * radius - 0.004;
  std::vector<Point2> starts;
  for (double x = kRoomLong - 0.8; x > 0.5; x -= apart) {
    for (double z = 0.5; z < kRoomWide - 0.5; z += apart) {
      const uint64_t n = starts.size();
      starts.push_back({x + spare * (random_unit(seed, 1, n) - 0.5),
                        z + spare * (random_unit(seed, 2, n) - 0.5)});
    }
  }
  const auto off = [](const Point2& s) { return std::hypot(s.x - kRoomLong, s.z - kRoomWide / 2); };
  std::sort(starts.begin(), starts.end(),
            [&](const Point2& a, const Point2& b) { return off(a) < off(b); });
  starts.resize(std::min<size_t>(starts.size(), door.people));
  return starts;
}

// When people passed the middle of the door, in order. [s]
using Times = std::vector<double>;

Result<Times> pass(const Door& door, const ValidationConfig& config, ValidationResult& result,
                   Context& context) {
  const AvatarClass body = walker();
  auto crowd = PlaneCrowd::create(door_plane(door.width), body, Routing::kPaths, config, context);
  if (!crowd) return crowd.error();
  const auto ids = crowd->add_fitting(waiting(door, body.radius, config.seed), 0, context);
  if (!ids) return ids.error();
  for (size_t i = 0; i < ids->size(); ++i) {
    const double z = 1 + (kRoomWide - 2) * random_unit(config.seed, 3, i);
    crowd->set_goal((*ids)[i], {kRoomLong + kWallThickness + kExitLength - 0.5, z});
  }
  Times times;
  const double line = kRoomLong + kWallThickness / 2;
  std::set<uint32_t> through;  // only the first time counts
  const double limit = 60 + 3.0 * door.people / door.width;
  while (crowd->size() > 0 && crowd->time() < limit) {
    crowd->step();
    if (context.cancel) return Error{Errc::kCancelled, "cancelled"};
    std::vector<AvatarId> leaving;
    for (const AvatarMotion& s : crowd->avatars()) {
      const double before = s.x - s.vx * PlaneCrowd::kStep;
      if (before < line && s.x >= line && through.insert(s.id.slot1).second) {
        times.push_back(crowd->time() - (s.x - line) / std::max(1e-9, s.vx));
      }
      if (s.x > kRoomLong + kWallThickness + kExitLength - 2) leaving.push_back(s.id);
    }
    crowd->remove(leaving);
  }
  std::sort(times.begin(), times.end());
  crowd->report(result);
  return times;
}

std::string at_width(const char* what, double width) {
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), "%s, %.1f m", what, width);
  return text.data();
}

Result<ValidationResult> bottleneck(const ValidationConfig& config, Context& context) {
  ValidationResult result;
  std::vector<double> widths{0.8, 0.9, 1.0, 1.2, 1.4, 1.6, 1.8, 2.0, 2.2, 2.5};
  if (config.brief) widths = {0.8, 1.0, 1.2, 1.8, 2.5};
  std::vector<double> flows;
  for (const double width : widths) {
    const Door door{.width = width, .people = config.brief ? 120u : 200u};
    const auto times = pass(door, config, result, context);
    if (!times) return times.error();
    flows.push_back(flow_rate(*times));
    result.measures.push_back({.name = at_width("flow by width", width),
                               .value = flow_rate(*times) / width,
                               .unit = "p/(m s)",
                               .low = 1.8,
                               .high = 2.3});
    result.measures.push_back({.name = at_width("left behind", width),
                               .value = static_cast<double>(door.people - times->size()),
                               .low = 0,
                               .high = 0});
  }
  // J = k b by least squares.
  double bj = 0, bb = 0, mean = 0;
  for (size_t i = 0; i < widths.size(); ++i) {
    bj += widths[i] * flows[i];
    bb += widths[i] * widths[i];
    mean += flows[i] / static_cast<double>(widths.size());
  }
  const double k = bj / bb;
  double off = 0, spread = 0;
  for (size_t i = 0; i < widths.size(); ++i) {
    off += (flows[i] - k * widths[i]) * (flows[i] - k * widths[i]);
    spread += (flows[i] - mean) * (flows[i] - mean);
  }
  result.measures.push_back(
      {.name = "k of J = k b", .value = k, .unit = "p/(m s)", .low = 1.8, .high = 2.3});
  result.measures.push_back({.name = "share of the variance that J = k b explains",
                             .value = 1 - off / spread,
                             .low = 0.95});
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
  result.charts.push_back(std::move(chart));
  return result;
}

const std::array<Test, 1> kBottleneckTests{Test{
    {"bottleneck", "Flow through doors 0.8 to 2.5 m wide",
     "200 people wait at 3.3 /m2 before a door through a wall 1 m thick. Times at the line in its "
     "middle, without the first and the last tenth: people by time and width [SS10].",
     "1.8 to 2.3 p/(m s), linear in the width: [Seyfried09], [Kretz06]"},
    bottleneck}};

}  // namespace

std::span<const Test> bottleneck_tests() { return kBottleneckTests; }

}  // namespace throng::validate
