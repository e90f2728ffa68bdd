// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <bit>
#include <cstdlib>
#include <map>
#include <numeric>

#include "world/zone_data.h"

// Storeys: sheets of neighbouring tiles that continue each other are flooded into groups, never two
// that lie over each other; groups of like height that do not overlap then share a number.
namespace throng {
namespace {

using Rows = std::array<uint64_t, 64>;

struct LevelInfo {
  int32_t tile_x = 0, tile_z = 0;
  LevelView view;
  int32_t cells = 0;
  double mean = 0;  // [mm]
};

Rows rows_of(const LevelView& view) {
  Rows rows;
  if (view.present == nullptr) {
    rows.fill(~uint64_t{0});
  } else {
    std::copy_n(view.present, 64, rows.begin());
  }
  return rows;
}

bool overlap(const LevelView& a, const LevelView& b) {
  const Rows p = rows_of(a), q = rows_of(b);
  for (size_t z = 0; z < 64; ++z) {
    if ((p[z] & q[z]) != 0) return true;
  }
  return false;
}

// Border cells over which two levels of tiles side by side continue each other.
int32_t shared_cells(const LevelView& a, const LevelView& b, int32_t side, int32_t max_step) {
  int32_t count = 0;
  for (int32_t i = 0; i < 64; ++i) {
    const std::array<std::array<int32_t, 4>, 4> ends{
        {{0, i, 63, i}, {63, i, 0, i}, {i, 0, i, 63}, {i, 63, i, 0}}};
    const auto [ax, az, bx, bz] = ends[static_cast<size_t>(side)];
    if (!a.has(ax, az) || !b.has(bx, bz)) continue;
    if (std::abs(a.sample(ax, az) - b.sample(bx, bz)) <= max_step) ++count;
  }
  return count;
}

}  // namespace

std::vector<int32_t> World::storeys() const {
  const WorldData& world = *data_;
  std::vector<LevelInfo> levels(world.level_count);
  double max_step = 0;
  for (const AvatarClass& avatar : world.summary.classes) max_step = std::max(max_step, avatar.step);
  const auto step = static_cast<int32_t>(max_step * 1000);
  const auto per_zone = static_cast<int32_t>(world.tiles_per_zone);
  for (size_t s = 0; s < world.slots.size(); ++s) {
    const Zone* zone = world.zone(s);
    if (zone == nullptr) continue;
    for (uint32_t i = 0; i < zone->level_count(); ++i) {
      LevelInfo& level = levels[world.slots[s]->first_level + i];
      level.view = zone->view(i);
      const int32_t tile = level.view.record->tile();
      level.tile_x = zone->root().x() * per_zone + tile % per_zone;
      level.tile_z = zone->root().z() * per_zone + tile / per_zone;
      double sum = 0;
      const Rows rows = rows_of(level.view);
      for (int32_t z = 0; z < 64; z += 4) {
        for (int32_t x = 0; x < 64; x += 4) {
          if (((rows[static_cast<size_t>(z)] >> x) & 1) == 0) continue;
          sum += level.view.sample(x, z);
          ++level.cells;
        }
      }
      if (level.cells == 0) {  // a few cells between the samples
        for (int32_t c = 0; c < 4096; ++c) {
          if (!level.view.has(c % 64, c / 64)) continue;
          sum += level.view.sample(c % 64, c / 64);
          ++level.cells;
        }
      }
      level.mean = level.cells > 0 ? sum / level.cells : 0;
    }
  }

  constexpr std::array<std::array<int32_t, 2>, 4> kSides{{{-1, 0}, {1, 0}, {0, -1}, {0, 1}}};
  std::vector<int32_t> group(levels.size(), -1);
  std::vector<std::vector<uint32_t>> members;
  std::vector<uint32_t> order(levels.size());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(),
                   [&](uint32_t a, uint32_t b) { return levels[a].cells > levels[b].cells; });
  const auto blocked = [&](uint32_t level, int32_t in_group) {
    const auto tile = world.tile_levels(levels[level].tile_x, levels[level].tile_z);
    for (uint32_t other = tile.first; other < tile.last; ++other) {
      if (group[other] == in_group && overlap(levels[level].view, levels[other].view)) return true;
    }
    return false;
  };
  for (const uint32_t seed : order) {
    if (group[seed] >= 0) continue;
    const auto id = static_cast<int32_t>(members.size());
    members.push_back({seed});
    group[seed] = id;
    for (size_t head = 0; head < members.back().size(); ++head) {
      const LevelInfo& level = levels[members.back()[head]];
      for (int32_t side = 0; side < 4; ++side) {
        const auto [dx, dz] = kSides[static_cast<size_t>(side)];
        const auto tile = world.tile_levels(level.tile_x + dx, level.tile_z + dz);
        for (uint32_t other = tile.first; other < tile.last; ++other) {
          if (group[other] >= 0 || shared_cells(level.view, levels[other].view, side, step) < 4 ||
              blocked(other, id)) {
            continue;
          }
          group[other] = id;
          members.back().push_back(other);
        }
      }
    }
  }

  // Groups of about one height that do not lie over each other share a storey.
  struct Storey {
    double mean = 0, cells = 0;
    std::map<std::pair<int32_t, int32_t>, std::vector<uint32_t>> tiles;
  };
  std::vector<Storey> storeys;
  std::vector<int32_t> storey_of(members.size(), 0);
  std::vector<size_t> by_size(members.size());
  std::iota(by_size.begin(), by_size.end(), size_t{0});
  const auto size_of = [&](size_t g) {
    double cells = 0;
    for (const uint32_t level : members[g]) cells += levels[level].cells;
    return cells;
  };
  std::vector<double> sizes;
  for (size_t g = 0; g < members.size(); ++g) sizes.push_back(size_of(g));
  std::stable_sort(by_size.begin(), by_size.end(), [&](size_t a, size_t b) { return sizes[a] > sizes[b]; });
  for (const size_t g : by_size) {
    double mean = 0;
    for (const uint32_t level : members[g]) mean += levels[level].mean * levels[level].cells;
    mean /= std::max(1.0, sizes[g]);
    size_t best = storeys.size();
    double best_distance = 1500;  // [mm]
    for (size_t s = 0; s < storeys.size(); ++s) {
      const double distance = std::fabs(storeys[s].mean - mean);
      if (distance >= best_distance) continue;
      bool clash = false;
      for (const uint32_t level : members[g]) {
        const auto found = storeys[s].tiles.find({levels[level].tile_z, levels[level].tile_x});
        if (found == storeys[s].tiles.end()) continue;
        for (const uint32_t other : found->second) {
          clash = clash || overlap(levels[level].view, levels[other].view);
        }
      }
      if (clash) continue;
      best = s;
      best_distance = distance;
    }
    if (best == storeys.size()) storeys.emplace_back();
    Storey& storey = storeys[best];
    storey.mean = (storey.mean * storey.cells + mean * sizes[g]) / std::max(1.0, storey.cells + sizes[g]);
    storey.cells += sizes[g];
    for (const uint32_t level : members[g]) {
      storey.tiles[{levels[level].tile_z, levels[level].tile_x}].push_back(level);
    }
    storey_of[g] = static_cast<int32_t>(best);
  }
  std::vector<int32_t> rank(storeys.size()), by_height(storeys.size());
  std::iota(by_height.begin(), by_height.end(), 0);
  std::stable_sort(by_height.begin(), by_height.end(), [&](int32_t a, int32_t b) {
    return storeys[static_cast<size_t>(a)].mean < storeys[static_cast<size_t>(b)].mean;
  });
  for (size_t i = 0; i < by_height.size(); ++i) rank[static_cast<size_t>(by_height[i])] = static_cast<int32_t>(i);
  std::vector<int32_t> out(levels.size(), 0);
  for (size_t l = 0; l < out.size(); ++l) {
    out[l] = rank[static_cast<size_t>(storey_of[static_cast<size_t>(group[l])])];
  }
  return out;
}

}  // namespace throng
