// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "path/zone_search.h"

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <optional>

#include "path/border.h"
#include "path/mesh_ray.h"

namespace throng {
namespace {

constexpr float kNever = std::numeric_limits<float>::infinity();

uint32_t zone_of(const WorldData& world, const PathMesh& mesh, uint32_t rect) {
  return static_cast<uint32_t>(world.slot_of_level(mesh.rects[rect].level));
}

bool touch(const WorldData& world, uint32_t a, uint32_t b) {
  const format::ZoneEntry &p = world.slots[a]->entry, &q = world.slots[b]->entry;
  return std::abs(p.x() - q.x()) <= 1 && std::abs(p.z() - q.z()) <= 1;
}

// The corners of the way to a gate of the zone, the first of which is at `next`.
void add_corners(const PathMesh& mesh, const ZoneWays& ways, uint16_t next, size_t gate,
                 std::vector<WayPoint>& way) {
  while (next != kStraight) {
    way.push_back(way_point(mesh, ways.corners[next]));
    next = ways.next[ways.row(next) + gate];
  }
}

}  // namespace

void ZoneSearch::Reached::begin(size_t hubs) {
  if (hubs_.size() < hubs) hubs_.resize(hubs);
  if (++now_ != 0) return;
  std::fill(hubs_.begin(), hubs_.end(), Reach{});
  now_ = 1;
}

void ZoneSearch::Reached::add(const TwoHopLabels& labels, uint32_t node, uint32_t from,
                              float length) {
  for (const TwoHopLabels::Label& label : labels.of(node)) {
    Reach& hub = hubs_[label.hub];
    const float here = length + label.length;
    if (hub.now != now_ || here < hub.length) hub = {now_, from, here};
  }
}

// From an end to the gates of its zone, and on to the hubs of its territory.
void ZoneSearch::look_out(const WorldData& world, const PathMesh& mesh, const ZoneGraph& graph,
                          const Stop& stop, End& end) {
  end.zone = zone_of(world, mesh, stop.rect);
  end.territory = graph.territory_of_zone[end.zone];
  const ZoneWays& ways = graph.zones[end.zone];
  look_for_gates(mesh, graph.gates, end.zone, ways, stop, sight_, end.length, end.next);
  const Territory& territory = graph.territories[end.territory];
  end.hubs.begin(territory.gates.size());
  for (size_t g = 0; g < ways.gates.size(); ++g) {
    if (end.length[g] < kNever)
      end.hubs.add(territory.labels, territory.place_of_gate(ways.gates[g]),
                   static_cast<uint32_t>(g), end.length[g]);
  }
}

bool ZoneSearch::join(const ZoneGraph& graph, const Stop& from, const Stop& to, Best& best) {
  best.length = kNever;
  if (start_.territory == goal_.territory) {
    const auto hubs = static_cast<uint32_t>(graph.territories[start_.territory].gates.size());
    for (uint32_t hub = 0; hub < hubs; ++hub) {
      const Reach *there = start_.hubs.at(hub), *back = goal_.hubs.at(hub);
      if (there != nullptr && back != nullptr && there->length + back->length < best.length)
        best = {there->length + back->length, false, hub, 0, 0};
    }
  }
  join_posts(graph, from, to, best);
  return best.length < kNever;
}

// Finds how far a post of an end's territory is.
void ZoneSearch::reach_post(const ZoneGraph& graph, End& end, size_t place) {
  const Territory& territory = graph.territories[end.territory];
  End::Post& post = end.posts[place];
  for (const TwoHopLabels::Label& label : territory.labels.of(territory.post_gates[place])) {
    const Reach* hub = end.hubs.at(label.hub);
    if (hub != nullptr && hub->length + label.length < post.length)
      post = {hub->length + label.length, label.hub, post.beyond, post.bound};
  }
}

// Ways that leave the territory. No way over a post is shorter than the straight lines to it and
// from it, so of all posts only those count that lie in the ellipse of a way that is known.
void ZoneSearch::join_posts(const ZoneGraph& graph, const Stop& from, const Stop& to, Best& best) {
  const auto list = [&](End& end, CellPoint here, CellPoint there) {
    const Territory& territory = graph.territories[end.territory];
    end.posts.resize(territory.posts.size());
    for (size_t p = 0; p < end.posts.size(); ++p) {
      const CellPoint at = territory.post_at[p];
      const auto beyond = static_cast<float>(distance(at, there));
      end.posts[p] = {kNever, 0, beyond, static_cast<float>(distance(here, at)) + beyond};
    }
  };
  // The post of the smallest bound that is reached.
  const auto nearest = [&](End& end) -> std::optional<size_t> {
    std::vector<End::Post>& posts = end.posts;
    for (size_t tries = 0; tries < posts.size(); ++tries) {
      const auto least = std::min_element(
          posts.begin(), posts.end(),
          [](const End::Post& a, const End::Post& b) { return a.bound < b.bound; });
      if (!(least->bound < kNever)) break;
      const auto place = static_cast<size_t>(least - posts.begin());
      reach_post(graph, end, place);
      if (least->length < kNever) return place;
      least->bound = kNever;
    }
    return std::nullopt;
  };
  const CellPoint start_at = in_cells(from.at), goal_at = in_cells(to.at);
  list(start_, start_at, goal_at);
  list(goal_, goal_at, start_at);
  const auto first = nearest(start_), last = nearest(goal_);
  if (!first || !last) return;
  const Territory& start = graph.territories[start_.territory];
  const Territory& goal = graph.territories[goal_.territory];
  const Meeting met =
      meet(graph.post_labels.of(start.posts[*first]), graph.post_labels.of(goal.posts[*last]));
  constexpr float kSlack = 1.00001f;  // floats
  float known = kSlack * std::min(best.length, start_.posts[*first].length + met.length +
                                                   goal_.posts[*last].length);
  const auto each_within = [&](End& end, auto visit) {
    for (size_t p = 0; p < end.posts.size(); ++p) {
      if (!(end.posts[p].bound <= known)) continue;
      reach_post(graph, end, p);
      if (end.posts[p].length + end.posts[p].beyond <= known) visit(p);
    }
  };
  post_hubs_.begin(graph.post_territories.size());
  each_within(start_, [&](size_t p) {
    post_hubs_.add(graph.post_labels, start.posts[p], static_cast<uint32_t>(p),
                   start_.posts[p].length);
  });
  each_within(goal_, [&](size_t p) {
    for (const TwoHopLabels::Label& label : graph.post_labels.of(goal.posts[p])) {
      const Reach* hub = post_hubs_.at(label.hub);
      if (hub == nullptr) continue;
      const float here = hub->length + label.length + goal_.posts[p].length;
      if (here < best.length) best = {here, true, label.hub, hub->from, static_cast<uint32_t>(p)};
    }
    known = std::min(known, kSlack * best.length);
  });
}

// Adds the gates from one of a territory to another over a hub, without the first.
void ZoneSearch::add_gates(const Territory& territory, uint32_t from, uint32_t hub, uint32_t to) {
  walked_.clear();
  const TwoHopLabels& labels = territory.labels;
  labels.walk(labels.place_of(from, hub), labels.place_of(to, hub), walked_);
  for (size_t i = 1; i < walked_.size(); ++i) gates_.push_back(territory.gates[walked_[i]]);
}

// The gates of the way, from one of the first zone to one of the last.
void ZoneSearch::list_gates(const ZoneGraph& graph, const Best& best) {
  const Territory& start = graph.territories[start_.territory];
  const Territory& goal = graph.territories[goal_.territory];
  const auto gate_to = [&](const End& end, uint32_t hub) {
    return graph.zones[end.zone].gates[end.hubs.at(hub)->from];
  };
  if (!best.over_posts) {
    const uint32_t first = gate_to(start_, best.hub), last = gate_to(goal_, best.hub);
    gates_.assign(1, first);
    add_gates(start, start.place_of_gate(first), best.hub, start.place_of_gate(last));
    return;
  }
  const uint32_t first_hub = start_.posts[best.first].hub, last_hub = goal_.posts[best.last].hub;
  const uint32_t first = gate_to(start_, first_hub), last = gate_to(goal_, last_hub);
  gates_.assign(1, first);
  add_gates(start, start.place_of_gate(first), first_hub, start.post_gates[best.first]);
  posts_.clear();
  const TwoHopLabels& labels = graph.post_labels;
  labels.walk(labels.place_of(start.posts[best.first], best.hub),
              labels.place_of(goal.posts[best.last], best.hub), posts_);
  for (size_t i = 1; i < posts_.size(); ++i) {
    // Two posts of one border are joined in both territories.
    Meeting least;
    const Territory* over = nullptr;
    uint32_t from = 0, to = 0;
    for (const uint32_t t : graph.post_territories[posts_[i - 1]]) {
      const auto& others = graph.post_territories[posts_[i]];
      if (t != others[0] && t != others[1]) continue;
      const Territory& territory = graph.territories[t];
      const auto place = [&](uint32_t post) {
        const auto at = std::lower_bound(territory.posts.begin(), territory.posts.end(), post);
        return territory.post_gates[static_cast<size_t>(at - territory.posts.begin())];
      };
      const uint32_t a = place(posts_[i - 1]), b = place(posts_[i]);
      const Meeting met = meet(territory.labels.of(a), territory.labels.of(b));
      if (!(met.length < least.length)) continue;
      least = met;
      over = &territory;
      from = a;
      to = b;
    }
    if (over != nullptr) add_gates(*over, from, least.hub, to);
  }
  add_gates(goal, goal.post_gates[best.last], last_hub, goal.place_of_gate(last));
}

// From gate to gate of one zone: the first one is there already.
void ZoneSearch::add_gate_way(const PathMesh& mesh, const ZoneGraph& graph, uint32_t from,
                              uint32_t to) {
  float least = kNever;
  const ZoneWays* best = nullptr;
  size_t best_to = 0;
  uint16_t next = kStraight;
  for (const uint32_t zone : graph.gates[from].zone) {
    if (zone != graph.gates[to].zone[0] && zone != graph.gates[to].zone[1]) continue;
    const ZoneWays& ways = graph.zones[zone];
    const size_t goal = ways.place_of_gate(to);
    const size_t at = ways.row(ways.corners.size() + ways.place_of_gate(from)) + goal;
    if (!(ways.length[at] < least)) continue;
    least = ways.length[at];
    best = &ways;
    best_to = goal;
    next = ways.next[at];
  }
  if (best != nullptr) add_corners(mesh, *best, next, best_to, way_);
  const Gate& gate = graph.gates[to];
  way_.push_back({gate.at, gate.rect[0]});
}

// The way that the labels tell, pulled taut.
bool ZoneSearch::lead(const PathMesh& mesh, const ZoneGraph& graph, const Stop& from,
                      const Stop& to, const Best& best, std::vector<uint32_t>& corners,
                      double& length) {
  list_gates(graph, best);
  const ZoneWays &start = graph.zones[start_.zone], &goal = graph.zones[goal_.zone];
  const size_t first = start.place_of_gate(gates_.front());
  const size_t last = goal.place_of_gate(gates_.back());
  way_.assign(1, {in_cells(from.at), from.rect});
  add_corners(mesh, start, start_.next[first], first, way_);
  way_.push_back({graph.gates[gates_.front()].at, graph.gates[gates_.front()].rect[0]});
  for (size_t i = 1; i < gates_.size(); ++i) add_gate_way(mesh, graph, gates_[i - 1], gates_[i]);
  tail_.clear();
  add_corners(mesh, goal, goal_.next[last], last, tail_);
  way_.insert(way_.end(), tail_.rbegin(), tail_.rend());
  way_.push_back({in_cells(to.at), to.rect});
  return pull_.pull(mesh, way_, corners, length);
}

SearchResult ZoneSearch::find(const WorldData& world, const PathMesh& mesh, const ZoneGraph& graph,
                              const Stop& from, const Stop& to, const SearchBudget& budget,
                              std::vector<uint32_t>& corners, double& length) {
  expanded_ = 0;
  if (mesh_ray(mesh, from.rect, from.at, to.at) == to.rect) {
    corners.clear();
    length = distance(in_cells(from.at), in_cells(to.at));
    return SearchResult::kFound;
  }
  look_out(world, mesh, graph, from, start_);
  look_out(world, mesh, graph, to, goal_);
  Best best;
  const bool led =
      join(graph, from, to, best) && lead(mesh, graph, from, to, best, corners, length);
  if (led && !touch(world, start_.zone, goal_.zone)) return SearchResult::kFound;
  // Near ends, or a way that stays in one zone: search for one that is shorter.
  constexpr uint64_t kNearNodes = 4096;
  double near = led ? length : PathSearch::kAnyLength;
  const SearchBudget least(std::min(budget.max_nodes, kNearNodes), budget.cancel);
  const SearchResult result =
      search_.find(mesh, from, to, led ? least : budget, near_corners_, near, near);
  expanded_ = search_.expanded();
  if (result == SearchResult::kFound) {
    corners = near_corners_;
    length = near;
  }
  return led ? SearchResult::kFound : result;
}

}  // namespace throng
