// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>

#include "throng/base.h"
#include "throng/context.h"
#include "throng/recording.h"
#include "throng/result.h"

/// Exports recordings as text that other programs read. Files are complete or absent.
namespace throng {

/// Which avatars of a recording to export: many tools know one floor only, a recording may have
/// several.
struct ExportConfig {
  double lowest = -1e9;  ///< Lowest feet to export. [m]
  double highest = 1e9;  ///< Highest feet to export. [m]
};

/// Maps steps to film frames at a constant rate. The interval is the greatest common divisor of the
/// steps between recorded frames, so that each of these falls on a film frame.
struct FilmRate {
  uint64_t first_step = 0;
  uint64_t steps = 1;  ///< From one film frame to the next.
  double rate = 10;    ///< Film frames per second.
  [[nodiscard]] uint64_t frame_of(uint64_t step) const { return (step - first_step) / steps; }
};

/// The film rate of a recording. Fails with kBadFile as Replay::read does.
[[nodiscard]] THRONG_API Result<FilmRate> film_rate(Replay& replay);

/// The first line of a CSV table, and its continuation where avatars may lean: the unit vector
/// along the body from its feet.
inline constexpr const char* kCsvColumns = "step,id,class,x,y,z,radius";
inline constexpr const char* kCsvUpColumns = ",up_x,up_y,up_z";

/// Exports a CSV table, one line per avatar and frame, as `throng run --trajectories` writes. Fails
/// with kBadFile, kIo or kCancelled.
[[nodiscard]] THRONG_API Result<void> export_csv(Replay& replay, const std::string& path,
                                                 const ExportConfig& config, Context& context);

/// Exports the text format of the Juelich experiments, one line per avatar and frame: id, frame, x,
/// y, z in metres. Its x and y are x and z here, its z is the height of the feet. Fails as
/// export_csv does.
[[nodiscard]] THRONG_API Result<void> export_juelich(Replay& replay, const std::string& path,
                                                     const ExportConfig& config, Context& context);

}  // namespace throng
