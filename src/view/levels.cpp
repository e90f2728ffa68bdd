// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "view/levels.h"

#include <algorithm>
#include <cmath>
#include <map>

// Storeys are the peaks of a histogram of floor heights, largest first. Time: linear in cells.
namespace throng::view {
namespace {

constexpr int32_t kBin = 250;           // [mm]
constexpr int32_t kStoreyBins = 8;      // [bins] Smallest distance of two storeys.
constexpr double kShare = 0.08;         // Smallest area of a storey, as a share of the largest one.
constexpr uint32_t kMaxTiles = 20'000;  // Of more tiles, every n-th is read.

}  // namespace

std::vector<double> storey_heights(const World& world, Context& context) {
  const WorldSummary summary = world.summary();
  std::map<int32_t, uint64_t> cells;  // By bin of height.
  const uint32_t tiles = world.level_tile_count(), stride = tiles / kMaxTiles + 1;
  for (uint32_t tile = 0; tile < tiles && !context.cancel; tile += stride) {
    const LevelTileContent content = world.level_tile(tile);
    for (size_t i = 0; i < content.floor.size(); ++i) {
      const bool is_legal = std::any_of(content.clearance.begin(), content.clearance.end(),
                                        [i](const auto& of_class) { return of_class[i] > 0; });
      if (content.floor[i] == kNoFloor || !is_legal) continue;
      ++cells[content.floor[i] / kBin];
    }
  }
  std::vector<std::pair<uint64_t, int32_t>> by_size;
  for (const auto& [bin, count] : cells) by_size.emplace_back(count, bin);
  std::sort(by_size.rbegin(), by_size.rend());
  std::vector<int32_t> storeys;
  for (const auto& [count, bin] : by_size) {
    if (static_cast<double>(count) < kShare * static_cast<double>(by_size.front().first)) break;
    const int32_t height = bin;
    const bool apart = std::all_of(storeys.begin(), storeys.end(), [height](int32_t other) {
      return std::abs(other - height) >= kStoreyBins;
    });
    if (apart) storeys.push_back(height);
  }
  std::sort(storeys.begin(), storeys.end());
  std::vector<double> heights;
  heights.reserve(storeys.size());
  for (const int32_t bin : storeys) heights.push_back(summary.origin.y + bin * kBin * 1e-3);
  return heights;
}

}  // namespace throng::view
