// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "throng/base.h"
#include "throng/context.h"
#include "throng/recording.h"
#include "throng/result.h"

/// What a recording comes to: who is left, who crosses which line, where it is dense, where people
/// wait.
namespace throng {

/// A line on the ground, seen from above, across which people are counted.
struct FlowLine {
  double x0 = 0, z0 = 0, x1 = 0, z1 = 0;  ///< Its ends. [m, not the same]
  double lowest = -1e9, highest = 1e9;    ///< Only feet between these heights count. [m]
};

struct SummaryConfig {
  std::vector<FlowLine> lines = {};
  double bin = 1;     ///< Of the flows. [s, >= 0.001]
  double cell = 0.5;  ///< Of the maps. [m, >= 0.001]
  double storey = 3;  ///< A map for each so many metres of height. [m, >= 0.001]
  double slow = 0.2;  ///< Who is slower than this waits. [m/s, >= 0.001]
  uint64_t max_cells = uint64_t{1} << 24;  ///< Of all maps together.
};

/// Crossings of one line, bin by bin from the first frame on. Forth is to the right of who goes
/// from the line's first end to its second (x to the right, z down).
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
  std::vector<double> waiting;  ///< Time waited by all together. [s / m^2]
};

struct ReplaySummary {
  uint64_t positions = 0;  ///< Avatars summed over all frames.
  double mean_speed = 0;   ///< Of everybody over all time. [m/s]
  double waited = 0;       ///< By all together. [s]
  double last_left = 0;    ///< When the last one left, 0 if nobody did. [s]
  // One a frame:
  std::vector<double> time;  ///< [s]
  std::vector<uint32_t> present;
  std::vector<uint64_t> come, left;  ///< So far; those of the first frame have come.
  std::vector<double> speed;         ///< Mean of those who stay to the next frame; last: as before.
  std::vector<LineFlow> lines;       ///< As in the config.
  std::vector<SummaryMap> maps;      ///< Of storeys in which anybody was, lowest first.
};

/// Reads all frames twice; a body holds its place until the next frame. Fails with kBadConfig,
/// kBadFile (a corrupt chunk, no frame at all), kLimit (too many cells) or kCancelled.
[[nodiscard]] THRONG_API Result<ReplaySummary> summarise(Replay& replay,
                                                         const SummaryConfig& config,
                                                         Context& context);

}  // namespace throng
