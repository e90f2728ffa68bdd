// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "validate/streams.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "core/random.h"
#include "validate/plane_crowd.h"
#include "validate/statistics.h"
#include "validate/tests.h"

// Self-organisation of streams: lanes of a counter-flow [NS12], crossings without jams, arches
// before doors [HFV00].
namespace throng::validate {

double lane_order(std::span<const Passer> people, double row) {
  std::map<int64_t, std::pair<double, double>> rows;  // up, down
  for (const Passer& p : people) {
    auto& [up, down] = rows[static_cast<int64_t>(std::floor(p.across / row))];
    (p.up ? up : down) += 1;
  }
  const auto all = static_cast<double>(people.size());
  const auto count = static_cast<double>(rows.size());
  if (all <= count) return 0;
  double sum = 0;
  for (const auto& [at, counts] : rows) {
    const auto [up, down] = counts;
    sum += (up - down) * (up - down) / (up + down);
  }
  // With random directions a row of n people has a mean square surplus of n.
  return (sum - count) / (all - count);
}

double arch_shape(std::span<const DoorOffset> people) {
  double aside = 0, front = 0;
  for (const DoorOffset& p : people) {
    aside += std::fabs(p.aside);
    front += p.front;
  }
  return front > 0 ? aside / front : 0;
}

namespace {

// Lanes: avatars that leave at one end enter again at the other, so the number stays.
constexpr double kCorridorLength = 40, kCorridorWidth = 6;  // [m]
constexpr double kLaneFrom = 10, kLaneUntil = 30;           // [m] where order is measured
constexpr double kRow = 0.6;                                // [m]
constexpr double kLaneTime = 120;                           // [s]

struct Lanes {
  std::vector<double> order, speed;  // of each second
};

Result<Lanes> walk_lanes(double density, const ValidationConfig& config, ValidationResult& result,
                         Context& context) {
  PlaneConfig plane;
  plane.ground = box(-1, -0.5, kCorridorLength + 1, kCorridorWidth + 0.5);
  plane.obstacles = {box(-1, -0.5, kCorridorLength + 1, 0),
                     box(-1, kCorridorWidth, kCorridorLength + 1, kCorridorWidth + 0.5)};
  const AvatarClass body;
  auto crowd = PlaneCrowd::create(plane, body, Routing::kStraight, config, context);
  if (!crowd) return crowd.error();
  // Each avatar starts at a point of a grid, in a random direction.
  std::vector<Point2> starts;
  const double apart = 1 / std::sqrt(density), spare = apart - 2 * body.radius - 0.01;
  for (double x = apart / 2; x < kCorridorLength; x += apart) {
    for (double z = std::max(0.3, apart / 2); z < kCorridorWidth - 0.25; z += apart) {
      const uint64_t n = starts.size();
      starts.push_back({x + spare * (random_unit(config.seed, 1, n) - 0.5),
                        std::clamp(z + spare * (random_unit(config.seed, 2, n) - 0.5), 0.3,
                                   kCorridorWidth - 0.3)});
    }
  }
  const auto ids = crowd->add_fitting(starts, 0, context);
  if (!ids) return ids.error();
  std::map<uint32_t, bool> is_up;  // by slot
  for (const AvatarId id : *ids) {
    is_up[id.slot1] = random_unit(config.seed, 3, id.slot1) < 0.5;
  }
  Lanes lanes;
  std::vector<std::pair<Point2, bool>> entering;
  std::vector<Passer> passers;
  std::vector<AvatarId> walking, leaving;
  std::vector<Vec3d> velocities;
  const double time = config.brief ? kLaneTime / 4 : kLaneTime;
  double speeds = 0, measured = 0;
  for (int64_t step = 1; crowd->time() < time - 1e-9; ++step) {
    walking.clear();
    velocities.clear();
    leaving.clear();
    for (const AvatarMotion& s : crowd->avatars()) {
      const bool up = is_up[s.id.slot1];
      if (up ? s.x > kCorridorLength : s.x < 0) {
        leaving.push_back(s.id);
        entering.push_back({{up ? 0.1 : kCorridorLength - 0.1, s.z}, up});
        continue;
      }
      walking.push_back(s.id);
      velocities.push_back({up ? body.speed : -body.speed, 0, 0});
    }
    crowd->remove(leaving);
    std::vector<Point2> at;
    for (const auto& [start, up] : entering) at.push_back(start);
    const auto added = crowd->add(at, std::vector<double>(at.size(), body.speed), context);
    if (!added) return added.error();
    size_t k = 0;
    std::erase_if(entering, [&](const auto& one) {
      const AvatarId id = (*added)[k++];
      if (!id) return false;
      is_up[id.slot1] = one.second;
      walking.push_back(id);
      velocities.push_back({one.second ? body.speed : -body.speed, 0, 0});
      return true;
    });
    crowd->set_velocities(walking, velocities);
    crowd->step();
    if (context.cancel) return Error{Errc::kCancelled, "cancelled"};
    passers.clear();
    for (const AvatarMotion& s : crowd->avatars()) {
      if (s.x < kLaneFrom || s.x > kLaneUntil) continue;
      const bool up = is_up[s.id.slot1];
      passers.push_back({s.z, up});
      speeds += up ? s.vx : -s.vx;
      measured += 1;
    }
    if (step % 10 != 0) continue;
    lanes.order.push_back(lane_order(passers, kRow));
    lanes.speed.push_back(measured > 0 ? speeds / measured : 0);
    speeds = measured = 0;
  }
  crowd->report(result);
  return lanes;
}

double mean_of(const std::vector<double>& values, size_t from, size_t until) {
  double sum = 0;
  for (size_t i = from; i < until; ++i) sum += values[i];
  return sum / static_cast<double>(until - from);
}

Result<ValidationResult> lanes(const ValidationConfig& config, Context& context) {
  ValidationResult result;
  ValidationChart order{"lanes_order", {}}, speed{"lanes_speed", {}};
  order.chart.title = "Order of lanes in a counter-flow";
  order.chart.y_title = "order, 1: every row goes one way";
  order.chart.max = 1.4;  // room for the legend
  speed.chart.max = 1.9;
  speed.chart.title = "Speed in a counter-flow";
  speed.chart.y_title = "speed along the corridor, m/s";
  for (const double density : {0.3, 0.6, 1.0, 1.5, 2.0}) {
    const auto found = walk_lanes(density, config, result, context);
    if (!found) return found.error();
    const size_t seconds = found->order.size(), last = seconds / 4;
    const std::string at = fmt::format("{:.1f} /m2", density);
    result.measures.push_back(
        {.name = "order in the first 5 s, " + at, .value = mean_of(found->order, 0, 5)});
    ValidationMeasure last_order{.name = "order in the last quarter, " + at,
                                 .value = mean_of(found->order, seconds - last, seconds)};
    if (density > 0.5) last_order.low = 0.5;  // At a lower density there is space without lanes.
    result.measures.push_back(std::move(last_order));
    result.measures.push_back({.name = "speed in the last quarter, " + at,
                               .value = mean_of(found->speed, seconds - last, seconds),
                               .unit = "m/s",
                               .low = weidmann(density) / 2});
    for (ValidationChart* chart : {&order, &speed}) {
      chart->chart.x_title = "time, s";
      chart->chart.x.clear();
      ChartLine line{.name = at, .kind = LineKind::kPlain};
      for (size_t i = 0; i < seconds; ++i) {
        chart->chart.x.push_back(static_cast<double>(i + 1));
        line.values.push_back(std::max(0.0, chart == &order ? found->order[i] : found->speed[i]));
      }
      chart->chart.lines.push_back(std::move(line));
    }
  }
  result.charts = {std::move(order), std::move(speed)};
  return result;
}

// Two corridors that cross: half a person a square metre enters each, so the density is one where
// they cross unless there is a jam.
constexpr double kArm = 12, kCross = 4;  // [m] of a corridor before the crossing; its width
constexpr double kEach = 0.5;            // [1/m2]

Result<ValidationResult> crossing(const ValidationConfig& config, Context& context) {
  ValidationResult result;
  const double all = 2 * kArm + kCross;
  PlaneConfig plane;
  plane.ground = box(-1, -1, all + 1, all + 1);
  plane.obstacles = {box(-1, -1, kArm, kArm), box(kArm + kCross, -1, all + 1, kArm),
                     box(-1, kArm + kCross, kArm, all + 1),
                     box(kArm + kCross, kArm + kCross, all + 1, all + 1)};
  const AvatarClass body;
  auto crowd = PlaneCrowd::create(plane, body, Routing::kPaths, config, context);
  if (!crowd) return crowd.error();
  const double rate = kEach * body.speed * kCross;  // [p/s] of each stream
  const double time = config.brief ? 40 : 120, from = time / 3;
  std::map<uint32_t, int> stream_of;
  std::array<uint64_t, 2> called{};
  std::vector<std::pair<Point2, int>> entering;
  uint64_t entered = 0, left = 0, max_outside = 0;
  double inside = 0, speeds = 0;
  int64_t steps = 0;
  while (crowd->time() < time - 1e-9) {
    for (int k = 0; k < 2; ++k) {
      const auto which = static_cast<size_t>(k);
      while (static_cast<double>(called[which]) < rate * crowd->time()) {
        const double aside =
            kArm + 0.25 + (kCross - 0.5) * random_unit(config.seed, 10 + which, called[which]);
        ++called[which];
        entering.push_back({k == 0 ? Point2{-0.5, aside} : Point2{aside, -0.5}, k});
      }
    }
    std::vector<Point2> at;
    for (const auto& [start, stream] : entering) at.push_back(start);
    const auto added = crowd->add(at, std::vector<double>(at.size(), body.speed), context);
    if (!added) return added.error();
    const bool counts = crowd->time() >= from;
    size_t n = 0;
    std::erase_if(entering, [&](const auto& one) {
      const AvatarId id = (*added)[n++];
      if (!id) return false;
      stream_of[id.slot1] = one.second;
      crowd->set_goal(
          id, one.second == 0 ? Point2{all + 0.7, one.first.z} : Point2{one.first.x, all + 0.7});
      entered += counts ? 1 : 0;
      return true;
    });
    max_outside = std::max<uint64_t>(max_outside, entering.size());
    crowd->step();
    if (context.cancel) return Error{Errc::kCancelled, "cancelled"};
    std::vector<AvatarId> leaving;
    steps += counts ? 1 : 0;
    for (const AvatarMotion& s : crowd->avatars()) {
      const bool eastward = stream_of[s.id.slot1] == 0;
      if ((eastward ? s.x : s.z) > all) leaving.push_back(s.id);
      if (!counts || s.x < kArm || s.x > kArm + kCross || s.z < kArm || s.z > kArm + kCross) {
        continue;
      }
      inside += 1;
      speeds += eastward ? s.vx : s.vz;
    }
    left += counts ? leaving.size() : 0;
    crowd->remove(leaving);
  }
  crowd->report(result);
  result.measures = {
      {.name = "density where they cross",
       .value = inside / (kCross * kCross * static_cast<double>(steps)),
       .unit = "1/m2"},
      {.name = "speed there", .value = speeds / inside, .unit = "m/s", .low = weidmann(1) / 2},
      {.name = "left / entered",
       .value = static_cast<double>(left) / static_cast<double>(entered),
       .low = 0.9},
      {.name = "max waiting for room to enter", .value = static_cast<double>(max_outside)},
  };
  return result;
}

// A crowd that walks up to a door.
constexpr double kDoor = 1.2, kHall = 14;  // [m]
constexpr uint32_t kCrowd = 150;

Result<ValidationResult> arch(const ValidationConfig& config, Context& context) {
  ValidationResult result;
  PlaneConfig plane;
  plane.ground = box(-0.5, -0.5, kHall + 8, kHall + 0.5);
  const double middle = kHall / 2;
  plane.obstacles = {box(kHall, -0.5, kHall + 0.5, middle - kDoor / 2),
                     box(kHall, middle + kDoor / 2, kHall + 0.5, kHall + 0.5)};
  const AvatarClass body;
  auto crowd = PlaneCrowd::create(plane, body, Routing::kPaths, config, context);
  if (!crowd) return crowd.error();
  std::vector<Point2> starts;
  for (uint64_t n = 0; n < kCrowd; ++n) {
    starts.push_back(
        {0.5 + 0.6 * static_cast<double>(n / 15) + 0.2 * (random_unit(config.seed, 1, n) - 0.5),
         2.8 + 0.6 * static_cast<double>(n % 15) + 0.2 * (random_unit(config.seed, 2, n) - 0.5)});
  }
  const auto ids = crowd->add_fitting(starts, 0, context);
  if (!ids) return ids.error();
  for (const AvatarId id : *ids) crowd->set_goal(id, {kHall + 7, middle});
  std::vector<double> times;
  std::vector<DoorOffset> waiting;
  double shape = 0, near = 0;
  int64_t samples = 0;
  while (crowd->size() > 0 && crowd->time() < 300) {
    crowd->step();
    if (context.cancel) return Error{Errc::kCancelled, "cancelled"};
    std::vector<AvatarId> leaving;
    waiting.clear();
    for (const AvatarMotion& s : crowd->avatars()) {
      const double before = s.x - s.vx * PlaneCrowd::kStep;
      if (before < kHall + 0.25 && s.x >= kHall + 0.25) times.push_back(crowd->time());
      if (s.x > kHall + 5) leaving.push_back(s.id);
      if (s.x < kHall) waiting.push_back({s.z - middle, kHall - s.x});
    }
    crowd->remove(leaving);
    if (crowd->time() < 15 || crowd->time() > 30 + 1e-9) continue;
    ++samples;
    shape += arch_shape(waiting);
    near += static_cast<double>(std::ranges::count_if(
        waiting, [](const DoorOffset& p) { return std::hypot(p.aside, p.front) < 2; }));
  }
  crowd->report(result);
  const double half_circle = 2 * 3.14159265358979323846;  // of 2 m [m2]
  result.measures = {
      {.name = "to the side by to the front, 15 to 30 s",
       .value = shape / static_cast<double>(samples),
       .low = 0.6,
       .high = 1.6},
      {.name = "density within 2 m of the door",
       .value = near / (half_circle * static_cast<double>(samples)),
       .unit = "1/m2"},
      {.name = "flow", .value = flow_rate(times) / kDoor, .unit = "p/(m s)"},
      {.name = "left behind", .value = static_cast<double>(crowd->size()), .low = 0, .high = 0},
  };
  return result;
}

const std::array<Test, 3> kStreamTests{
    Test{{"lanes", "Lanes in a counter-flow",
          "A corridor of 40 x 6 m, people start in either direction at random, mixed; those that "
          "leave at one end enter again at the other. Order of rows 0.6 m wide along the middle 20 "
          "m [NS12], 0 for random mixing, 1 if every row has one direction, each second for 120 s; "
          "speeds along the corridor.",
          "ours: an order of 0.5 from 0.6 /m2 up, and half of the speed of [Weidmann93]"},
         lanes},
    Test{{"crossing", "Two streams that cross at right angles",
          "Corridors 4 m wide, half a person a square metre entering each, so 1 /m2 where they "
          "cross; after the first third of 120 s.",
          "ours: no jam, that is half of [Weidmann93]'s speed at 1 /m2, and nine of ten that "
          "enter leave"},
         crossing},
    Test{{"arch", "An arch before a door",
          "150 people walk up to a door of 1.2 m. From 15 to 30 s: mean distance to the side of "
          "all before it by mean distance to the front; 1 for a half circle, less for a column, "
          "more for a line along the wall. Flow as of bottleneck.",
          "[HFV00]: arches; the range is ours"},
         arch}};

}  // namespace

std::span<const Test> stream_tests() { return kStreamTests; }

}  // namespace throng::validate
