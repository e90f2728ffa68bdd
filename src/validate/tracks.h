// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "throng/base.h"

/// Recorded trajectories of people.
namespace throng::validate {

struct TrackPoint {
  int64_t frame = 0;
  double x = 0, z = 0;  ///< [m]
};

struct Track {
  int64_t person = 0;
  std::vector<TrackPoint> points;  ///< Frames ascending.
};

struct Tracks {
  std::vector<Track> people;  ///< By person.
  double fps = 16;            ///< Frames a second, as the file states.
};

/// Reads the trajectory text of Forschungszentrum Juelich: lines of person, frame, x, y, height,
/// comments with the unit and the frames a second; without them centimetres at 16 a second, as in
/// the experiments of 2009. Fails with kIo (it cannot be read), kBadFile and the line.
Result<Tracks> load_juelich(const std::string& path);
/// Reads an "obsmat.txt" of the scenes of ETH and UCY: lines of frame, person, x, 0, y and a
/// velocity, which is left out. fps is not in the file. Fails as above.
Result<Tracks> load_obsmat(const std::string& path);

}  // namespace throng::validate
