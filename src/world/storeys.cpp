// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <map>
#include <numeric>
#include <set>
#include <tuple>
#include <utility>

#include "world/place.h"
#include "world/tile_grid.h"
#include "world/zone_data.h"

// Storeys: level tiles of neighbouring tiles that continue each other are joined into groups, the
// surest first (Kruskal), never two that lie over each other; groups of like height that do not
// overlap then share a number.
namespace throng {
namespace {

struct LevelInfo {
  int32_t tile_x = 0, tile_z = 0;
  world::LevelView view;
  int32_t cells = 0;
  double mean = 0;  // [mm]
};

world::CellRows rows_of(const world::LevelView& view) {
  world::CellRows rows;
  if (view.present == nullptr) {
    rows.fill(~uint64_t{0});
  } else {
    world::unpack_bits(view.present, rows);
  }
  return rows;
}

bool overlap(const world::LevelView& a, const world::LevelView& b) {
  const world::CellRows p = rows_of(a), q = rows_of(b);
  for (size_t z = 0; z < 64; ++z) {
    if ((p[z] & q[z]) != 0) return true;
  }
  return false;
}

// Border cells over which two levels of tiles side by side continue each other.
int32_t shared_cells(const world::LevelView& a, const world::LevelView& b, int32_t side,
                     int32_t max_step) {
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

// Two levels of neighbouring tiles that continue each other. The more cells, the closer their
// heights and the larger they are, the heavier: a floor continues as a floor before it turns into
// the ramp to the next one, or into what is left of it under the ramp's low end.
struct Seam {
  uint32_t a = 0, b = 0;
  double weight = 0;
};

std::vector<Seam> find_seams(const world::WorldData& world, const std::vector<LevelInfo>& levels,
                             int32_t max_step) {
  constexpr std::array<std::array<int32_t, 3>, 2> kSides{{{1, 0, 1}, {0, 1, 3}}};
  std::vector<Seam> seams;
  for (uint32_t a = 0; a < levels.size(); ++a) {
    for (const auto& [dx, dz, side] : kSides) {
      const auto tile = world.tile_levels(levels[a].tile_x + dx, levels[a].tile_z + dz);
      for (uint32_t b = tile.first; b < tile.last; ++b) {
        const int32_t shared = shared_cells(levels[a].view, levels[b].view, side, max_step);
        if (shared < 4) continue;
        const double apart = std::fabs(levels[a].mean - levels[b].mean);
        const int32_t cells = std::min(levels[a].cells, levels[b].cells);
        seams.push_back({a, b, shared * static_cast<double>(cells) / (1 + apart / 500)});
      }
    }
  }
  std::stable_sort(seams.begin(), seams.end(),
                   [](const Seam& p, const Seam& q) { return p.weight > q.weight; });
  return seams;
}

// Levels joined over their seams, heaviest first, into groups that never lie over each other.
class Groups {
 public:
  explicit Groups(const std::vector<LevelInfo>& levels) : levels_(levels), parent_(levels.size()) {
    std::iota(parent_.begin(), parent_.end(), 0u);
    tiles_.resize(levels.size());
    size_.assign(levels.size(), 1);
    for (uint32_t l = 0; l < levels.size(); ++l) tiles_[l][key(l)] = {l};
  }

  uint32_t find(uint32_t level) {
    while (parent_[level] != level) level = parent_[level] = parent_[parent_[level]];
    return level;
  }

  void join(uint32_t a, uint32_t b) {
    a = find(a);
    b = find(b);
    if (size_[a] < size_[b] || (size_[a] == size_[b] && b < a)) std::swap(a, b);
    if (a == b || overlapping_.contains({a, b})) return;
    if (groups_overlap(a, b)) {
      overlapping_.insert({a, b});  // For good: groups only grow.
      return;
    }
    parent_[b] = a;
    size_[a] += size_[b];
    for (auto& [tile, members] : tiles_[b]) {
      auto& into = tiles_[a][tile];
      into.insert(into.end(), members.begin(), members.end());
    }
    tiles_[b].clear();
  }

 private:
  using Tile = std::pair<int32_t, int32_t>;

  [[nodiscard]] Tile key(uint32_t level) const {
    return {levels_[level].tile_z, levels_[level].tile_x};
  }

  [[nodiscard]] bool groups_overlap(uint32_t large, uint32_t small) const {
    for (const auto& [tile, members] : tiles_[small]) {
      const auto found = tiles_[large].find(tile);
      if (found == tiles_[large].end()) continue;
      for (const uint32_t p : members) {
        for (const uint32_t q : found->second) {
          if (overlap(levels_[p].view, levels_[q].view)) return true;
        }
      }
    }
    return false;
  }

  const std::vector<LevelInfo>& levels_;
  std::vector<uint32_t> parent_;
  std::vector<uint32_t> size_;
  std::vector<std::map<Tile, std::vector<uint32_t>>> tiles_;
  std::set<std::pair<uint32_t, uint32_t>> overlapping_;
};

std::vector<std::vector<uint32_t>> group_levels(const world::WorldData& world,
                                                const std::vector<LevelInfo>& levels,
                                                int32_t max_step) {
  Groups groups(levels);
  for (const Seam& seam : find_seams(world, levels, max_step)) groups.join(seam.a, seam.b);
  std::vector<std::vector<uint32_t>> members;
  std::map<uint32_t, size_t> index;
  for (uint32_t l = 0; l < levels.size(); ++l) {
    const auto [at, is_new] = index.try_emplace(groups.find(l), members.size());
    if (is_new) members.emplace_back();
    members[at->second].push_back(l);
  }
  return members;
}

// Each level with its mean height, over samples a few cells apart.
std::vector<LevelInfo> levels_of(const world::WorldData& world) {
  std::vector<LevelInfo> levels(world.level_count);
  for (size_t s = 0; s < world.slots.size(); ++s) {
    const world::Zone* zone = world.zone(s);
    if (zone == nullptr) continue;
    for (uint32_t i = 0; i < zone->level_count(); ++i) {
      LevelInfo& level = levels[world.slots[s]->first_level + i];
      level.view = zone->view(i);
      std::tie(level.tile_x, level.tile_z) = world::tile_of(world, *zone, *level.view.record);
      double sum = 0;
      const world::CellRows rows = rows_of(level.view);
      for (int32_t z = 0; z < 64; z += 4) {
        for (int32_t x = 0; x < 64; x += 4) {
          if (((rows[static_cast<size_t>(z)] >> x) & 1) == 0) continue;
          sum += level.view.sample(x, z);
          ++level.cells;
        }
      }
      if (level.cells == 0) {  // a few cells between the samples
        for (int32_t c = 0; c < 4096; ++c) {
          if (!level.view.has(world::x_of_cell(c), world::z_of_cell(c))) continue;
          sum += level.view.sample(world::x_of_cell(c), world::z_of_cell(c));
          ++level.cells;
        }
      }
      level.mean = level.cells > 0 ? sum / level.cells : 0;
    }
  }
  return levels;
}

// Groups of levels of about one height that do not lie over each other share a storey.
class Storeys {
 public:
  explicit Storeys(const std::vector<LevelInfo>& levels) : levels_(levels) {}

  // The storey that a group joins: a new one if it fits into none. Give the largest group first.
  int32_t add(const std::vector<uint32_t>& group, double size) {
    double mean = 0;
    for (const uint32_t level : group) mean += levels_[level].mean * levels_[level].cells;
    mean /= std::max(1.0, size);
    const size_t best = find(group, size, mean);
    if (best == storeys_.size()) storeys_.emplace_back();
    Storey& storey = storeys_[best];
    storey.mean = (storey.mean * storey.cells + mean * size) / std::max(1.0, storey.cells + size);
    storey.cells += size;
    for (const uint32_t level : group) {
      storey.tiles[{levels_[level].tile_z, levels_[level].tile_x}].push_back(level);
    }
    return static_cast<int32_t>(best);
  }

  // Of each storey: how many are lower.
  [[nodiscard]] std::vector<int32_t> ranks() const {
    std::vector<int32_t> rank(storeys_.size()), by_height(storeys_.size());
    std::iota(by_height.begin(), by_height.end(), 0);
    std::stable_sort(by_height.begin(), by_height.end(), [&](int32_t a, int32_t b) {
      return storeys_[static_cast<size_t>(a)].mean < storeys_[static_cast<size_t>(b)].mean;
    });
    for (size_t i = 0; i < by_height.size(); ++i)
      rank[static_cast<size_t>(by_height[i])] = static_cast<int32_t>(i);
    return rank;
  }

 private:
  // What is left of a floor where it was cut, under the low end of a ramp, founds no storey.
  static constexpr double kRemnantShare = 0.02;  // of a storey's cells
  static constexpr double kMaxDistance = 1500;   // [mm]
  struct Storey {
    double mean = 0, cells = 0;
    std::map<std::pair<int32_t, int32_t>, std::vector<uint32_t>> tiles;
  };

  // The storey of the nearest height over or under which no level of the group lies; for remnants
  // the nearest of all if there is none. Else their number.
  [[nodiscard]] size_t find(const std::vector<uint32_t>& group, double size, double mean) const {
    size_t best = storeys_.size(), nearest = storeys_.size();
    double best_distance = kMaxDistance, min_distance = kMaxDistance;
    for (size_t s = 0; s < storeys_.size(); ++s) {
      const double distance = std::fabs(storeys_[s].mean - mean);
      if (distance < min_distance && size < kRemnantShare * storeys_[s].cells) {
        nearest = s;
        min_distance = distance;
      }
      if (distance >= best_distance || overlaps(storeys_[s], group)) continue;
      best = s;
      best_distance = distance;
    }
    return best == storeys_.size() ? nearest : best;
  }

  // Does a level of the group lie over or under one of the storey?
  [[nodiscard]] bool overlaps(const Storey& storey, const std::vector<uint32_t>& group) const {
    for (const uint32_t level : group) {
      const auto found = storey.tiles.find({levels_[level].tile_z, levels_[level].tile_x});
      if (found == storey.tiles.end()) continue;
      for (const uint32_t other : found->second) {
        if (overlap(levels_[level].view, levels_[other].view)) return true;
      }
    }
    return false;
  }

  const std::vector<LevelInfo>& levels_;
  std::vector<Storey> storeys_;
};

}  // namespace

std::vector<int32_t> World::storeys() const {
  const world::WorldData& world = *state_;
  double max_step = 0;
  for (const AvatarClass& avatar : world.summary.classes)
    max_step = std::max(max_step, avatar.step_height);
  const auto step = static_cast<int32_t>(max_step * 1000);
  const std::vector<LevelInfo> levels = levels_of(world);
  const std::vector<std::vector<uint32_t>> members = group_levels(world, levels, step);
  std::vector<double> sizes;  // of the groups [cells]
  for (const std::vector<uint32_t>& group : members) {
    double cells = 0;
    for (const uint32_t level : group) cells += levels[level].cells;
    sizes.push_back(cells);
  }
  std::vector<size_t> by_size(members.size());
  std::iota(by_size.begin(), by_size.end(), size_t{0});
  std::stable_sort(by_size.begin(), by_size.end(),
                   [&](size_t a, size_t b) { return sizes[a] > sizes[b]; });
  Storeys storeys(levels);
  std::vector<int32_t> storey_of(members.size(), 0);
  for (const size_t g : by_size) storey_of[g] = storeys.add(members[g], sizes[g]);
  const std::vector<int32_t> rank = storeys.ranks();
  std::vector<int32_t> out(levels.size(), 0);
  for (size_t g = 0; g < members.size(); ++g) {
    for (const uint32_t level : members[g]) out[level] = rank[static_cast<size_t>(storey_of[g])];
  }
  return out;
}

}  // namespace throng
