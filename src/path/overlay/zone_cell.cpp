// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "path/overlay/zone_cell.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <tuple>
#include <utility>

#include "core/function_ref.h"
#include "core/parallel.h"

// Builds the graph of zones: tables of each zone, labels of the entrances of each overlay cell,
// labels of the boundary nodes between them. Time: mostly of the tables (zone_paths.cpp) and the
// labels (ground/two_hop.cpp); joining nodes is cubic in the entrances of a zone and in the
// boundary nodes of an overlay cell at most.
namespace throng::path {
namespace {

using Edges = std::vector<std::vector<PathGraph::Edge>>;

// Joins every two of `count` nodes by their paths' lengths, without the paths that lead over
// another.
void add_edges(size_t count, FunctionRef<float(size_t, size_t)> length_of,
               FunctionRef<uint32_t(size_t)> node_of, Edges& edges) {
  std::vector<float> lengths(count * count, kNeverReached);
  for (size_t a = 0; a < count; ++a) {
    for (size_t b = a + 1; b < count; ++b)
      lengths[a * count + b] = lengths[b * count + a] = length_of(a, b);
  }
  for (size_t a = 0; a < count; ++a) {
    for (size_t b = a + 1; b < count; ++b) {
      const float direct = lengths[a * count + b];
      if (!(direct < kNeverReached)) continue;
      constexpr float kRoundingShare = 1e-5f;  // of the length: floats
      const float* from = &lengths[a * count];
      const float* to = &lengths[b * count];
      bool is_over = false;
      for (size_t c = 0; c < count && !is_over; ++c)
        is_over = from[c] > 0 && to[c] > 0 && from[c] + to[c] <= direct * (1 + kRoundingShare);
      if (is_over) continue;
      edges[node_of(a)].push_back({node_of(b), direct});
      edges[node_of(b)].push_back({node_of(a), direct});
    }
  }
}

// Of edges between the same nodes, the shortest.
PathGraph to_graph(Edges& edges) {
  PathGraph graph;
  graph.first.push_back(0);
  for (auto& of_node : edges) {
    std::sort(of_node.begin(), of_node.end(), [](const auto& a, const auto& b) {
      return a.to != b.to ? a.to < b.to : a.length < b.length;
    });
    for (const PathGraph::Edge& edge : of_node) {
      if (graph.edges.size() > graph.first.back() && graph.edges.back().to == edge.to) continue;
      graph.edges.push_back(edge);
    }
    graph.first.push_back(static_cast<uint32_t>(graph.edges.size()));
  }
  return graph;
}

PathGraph entrance_graph(const ZoneGraph& graph, const OverlayCell& zone_cell,
                         const std::vector<uint32_t>& zones) {
  Edges edges(zone_cell.entrances.size());
  for (const uint32_t zone : zones) {
    const ZonePaths& paths = graph.zones[zone];
    const size_t corners = paths.corners.size();
    add_edges(
        paths.entrances.size(),
        [&](size_t a, size_t b) {
          return std::min(paths.length[paths.row(corners + a) + b],
                          paths.length[paths.row(corners + b) + a]);
        },
        [&](size_t entrance) { return zone_cell.place_of_entrance(paths.entrances[entrance]); },
        edges);
  }
  return to_graph(edges);
}

// The first node of each connected component.
std::vector<uint32_t> components_of(const PathGraph& graph) {
  std::vector<uint32_t> of(graph.count(), UINT32_MAX), queue;
  for (uint32_t node = 0; node < of.size(); ++node) {
    if (of[node] != UINT32_MAX) continue;
    queue.assign(1, node);
    of[node] = node;
    while (!queue.empty()) {
      const uint32_t at = queue.back();
      queue.pop_back();
      for (const PathGraph::Edge& edge : graph.of(at)) {
        if (of[edge.to] != UINT32_MAX) continue;
        of[edge.to] = node;
        queue.push_back(edge.to);
      }
    }
  }
  return of;
}

// Of the entrances between two overlay cells that join the same components of them, one every so
// many cells of the border is a boundary node. `components` has, for each overlay cell, the
// component of each entrance.
void choose_boundary_nodes(const world::WorldData& world,
                           const std::vector<std::vector<uint32_t>>& components, ZoneGraph& graph) {
  struct Candidate {
    std::array<uint32_t, 2> zone_cells, parts;
    double along, across;
    uint32_t entrance;
    [[nodiscard]] auto key() const { return std::tuple{zone_cells, parts, across}; }
  };
  std::vector<Candidate> candidates;
  for (uint32_t g = 0; g < graph.entrances.size(); ++g) {
    const Entrance& entrance = graph.entrances[g];
    const uint32_t a = graph.cell_of_zone[entrance.zone[0]];
    const uint32_t b = graph.cell_of_zone[entrance.zone[1]];
    if (a == b) continue;
    const bool is_upright = entrance.at.x == std::floor(entrance.at.x);
    candidates.push_back({{a, b},
                          {components[a][graph.zone_cells[a].place_of_entrance(g)],
                           components[b][graph.zone_cells[b].place_of_entrance(g)]},
                          is_upright ? entrance.at.z : entrance.at.x,
                          is_upright ? entrance.at.x : entrance.at.z,
                          g});
  }
  std::sort(candidates.begin(), candidates.end(), [](const Candidate& p, const Candidate& q) {
    return std::tuple{p.key(), p.along, p.entrance} < std::tuple{q.key(), q.along, q.entrance};
  });
  const double apart = world.tiles_per_zone * 64 * 0.15;
  const Candidate* last = nullptr;
  for (const Candidate& c : candidates) {
    if (last != nullptr && last->key() == c.key() && c.along - last->along < apart) continue;
    last = &c;
    const auto boundary_node = static_cast<uint32_t>(graph.boundary_cells.size());
    graph.boundary_cells.push_back(c.zone_cells);
    for (const uint32_t t : c.zone_cells) {
      graph.zone_cells[t].boundary_nodes.push_back(boundary_node);
      graph.zone_cells[t].boundary_entrances.push_back(
          graph.zone_cells[t].place_of_entrance(c.entrance));
      graph.zone_cells[t].boundary_node_at.push_back(graph.entrances[c.entrance].at);
    }
  }
}

// Per overlay cell its zones.
std::vector<std::vector<uint32_t>> group_zones(const world::WorldData& world, ZoneGraph& graph) {
  std::map<std::pair<int32_t, int32_t>, std::vector<uint32_t>> groups;
  for (uint32_t slot = 0; slot < world.slots.size(); ++slot) {
    const format::ZoneEntry& entry = world.slots[slot]->entry;
    groups[{entry.z() / kZonesPerCell, entry.x() / kZonesPerCell}].push_back(slot);
  }
  std::vector<std::vector<uint32_t>> zones;
  graph.cell_of_zone.resize(world.slots.size());
  for (auto& [place, members] : groups) {
    for (const uint32_t slot : members)
      graph.cell_of_zone[slot] = static_cast<uint32_t>(zones.size());
    zones.push_back(std::move(members));
  }
  return zones;
}

}  // namespace

uint32_t OverlayCell::place_of_entrance(uint32_t entrance) const {
  return static_cast<uint32_t>(std::lower_bound(entrances.begin(), entrances.end(), entrance) -
                               entrances.begin());
}

uint64_t ZoneGraph::bytes() const {
  uint64_t bytes = entrances.size() * sizeof(Entrance) + boundary_labels.bytes() +
                   (cell_of_zone.size() + 2 * boundary_cells.size()) * sizeof(uint32_t);
  for (const ZonePaths& paths : zones) bytes += sizeof(ZonePaths) + paths.bytes();
  for (const OverlayCell& t : zone_cells) {
    bytes += t.labels.bytes() +
             (t.entrances.size() + t.boundary_nodes.size() + t.boundary_entrances.size()) *
                 sizeof(uint32_t) +
             t.boundary_node_at.size() * sizeof(CellPoint);
  }
  return bytes;
}

uint64_t ZoneGraph::label_count() const {
  uint64_t count = boundary_labels.labels.size();
  for (const OverlayCell& t : zone_cells) count += t.labels.labels.size();
  return count;
}

Result<ZoneGraph> build_zone_graph(const world::WorldData& world, const PathMesh& mesh,
                                   int32_t workers, Context& context) {
  const Error cancelled{Errc::kCancelled, "path: cancelled"};
  ZoneGraph graph;
  graph.entrances = find_entrances(world, mesh, zones_of_rects(world, mesh));
  graph.zones.resize(world.slots.size());
  for (size_t slot = 0; slot < graph.zones.size(); ++slot) {
    const uint32_t first = world.slots[slot]->first_level;
    graph.zones[slot].first_rect = mesh.first[first];
    graph.zones[slot].last_rect = mesh.first[first + world.slots[slot]->entry.levels()];
  }
  for (uint32_t g = 0; g < graph.entrances.size(); ++g) {
    for (const uint32_t zone : graph.entrances[g].zone) graph.zones[zone].entrances.push_back(g);
  }
  std::vector<Sight> sights(static_cast<size_t>(worker_count(workers)));
  std::vector<uint8_t> fits(graph.zones.size(), 1);
  parallel_for_worker(graph.zones.size(), workers, [&](size_t zone, int32_t worker) {
    if (context.cancel) return;
    Sight& sight = sights[static_cast<size_t>(worker)];
    fits[zone] = find_zone_paths(mesh, graph.entrances, static_cast<uint32_t>(zone), sight,
                                 graph.zones[zone])
                     ? 1
                     : 0;
  });
  if (context.cancel) return cancelled;
  if (const auto bad = std::find(fits.begin(), fits.end(), uint8_t{0}); bad != fits.end()) {
    const auto slot = static_cast<size_t>(bad - fits.begin());
    const format::ZoneEntry& entry = world.slots[slot]->entry;
    return Error{Errc::kBadConfig,
                 "path: zone " + std::to_string(entry.x()) + ", " + std::to_string(entry.z()) +
                     " has " + std::to_string(graph.zones[slot].corners.size()) +
                     " corners, zones of paths may have " + std::to_string(kStraight - 1) +
                     "; bake the world with smaller zones"};
  }

  const auto zones = group_zones(world, graph);
  graph.zone_cells.resize(zones.size());
  std::vector<std::vector<uint32_t>> components(zones.size());
  std::vector<Error> errors(zones.size());
  constexpr uint64_t kSamples = 128;
  parallel_for(zones.size(), workers, [&](size_t t) {
    OverlayCell& zone_cell = graph.zone_cells[t];
    for (const uint32_t zone : zones[t]) {
      const auto& entrances = graph.zones[zone].entrances;
      zone_cell.entrances.insert(zone_cell.entrances.end(), entrances.begin(), entrances.end());
    }
    std::sort(zone_cell.entrances.begin(), zone_cell.entrances.end());
    zone_cell.entrances.erase(std::unique(zone_cell.entrances.begin(), zone_cell.entrances.end()),
                              zone_cell.entrances.end());
    const PathGraph paths = entrance_graph(graph, zone_cell, zones[t]);
    components[t] = components_of(paths);
    auto labels = label_graph(paths, kSamples, 1, context);
    if (labels) {
      zone_cell.labels = std::move(*labels);
    } else {
      errors[t] = labels.error();
    }
  });
  if (context.cancel) return cancelled;
  for (const Error& error : errors) {
    if (error.code != Errc::kOk) return error;
  }

  choose_boundary_nodes(world, components, graph);
  Edges edges(graph.boundary_cells.size());
  for (const OverlayCell& zone_cell : graph.zone_cells) {
    add_edges(
        zone_cell.boundary_nodes.size(),
        [&](size_t a, size_t b) {
          return meet(zone_cell.labels.of(zone_cell.boundary_entrances[a]),
                      zone_cell.labels.of(zone_cell.boundary_entrances[b]))
              .length;
        },
        [&](size_t boundary_node) { return zone_cell.boundary_nodes[boundary_node]; }, edges);
  }
  auto labels = label_graph(to_graph(edges), kSamples, workers, context);
  if (!labels) return labels.error();
  graph.boundary_labels = std::move(*labels);
  return graph;
}

}  // namespace throng::path
