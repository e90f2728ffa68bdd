// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "naive_slices.h"

#include <algorithm>
#include <limits>

// [ML06] algorithms 2 and 3, without the shortcuts of the sweep.
namespace throng::naive {
namespace {

enum class Test { kKeep, kDismissCurrent, kReplacePrevious };

// Algorithm 2 as printed; i is the index of the newest slice, which follows slices[i - 1].
Test test_slice(const std::vector<Slice>& slices, size_t i, int32_t avatar_height) {
  const size_t cells = slices[i].surface.size();
  std::vector<bool> invalid(cells, false);
  size_t count_equal = 0, count_useless = 0;
  for (size_t a = 0; a < cells; ++a) {
    if (slices[i].height - slices[i].surface[a] < avatar_height) {
      ++count_useless;
    } else if (slices[i].surface[a] == slices[i - 1].surface[a]) {
      invalid[a] = true;
      ++count_equal;
    }
  }
  if (count_equal + count_useless == cells) return Test::kDismissCurrent;
  if (i > 1) {
    size_t count = 0;
    for (size_t a = 0; a < cells; ++a) {
      if (invalid[a] || slices[i - 2].surface[a] == slices[i - 1].surface[a] ||
          slices[i - 1].height - slices[i - 1].surface[a] < avatar_height) {
        ++count;
      }
    }
    if (count == cells) return Test::kReplacePrevious;
  }
  return Test::kKeep;
}

int32_t maximum(const Slice& slice) {
  return *std::max_element(slice.surface.begin(), slice.surface.end());
}

}  // namespace

Slice cut(const Columns& columns, int32_t height, int32_t far_plane) {
  Slice slice{.height = height, .surface = {}};
  for (size_t cell = 0; cell + 1 < columns.first.size(); ++cell) {
    int32_t value = far_plane;
    for (uint32_t i = columns.first[cell]; i < columns.first[cell + 1]; ++i) {
      if (columns.low[i] > height) continue;
      value = std::max(value, std::min(columns.high[i], height));
    }
    slice.surface.push_back(value);
  }
  return slice;
}

SliceRun slice(const Columns& columns, const papers::SweepConfig& config) {
  SliceRun run;
  std::vector<Slice>& slices = run.kept;
  slices.push_back(
      cut(columns, config.max_y + config.avatar_height + config.resolution, config.far_plane));
  run.taken.push_back(slices[0]);
  int32_t max = maximum(slices[0]);
  size_t i = 1;
  while (max > config.min_y + config.avatar_height) {
    slices.resize(i);
    slices.push_back(cut(columns, max - config.resolution, config.far_plane));
    run.taken.push_back(slices[i]);
    max = maximum(slices[i]);
    const Test test = test_slice(slices, i, config.avatar_height);
    if (test == Test::kKeep) {
      ++i;
    } else if (test == Test::kReplacePrevious) {
      slices[i - 1] = slices[i];
    }
  }
  slices.resize(i);
  return run;
}

std::vector<papers::SliceTile> make_tiles(const Columns& columns) {
  std::vector<papers::SliceTile> tiles;
  for (int32_t tz = 0; tz * kTileCells < columns.depth; ++tz) {
    for (int32_t tx = 0; tx * kTileCells < columns.width; ++tx) {
      papers::SliceTile tile{.tile_x = tx, .tile_z = tz, .first = {0}, .low = {}, .high = {}};
      for (int32_t cell = 0; cell < kTileCells * kTileCells; ++cell) {
        const int32_t x = tx * kTileCells + cell % kTileCells;
        const int32_t z = tz * kTileCells + cell / kTileCells;
        if (x < columns.width && z < columns.depth) {
          const auto from =
              static_cast<size_t>(z) * static_cast<size_t>(columns.width) + static_cast<size_t>(x);
          const auto low = columns.lows(from);
          const auto high = columns.highs(from);
          tile.low.insert(tile.low.end(), low.begin(), low.end());
          tile.high.insert(tile.high.end(), high.begin(), high.end());
        }
        tile.first.push_back(static_cast<uint32_t>(tile.low.size()));
      }
      tiles.push_back(std::move(tile));
    }
  }
  return tiles;
}

papers::SweepConfig sweep_config(const Columns& columns, int32_t avatar_height,
                                 int32_t resolution) {
  papers::SweepConfig config{.width = columns.width,
                             .depth = columns.depth,
                             .avatar_height = avatar_height,
                             .resolution = resolution};
  if (!columns.low.empty()) {
    config.min_y = *std::min_element(columns.low.begin(), columns.low.end());
    config.max_y = *std::max_element(columns.high.begin(), columns.high.end());
  }
  config.far_plane = config.min_y - resolution;  // eq. 2
  return config;
}

}  // namespace throng::naive
