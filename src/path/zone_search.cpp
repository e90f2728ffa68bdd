// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "path/zone_search.h"

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <numeric>
#include <optional>

#include "core/prefetch.h"
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

// The corners of the way to a gate of the zone, the first of which is at `next`. Where they are is
// asked for, not waited for: place_corners() tells it.
void add_corners(const PathMesh& mesh, const ZoneWays& ways, uint16_t next, size_t gate,
                 std::vector<WayPoint>& way) {
  while (next != kStraight) {
    way.push_back({{}, kNoRect, ways.corners[next]});
    prefetch(&mesh.corners[way.back().corner]);
    next = ways.next[ways.row(next) + gate];
  }
}

void place_corners(const PathMesh& mesh, std::vector<WayPoint>& way) {
  for (WayPoint& point : way) {
    if (point.corner != kNoCorner) point = way_point(mesh, point.corner);
  }
}

}  // namespace

void ZoneSearch::Reached::begin(size_t hubs) { hubs_.assign(hubs, word(kNever, 0)); }

void ZoneSearch::Reached::add(std::span<const TwoHopLabels::Label> labels, uint32_t from,
                              float length) {
  for (const TwoHopLabels::Label& label : labels)
    hubs_[label.hub] = std::min(hubs_[label.hub], word(length + label.length, from));
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
  asked_.clear();
  for (const uint32_t gate : ways.gates) asked_.push_back(territory.place_of_gate(gate));
  territory.labels.ask_for(asked_);
  for (uint32_t g = 0; g < asked_.size(); ++g) {
    if (end.length[g] < kNever) end.hubs.add(territory.labels.of(asked_[g]), g, end.length[g]);
  }
}

bool ZoneSearch::join(const ZoneGraph& graph, const Stop& from, const Stop& to, Best& best) {
  best.length = kNever;
  if (start_.territory == goal_.territory) {
    const auto hubs = static_cast<uint32_t>(graph.territories[start_.territory].gates.size());
    for (uint32_t hub = 0; hub < hubs; ++hub) {
      const float here = start_.hubs.length(hub) + goal_.hubs.length(hub);
      if (here < best.length) best = {here, false, hub, 0, 0};
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
    const float here = end.hubs.length(label.hub) + label.length;
    if (here < post.length) post = {here, label.hub, post.beyond, post.bound};
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
    const Territory& territory = graph.territories[end.territory];
    const auto keep = [&](auto is_kept) {
      std::erase_if(within_, [&](uint32_t p) { return !is_kept(end.posts[p]); });
    };
    within_.resize(end.posts.size());
    std::iota(within_.begin(), within_.end(), 0u);
    keep([&](const End::Post& post) { return post.bound <= known; });
    asked_.clear();
    for (const uint32_t p : within_) asked_.push_back(territory.post_gates[p]);
    territory.labels.ask_for(asked_);
    for (const uint32_t p : within_) reach_post(graph, end, p);
    keep([&](const End::Post& post) { return post.length + post.beyond <= known; });
    asked_.clear();
    for (const uint32_t p : within_) asked_.push_back(territory.posts[p]);
    graph.post_labels.ask_for(asked_);
    for (const uint32_t p : within_) {
      if (end.posts[p].length + end.posts[p].beyond <= known) visit(p);
    }
  };
  post_hubs_.begin(graph.post_territories.size());
  each_within(start_, [&](uint32_t p) {
    post_hubs_.add(graph.post_labels.of(start.posts[p]), p, start_.posts[p].length);
  });
  each_within(goal_, [&](uint32_t p) {
    for (const TwoHopLabels::Label& label : graph.post_labels.of(goal.posts[p])) {
      const float here = post_hubs_.length(label.hub) + label.length + goal_.posts[p].length;
      if (!(here < best.length)) continue;
      best = {here, true, label.hub, post_hubs_.from(label.hub), p};
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
    return graph.zones[end.zone].gates[end.hubs.from(hub)];
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

// Finds where the tables of zones tell of the ways from gate to gate.
void ZoneSearch::look_up_legs(const ZoneGraph& graph) {
  for (const uint32_t gate : gates_) prefetch(&graph.gates[gate]);
  legs_.clear();
  for (uint32_t i = 1; i < gates_.size(); ++i) {
    const Gate &from = graph.gates[gates_[i - 1]], &to = graph.gates[gates_[i]];
    for (const uint32_t zone : from.zone) {
      if (zone != to.zone[0] && zone != to.zone[1]) continue;
      legs_.push_back({i, &graph.zones[zone], 0, 0});
      prefetch(&legs_.back().ways->gates);
      prefetch(&legs_.back().ways->next);
    }
  }
  for (const Leg& leg : legs_) prefetch(leg.ways->gates.data() + leg.ways->gates.size() / 2);
  for (Leg& leg : legs_) {
    const ZoneWays& ways = *leg.ways;
    leg.goal = ways.place_of_gate(gates_[leg.to]);
    leg.at = ways.row(ways.corners.size() + ways.place_of_gate(gates_[leg.to - 1])) + leg.goal;
    prefetch(&ways.length[leg.at]);
    prefetch(&ways.next[leg.at]);
  }
}

// From gate to gate: the first one is there already.
void ZoneSearch::add_legs(const PathMesh& mesh, const ZoneGraph& graph) {
  look_up_legs(graph);
  auto leg = legs_.begin();
  for (uint32_t i = 1; i < gates_.size(); ++i) {
    const Leg* best = nullptr;
    for (; leg != legs_.end() && leg->to == i; ++leg) {
      const float length = leg->ways->length[leg->at];
      if (length < (best == nullptr ? kNever : best->ways->length[best->at])) best = &*leg;
    }
    if (best != nullptr)
      add_corners(mesh, *best->ways, best->ways->next[best->at], best->goal, way_);
    const Gate& gate = graph.gates[gates_[i]];
    way_.push_back({gate.at, gate.rect[0]});
  }
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
  add_legs(mesh, graph);
  tail_.clear();
  add_corners(mesh, goal, goal_.next[last], last, tail_);
  way_.insert(way_.end(), tail_.rbegin(), tail_.rend());
  way_.push_back({in_cells(to.at), to.rect});
  place_corners(mesh, way_);
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

}  // namespace throng
