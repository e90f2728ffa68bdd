// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "path/overlay/zone_search.h"

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <numeric>
#include <optional>

#include "core/arrays/prefetch.h"
#include "path/ground/border.h"
#include "path/ground/mesh_ray.h"

// Joins the tables and labels of the zones of both ends, then pulls the path taut. Time: mostly of
// the labels that are read, linear, of boundary nodes only those that may lie on a shorter path;
// ends in the same zone or in zones that touch add a search of the mesh.
namespace throng::path {
namespace {

uint32_t zone_of(const world::WorldData& world, const PathMesh& mesh, uint32_t rect) {
  return static_cast<uint32_t>(world.slot_of_level(mesh.rects[rect].level));
}

bool touch(const world::WorldData& world, uint32_t a, uint32_t b) {
  const format::ZoneEntry &p = world.slots[a]->entry, &q = world.slots[b]->entry;
  return std::abs(p.x() - q.x()) <= 1 && std::abs(p.z() - q.z()) <= 1;
}

// The corners of the path to an entrance of the zone, the first of which is at `next`. Their
// positions are prefetched, not read: place_corners() reads them.
void add_corners(const PathMesh& mesh, const ZonePaths& paths, uint16_t next, size_t entrance,
                 std::vector<Waypoint>& path) {
  while (next != kStraight) {
    path.push_back({{}, kNoRect, paths.corners[next]});
    prefetch(&mesh.corners[path.back().corner]);
    next = paths.next[paths.row(next) + entrance];
  }
}

void place_corners(const PathMesh& mesh, std::vector<Waypoint>& path) {
  for (Waypoint& point : path) {
    if (point.corner != kNoCorner) point = waypoint(mesh, point.corner);
  }
}

}  // namespace

void ZoneSearch::Reached::begin(size_t hubs) { hubs_.assign(hubs, word(kNeverReached, 0)); }

void ZoneSearch::Reached::add(std::span<const TwoHopLabels::Label> labels, uint32_t from,
                              float length) {
  for (const TwoHopLabels::Label& label : labels)
    hubs_[label.hub] = std::min(hubs_[label.hub], word(length + label.length, from));
}

// From an end to the entrances of its zone, and on to the hubs of its overlay cell.
void ZoneSearch::find_hubs(const world::WorldData& world, const PathMesh& mesh,
                           const ZoneGraph& graph, const Stop& stop, End& end) {
  end.zone = zone_of(world, mesh, stop.rect);
  end.zone_cell = graph.cell_of_zone[end.zone];
  const ZonePaths& paths = graph.zones[end.zone];
  find_entrances_around(mesh, graph.entrances, end.zone, paths, stop, sight_, end.length, end.next);
  const OverlayCell& zone_cell = graph.zone_cells[end.zone_cell];
  end.hubs.begin(zone_cell.entrances.size());
  prefetched_.clear();
  for (const uint32_t entrance : paths.entrances)
    prefetched_.push_back(zone_cell.place_of_entrance(entrance));
  zone_cell.labels.ask_for(prefetched_);
  for (uint32_t g = 0; g < prefetched_.size(); ++g) {
    if (end.length[g] < kNeverReached)
      end.hubs.add(zone_cell.labels.of(prefetched_[g]), g, end.length[g]);
  }
}

bool ZoneSearch::join(const ZoneGraph& graph, const Stop& from, const Stop& to, Best& best) {
  best.length = kNeverReached;
  if (start_.zone_cell == goal_.zone_cell) {
    const auto hubs = static_cast<uint32_t>(graph.zone_cells[start_.zone_cell].entrances.size());
    for (uint32_t hub = 0; hub < hubs; ++hub) {
      const float here = start_.hubs.length(hub) + goal_.hubs.length(hub);
      if (here < best.length) best = {here, false, hub, 0, 0};
    }
  }
  join_boundary_nodes(graph, from, to, best);
  return best.length < kNeverReached;
}

// Finds how far a boundary node of an end's overlay cell is.
void ZoneSearch::reach_boundary_node(const ZoneGraph& graph, End& end, size_t place) {
  const OverlayCell& zone_cell = graph.zone_cells[end.zone_cell];
  End::BoundaryNode& boundary_node = end.boundary_nodes[place];
  for (const TwoHopLabels::Label& label :
       zone_cell.labels.of(zone_cell.boundary_entrances[place])) {
    const float here = end.hubs.length(label.hub) + label.length;
    if (here < boundary_node.length)
      boundary_node = {here, label.hub, boundary_node.beyond, boundary_node.bound};
  }
}

// Paths that leave the overlay cell. No path over a boundary node is shorter than the straight
// lines to it and from it, so only boundary nodes in the ellipse of a known path count.
void ZoneSearch::join_boundary_nodes(const ZoneGraph& graph, const Stop& from, const Stop& to,
                                     Best& best) {
  const auto list = [&](End& end, CellPoint here, CellPoint there) {
    const OverlayCell& zone_cell = graph.zone_cells[end.zone_cell];
    end.boundary_nodes.resize(zone_cell.boundary_nodes.size());
    for (size_t p = 0; p < end.boundary_nodes.size(); ++p) {
      const CellPoint at = zone_cell.boundary_node_at[p];
      const auto beyond = static_cast<float>(distance(at, there));
      end.boundary_nodes[p] = {kNeverReached, 0, beyond,
                               static_cast<float>(distance(here, at)) + beyond};
    }
  };
  // The boundary node of the smallest bound that is reached.
  const auto nearest = [&](End& end) -> std::optional<size_t> {
    std::vector<End::BoundaryNode>& boundary_nodes = end.boundary_nodes;
    for (size_t tries = 0; tries < boundary_nodes.size(); ++tries) {
      const auto least = std::min_element(
          boundary_nodes.begin(), boundary_nodes.end(),
          [](const End::BoundaryNode& a, const End::BoundaryNode& b) { return a.bound < b.bound; });
      if (!(least->bound < kNeverReached)) break;
      const auto place = static_cast<size_t>(least - boundary_nodes.begin());
      reach_boundary_node(graph, end, place);
      if (least->length < kNeverReached) return place;
      least->bound = kNeverReached;
    }
    return std::nullopt;
  };
  const CellPoint start_at = in_cells(from.at), goal_at = in_cells(to.at);
  list(start_, start_at, goal_at);
  list(goal_, goal_at, start_at);
  const auto first = nearest(start_), last = nearest(goal_);
  if (!first || !last) return;
  const OverlayCell& start = graph.zone_cells[start_.zone_cell];
  const OverlayCell& goal = graph.zone_cells[goal_.zone_cell];
  const Meeting met = meet(graph.boundary_labels.of(start.boundary_nodes[*first]),
                           graph.boundary_labels.of(goal.boundary_nodes[*last]));
  constexpr float kRoundingFactor = 1.00001f;  // floats
  float known =
      kRoundingFactor * std::min(best.length, start_.boundary_nodes[*first].length + met.length +
                                                  goal_.boundary_nodes[*last].length);
  const auto each_within = [&](End& end, auto visit) {
    const OverlayCell& zone_cell = graph.zone_cells[end.zone_cell];
    const auto keep = [&](auto is_kept) {
      std::erase_if(within_, [&](uint32_t p) { return !is_kept(end.boundary_nodes[p]); });
    };
    within_.resize(end.boundary_nodes.size());
    std::iota(within_.begin(), within_.end(), 0u);
    keep([&](const End::BoundaryNode& boundary_node) { return boundary_node.bound <= known; });
    prefetched_.clear();
    for (const uint32_t p : within_) prefetched_.push_back(zone_cell.boundary_entrances[p]);
    zone_cell.labels.ask_for(prefetched_);
    for (const uint32_t p : within_) reach_boundary_node(graph, end, p);
    keep([&](const End::BoundaryNode& boundary_node) {
      return boundary_node.length + boundary_node.beyond <= known;
    });
    prefetched_.clear();
    for (const uint32_t p : within_) prefetched_.push_back(zone_cell.boundary_nodes[p]);
    graph.boundary_labels.ask_for(prefetched_);
    for (const uint32_t p : within_) {
      if (end.boundary_nodes[p].length + end.boundary_nodes[p].beyond <= known) visit(p);
    }
  };
  boundary_hubs_.begin(graph.boundary_cells.size());
  each_within(start_, [&](uint32_t p) {
    boundary_hubs_.add(graph.boundary_labels.of(start.boundary_nodes[p]), p,
                       start_.boundary_nodes[p].length);
  });
  each_within(goal_, [&](uint32_t p) {
    for (const TwoHopLabels::Label& label : graph.boundary_labels.of(goal.boundary_nodes[p])) {
      const float here =
          boundary_hubs_.length(label.hub) + label.length + goal_.boundary_nodes[p].length;
      if (!(here < best.length)) continue;
      best = {here, true, label.hub, boundary_hubs_.from(label.hub), p};
    }
    known = std::min(known, kRoundingFactor * best.length);
  });
}

// Adds the entrances from one of an overlay cell to another over a hub, without the first.
void ZoneSearch::add_entrances(const OverlayCell& zone_cell, uint32_t from, uint32_t hub,
                               uint32_t to) {
  walked_.clear();
  const TwoHopLabels& labels = zone_cell.labels;
  labels.walk(labels.place_of(from, hub), labels.place_of(to, hub), walked_);
  for (size_t i = 1; i < walked_.size(); ++i) entrances_.push_back(zone_cell.entrances[walked_[i]]);
}

// The entrances of the path, from one of the first zone to one of the last.
void ZoneSearch::list_entrances(const ZoneGraph& graph, const Best& best) {
  const OverlayCell& start = graph.zone_cells[start_.zone_cell];
  const OverlayCell& goal = graph.zone_cells[goal_.zone_cell];
  const auto entrance_to = [&](const End& end, uint32_t hub) {
    return graph.zones[end.zone].entrances[end.hubs.from(hub)];
  };
  if (!best.over_boundary_nodes) {
    const uint32_t first = entrance_to(start_, best.hub), last = entrance_to(goal_, best.hub);
    entrances_.assign(1, first);
    add_entrances(start, start.place_of_entrance(first), best.hub, start.place_of_entrance(last));
    return;
  }
  const uint32_t first_hub = start_.boundary_nodes[best.first].hub,
                 last_hub = goal_.boundary_nodes[best.last].hub;
  const uint32_t first = entrance_to(start_, first_hub), last = entrance_to(goal_, last_hub);
  entrances_.assign(1, first);
  add_entrances(start, start.place_of_entrance(first), first_hub,
                start.boundary_entrances[best.first]);
  boundary_nodes_.clear();
  const TwoHopLabels& labels = graph.boundary_labels;
  labels.walk(labels.place_of(start.boundary_nodes[best.first], best.hub),
              labels.place_of(goal.boundary_nodes[best.last], best.hub), boundary_nodes_);
  for (size_t i = 1; i < boundary_nodes_.size(); ++i) {
    // Two boundary nodes of one border are joined in both overlay cells.
    Meeting least;
    const OverlayCell* over = nullptr;
    uint32_t from = 0, to = 0;
    for (const uint32_t t : graph.boundary_cells[boundary_nodes_[i - 1]]) {
      const auto& others = graph.boundary_cells[boundary_nodes_[i]];
      if (t != others[0] && t != others[1]) continue;
      const OverlayCell& zone_cell = graph.zone_cells[t];
      const auto place = [&](uint32_t boundary_node) {
        const auto at = std::lower_bound(zone_cell.boundary_nodes.begin(),
                                         zone_cell.boundary_nodes.end(), boundary_node);
        return zone_cell
            .boundary_entrances[static_cast<size_t>(at - zone_cell.boundary_nodes.begin())];
      };
      const uint32_t a = place(boundary_nodes_[i - 1]), b = place(boundary_nodes_[i]);
      const Meeting met = meet(zone_cell.labels.of(a), zone_cell.labels.of(b));
      if (!(met.length < least.length)) continue;
      least = met;
      over = &zone_cell;
      from = a;
      to = b;
    }
    if (over != nullptr) add_entrances(*over, from, least.hub, to);
  }
  add_entrances(goal, goal.boundary_entrances[best.last], last_hub, goal.place_of_entrance(last));
}

// Finds where the tables of zones hold the paths from entrance to entrance.
void ZoneSearch::find_segments(const ZoneGraph& graph) {
  for (const uint32_t entrance : entrances_) prefetch(&graph.entrances[entrance]);
  segments_.clear();
  for (uint32_t i = 1; i < entrances_.size(); ++i) {
    const Entrance &from = graph.entrances[entrances_[i - 1]], &to = graph.entrances[entrances_[i]];
    for (const uint32_t zone : from.zone) {
      if (zone != to.zone[0] && zone != to.zone[1]) continue;
      segments_.push_back({i, &graph.zones[zone], 0, 0});
      prefetch(&segments_.back().paths->entrances);
      prefetch(&segments_.back().paths->next);
    }
  }
  for (const Segment& segment : segments_)
    prefetch(segment.paths->entrances.data() + segment.paths->entrances.size() / 2);
  for (Segment& segment : segments_) {
    const ZonePaths& paths = *segment.paths;
    segment.goal = paths.place_of_entrance(entrances_[segment.to]);
    segment.at =
        paths.row(paths.corners.size() + paths.place_of_entrance(entrances_[segment.to - 1])) +
        segment.goal;
    prefetch(&paths.length[segment.at]);
    prefetch(&paths.next[segment.at]);
  }
}

// From entrance to entrance: the first one is there already.
void ZoneSearch::add_segments(const PathMesh& mesh, const ZoneGraph& graph) {
  find_segments(graph);
  auto segment = segments_.begin();
  for (uint32_t i = 1; i < entrances_.size(); ++i) {
    const Segment* best = nullptr;
    for (; segment != segments_.end() && segment->to == i; ++segment) {
      const float length = segment->paths->length[segment->at];
      if (length < (best == nullptr ? kNeverReached : best->paths->length[best->at]))
        best = &*segment;
    }
    if (best != nullptr)
      add_corners(mesh, *best->paths, best->paths->next[best->at], best->goal, path_);
    const Entrance& entrance = graph.entrances[entrances_[i]];
    path_.push_back({entrance.at, entrance.rect[0]});
  }
}

// The path that the labels give, pulled taut.
bool ZoneSearch::lead(const PathMesh& mesh, const ZoneGraph& graph, const Stop& from,
                      const Stop& to, const Best& best, std::vector<uint32_t>& corners,
                      double& length) {
  list_entrances(graph, best);
  const ZonePaths &start = graph.zones[start_.zone], &goal = graph.zones[goal_.zone];
  const size_t first = start.place_of_entrance(entrances_.front());
  const size_t last = goal.place_of_entrance(entrances_.back());
  path_.assign(1, {in_cells(from.at), from.rect});
  add_corners(mesh, start, start_.next[first], first, path_);
  path_.push_back(
      {graph.entrances[entrances_.front()].at, graph.entrances[entrances_.front()].rect[0]});
  add_segments(mesh, graph);
  tail_.clear();
  add_corners(mesh, goal, goal_.next[last], last, tail_);
  path_.insert(path_.end(), tail_.rbegin(), tail_.rend());
  path_.push_back({in_cells(to.at), to.rect});
  place_corners(mesh, path_);
  return pull_.pull(mesh, path_, corners, length);
}

SearchResult ZoneSearch::find(const world::WorldData& world, const PathMesh& mesh,
                              const ZoneGraph& graph, const Stop& from, const Stop& to,
                              const SearchBudget& budget, std::vector<uint32_t>& corners,
                              double& length) {
  expanded_ = 0;
  if (mesh_ray(mesh, from.rect, from.at, to.at) == to.rect) {
    corners.clear();
    length = distance(in_cells(from.at), in_cells(to.at));
    return SearchResult::kFound;
  }
  find_hubs(world, mesh, graph, from, start_);
  find_hubs(world, mesh, graph, to, goal_);
  Best best;
  const bool led =
      join(graph, from, to, best) && lead(mesh, graph, from, to, best, corners, length);
  if (led && !touch(world, start_.zone, goal_.zone)) return SearchResult::kFound;
  // Near ends, or a path that stays in one zone: search for one that is shorter.
  constexpr uint64_t kNearNodes = 4096;
  double near = led ? length : PathSearch::kAnyLength;
  const SearchBudget least(std::min(budget.max_nodes, kNearNodes), budget.cancel, budget.max_bytes);
  const SearchResult result =
      search_.find(mesh, from, to, led ? least : budget, near_corners_, near, near);
  expanded_ = search_.expanded();
  if (result == SearchResult::kFound) {
    corners = near_corners_;
    length = near;
  }
  return led ? SearchResult::kFound : result;
}

}  // namespace throng::path
