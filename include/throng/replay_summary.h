// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "throng/base.h"
#include "throng/context.h"
#include "throng/recording.h"
#include "throng/result.h"

/// Summaries of recordings: numbers of avatars, flows over lines, maps of density and of waiting.
namespace throng {

/// A line on the ground, seen from above, where crossings are counted.
struct FlowLine {
  double x0 = 0, z0 = 0, x1 = 0, z1 = 0;  ///< Its ends. [m, not the same]
  double lowest = -1e9, highest = 1e9;    ///< Only feet between these heights count. [m]
};

/// Settings for summarise.
struct SummaryConfig {
  std::vector<FlowLine> lines = {};
  double bin = 1;                          ///< Time bin of the flows. [s, >= 0.001]
  double cell = 0.5;                       ///< Side of a cell of the maps. [m, >= 0.001]
  double storey = 3;                       ///< Height of a storey; each has its maps. [m, >= 0.001]
  double slow = 0.2;                       ///< Avatars slower than this wait. [m/s, >= 0.001]
  uint64_t max_cells = uint64_t{1} << 24;  ///< Limit of the cells of all maps together.
};

/// Crossings of one line, per time bin from the first frame on. Forth is to the right as seen from
/// the line's first end towards its second (x to the right, z down).
struct LineFlow {
  std::vector<uint32_t> forth, back;
  uint64_t total_forth = 0, total_back = 0;
};

/// Cells of one storey, row by row: cell (i, k) begins at x0 + i * cell, z0 + k * cell.
struct SummaryMap {
  double lowest = 0, highest = 0;  ///< Feet in [lowest, highest). [m]
  double x0 = 0, z0 = 0, cell = 0.5;
  int32_t width = 0, depth = 0;
  std::vector<double> density;  ///< Mean over the whole time. [persons / m^2]
  std::vector<double> waiting;  ///< Waiting time, summed over avatars. [s / m^2]
};

/// The summary of a recording.
struct ReplaySummary {
  uint64_t positions = 0;  ///< Avatars summed over all frames.
  double mean_speed = 0;   ///< Over all avatars and frames. [m/s]
  double waited = 0;       ///< Waiting time, summed over avatars. [s]
  double last_left = 0;    ///< When the last avatar left; 0 if none did. [s]
  // One per frame:
  std::vector<double> time;  ///< [s]
  std::vector<uint32_t> present;
  std::vector<uint64_t> come, left;  ///< So far; avatars of the first frame have come.
  /// Mean over avatars that are also in the next frame; the last frame repeats the one before.
  std::vector<double> speed;
  std::vector<LineFlow> lines;   ///< In the order of the config.
  std::vector<SummaryMap> maps;  ///< Of storeys with avatars, lowest first.
};

/// Summarises a recording; each position counts until the next frame. Reads all frames twice. Fails
/// with kBadConfig, kBadFile (a corrupt chunk, no frame at all), kLimit (too many cells) or
/// kCancelled.
[[nodiscard]] THRONG_API Result<ReplaySummary> summarise(Replay& replay,
                                                         const SummaryConfig& config,
                                                         Context& context);

}  // namespace throng
