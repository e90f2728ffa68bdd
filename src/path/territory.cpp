// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "path/territory.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <string>
#include <tuple>
#include <utility>

#include "core/parallel.h"

namespace throng {
namespace {

constexpr float kNever = std::numeric_limits<float>::infinity();
using Edges = std::vector<std::vector<WayGraph::Edge>>;

// Joins every two of `count` nodes by their ways' lengths, without the ways that lead over another.
void add_edges(size_t count, const std::function<float(size_t, size_t)>& length_of,
               const std::function<uint32_t(size_t)>& node_of, Edges& edges) {
  std::vector<float> lengths(count * count, kNever);
  for (size_t a = 0; a < count; ++a) {
    for (size_t b = a + 1; b < count; ++b)
      lengths[a * count + b] = lengths[b * count + a] = length_of(a, b);
  }
  for (size_t a = 0; a < count; ++a) {
    for (size_t b = a + 1; b < count; ++b) {
      const float direct = lengths[a * count + b];
      if (!(direct < kNever)) continue;
      constexpr float kSlack = 1e-5f;  // of the length: floats
      const float* from = &lengths[a * count];
      const float* to = &lengths[b * count];
      bool is_over = false;
      for (size_t c = 0; c < count && !is_over; ++c)
        is_over = from[c] > 0 && to[c] > 0 && from[c] + to[c] <= direct * (1 + kSlack);
      if (is_over) continue;
      edges[node_of(a)].push_back({node_of(b), direct});
      edges[node_of(b)].push_back({node_of(a), direct});
    }
  }
}

// Of edges between the same nodes, the shortest.
WayGraph to_graph(Edges& edges) {
  WayGraph graph;
  graph.first.push_back(0);
  for (auto& of_node : edges) {
    std::sort(of_node.begin(), of_node.end(), [](const auto& a, const auto& b) {
      return a.to != b.to ? a.to < b.to : a.length < b.length;
    });
    for (const WayGraph::Edge& edge : of_node) {
      if (graph.edges.size() > graph.first.back() && graph.edges.back().to == edge.to) continue;
      graph.edges.push_back(edge);
    }
    graph.first.push_back(static_cast<uint32_t>(graph.edges.size()));
  }
  return graph;
}

WayGraph gate_graph(const ZoneGraph& graph, const Territory& territory,
                    const std::vector<uint32_t>& zones) {
  Edges edges(territory.gates.size());
  for (const uint32_t zone : zones) {
    const ZoneWays& ways = graph.zones[zone];
    const size_t corners = ways.corners.size();
    add_edges(
        ways.gates.size(),
        [&](size_t a, size_t b) {
          return std::min(ways.length[ways.row(corners + a) + b],
                          ways.length[ways.row(corners + b) + a]);
        },
        [&](size_t gate) { return territory.place_of_gate(ways.gates[gate]); }, edges);
  }
  return to_graph(edges);
}

// The first node of what holds together with each.
std::vector<uint32_t> components_of(const WayGraph& graph) {
  std::vector<uint32_t> of(graph.count(), UINT32_MAX), queue;
  for (uint32_t node = 0; node < of.size(); ++node) {
    if (of[node] != UINT32_MAX) continue;
    queue.assign(1, node);
    of[node] = node;
    while (!queue.empty()) {
      const uint32_t at = queue.back();
      queue.pop_back();
      for (const WayGraph::Edge& edge : graph.of(at)) {
        if (of[edge.to] != UINT32_MAX) continue;
        of[edge.to] = node;
        queue.push_back(edge.to);
      }
    }
  }
  return of;
}

// Of the gates between two territories that join the same parts of them, one every so many cells of
// the border is a post. `components` has, for each territory, the part of each gate.
void choose_posts(const WorldData& world, const std::vector<std::vector<uint32_t>>& components,
                  ZoneGraph& graph) {
  struct Candidate {
    std::array<uint32_t, 2> territories, parts;
    double along, across;
    uint32_t gate;
    [[nodiscard]] auto key() const { return std::tuple{territories, parts, across}; }
  };
  std::vector<Candidate> candidates;
  for (uint32_t g = 0; g < graph.gates.size(); ++g) {
    const Gate& gate = graph.gates[g];
    const uint32_t a = graph.territory_of_zone[gate.zone[0]];
    const uint32_t b = graph.territory_of_zone[gate.zone[1]];
    if (a == b) continue;
    const bool is_upright = gate.at.x == std::floor(gate.at.x);
    candidates.push_back({{a, b},
                          {components[a][graph.territories[a].place_of_gate(g)],
                           components[b][graph.territories[b].place_of_gate(g)]},
                          is_upright ? gate.at.z : gate.at.x,
                          is_upright ? gate.at.x : gate.at.z,
                          g});
  }
  std::sort(candidates.begin(), candidates.end(), [](const Candidate& p, const Candidate& q) {
    return std::tuple{p.key(), p.along, p.gate} < std::tuple{q.key(), q.along, q.gate};
  });
  const double apart = world.tiles_per_zone * 64 * 0.15;
  const Candidate* last = nullptr;
  for (const Candidate& c : candidates) {
    if (last != nullptr && last->key() == c.key() && c.along - last->along < apart) continue;
    last = &c;
    const auto post = static_cast<uint32_t>(graph.post_territories.size());
    graph.post_territories.push_back(c.territories);
    for (const uint32_t t : c.territories) {
      graph.territories[t].posts.push_back(post);
      graph.territories[t].post_gates.push_back(graph.territories[t].place_of_gate(c.gate));
      graph.territories[t].post_at.push_back(graph.gates[c.gate].at);
    }
  }
}

// Per territory its zones.
std::vector<std::vector<uint32_t>> group_zones(const WorldData& world, ZoneGraph& graph) {
  std::map<std::pair<int32_t, int32_t>, std::vector<uint32_t>> groups;
  for (uint32_t slot = 0; slot < world.slots.size(); ++slot) {
    const format::ZoneEntry& entry = world.slots[slot]->entry;
    groups[{entry.z() / kTerritoryZones, entry.x() / kTerritoryZones}].push_back(slot);
  }
  std::vector<std::vector<uint32_t>> zones;
  graph.territory_of_zone.resize(world.slots.size());
  for (auto& [place, members] : groups) {
    for (const uint32_t slot : members)
      graph.territory_of_zone[slot] = static_cast<uint32_t>(zones.size());
    zones.push_back(std::move(members));
  }
  return zones;
}

}  // namespace

uint32_t Territory::place_of_gate(uint32_t gate) const {
  return static_cast<uint32_t>(std::lower_bound(gates.begin(), gates.end(), gate) - gates.begin());
}

uint64_t ZoneGraph::bytes() const {
  uint64_t bytes = gates.size() * sizeof(Gate) + post_labels.bytes() +
                   (territory_of_zone.size() + 2 * post_territories.size()) * sizeof(uint32_t);
  for (const ZoneWays& ways : zones) bytes += sizeof(ZoneWays) + ways.bytes();
  for (const Territory& t : territories) {
    bytes += t.labels.bytes() +
             (t.gates.size() + t.posts.size() + t.post_gates.size()) * sizeof(uint32_t) +
             t.post_at.size() * sizeof(CellPoint);
  }
  return bytes;
}

uint64_t ZoneGraph::label_count() const {
  uint64_t count = post_labels.labels.size();
  for (const Territory& t : territories) count += t.labels.labels.size();
  return count;
}

Result<ZoneGraph> build_zone_graph(const WorldData& world, const PathMesh& mesh, int32_t workers,
                                   Context& context) {
  const Error cancelled{Errc::kCancelled, "path: cancelled"};
  ZoneGraph graph;
  graph.gates = find_gates(world, mesh, zones_of_rects(world, mesh));
  graph.zones.resize(world.slots.size());
  for (size_t slot = 0; slot < graph.zones.size(); ++slot) {
    const uint32_t first = world.slots[slot]->first_level;
    graph.zones[slot].first_rect = mesh.first[first];
    graph.zones[slot].last_rect = mesh.first[first + world.slots[slot]->entry.levels()];
  }
  for (uint32_t g = 0; g < graph.gates.size(); ++g) {
    for (const uint32_t zone : graph.gates[g].zone) graph.zones[zone].gates.push_back(g);
  }
  std::vector<Sight> sights(static_cast<size_t>(worker_count(workers)));
  std::vector<uint8_t> fits(graph.zones.size(), 1);
  parallel_for_worker(graph.zones.size(), workers, [&](size_t zone, int32_t worker) {
    if (context.cancel) return;
    Sight& sight = sights[static_cast<size_t>(worker)];
    fits[zone] =
        find_zone_ways(mesh, graph.gates, static_cast<uint32_t>(zone), sight, graph.zones[zone])
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
  graph.territories.resize(zones.size());
  std::vector<std::vector<uint32_t>> components(zones.size());
  std::vector<Error> errors(zones.size());
  constexpr uint64_t kSamples = 128;
  parallel_for(zones.size(), workers, [&](size_t t) {
    Territory& territory = graph.territories[t];
    for (const uint32_t zone : zones[t]) {
      const auto& gates = graph.zones[zone].gates;
      territory.gates.insert(territory.gates.end(), gates.begin(), gates.end());
    }
    std::sort(territory.gates.begin(), territory.gates.end());
    territory.gates.erase(std::unique(territory.gates.begin(), territory.gates.end()),
                          territory.gates.end());
    const WayGraph ways = gate_graph(graph, territory, zones[t]);
    components[t] = components_of(ways);
    auto labels = label_graph(ways, kSamples, 1, context);
    if (labels) {
      territory.labels = std::move(*labels);
    } else {
      errors[t] = labels.error();
    }
  });
  if (context.cancel) return cancelled;
  for (const Error& error : errors) {
    if (error.code != Errc::kOk) return error;
  }

  choose_posts(world, components, graph);
  Edges edges(graph.post_territories.size());
  for (const Territory& territory : graph.territories) {
    add_edges(
        territory.posts.size(),
        [&](size_t a, size_t b) {
          return meet(territory.labels.of(territory.post_gates[a]),
                      territory.labels.of(territory.post_gates[b]))
              .length;
        },
        [&](size_t post) { return territory.posts[post]; }, edges);
  }
  auto labels = label_graph(to_graph(edges), kSamples, workers, context);
  if (!labels) return labels.error();
  graph.post_labels = std::move(*labels);
  return graph;
}

}  // namespace throng
