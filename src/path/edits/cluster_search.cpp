// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "path/edits/cluster_search.h"

#include <algorithm>
#include <cmath>

#include "world/tile_grid.h"

// A* over connected cells of squares of 16 x 16 cells. Time: n log n in the clusters that it
// reaches; the clusters of a level are found once, in a time linear in its cells.
namespace throng::path {
namespace {

using world::GroundPoint;

constexpr int32_t kSide = Corridor::kSide;
constexpr int32_t kAcross = Corridor::kAcross;
constexpr size_t kCells = kTileCells;

size_t cell_index(int32_t x, int32_t z) {  // in a tile
  return static_cast<size_t>(z) * kCells + static_cast<size_t>(x);
}

uint8_t square_of(int32_t x, int32_t z) {
  return static_cast<uint8_t>(z / kSide * kAcross + x / kSide);
}

bool is_open(const world::CellRows& open, int32_t x, int32_t z) {
  return (open[static_cast<size_t>(z)] >> x & 1) != 0;
}

// Legal cells where a metre does not cost infinity.
world::CellRows open_cells(const GroundView& view, const ViewLevel& level) {
  world::CellRows open = level.legal;
  if (view.is_plain()) return open;
  for (uint32_t n = 0; n < level.rect_count; ++n) {
    if (std::isfinite(view.factor(level, n))) continue;
    const MeshRect& rect = view.rect(level, n);
    const int32_t x = rect.x - level.tile_x * kTileCells, z = rect.z - level.tile_z * kTileCells;
    const uint64_t wide = rect.width >= 64 ? ~uint64_t{0} : (uint64_t{1} << rect.width) - 1;
    for (int32_t row = z; row < z + rect.depth; ++row)
      open[static_cast<size_t>(row)] &= ~(wide << x);
  }
  return open;
}

// May a body step between neighbouring open cells of a level?
bool has_step(const GroundView& view, const ViewLevel& level, int32_t x, int32_t z, int32_t nx,
              int32_t nz) {
  return level.ground.step_safe ||
         std::abs(level.ground.view.sample(x, z) - level.ground.view.sample(nx, nz)) <= view.step();
}

}  // namespace

// Cell by cell within each square.
void ClusterSearch::find_clusters(const GroundView& view, const ViewLevel& level,
                                  LevelClusters& of) {
  of.clusters.clear();
  of.of_cell.fill(kNone);
  std::array<uint16_t, size_t{kSide} * kSide> reached{};  // cells of the tile
  for (int32_t z = 0; z < kTileCells; ++z) {
    for (int32_t x = 0; x < kTileCells; ++x) {
      if (!is_open(of.open, x, z) || of.of_cell[cell_index(x, z)] != kNone) continue;
      const auto number = static_cast<uint16_t>(of.clusters.size());
      size_t count = 0;
      int64_t sum_x = 0, sum_z = 0;
      const auto reach = [&](int32_t cx, int32_t cz) {
        of.of_cell[cell_index(cx, cz)] = number;
        reached[count++] = static_cast<uint16_t>(cell_index(cx, cz));
        sum_x += cx;
        sum_z += cz;
      };
      reach(x, z);
      const int32_t x0 = x / kSide * kSide, z0 = z / kSide * kSide;
      for (size_t i = 0; i < count; ++i) {
        const int32_t cx = reached[i] % kTileCells, cz = reached[i] / kTileCells;
        for (const auto [nx, nz] : {std::array{cx + 1, cz}, std::array{cx - 1, cz},
                                    std::array{cx, cz + 1}, std::array{cx, cz - 1}}) {
          if (nx < x0 || nz < z0 || nx >= x0 + kSide || nz >= z0 + kSide) continue;
          if (!is_open(of.open, nx, nz) || of.of_cell[cell_index(nx, nz)] != kNone) continue;
          if (has_step(view, level, cx, cz, nx, nz)) reach(nx, nz);
        }
      }
      // The cell that is nearest to the mean.
      const auto n = static_cast<int64_t>(count);
      int64_t least = INT64_MAX;
      uint16_t centre = reached[0];
      for (size_t i = 0; i < count; ++i) {
        const int64_t dx = reached[i] % kTileCells * n - sum_x;
        const int64_t dz = reached[i] / kTileCells * n - sum_z;
        if (dx * dx + dz * dz >= least) continue;
        least = dx * dx + dz * dz;
        centre = reached[i];
      }
      of.clusters.push_back({middle_of_cell(level.tile_x * kTileCells + centre % kTileCells,
                                            level.tile_z * kTileCells + centre / kTileCells),
                             square_of(x, z)});
    }
  }
}

// Neighbours across the borders of squares.
void ClusterSearch::join(const GroundView& view, const ViewLevel& level, LevelClusters& of) {
  of.joined.clear();
  const auto join_cells = [&](int32_t x, int32_t z, int32_t nx, int32_t nz) {
    const uint16_t a = of.of_cell[cell_index(x, z)], b = of.of_cell[cell_index(nx, nz)];
    if (a == kNone || b == kNone || !has_step(view, level, x, z, nx, nz)) return;
    if (!of.joined.empty() && of.joined.back() == std::array{b, a}) return;
    of.joined.push_back({a, b});
    of.joined.push_back({b, a});
  };
  for (int32_t line = kSide; line < kTileCells; line += kSide) {
    for (int32_t i = 0; i < kTileCells; ++i) join_cells(line - 1, i, line, i);
    for (int32_t i = 0; i < kTileCells; ++i) join_cells(i, line - 1, i, line);
  }
  std::sort(of.joined.begin(), of.joined.end());
  of.joined.erase(std::unique(of.joined.begin(), of.joined.end()), of.joined.end());
  of.first_joined.assign(of.clusters.size() + 1, 0);
  for (const auto& pair : of.joined) ++of.first_joined[pair[0] + size_t{1}];
  for (size_t c = 0; c < of.clusters.size(); ++c) of.first_joined[c + 1] += of.first_joined[c];
}

// The nodes of a level follow each other.
ClusterSearch::LevelClusters& ClusterSearch::clusters_of(GroundView& view, uint32_t number) {
  std::unique_ptr<LevelClusters>& of = levels_[number];
  if (of != nullptr && of->search == search_) return *of;
  if (of == nullptr) of = std::make_unique<LevelClusters>();
  if (of->version != version_) {  // The ground here, or beside it, may have changed.
    of->version = version_;
    const ViewLevel& level = *view.level(number);
    const world::CellRows open = open_cells(view, level);
    if (!of->is_found || of->open != open) {
      of->is_found = true;
      of->open = open;
      find_clusters(view, level, *of);
      join(view, level, *of);
    }
    of->beyond.clear();
    of->beyond_of.assign(of->clusters.size(), {kNotAsked, kNotAsked});
  }
  of->search = search_;
  of->first_node = static_cast<uint32_t>(nodes_.size());
  for (size_t c = 0; c < of->clusters.size(); ++c) {
    Node node;
    node.level = number;
    node.cluster = static_cast<uint16_t>(c);
    node.at = of->clusters[c].centre;
    nodes_.push_back(node);
  }
  return *of;
}

uint32_t ClusterSearch::node_at(GroundView& view, uint32_t level, GroundPoint at) {
  const LevelClusters& of = clusters_of(view, level);
  const uint16_t cluster =
      of.of_cell[cell_index(world::in_tile(at.cell_x()), world::in_tile(at.cell_z()))];
  return cluster == kNone ? UINT32_MAX : of.first_node + cluster;
}

void ClusterSearch::find_edges(GroundView& view, uint32_t node) {
  if (nodes_[node].has_edges) return;
  nodes_[node].has_edges = true;
  nodes_[node].first_edge = static_cast<uint32_t>(edges_.size());
  LevelClusters& of = *levels_[nodes_[node].level];
  const size_t cluster = nodes_[node].cluster;
  for (uint32_t j = of.first_joined[cluster]; j < of.first_joined[cluster + 1]; ++j) {
    edges_.push_back(of.first_node + of.joined[j][1]);
  }
  if (of.beyond_of[cluster][0] == kNotAsked) find_beyond(view, nodes_[node].level, cluster);
  for (uint32_t j = of.beyond_of[cluster][0]; j < of.beyond_of[cluster][1]; ++j) {
    const Beyond to = of.beyond[j];
    edges_.push_back(clusters_of(view, to.level).first_node + to.cluster);
  }
  nodes_[node].edges = static_cast<uint32_t>(edges_.size()) - nodes_[node].first_edge;
}

// To other levels.
void ClusterSearch::find_beyond(GroundView& view, uint32_t number, size_t cluster) {
  const ViewLevel* level = view.level(number);
  LevelClusters& of = *levels_[number];
  const int32_t square = of.clusters[cluster].square;
  const int32_t x0 = square % kAcross * kSide, z0 = square / kAcross * kSide;
  const int32_t tile_x = level->tile_x * kTileCells, tile_z = level->tile_z * kTileCells;
  const size_t first = of.beyond.size();
  const auto cross = [&](int32_t x, int32_t z, int32_t toward_x, int32_t toward_z) {
    if (of.of_cell[cell_index(x, z)] != cluster) return;
    const int32_t wx = tile_x + x, wz = tile_z + z;
    const auto next =
        world::step_to(view.ground(), level, wx, wz, wx + toward_x, wz + toward_z, view.step());
    if (!next) return;
    const uint32_t to = (*next)->ground.world_level;
    const uint16_t there =
        clusters_of(view, to)
            .of_cell[cell_index(world::in_tile(wx + toward_x), world::in_tile(wz + toward_z))];
    const auto is_there = [&](const Beyond& other) {
      return other.level == to && other.cluster == there;
    };
    if (there == kNone ||
        std::any_of(of.beyond.begin() + static_cast<ptrdiff_t>(first), of.beyond.end(), is_there)) {
      return;
    }
    of.beyond.push_back({to, there});
  };
  for (int32_t i = 0; i < kSide; ++i) {
    if (x0 == 0) cross(0, z0 + i, -1, 0);
    if (x0 + kSide == kTileCells) cross(kTileCells - 1, z0 + i, 1, 0);
    if (z0 == 0) cross(x0 + i, 0, 0, -1);
    if (z0 + kSide == kTileCells) cross(x0 + i, kTileCells - 1, 0, 1);
  }
  // To another level of the tile, where this one ends.
  const auto levels = view.world().tile_levels(level->tile_x, level->tile_z);
  if (levels.last - levels.first > 1) {
    const auto leave = [&](int32_t x, int32_t z, int32_t toward_x, int32_t toward_z) {
      const int32_t nx = x + toward_x, nz = z + toward_z;
      if (nx < 0 || nz < 0 || nx >= kTileCells || nz >= kTileCells) return;
      if (!level->is_legal(nx, nz) || !has_step(view, *level, x, z, nx, nz)) {
        cross(x, z, toward_x, toward_z);
      }
    };
    for (int32_t z = z0; z < z0 + kSide; ++z) {
      for (int32_t x = x0; x < x0 + kSide; ++x) {
        if (of.of_cell[cell_index(x, z)] != cluster) continue;
        leave(x, z, -1, 0);
        leave(x, z, 1, 0);
        leave(x, z, 0, -1);
        leave(x, z, 0, 1);
      }
    }
  }
  of.beyond_of[cluster] = {static_cast<uint32_t>(first), static_cast<uint32_t>(of.beyond.size())};
}

// By how much a metre on the ground of a cluster costs more in a direction.
double ClusterSearch::factor(GroundView& view, uint32_t node,
                             const GroundDelays::Heading& heading) const {
  const Node& of = nodes_[node];
  const int32_t x = of.at.cell_x(), z = of.at.cell_z();
  const double by_kind =
      view.is_plain() ? 1 : view.factor(view.rect_at(*view.level(of.level), x, z));
  if (view.delays() == nullptr) return by_kind;
  return by_kind * view.delays()->factor(of.level, world::in_tile(x), world::in_tile(z), heading);
}

// A segment between the centres, half of it on the ground of each; across a corner, through a part
// of a third, `by`, it costs at least as much as there.
void ClusterSearch::relax(GroundView& view, uint32_t from, uint32_t by, uint32_t to) {
  const Node& a = nodes_[from];
  Node& b = nodes_[to];
  if (b.done) return;
  const double length = distance_of(a.at, b.at);
  if (a.cost + length * view.min_factor() >= b.cost) return;
  const GroundDelays::Heading heading =
      view.delays() == nullptr ? GroundDelays::Heading{} : GroundDelays::heading(a.at, b.at);
  const double least = by == from ? 0 : factor(view, by, heading);
  const double cost = a.cost + length *
                                   (std::max(factor(view, from, heading), least) +
                                    std::max(factor(view, to, heading), least)) /
                                   2;
  if (cost >= b.cost) return;
  b.cost = cost;
  b.parent = from;
  open_.push({cost + distance_of(b.at, to_) * view.min_factor(), to});
}

// Also to neighbours of neighbours across the corner of its square.
void ClusterSearch::expand(GroundView& view, uint32_t node) {
  find_edges(view, node);
  for (uint32_t e = 0; e < nodes_[node].edges; ++e) {
    const uint32_t next = edges_[nodes_[node].first_edge + e];
    find_edges(view, next);
    relax(view, node, node, next);
    const GroundPoint at = nodes_[node].at, by = nodes_[next].at;
    const auto square = [](int64_t along) { return along >> world::kUnitBits >> 4; };
    for (uint32_t f = 0; f < nodes_[next].edges; ++f) {
      const uint32_t beyond = edges_[nodes_[next].first_edge + f];
      const GroundPoint to = nodes_[beyond].at;
      const bool is_across = square(to.x) != square(at.x) && square(to.z) != square(at.z);
      if (is_across && (square(by.x) == square(at.x) || square(by.z) == square(at.z))) {
        relax(view, node, next, beyond);
      }
    }
  }
}

void ClusterSearch::add_near(GroundView& view, uint32_t node, int rings) {
  const uint32_t level = nodes_[node].level;
  corridor_.add(level, levels_[level]->clusters[nodes_[node].cluster].square);
  if (rings == 0) return;
  find_edges(view, node);
  for (uint32_t e = 0; e < nodes_[node].edges; ++e) {
    add_near(view, edges_[nodes_[node].first_edge + e], rings - 1);
  }
}

void ClusterSearch::trace(GroundView& view, uint32_t goal) {
  constexpr int kRings = 2;  // around the squares, in which a path may lead, too
  corridor_.clear();
  for (uint32_t n = goal; n != UINT32_MAX; n = nodes_[n].parent) add_near(view, n, kRings);
}

const Corridor* ClusterSearch::find(GroundView& view, const ViewStop& from, const ViewStop& to,
                                    double max_cost, uint64_t max_clusters) {
  ++search_;
  version_ = view.version() + 1;
  nodes_.clear();
  edges_.clear();
  open_.clear();
  expanded_ = 0;
  is_spent_ = false;
  to_ = to.at;
  const uint32_t start = node_at(view, from.level, from.at);
  const uint32_t goal = node_at(view, to.level, to.at);
  if (start == UINT32_MAX || goal == UINT32_MAX) return nullptr;
  nodes_[start].at = from.at;
  nodes_[goal].at = to.at;
  nodes_[start].cost = 0;
  open_.push({distance_of(from.at, to.at) * view.min_factor(), start});
  while (!open_.empty()) {
    const Open next = open_.pop();
    if (next.bound > max_cost) return nullptr;
    if (nodes_[next.node].done) continue;
    nodes_[next.node].done = true;
    if (next.node == goal) {
      trace(view, goal);
      return &corridor_;
    }
    is_spent_ = expanded_ == max_clusters;
    if (is_spent_) return nullptr;
    ++expanded_;
    expand(view, next.node);
  }
  return nullptr;
}

}  // namespace throng::path
