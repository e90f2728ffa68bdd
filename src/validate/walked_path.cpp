// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "validate/walked_path.h"

#include <algorithm>
#include <cmath>
#include <limits>

// Paths are cut into moves of equal time, end to end; all measures are of these moves, so a
// recorded and a simulated path are measured alike.
namespace throng::validate {
namespace {

constexpr size_t kMoveSteps = 4;      // of a move: 0.4 s
constexpr double kMinStraight = 0.5;  // [m] of a straight line that a path is compared with
constexpr double kMinMove = 0.05;     // [m] of a move that can turn

constexpr double kDegrees = 180 / 3.14159265358979323846;  // of a radian
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

double apart(const Point2& a, const Point2& b) { return std::hypot(b.x - a.x, b.z - a.z); }

// Signed distance from the line.
double beyond(const Point2& p, const CrossedLine& line) {
  return line.from.z == line.to.z ? p.z - line.from.z : p.x - line.from.x;
}

// Positions at the ends of the moves before the line; empty if it is not crossed.
std::vector<Point2> moves_before(const WalkedPath& path, const CrossedLine& line) {
  std::vector<Point2> ends;
  const size_t until = crossing_index(path, line);
  for (size_t i = 0; i < until; i += kMoveSteps) ends.push_back(path.at[i]);
  return ends;
}

// Sums over paths, of which the measures are means.
struct Sums {
  size_t people = 0, compared = 0, changes = 0, turns = 0;
  double detours = 0, squares = 0, away = 0;

  void add(std::span<const Point2> ends, const Point2& middle);
  void add_change(const Point2& a, const Point2& b, const Point2& c);
};

void Sums::add(std::span<const Point2> ends, const Point2& middle) {
  ++people;
  double length = 0;
  for (size_t i = 1; i < ends.size(); ++i) {
    length += apart(ends[i - 1], ends[i]);
    away += std::max(0.0, apart(ends[i], middle) - apart(ends[i - 1], middle));
    if (i >= 2) add_change(ends[i - 2], ends[i - 1], ends[i]);
  }
  const double straight = apart(ends.front(), ends.back());
  if (straight < kMinStraight) return;
  ++compared;
  detours += length / straight;
}

void Sums::add_change(const Point2& a, const Point2& b, const Point2& c) {
  const double first = apart(a, b), second = apart(b, c);
  const double speeds = (second - first) / (kMoveSteps * PlaneCrowd::kStep);
  squares += speeds * speeds;
  ++changes;
  const bool moves = first >= kMinMove && second >= kMinMove;
  if (moves && (b.x - a.x) * (c.x - b.x) + (b.z - a.z) * (c.z - b.z) < 0) ++turns;
}

double mean(double sum, size_t count) {
  return count > 0 ? sum / static_cast<double>(count) : kNone;
}

}  // namespace

WalkedPath resampled(const Track& track, double fps) {
  WalkedPath path;
  const auto time = [&](size_t i) { return static_cast<double>(track.points[i].frame) / fps; };
  path.first = static_cast<int64_t>(std::ceil(time(0) / PlaneCrowd::kStep - 1e-9));
  size_t i = 0;
  for (int64_t step = path.first;; ++step) {
    const double t = static_cast<double>(step) * PlaneCrowd::kStep;
    while (i + 1 < track.points.size() && time(i + 1) < t) ++i;
    if (i + 1 >= track.points.size()) break;
    const TrackPoint &a = track.points[i], &b = track.points[i + 1];
    const double part = (t - time(i)) / (time(i + 1) - time(i));
    path.at.push_back({a.x + part * (b.x - a.x), a.z + part * (b.z - a.z)});
  }
  return path;
}

size_t crossing_index(const WalkedPath& path, const CrossedLine& line) {
  for (size_t i = 1; i < path.at.size(); ++i) {
    if ((beyond(path.at[i - 1], line) < 0) != (beyond(path.at[i], line) < 0)) return i;
  }
  return 0;
}

double crossing_time(const WalkedPath& path, const CrossedLine& line) {
  const size_t i = crossing_index(path, line);
  if (i == 0) return -1;
  const double before = beyond(path.at[i - 1], line), after = beyond(path.at[i], line);
  return (static_cast<double>(path.first + static_cast<int64_t>(i)) - after / (after - before)) *
         PlaneCrowd::kStep;
}

PathMeasures measure_paths(std::span<const WalkedPath> paths, const CrossedLine& line) {
  const Point2 middle{(line.from.x + line.to.x) / 2, (line.from.z + line.to.z) / 2};
  Sums sums;
  for (const WalkedPath& path : paths) {
    const std::vector<Point2> ends = moves_before(path, line);
    if (ends.size() >= 2) sums.add(ends, middle);
  }
  return {.people = sums.people,
          .detour = mean(sums.detours, sums.compared),
          .turns = mean(static_cast<double>(sums.turns), sums.changes),
          .speed_change = std::sqrt(mean(sums.squares, sums.changes)),
          .walked_away = mean(sums.away, sums.people)};
}

double mean_turning_rate(std::span<const std::vector<Point2>> orientations, double dt) {
  double angles = 0;
  size_t count = 0;
  for (const std::vector<Point2>& of_one : orientations) {
    for (size_t i = 1; i < of_one.size(); ++i) {
      const Point2 &a = of_one[i - 1], &b = of_one[i];
      angles += std::fabs(std::atan2(a.x * b.z - a.z * b.x, a.x * b.x + a.z * b.z));
      ++count;
    }
  }
  return mean(angles * kDegrees, count) / dt;
}

}  // namespace throng::validate
