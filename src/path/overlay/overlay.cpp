// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "path/overlay/overlay.h"

#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>

#include "core/arrays/strong_parts.h"
#include "core/parallel.h"
#include "path/ground/open_list.h"
#include "path/overlay/overlay_graph.h"

// Chooses the entrances of a mesh's overlay, after [BMS04], and the costs between them from the
// lowest level up, after [DGPW11]. Time: n log n in the blocks and portals, and for each entrance
// of an overlay cell a Dijkstra search: on the lowest level over its blocks, above over the
// entrances of the cells that it holds.
namespace throng::path {
namespace {

constexpr double kSmallestSide = 5;           // [m]
constexpr size_t kMinOverlayCells = 8;        // An overlay level of fewer cells has none above.
constexpr double kEntranceSpacing = 1.0 / 8;  // of a side

uint64_t square_key(int64_t x, int64_t z) {
  constexpr int64_t kMiddle = int64_t{1} << 31;
  return static_cast<uint64_t>(z + kMiddle) << 32 | static_cast<uint64_t>(x + kMiddle);
}

uint64_t key_above(uint64_t key, uint32_t halvings) {
  const uint64_t z = key >> 32, x = key & UINT32_MAX;
  return z >> halvings << 32 | x >> halvings;
}

std::vector<uint64_t> distinct(std::vector<uint64_t> keys) {
  std::sort(keys.begin(), keys.end());
  keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
  return keys;
}

std::vector<uint64_t> all_above(std::vector<uint64_t> keys, uint32_t halvings) {
  for (uint64_t& key : keys) key = key_above(key, halvings);
  return distinct(std::move(keys));
}

uint32_t place_in(const std::vector<uint64_t>& keys, uint64_t key) {
  return static_cast<uint32_t>(std::lower_bound(keys.begin(), keys.end(), key) - keys.begin());
}

}  // namespace

Overlay::Overlay(const graph::NodeMesh& mesh, const PieceCost& cost, int32_t workers,
                 size_t crossings) {
  choose_sides(mesh, workers, crossings);
  if (overlay_levels_.empty()) return;
  choose_entrances(mesh, workers);
  at_.resize(2 * entrances_.size());
  const NodeView view(mesh);
  for (uint32_t entry = 0; entry < at_.size(); ++entry) {
    at_[entry] = position(view, ends_of(view, crossing(entry)).in);
  }
  for (size_t k = 0; k < overlay_levels_.size(); ++k) {
    list_entries(mesh, overlay_levels_[k], static_cast<uint8_t>(k));
  }
  measure_costs(mesh, cost, workers);
  for (size_t k = 1; k < overlay_levels_.size(); ++k) join_up(k, workers);
}

void Overlay::choose_sides(const graph::NodeMesh& mesh, int32_t workers, size_t crossings) {
  std::vector<uint64_t> of_block(mesh.blocks().size());
  parallel_for(of_block.size(), workers, [&](size_t b) {
    const graph::NodeBlock& block = mesh.blocks()[b];
    const Vec3d at = mesh.surface(static_cast<uint32_t>(b))
                         .at((block.s + 0.5) * block.side(), (block.t + 0.5) * block.side());
    of_block[b] = square_key(static_cast<int64_t>(std::floor(at.x / kSmallestSide)),
                             static_cast<int64_t>(std::floor(at.z / kSmallestSide)));
  });
  std::vector<uint64_t> keys = distinct(of_block);
  uint32_t halvings = 0;
  while (keys.size() > 1 && mesh.portals().size() < crossings * keys.size()) {
    keys = all_above(std::move(keys), 1);
    ++halvings;
  }
  if (keys.size() < 2) return;
  of_block_.resize(of_block.size());
  parallel_for(of_block.size(), workers,
               [&](size_t b) { of_block_[b] = place_in(keys, key_above(of_block[b], halvings)); });
  first_block_.assign(keys.size() + 1, 0);
  for (const uint32_t overlay_cell : of_block_) ++first_block_[overlay_cell + 1];
  std::inclusive_scan(first_block_.begin(), first_block_.end(), first_block_.begin());
  blocks_.resize(of_block_.size());
  std::vector<uint32_t> next(first_block_.begin(), first_block_.end() - 1);
  for (uint32_t b = 0; b < of_block_.size(); ++b) blocks_[next[of_block_[b]]++] = b;
  double side = kSmallestSide * std::pow(2, halvings);
  while (true) {
    OverlayLevel overlay_level;
    overlay_level.side = side;
    overlay_level.first.assign(keys.size() + 1, 0);
    static_assert(kTimes == 4);
    const std::vector<uint64_t> above = all_above(keys, 2);
    if (keys.size() <= kMinOverlayCells || above.size() == 1) {
      overlay_levels_.push_back(std::move(overlay_level));
      return;
    }
    for (const uint64_t key : keys)
      overlay_level.above.push_back(place_in(above, key_above(key, 2)));
    overlay_levels_.push_back(std::move(overlay_level));
    keys = above;
    side *= kTimes;
  }
}

void Overlay::choose_entrances(const graph::NodeMesh& mesh, int32_t workers) {
  // Components of each overlay cell by itself.
  std::vector<uint32_t> part_of(of_block_.size());
  std::vector<uint32_t> counts(first_block_.size() - 1);
  parallel_for(counts.size(), workers, [&](size_t d) {
    const auto blocks = blocks_of(static_cast<uint32_t>(d));
    const StrongParts parts = strong_parts(
        static_cast<uint32_t>(blocks.size()),
        [&](uint32_t b) { return static_cast<uint32_t>(mesh.portals_of(blocks[b]).size()); },
        [&](uint32_t b, uint32_t k) {
          const graph::PortalSides portal = mesh.portals().sides(mesh.portals_of(blocks[b])[k]);
          if (portal.one_way && portal.b == blocks[b]) return UINT32_MAX;
          const uint32_t to = portal.a == blocks[b] ? portal.b : portal.a;
          if (of_block_[to] != d) return UINT32_MAX;
          const auto at = std::lower_bound(blocks.begin(), blocks.end(), to);
          return static_cast<uint32_t>(at - blocks.begin());
        });
    for (size_t b = 0; b < blocks.size(); ++b) part_of[blocks[b]] = parts.of[b];
    counts[d] = parts.count;
  });
  std::exclusive_scan(counts.begin(), counts.end(), counts.begin(), uint32_t{0});
  struct Candidate {
    uint32_t from, to;
    bool one_way;
    uint32_t portal;
    [[nodiscard]] auto group() const { return std::tie(from, to, one_way); }
  };
  std::vector<Candidate> candidates;
  for (uint32_t p = 0; p < mesh.portals().size(); ++p) {
    const graph::PortalSides portal = mesh.portals().sides(p);
    const uint32_t a = of_block_[portal.a], b = of_block_[portal.b];
    if (a == b) continue;
    uint32_t from = counts[a] + part_of[portal.a], to = counts[b] + part_of[portal.b];
    if (!portal.one_way && from > to) std::swap(from, to);
    candidates.push_back({from, to, portal.one_way, p});
  }
  std::sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
    return std::tuple_cat(a.group(), std::tie(a.portal)) <
           std::tuple_cat(b.group(), std::tie(b.portal));
  });
  const NodeView view(mesh);
  std::vector<Vec3d> chosen;
  for (size_t i = 0; i < candidates.size(); ++i) {
    if (i == 0 || candidates[i].group() != candidates[i - 1].group()) chosen.clear();
    const graph::PortalSides portal = mesh.portals().sides(candidates[i].portal);
    uint32_t a = of_block_[portal.a], b = of_block_[portal.b];
    uint8_t top = 0;
    while (top + size_t{1} < overlay_levels_.size()) {
      a = overlay_levels_[top].above[a];
      b = overlay_levels_[top].above[b];
      if (a == b) break;
      ++top;
    }
    const double apart = overlay_levels_[top].side * kEntranceSpacing;
    const Vec3d at = position(view, ends_of(view, {candidates[i].portal}).out);
    if (std::any_of(chosen.begin(), chosen.end(),
                    [&](Vec3d other) { return length(other - at) < apart; })) {
      continue;
    }
    chosen.push_back(at);
    entrances_.push_back({candidates[i].portal, top});
  }
  std::sort(entrances_.begin(), entrances_.end(),
            [](const Entrance& a, const Entrance& b) { return a.portal < b.portal; });
}

void Overlay::list_entries(const graph::NodeMesh& mesh, OverlayLevel& overlay_level, uint8_t k) {
  overlay_level.of_entry.assign(2 * entrances_.size(), graph::kNoNode);
  overlay_level.place.assign(2 * entrances_.size(), 0);
  const size_t overlay = overlay_level.first.size() - 1;
  const NodeView view(mesh);
  for (uint32_t entry = 0; entry < overlay_level.of_entry.size(); ++entry) {
    if (entrances_[entry / 2].overlay_level < k) continue;
    uint32_t overlay_cell = of_block_[ends_of(view, crossing(entry)).in.block];
    for (uint8_t below = 0; below < k; ++below)
      overlay_cell = overlay_levels_[below].above[overlay_cell];
    overlay_level.of_entry[entry] = overlay_cell;
    ++overlay_level.first[overlay_cell + 1];
  }
  std::inclusive_scan(overlay_level.first.begin(), overlay_level.first.end(),
                      overlay_level.first.begin());
  overlay_level.entries.resize(overlay_level.first.back());
  std::vector<uint32_t> next(overlay_level.first.begin(), overlay_level.first.end() - 1);
  for (uint32_t entry = 0; entry < overlay_level.of_entry.size(); ++entry) {
    const uint32_t overlay_cell = overlay_level.of_entry[entry];
    if (overlay_cell == graph::kNoNode) continue;
    overlay_level.place[entry] = next[overlay_cell] - overlay_level.first[overlay_cell];
    overlay_level.entries[next[overlay_cell]++] = entry;
  }
  uint64_t costs = 0;
  for (size_t d = 0; d < overlay; ++d) {
    overlay_level.first_cost.push_back(costs);
    const uint64_t count = overlay_level.first[d + 1] - overlay_level.first[d];
    costs += count * count;
  }
  overlay_level.costs.assign(costs, std::numeric_limits<float>::infinity());
}

// An entry into a one-way portal from its far side leads nowhere: no path comes to it.
void Overlay::measure_costs(const graph::NodeMesh& mesh, const PieceCost& cost, int32_t workers) {
  OverlayLevel& overlay_level = overlay_levels_.front();
  const NodeView view(mesh);
  std::vector<OverlayGraph> graphs(static_cast<size_t>(worker_count(workers)), {view, cost});
  parallel_for_worker(overlay_level.first.size() - 1, workers, [&](size_t d, int32_t worker) {
    const auto overlay_cell = static_cast<uint32_t>(d);
    const auto entries = overlay_level.entries_of(overlay_cell);
    if (entries.empty()) return;
    OverlayGraph& graph = graphs[static_cast<size_t>(worker)];
    graph.set(blocks_of(overlay_cell), true);
    // Arcs out over entrances, and their columns in the table.
    std::vector<std::pair<uint32_t, uint32_t>> columns;
    for (uint32_t w = 0; w < graph.arcs().size(); ++w) {
      const OverlayGraph::Arc& arc = graph.arcs()[w];
      if (arc.into != graph::kNoNode) continue;
      const uint32_t entry = entry_of(arc.crossing);
      if (entry != graph::kNoNode) columns.emplace_back(w, overlay_level.place[entry ^ 1]);
    }
    for (size_t i = 0; i < entries.size(); ++i) {
      const Crossing in = crossing(entries[i]);
      if (in.backward && mesh.portals().sides(in.portal).one_way) continue;
      const std::vector<double>& costs = graph.run(ends_of(view, in).in);
      float* row = overlay_level.costs.data() + overlay_level.first_cost[d] + i * entries.size();
      for (const auto& [arc, column] : columns) {
        if (column != i) row[column] = static_cast<float>(costs[arc]);
      }
    }
  });
}

// Through an overlay cell over the cells of the level below that it holds.
void Overlay::join_up(size_t k, int32_t workers) {
  OverlayLevel& overlay_level = overlay_levels_[k];
  const OverlayLevel& below = overlay_levels_[k - 1];
  std::vector<std::vector<uint32_t>> parts(overlay_level.first.size() - 1);
  for (uint32_t d = 0; d < below.above.size(); ++d) parts[below.above[d]].push_back(d);
  struct Open {
    double cost;
    uint32_t entry;
    bool operator<(const Open& other) const {
      return cost != other.cost ? cost > other.cost : entry > other.entry;
    }
  };
  parallel_for(parts.size(), workers, [&](size_t d) {
    const auto entries = overlay_level.entries_of(static_cast<uint32_t>(d));
    if (entries.empty()) return;
    // Entries into parts lie here part by part.
    std::vector<size_t> first;
    size_t count = 0;
    for (const uint32_t part : parts[d]) {
      first.push_back(count);
      count += below.entries_of(part).size();
    }
    const auto index = [&](uint32_t entry) {
      const auto part = std::lower_bound(parts[d].begin(), parts[d].end(), below.of_entry[entry]);
      return first[static_cast<size_t>(part - parts[d].begin())] + below.place[entry];
    };
    std::vector<double> cost;
    OpenList<Open> open;
    for (size_t i = 0; i < entries.size(); ++i) {
      cost.assign(count, kNoPath);
      float* row = overlay_level.costs.data() + overlay_level.first_cost[d] + i * entries.size();
      cost[index(entries[i])] = 0;
      open.push({0, entries[i]});  // (it is empty here)
      while (!open.empty()) {
        const Open top = open.pop();
        if (top.cost > cost[index(top.entry)]) continue;
        const auto through = below.costs_from(top.entry);
        const auto others = below.entries_of(below.of_entry[top.entry]);
        for (size_t j = 0; j < others.size(); ++j) {
          const double next = top.cost + double{through[j]};
          if (!(next < kNoPath)) continue;
          const uint32_t out = others[j] ^ 1;  // The entrance crossed, out of the sub-cell.
          if (below.above[below.of_entry[out]] != d) {
            // The overlay cell is left only over its own entrances.
            float& known = row[overlay_level.place[others[j]]];
            known = std::min(known, static_cast<float>(next));
            continue;
          }
          double& reached = cost[index(out)];
          if (next >= reached) continue;
          reached = next;
          open.push({next, out});
        }
      }
      row[i] = std::numeric_limits<float>::infinity();
    }
  });
}

uint32_t Overlay::entry_of(const Crossing& crossing) const {
  const auto at = std::lower_bound(
      entrances_.begin(), entrances_.end(), crossing.portal,
      [](const Entrance& entrance, uint32_t portal) { return entrance.portal < portal; });
  if (at == entrances_.end() || at->portal != crossing.portal) return graph::kNoNode;
  return 2 * static_cast<uint32_t>(at - entrances_.begin()) + (crossing.backward ? 1 : 0);
}

uint64_t Overlay::bytes() const {
  uint64_t bytes = (of_block_.size() + first_block_.size() + blocks_.size()) * sizeof(uint32_t) +
                   entrances_.size() * sizeof(Entrance) + at_.size() * sizeof(Vec3d);
  for (const OverlayLevel& overlay_level : overlay_levels_) {
    bytes +=
        (overlay_level.above.size() + overlay_level.of_entry.size() + overlay_level.first.size() +
         overlay_level.entries.size() + overlay_level.place.size() + overlay_level.costs.size()) *
            sizeof(uint32_t) +
        overlay_level.first_cost.size() * sizeof(uint64_t);
  }
  return bytes;
}

}  // namespace throng::path
