// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>

#include "throng/base.h"
#include "throng/context.h"
#include "throng/recording.h"
#include "throng/result.h"

/// Recordings as text that other programs read. Files are complete or not there.
namespace throng {

/// What of a recording to write: tools for crowds know one floor, a recording may have many.
struct ExportConfig {
  double lowest = -1e9;  ///< Only avatars whose feet are at least so high. [m]
  double highest = 1e9;  ///< And at most so high. [m]
};

/// Which frame of an even film a step is: film frames are as far apart as the closest frames of the
/// recording allow without falling between two of its steps.
struct FilmRate {
  uint64_t first_step = 0;
  uint64_t steps = 1;  ///< From one film frame to the next.
  double rate = 10;    ///< Film frames a second.
  [[nodiscard]] uint64_t frame_of(uint64_t step) const { return (step - first_step) / steps; }
};

/// Fails with kBadFile like Replay::read.
[[nodiscard]] THRONG_API Result<FilmRate> film_rate(Replay& replay);

/// The first line of a table of avatars; and what it goes on with where some may lean: along the
/// body from its feet, a unit vector.
inline constexpr const char* kCsvColumns = "step,id,class,x,y,z,radius";
inline constexpr const char* kCsvUpColumns = ",up_x,up_y,up_z";

/// A line an avatar, as `throng run --trajectories` writes them. Fails with kBadFile, kIo or
/// kCancelled.
[[nodiscard]] THRONG_API Result<void> export_csv(Replay& replay, const std::string& path,
                                                 const ExportConfig& config, Context& context);

/// The text format of the experiments in Juelich: a line an avatar: id, frame, x, y, z in metres,
/// their x and y our x and z, their z the height of the feet. Fails likewise.
[[nodiscard]] THRONG_API Result<void> export_juelich(Replay& replay, const std::string& path,
                                                     const ExportConfig& config, Context& context);

}  // namespace throng
