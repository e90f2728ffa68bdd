// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "path/edits/ground_finder.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "core/access.h"
#include "core/check_class.h"
#include "path/edits/ground_finder_state.h"
#include "path/edits/ground_view.h"
#include "path/edits/plan_shapes.h"
#include "path/edits/point_search.h"
#include "path/edits/solid.h"
#include "path/ground/reset_path.h"
#include "path/ground/segments.h"
#include "world/place.h"
#include "world/tile_grid.h"

// Checks and converts what callers give, and searches: exactly while every metre costs the same and
// no off-mesh link is in force, else over points of portals.
namespace throng::path {

bool GroundFinder::State::locate(const Place& place, ViewStop& stop) {
  const auto at = world::ground_point(mesh.world(), place);
  if (!at) return false;
  stop.at = *at;
  stop.level = place.level1 - 1;
  return mesh.stand(stop.level, stop.at, stop.rect);
}

void GroundFinder::State::give(Path& path) {
  const world::WorldData& world = mesh.world();
  double length = 0, cost = 0;
  for (size_t i = 0; i < stops.size(); ++i) {
    path.points.push_back(world::place_at(world, mesh.level(stops[i].level)->ground, stops[i].at));
    if (i == 0) continue;
    length += distance_of(stops[i - 1].at, stops[i].at);
    cost += cost_to(mesh, stops[i - 1], stops[i]);
    const bool is_off_mesh = stops[i].off_mesh_link > 0;
    path.segments.push_back(is_off_mesh ? SegmentKind::kOffMesh : SegmentKind::kWalk);
    if (is_off_mesh) path.links.push_back({static_cast<uint32_t>(i), LinkKind::kOffMesh});
  }
  path.length = length * world.summary.cell;
  path.cost = cost * world.summary.cell;
}

GroundFinder::GroundFinder(std::unique_ptr<State> state) : state_(std::move(state)) {}
GroundFinder::GroundFinder(const GroundFinder& other)
    : GroundFinder(std::make_unique<State>(other.state_->mesh)) {}
GroundFinder& GroundFinder::operator=(const GroundFinder& other) {
  if (this != &other) state_ = std::make_unique<State>(other.state_->mesh);
  return *this;
}
GroundFinder::GroundFinder(GroundFinder&&) noexcept = default;
GroundFinder& GroundFinder::operator=(GroundFinder&&) noexcept = default;
GroundFinder::~GroundFinder() = default;

Result<GroundFinder> GroundFinder::create(const World& world, const PathConfig& config) {
  if (data_of(world) == nullptr) return Error{Errc::kBadInput, "path: the world is empty"};
  if (auto ok = check_class(data_of(world)->summary.classes, config.avatar_class, "path"); !ok)
    return ok.error();
  if (config.workers < 0) return Error{Errc::kBadConfig, "path: workers must be 0 or more"};
  if (!(config.slope_cost >= 0 && config.slope_cost <= 1000)) {
    return Error{Errc::kBadConfig, "path: slope_cost must be 0 to 1000"};
  }
  if (auto ok = refuse_settings(config, "path", true); !ok) return ok.error();
  return GroundFinder(std::make_unique<State>(world, config));
}

ChangeId GroundFinder::add_obstacle(Solid solid) {
  GroundView::Change change;
  change.solid = std::move(solid);
  return state_->mesh.add(std::move(change));
}

Result<void> check_area(uint8_t kind) {
  if (kind >= 1 && kind <= 63) return {};
  return Error{Errc::kBadConfig, "area: kind " + std::to_string(kind) + " is not one of 1 to 63"};
}

Result<void> check_area_cost(uint8_t kind, double cost) {
  if (auto ok = check_area(kind); !ok) return ok;
  if (cost >= 0.01 && (cost <= 10000 || std::isinf(cost))) return {};
  return Error{Errc::kBadConfig, "area: a cost must be 0.01 to 10000, or infinite"};
}

Result<void> check_link(const OffMeshLink& link) {
  if ((!link.from && !link.from_on_nodes) || (!link.to && !link.to_on_nodes)) {
    return Error{Errc::kBadInput, "off-mesh link: it must lead from a place to another"};
  }
  if (link.cost > 0 && std::isfinite(link.cost)) return {};
  return Error{Errc::kBadInput, "off-mesh link: its cost must be above 0"};
}

Result<ChangeId> GroundFinder::add_area(const Prism& prism, uint8_t kind) {
  if (auto ok = check_area(kind); !ok) return ok.error();
  if (auto ok = check_prism(prism); !ok) return ok.error();
  GroundView::Change change;
  change.solid.prism = prism;
  change.is_area = true;
  change.kind = kind;
  return state_->mesh.add(std::move(change));
}

Result<ChangeId> GroundFinder::add_off_mesh_link(const OffMeshLink& link) {
  if (auto ok = check_link(link); !ok) return ok.error();
  if (is_over_nodes(link)) {
    return Error{Errc::kBadInput, "off-mesh link: its ends are not on the ground"};
  }
  State& s = *state_;
  const world::WorldData& world = s.mesh.world();
  // As the ground was baked: what stands there now may be removed.
  const auto end_of = [&](const Place& place) -> std::optional<world::GroundPoint> {
    const auto at = world::ground_point(world, place);
    if (!at) return {};
    const world::GroundLevel level =
        world::ground_level(world, place.level1 - 1, s.mesh.avatar_class());
    const int32_t x = world::in_tile(at->cell_x()), z = world::in_tile(at->cell_z());
    const bool legal = world::WorldGround{world, s.mesh.avatar_class()}.is_legal(level, x, z);
    return legal ? at : std::nullopt;
  };
  const auto from = end_of(link.from), to = end_of(link.to);
  if (!from || !to) {
    return Error{Errc::kBadInput,
                 "off-mesh link: it must lead from a place of the class to another"};
  }
  const uint32_t from_level = link.from.level1 - 1, to_level = link.to.level1 - 1;
  const ChangeId id = s.mesh.add({});
  const double cost = link.cost / world.summary.cell;
  s.mesh.add_off_mesh_link(from_level, {id, *from, *to, to_level, cost});
  if (link.two_way) s.mesh.add_off_mesh_link(to_level, {id, *to, *from, from_level, cost});
  return id;
}

void GroundFinder::set_density(std::shared_ptr<const DensityCells> density) {
  state_->mesh.set_density(std::move(density));
}

bool GroundFinder::remove(ChangeId change) { return state_->mesh.set_active(change, false, true); }
bool GroundFinder::set_active(ChangeId change, bool active) {
  return state_->mesh.set_active(change, active, false);
}

Result<void> GroundFinder::set_area_cost(uint8_t kind, double cost) {
  if (auto ok = check_area_cost(kind, cost); !ok) return ok;
  state_->mesh.set_area_cost(kind, cost);
  return {};
}

uint64_t GroundFinder::version() const { return state_->mesh.version(); }

bool GroundFinder::is_free(const Place& place) {
  ViewStop stop;
  return state_->locate(place, stop);
}

bool GroundFinder::allows(const Path& path) {
  State& s = *state_;
  GroundView& mesh = s.mesh;
  ViewStop stop;
  if (path.points.empty() || !s.locate(path.points.front(), stop)) return false;
  const ViewCells cells(mesh);
  for (size_t i = 1; i < path.points.size(); ++i) {
    const auto from = world::ground_point(mesh.world(), path.points[i - 1]);
    const auto to = world::ground_point(mesh.world(), path.points[i]);
    if (!from || !to) return false;
    if (!mesh.is_changed_on(*from, *to)) continue;
    uint32_t level = path.points[i - 1].level1 - 1;
    if (!cells.walk(level, *from, *to) || level != path.points[i].level1 - 1) return false;
  }
  return true;
}

void GroundFinder::begin(const Place& from, const Place& to, IfUnreachable otherwise) {
  state_->begin(from, to);
  state_->otherwise = otherwise;
}

void GroundFinder::begin_over_points(const Place& from, const Place& to) {
  state_->begin(from, to, true);
}

void GroundFinder::State::begin(const Place& start, const Place& goal, bool over_points) {
  from_place = start;
  to_place = goal;
  searching = locate(start, from) && locate(goal, to);
  version = mesh.version();
  is_exact = !over_points && mesh.is_plain() && !mesh.has_links();
  exact_nodes = nodes_before = expanded = 0;
  was_flooded = false;
  if (!searching) return;
  if (is_exact) exact.begin(mesh.rects(), exact_stop(from), exact_stop(to));
  if (!is_exact) search.begin(mesh, from, to);
}

void GroundFinder::State::begin_over_points() {
  is_exact = false;
  search.begin(mesh, from, to);
}

Stop GroundFinder::State::exact_stop(const ViewStop& stop) {
  return {stop.at, mesh.level(stop.level)->first_rect + stop.rect};
}

bool GroundFinder::State::give_exactly(double length, Path& path) {
  const ViewCells cells(mesh);
  SegmentWalker walker(cells, mesh.rects());
  const Stop goal = exact_stop(to);
  if (!walker.walk(exact_stop(from), corners, goal.at, exact_stops) ||
      exact_stops.back().rect != goal.rect)
    return false;
  const world::WorldData& world = mesh.world();
  for (const Stop& stop : exact_stops) {
    const uint32_t level = mesh.rects().rects[stop.rect].level;
    path.points.push_back(world::place_at(world, mesh.level(level)->ground, stop.at));
  }
  path.segments.assign(path.points.size() - 1, SegmentKind::kWalk);
  path.length = path.cost = length * world.summary.cell;
  path.end = PathEnd::kReached;
  return true;
}

// Rectangle by rectangle, around both in turn.
bool GroundFinder::State::is_cut_off() {
  constexpr size_t kMaxRects = 1 << 14;  // around each
  flooded[0].assign(1, exact_stop(from).rect);
  flooded[1].assign(1, exact_stop(to).rect);
  const auto mark = [&](uint32_t rect, uint8_t side) {
    if (flooded_by.size() <= rect) flooded_by.resize(mesh.rects().rects.size());
    flooded_by[rect] = side;
  };
  mark(flooded[0][0], 1);
  mark(flooded[1][0], 2);
  bool ends = false, meets = flooded[0][0] == flooded[1][0];
  for (size_t n = 0; n < kMaxRects && !ends && !meets; ++n) {
    for (uint8_t side = 1; side <= 2; ++side) {
      std::vector<uint32_t>& around = flooded[side - 1u];
      ends = ends || n == around.size();
      if (ends) break;
      const auto [first, count] = mesh.portal_range(around[n]);
      for (const MeshPortal& portal : std::span(mesh.rects().portals).subspan(first, count)) {
        const uint8_t by = portal.rect < flooded_by.size() ? flooded_by[portal.rect] : uint8_t{0};
        meets = meets || (by != 0 && by != side);
        if (by != 0) continue;
        mark(portal.rect, side);
        around.push_back(portal.rect);
      }
    }
  }
  for (const std::vector<uint32_t>& around : flooded) {
    for (const uint32_t rect : around) flooded_by[rect] = 0;
  }
  return ends && !meets;
}

std::optional<bool> GroundFinder::State::advance_exactly(uint64_t max_bytes, Path& path) {
  // A goal that cannot be reached would have all of the ground searched, which takes several times
  // as long over intervals as over points.
  constexpr uint64_t kNodesBefore = 4096;
  double length = 0;
  if (!was_flooded) {
    const SearchBudget first(std::min(exact_nodes, kNodesBefore), nullptr, max_bytes);
    const SearchResult result = exact.advance(first, corners, length);
    const bool is_spent =
        result == SearchResult::kBudget && first.spent(exact.expanded()) == SpentBudget::kNodes;
    if (!is_spent || exact.expanded() <= kNodesBefore) {
      return end_exactly(result, first, length, path);
    }
    was_flooded = true;
    nodes_before = kNodesBefore;
    if (is_cut_off()) {
      if (otherwise == IfUnreachable::kNearest) return {};
      path.nodes = kNodesBefore;
      path.end = PathEnd::kUnreachable;
      searching = false;
      return true;
    }
  }
  const SearchBudget budget(exact_nodes, nullptr, max_bytes);
  const SearchResult result = exact.advance(budget, corners, length);
  return end_exactly(result, budget, length, path);
}

std::optional<bool> GroundFinder::State::end_exactly(SearchResult result,
                                                     const SearchBudget& budget, double length,
                                                     Path& path) {
  path.nodes = std::min(exact.expanded(), exact_nodes);
  if (result == SearchResult::kBudget && budget.spent(exact.expanded()) == SpentBudget::kNodes) {
    path.end = PathEnd::kBudgetExhausted;
    path.spent = SpentBudget::kNodes;
    return false;
  }
  nodes_before = path.nodes;
  if (result != SearchResult::kFound || !give_exactly(length, path)) return {};
  searching = false;
  return true;
}

bool GroundFinder::State::advance(uint64_t max_nodes, uint64_t max_bytes, Path& path) {
  reset(path);
  if (!searching) return true;
  if (is_exact) {
    exact_nodes += std::min(max_nodes, UINT64_MAX - exact_nodes);
    if (const auto ended = advance_exactly(max_bytes, path)) return *ended;
    // The goal is not reached, or not over corners, or that takes too much memory.
    begin_over_points();
    max_nodes = exact_nodes - std::min(exact_nodes, nodes_before);
  }
  const PointSearch::State result = search.advance(mesh, max_nodes, max_bytes);
  path.nodes = nodes_before + search.expanded();
  path.end = PathEnd::kBudgetExhausted;
  path.spent = SpentBudget::kNodes;
  if (result == PointSearch::State::kSearching) return false;
  searching = false;
  if (result == PointSearch::State::kFull) {
    path.spent = SpentBudget::kMemory;
    search.give_back();
    return true;
  }
  path.end = result == PointSearch::State::kFound ? PathEnd::kReached : PathEnd::kUnreachable;
  path.spent = SpentBudget::kNone;
  search.trace(mesh, stops);
  search.give_back();
  string.pull(mesh, stops);
  give(path);
  if (path.end == PathEnd::kUnreachable) set_blocker(blocker(stops.back(), to), path);
  return true;
}

bool GroundFinder::advance(uint64_t max_nodes, Path& path) {
  State& s = *state_;
  // What the search has reached may no longer exist.
  if (s.searching && s.version != s.mesh.version()) s.begin(s.from_place, s.to_place);
  return s.advance(max_nodes, SearchBudget::kDefaultBytes, path);
}

void GroundFinder::find(const Place& from, const Place& to, Path& path, const SearchBudget& budget,
                        IfUnreachable otherwise) {
  begin(from, to, otherwise);
  Slice all;
  state_->advance(budget, all, path);
}

void GroundFinder::find_over_points(const Place& from, const Place& to, Path& path,
                                    const SearchBudget& budget) {
  state_->begin(from, to, true);
  Slice all;
  state_->advance(budget, all, path);
}

// What clusters say of the cost of a path: at most 8 % more, where it is straight.
constexpr double kClusterError = 1.1;

bool GroundFinder::find_by_delays(const Place& from, const Place& to, const DelayedSearch& search,
                                  Path& path) {
  State& s = *state_;
  reset(path);
  s.searching = false;
  if (!s.locate(from, s.from) || !s.locate(to, s.to)) return false;
  if (s.clusters == nullptr)
    s.clusters = std::make_unique<ClusterSearch>(s.mesh.world().level_count);
  s.mesh.set_delays(search.delays);
  const double max_cost = search.max_cost / s.mesh.world().summary.cell;
  const Corridor* corridor =
      s.clusters->find(s.mesh, s.from, s.to, max_cost * kClusterError, search.max_clusters);
  PointSearch::State result =
      s.clusters->is_spent() ? PointSearch::State::kSearching : PointSearch::State::kNone;
  if (corridor != nullptr) {
    s.search.begin(s.mesh, s.from, s.to, max_cost, corridor);
    result = s.search.advance(s.mesh, search.budget.max_nodes, search.budget.max_bytes);
  }
  path.nodes = s.clusters->expanded() + (corridor == nullptr ? 0 : s.search.expanded());
  path.end = PathEnd::kUnreachable;
  if (result == PointSearch::State::kSearching || result == PointSearch::State::kFull) {
    path.end = PathEnd::kBudgetExhausted;
    path.spent = result == PointSearch::State::kFull ? SpentBudget::kMemory : SpentBudget::kNodes;
  }
  if (result == PointSearch::State::kFound) {
    path.end = PathEnd::kReached;
    s.search.trace(s.mesh, s.stops);
    s.string.pull(s.mesh, s.stops);
    s.give(path);
  }
  s.mesh.set_delays(nullptr);
  s.search.give_back();
  return result == PointSearch::State::kFound;
}

double GroundFinder::delayed_length(const Place& from, const Place& to,
                                    const GroundDelays& delays) {
  State& s = *state_;
  ViewStop start, end;
  if (!s.locate(from, start) || !s.locate(to, end)) return std::numeric_limits<double>::infinity();
  s.mesh.set_delays(&delays);
  const double cost = segment_cost(s.mesh, start, end);
  s.mesh.set_delays(nullptr);
  return cost * s.mesh.world().summary.cell;
}

bool GroundFinder::advance(const SearchBudget& budget, Slice& slice, Path& path) {
  State& s = *state_;
  if (s.searching && s.version != s.mesh.version()) s.begin(s.from_place, s.to_place);
  return s.advance(budget, slice, path);
}

bool GroundFinder::State::advance(const SearchBudget& budget, Slice& slice, Path& path) {
  constexpr uint64_t kStride = 64;  // between looks at `cancel`
  while (true) {
    if (budget.cancel != nullptr && *budget.cancel) {
      reset(path);
      path.nodes = expanded;
      path.end = PathEnd::kBudgetExhausted;
      path.spent = SpentBudget::kCancelled;
      return true;
    }
    uint64_t part = std::min(slice.left, budget.max_nodes - std::min(budget.max_nodes, expanded));
    if (budget.cancel != nullptr) part = std::min(part, kStride);
    const bool ended = advance(part, budget.max_bytes, path);
    slice.take(ended ? path.nodes - expanded : part);
    expanded += part;
    if (ended || expanded >= budget.max_nodes) return true;
    if (slice.is_empty()) return false;
  }
}

}  // namespace throng::path
