// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "validate/plane_crowd.h"
#include "validate/walked_path.h"

/// A crowd that passes a door, as in laboratory experiments: [Kretz06], [Seyfried09].
namespace throng::validate {

/// The door, and the people that wait before it at 3.3 /m2, in a room of 12 x 12 m.
struct DoorConfig {
  double width = 1;       ///< [m, > 0, < 12]
  uint32_t people = 200;  ///< [> 0]
  double speed = 0;       ///< Desired speed of all; 0: that of the class. [m/s, >= 0]
};

/// How the people passed.
struct DoorRun {
  std::vector<double> times;      ///< When each passed the line, ascending. [s]
  CrossedLine line;               ///< In the middle of the door.
  std::vector<WalkedPath> paths;  ///< Of each, up to the first position beyond the line.
  std::vector<std::vector<Point2>> orientations;  ///< At the positions of the paths.
};

/// Lets the people pass until all have, or 60 s and 3 s a person and metre of width have gone by.
/// Adds the faults to `result`. Fails as Crowd::add does.
Result<DoorRun> pass_door(const DoorConfig& door, const ValidationConfig& config,
                          ValidationResult& result, Context& context);

/// A name of a measure at a width: "what, 0.8 m".
std::string at_width(const char* what, double width);

}  // namespace throng::validate
