// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "render/storey_index.h"

#include <algorithm>
#include <limits>
#include <numeric>

// Finds the storeys of a world and chooses those to show. Reads each level tile once.
namespace throng::render {
namespace {

constexpr double kMinShare = 0.01;  // Storeys with less than this share of all floor are not shown.

}  // namespace

StoreyIndex::StoreyIndex(const PictureWorld& world)
    : storeys_(world.storeys),
      row_floors_(static_cast<size_t>(world.tiles_z) * static_cast<size_t>(kTileCells), 0) {
  for (uint32_t i = 0; i < storeys_.size(); ++i) {
    const LevelTileContent tile = world.level_tile(i);
    int64_t sum = 0, count = 0;
    for (size_t c = 0; c < tile.floor.size(); ++c) {
      if (tile.floor[c] == kNoFloor) continue;
      sum += tile.floor[c];
      ++count;
      ++row_floors_[static_cast<size_t>(tile.tile_z) * kTileCells + c / kTileCells];
    }
    const auto storey = static_cast<size_t>(storeys_[i]);
    if (storey >= area_.size()) area_.resize(storey + 1, 0);
    if (count == 0) continue;
    area_[storey] += static_cast<double>(count) * world.cell * world.cell;
    tiles_[{tile.tile_z, tile.tile_x}].push_back(
        {i, static_cast<double>(sum) / static_cast<double>(count)});
  }
}

LocalStoreys StoreyIndex::around(Tile tile) const {
  std::map<size_t, std::vector<double>> means;
  for (int32_t z = tile.first - 1; z <= tile.first + 1; ++z) {
    for (int32_t x = tile.second - 1; x <= tile.second + 1; ++x) {
      const auto found = tiles_.find({z, x});
      if (found == tiles_.end()) continue;
      for (const LevelEntry& entry : found->second) {
        means[static_cast<size_t>(storeys_[entry.level])].push_back(entry.mean);
      }
    }
  }
  std::vector<std::pair<double, size_t>> order;
  for (auto& [storey, list] : means) {
    const auto middle = list.begin() + static_cast<ptrdiff_t>(list.size() / 2);
    std::nth_element(list.begin(), middle, list.end());
    order.emplace_back(*middle, storey);
  }
  std::sort(order.begin(), order.end());
  LocalStoreys local;
  for (const auto& [height, storey] : order) {
    local.height.push_back(height);
    local.storey.push_back(storey);
  }
  return local;
}

int32_t StoreyIndex::section_row(int32_t first, int32_t count) const {
  const auto floors = [&](int32_t row) { return row_floors_[static_cast<size_t>(row)]; };
  const int32_t middle = first + count / 2;
  int32_t best = middle;
  for (int32_t row = first + count / 4; row < first + count - count / 4; ++row) {
    if (floors(row) > floors(best)) best = row;
  }
  return floors(middle) * 10 >= floors(best) * 6 ? middle : best;
}

StoreyChoice StoreyIndex::choose(int32_t wanted, size_t max_count) const {
  const double all = std::accumulate(area_.begin(), area_.end(), 0.0);
  StoreyChoice choice;
  choice.shown.resize(area_.size());
  std::iota(choice.shown.begin(), choice.shown.end(), 0);
  const auto rank = [&](int32_t storey) {
    return storey == wanted ? std::numeric_limits<double>::infinity()
                            : area_[static_cast<size_t>(storey)];
  };
  while (choice.shown.size() > 1) {
    const auto smallest = std::min_element(choice.shown.begin(), choice.shown.end(),
                                           [&](int32_t a, int32_t b) { return rank(a) < rank(b); });
    if (choice.shown.size() <= max_count && rank(*smallest) >= kMinShare * all) break;
    ++choice.left_out;
    choice.shown.erase(smallest);
  }
  return choice;
}

}  // namespace throng::render
