// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "validate/plane_crowd.h"
#include "validate/tracks.h"

/// Walked paths, recorded or simulated, and measures of how calmly they were walked up to a line.
namespace throng::validate {

/// The path of a person, one position each step of PlaneCrowd::kStep.
struct WalkedPath {
  int64_t first = 0;  ///< Step of the first position.
  std::vector<Point2> at;
};

/// A line that people cross, parallel to an axis. Its ends do not limit it.
struct CrossedLine {
  Point2 from, to;
};

/// Positions of a track at each step, between frames by linear interpolation. Empty if no step lies
/// within it. [track: not empty; fps: > 0]
WalkedPath resampled(const Track& track, double fps);

/// Index of the first position beyond the line; 0: the path never crosses it.
size_t crossing_index(const WalkedPath& path, const CrossedLine& line);

/// Time of the first crossing of the line [s]; below 0: there is none.
double crossing_time(const WalkedPath& path, const CrossedLine& line);

/// How people walked before a line. NaN: there was nothing to measure.
struct PathMeasures {
  size_t people = 0;  ///< That crossed the line, and had walked for a move or more before.
  /// Length of the path by the straight line from its begin to its end, mean over people whose
  /// straight line is 0.5 m or longer. [>= 1]
  double detour = 0;
  /// Share of the changes from a move to the next one that turn by more than 90 degrees. Moves of
  /// less than 5 cm turn by nothing: heads sway by as much.
  double turns = 0;
  double speed_change = 0;  ///< Root mean square, from a move to the next one. [m/s]
  double walked_away = 0;   ///< Sum of moves away from the middle of the line, a person. [m]
};

/// Measures the paths from their begin to the last position before the line, in moves of 0.4 s, so
/// that swaying heads count little. Paths that do not cross the line are left out. Linear in the
/// positions.
PathMeasures measure_paths(std::span<const WalkedPath> paths, const CrossedLine& line);

/// Mean turning rate of orientations: the angles between successive ones by the time between them,
/// over all people. Each orientation is a unit vector; `dt` is the time between two. NaN: no person
/// has two. [degrees/s]
double mean_turning_rate(std::span<const std::vector<Point2>> orientations, double dt);

}  // namespace throng::validate
