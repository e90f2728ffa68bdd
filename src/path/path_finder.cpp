// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <memory>
#include <string>
#include <utility>

#include "core/access.h"
#include "core/check_class.h"
#include "path/edits/ground_finder_state.h"
#include "path/edits/nearest_cell.h"
#include "path/ground/blocker.h"
#include "path/ground/reset_path.h"
#include "path/path_finder_state.h"
#include "world/place.h"
#include "world/zone_data.h"

// Chooses the search that fits a class and what is put up in its world.
namespace throng {
namespace {

constexpr double kMinSpacing = 0.01;  // [m]

Vec3d position_of(const PathPoint& point) {
  if (const auto* place = std::get_if<Place>(&point)) return place->position;
  if (const auto* place = std::get_if<NodePlace>(&point)) return place->feet;
  return std::get<Vec3d>(point);
}

// A place that is nowhere.
bool is_nowhere(const PathPoint& point) {
  if (const auto* place = std::get_if<Place>(&point)) return !*place;
  if (const auto* place = std::get_if<NodePlace>(&point)) return !*place;
  return false;
}

PathSpace space_of(const AvatarClass& avatar, PathSpace asked) {
  if (asked != PathSpace::kOfClass) return asked;
  if (avatar.flies) return PathSpace::kAir;
  return goes_over_nodes(avatar) ? PathSpace::kNodes : PathSpace::kGround;
}

// Of a path that leads to the nearest place, if that was not asked for.
void forget_points(Path& path) {
  const uint64_t nodes = path.nodes;
  path::reset(path);
  path.end = PathEnd::kUnreachable;
  path.nodes = nodes;
}

path::IfUnreachable otherwise_of(const PathQuery& query) {
  return query.nearest ? path::IfUnreachable::kNearest : path::IfUnreachable::kNothing;
}

// For a path on the ground between places: no search of the mesh knows costs.
bool needs_mesh(const PathConfig& config) {
  return config.speedup != PathSpeedup::kOnDemand &&
         (config.slope_cost == 0 || config.speedup != PathSpeedup::kNone);
}

// Of the finder of ground with edits, whose data is made on demand.
PathConfig live_config(const PathConfig& config) {
  return {.avatar_class = config.avatar_class,
          .slope_cost = config.slope_cost,
          .workers = config.workers,
          .counts_ground = config.counts_ground};
}

}  // namespace

const path::EditList& PathFinder::State::edits() const { return *Access::state(config.edits); }

path::GroundFinder& PathFinder::State::ground() {
  if (!live) {
    auto made = path::GroundFinder::create(world, live_config(config));
    THRONG_ASSERT(made);  // The settings were checked.
    live = *std::move(made);
  }
  applied.follow(edits(), *live);
  return *live;
}

path::GroundFinder PathFinder::State::ground_of_its_own() const {
  const bool on_ground = config.space == PathSpace::kGround;
  PathConfig settings = live_config(config);
  if (!on_ground) settings.slope_cost = 0;
  auto made = on_ground && live ? Result<path::GroundFinder>(*live)
                                : path::GroundFinder::create(world, settings);
  THRONG_ASSERT(made);
  path::AppliedEdits known = on_ground && live ? applied : path::AppliedEdits();
  known.follow(edits(), *made);
  return *std::move(made);
}

PathFinder::PathFinder(std::unique_ptr<State> state) : state_(std::move(state)) {}
PathFinder::PathFinder(const PathFinder& other) : state_(std::make_unique<State>(*other.state_)) {
  state_->is_disturbed = true;  // What a query in parts has found is not copied.
}
PathFinder& PathFinder::operator=(const PathFinder& other) {
  if (this != &other) *this = PathFinder(other);
  return *this;
}
PathFinder::PathFinder(PathFinder&&) noexcept = default;
PathFinder& PathFinder::operator=(PathFinder&&) noexcept = default;
PathFinder::~PathFinder() = default;

Result<PathFinder> PathFinder::create(const World& world, const PathConfig& config,
                                      Context& context) {
  if (data_of(world) == nullptr) return Error{Errc::kBadInput, "path: the world is empty"};
  const auto& classes = data_of(world)->summary.classes;
  if (auto ok = check_class(classes, config.avatar_class, "path"); !ok) return ok.error();
  auto state = std::make_unique<State>();
  State& s = *state;
  s.world = world;
  s.config = config;
  s.config.space = space_of(classes[static_cast<size_t>(config.avatar_class)], config.space);
  if (s.config.space != PathSpace::kNodes && !(config.narrow_cost == 0 && config.low_cost == 0)) {
    return Error{Errc::kBadConfig, "path: narrow_cost and low_cost are for paths over nodes"};
  }
  if (s.config.space == PathSpace::kAir) {
    auto made = path::FlightFinder::create(world, config, context);
    if (!made) return made.error();
    s.flight = *std::move(made);
    s.summary = s.flight->summary();
  } else if (s.config.space == PathSpace::kNodes) {
    if (!s.config.nodes) {
      auto nodes = Nodes::open(world);
      if (!nodes) return nodes.error();
      s.config.nodes = *std::move(nodes);
    }
    auto made = path::NodeFinder::create(s.config.nodes, config, context);
    if (!made) return made.error();
    s.nodes = *std::move(made);
    s.summary = s.nodes->summary();
  } else {
    auto live = path::GroundFinder::create(world, live_config(config));  // Reads nothing yet.
    if (!live) return live.error();
    if (needs_mesh(config)) {
      auto made = path::MeshFinder::create(world, config, context);
      if (!made) return made.error();
      s.mesh = *std::move(made);
      s.summary = s.mesh->summary();
    } else {
      s.live = *std::move(live);
    }
  }
  return PathFinder(std::move(state));
}

PathSummary PathFinder::summary() const { return state_->summary; }

Place PathFinder::State::place_of(const PathPoint& point, double tolerance) const {
  if (const auto* place = std::get_if<Place>(&point)) return *place;
  if (is_nowhere(point)) return {};
  return world.find_place(config.avatar_class, position_of(point), tolerance);
}

NodePlace PathFinder::State::node_place_of(const PathPoint& point, double tolerance) {
  if (const auto* place = std::get_if<NodePlace>(&point)) return *place;
  if (is_nowhere(point)) return {};
  return nodes->find_place(position_of(point), tolerance);
}

void PathFinder::State::find_on_ground(const Place& from, const Place& to,
                                       path::IfUnreachable otherwise, const SearchBudget& budget,
                                       Path& path) {
  trim_ground(budget);
  if (!is_apart(from, to)) return find_connected(from, to, otherwise, budget, path);
  path::reset(path);
  if (!are_free(from, to)) return;
  path.end = PathEnd::kUnreachable;
  if (otherwise == path::IfUnreachable::kNothing) return;
  if (const Place nearest = nearest_connected(from, to)) {
    find_connected(from, nearest, path::IfUnreachable::kNothing, budget, path);
    if (path.end == PathEnd::kReached) return end_before(to, path);
    if (path.end != PathEnd::kUnreachable) return;
  }
  // Obstacles have cut that off.
  const uint64_t spent = path.nodes;
  is_disturbed = true;
  ground().find_over_points(from, to, path, budget.after(spent));
  path.nodes += spent;
}

void PathFinder::State::find_connected(const Place& from, const Place& to,
                                       path::IfUnreachable otherwise, const SearchBudget& budget,
                                       Path& path) {
  uint64_t spent = 0;
  if (mesh && !edits().may_shorten_paths(baked_kinds())) {
    // Obstacles only remove ground: the shortest path of the baked ground that can still be walked
    // is the shortest.
    mesh->find(from, to, path, budget);
    if (path.end == PathEnd::kReached && (!bears_on_ground() || ground().allows(path))) return;
    if (path.end == PathEnd::kBudgetExhausted) return;
    spent = path.nodes;
  }
  is_disturbed = true;
  ground().find(from, to, path, budget.after(spent), otherwise);
  path.nodes += spent;
  if (path.end == PathEnd::kUnreachable && otherwise == path::IfUnreachable::kNothing)
    forget_points(path);
}

bool PathFinder::State::is_apart(const Place& from, const Place& to) const {
  if (!mesh || edits().may_connect()) return false;
  const uint32_t a = mesh->component(from), b = mesh->component(to);
  return a != path::kNoRect && b != path::kNoRect && a != b;
}

bool PathFinder::State::are_free(const Place& from, const Place& to) {
  return !bears_on_ground() || (ground().is_free(from) && ground().is_free(to));
}

Place PathFinder::State::nearest_connected(const Place& from, const Place& to) {
  path::GroundView* view = bears_on_ground() ? &ground().state().mesh : nullptr;
  const world::WorldData& data = *data_of(world);
  const path::PathMesh& rects = mesh->mesh();
  const auto nearest =
      path::nearest_of_component(data, rects, view, mesh->component(from), *mesh->stop(to));
  if (!nearest) return {};
  const uint32_t level = rects.rects[nearest->rect].level;
  return world::place_at(data, world::ground_level(data, level, config.avatar_class), nearest->at);
}

void PathFinder::State::end_before(const Place& to, Path& path) {
  path.end = PathEnd::kUnreachable;
  const Place& last = path.points.back();
  // Not ground(), which follows edits: a query in parts may have stopped to.
  if (bears_on_ground() && live) return path::set_blocker(live->blocker(last, to), path);
  path.blocked_by = path::blocker_towards({*data_of(world), config.avatar_class}, last, to);
}

void PathFinder::State::find_over_nodes(const PathQuery& query, Path& path) {
  is_disturbed = true;
  begin_over_nodes(query);
  path::Slice all;
  nodes->advance(all, path);
}

void PathFinder::State::begin_over_nodes(const PathQuery& query) {
  applied.follow(edits(), *nodes);
  nodes->begin(node_place_of(query.from, query.tolerance), node_place_of(query.to, query.tolerance),
               std::max(kMinSpacing, query.spacing), query.budget);
}

void PathFinder::State::find_in_air(const PathQuery& query, Path& path) {
  is_disturbed = true;
  path::reset(path);
  if (is_nowhere(query.from) || is_nowhere(query.to)) return;
  begin_in_air(query);
  path::Slice all;
  flight->advance(all, path);
}

void PathFinder::State::begin_in_air(const PathQuery& query) {
  applied.follow(edits(), *flight);
  flight->begin({.from = position_of(query.from),
                 .to = position_of(query.to),
                 .vertical_tolerance = query.tolerance,
                 .budget = query.budget,
                 .by_turns = query.by_turns,
                 .nearest = query.nearest});
}

void PathFinder::find(const PathQuery& query, Path& path) {
  State& s = *state_;
  if (s.config.space == PathSpace::kAir) {
    s.find_in_air(query, path);
  } else if (s.config.space == PathSpace::kNodes) {
    s.find_over_nodes(query, path);
  } else {
    s.find_on_ground(s.place_of(query.from, query.tolerance), s.place_of(query.to, query.tolerance),
                     otherwise_of(query), query.budget, path);
  }
  path.blocked_by_edit = s.applied.edit_of(path.blocked_by_edit);
}

void PathFinder::find(const Place& from, const Place& to, Path& path, const SearchBudget& budget) {
  find({.from = from, .to = to, .budget = budget}, path);
}

void PathFinder::begin(const PathQuery& query) {
  state_->begun = query;
  state_->restarts = 0;
  state_->begin();
}

void PathFinder::State::begin() {
  is_begun = true;
  is_disturbed = false;
  begun_nodes = 0;
  if (config.space == PathSpace::kNodes) {
    begin_over_nodes(begun);
  } else if (config.space == PathSpace::kGround) {
    begin_on_ground();
  } else if (is_nowhere(begun.from) || is_nowhere(begun.to)) {
    is_begun = false;  // A query from or to nowhere ends at once.
  } else {
    begin_in_air(begun);
  }
  begun_version = edits().version();
  begun_finder = finder_version();
}

void PathFinder::State::follow_edits() {
  if (flight) {
    applied.follow(edits(), *flight);
  } else if (nodes) {
    applied.follow(edits(), *nodes);
  } else {
    ground();
  }
}

uint64_t PathFinder::State::finder_version() const {
  if (flight) return flight->version();
  if (nodes) return nodes->version();
  return live ? live->version() : 0;
}

void PathFinder::State::follow_edits_to_look_up() {
  if (is_begun && !is_disturbed && restarts == kMaxRestarts) return;
  follow_edits();
}

bool PathFinder::State::are_on_ground() {
  if (!live) return true;
  // While the costs of all kinds are 1, areas change nothing.
  bool has_costs = edits().costly_kinds != 0;
  for (uint8_t kind = 1; kind < edits().area_costs.size(); ++kind)
    has_costs = has_costs || live->state().mesh.area_cost(kind) != 1;
  bool found = false;
  edits().for_changed(begun_version, [&](const path::EditList::Changed& what) {
    if (found) return;
    if (what.edit == 0) {
      found = is_cost_on_ground(what.area);
      return;
    }
    const path::EditList::Edit& edit = edits().edits[what.edit - 1];
    if (!edit.bears_on_paths()) return;
    if (edit.kind == path::EditList::Kind::kOffMeshLink) {
      found = !path::is_over_nodes(edit.link);
    } else {
      found = (edit.is_obstacle() || has_costs) && is_on_ground(what.edit);
    }
  });
  return found;
}

// Which kinds the bake gave is known from a mesh alone: `live` has read only a part of the ground.
bool PathFinder::State::is_cost_on_ground(uint8_t kind) {
  const path::GroundView& view = live->state().mesh;
  if (view.area_cost(kind) == edits().area_costs[kind]) return false;
  if (!mesh || (baked_kinds() >> kind & 1) != 0) return true;
  const std::vector<path::EditList::Edit>& all = edits().edits;
  for (EditId id = 1; id <= all.size(); ++id) {
    const path::EditList::Edit& edit = all[id - 1];
    if (edit.kind == path::EditList::Kind::kArea && edit.area == kind && is_on_ground(id))
      return true;
  }
  return false;
}

// Where a change was is known from the finder, which may not have applied it yet.
bool PathFinder::State::is_on_ground(EditId id) {
  const path::GroundView& view = live->state().mesh;
  const path::EditList::Edit& edit = edits().edits[id - 1];
  const path::ChangeId own = applied.own(id);
  const bool was = own != 0 && view.change(own).active;
  return (was && view.touches(view.change(own).solid, !edit.is_obstacle())) ||
         (edit.active && view.touches(edit.solid(), !edit.is_obstacle()));
}

bool PathFinder::State::must_begin_again() {
  if (is_disturbed) return true;
  if (finder_version() != begun_finder) {
    // A look-up has followed edits, or a path that was found without a search of this finder.
    restarts = std::min(restarts + 1, kMaxRestarts);
    return true;
  }
  if (begun_version == edits().version() || restarts == kMaxRestarts) return false;
  const bool concern = config.space != PathSpace::kGround || are_on_ground();
  begun_version = edits().version();
  if (!concern) return false;
  follow_edits();
  // What the search leads to, if it is not the goal, was found without its ground.
  if (finder_version() == begun_finder && (!live || target == Target::kGoal)) return false;
  ++restarts;
  return true;
}

bool PathFinder::advance(uint64_t max_nodes, Path& path) {
  State& s = *state_;
  path::reset(path);
  if (!s.is_begun) return true;
  if (s.must_begin_again()) s.begin();
  const std::atomic<bool>* cancel = s.begun.budget.cancel;
  if (cancel != nullptr && *cancel) {
    path.nodes = s.begun_nodes;
    path.end = PathEnd::kBudgetExhausted;
    path.spent = SpentBudget::kCancelled;
    s.is_begun = false;
    return true;
  }
  path::Slice slice{max_nodes};
  s.is_begun = !s.advance(slice, path);
  path.blocked_by_edit = s.applied.edit_of(path.blocked_by_edit);
  s.begun_nodes = path.nodes;
  return !s.is_begun;
}

bool PathFinder::State::advance(path::Slice& slice, Path& path) {
  if (config.space == PathSpace::kAir) return flight->advance(slice, path);
  if (config.space == PathSpace::kNodes) return nodes->advance(slice, path);
  return advance_on_ground(slice, path);
}

// Here, where every query begins that may make ground: in parts or at once.
void PathFinder::State::trim_ground(const SearchBudget& budget) {
  if (live) live->state().mesh.trim(budget.max_bytes / 2);
}

void PathFinder::State::begin_on_ground() {
  trim_ground(begun.budget);
  begun_from = place_of(begun.from, begun.tolerance);
  begun_to = place_of(begun.to, begun.tolerance);
  nodes_before = 0;
  target = Target::kGoal;
  if (!is_apart(begun_from, begun_to) || !are_free(begun_from, begun_to)) {
    return ground().begin(begun_from, begun_to, otherwise_of(begun));
  }
  target = Target::kNothing;
  if (!begun.nearest) return;
  const Place nearest = nearest_connected(begun_from, begun_to);
  target = nearest ? Target::kNearest : Target::kFlood;
  if (nearest) return ground().begin(begun_from, nearest, path::IfUnreachable::kNothing);
  ground().begin_over_points(begun_from, begun_to);
}

bool PathFinder::State::advance_on_ground(path::Slice& slice, Path& path) {
  if (target == Target::kNothing) {
    path::reset(path);
    path.end = PathEnd::kUnreachable;
    return true;
  }
  if (target == Target::kNearest) {
    if (!live->advance(begun.budget, slice, path)) return false;
    if (path.end == PathEnd::kReached) {
      end_before(begun_to, path);
      return true;
    }
    if (path.end != PathEnd::kUnreachable) return true;
    // Obstacles have cut that off.
    target = Target::kFlood;
    nodes_before = path.nodes;
    live->begin_over_points(begun_from, begun_to);
  }
  const bool ended = live->advance(begun.budget.after(nodes_before), slice, path);
  path.nodes += nodes_before;
  if (!ended) return false;
  if (path.end == PathEnd::kUnreachable && !begun.nearest) forget_points(path);
  return true;
}

bool PathFinder::is_free(const PathPoint& end, double tolerance) {
  State& s = *state_;
  if (is_nowhere(end)) return false;
  s.follow_edits_to_look_up();
  if (s.flight) return s.flight->is_end(position_of(end), tolerance);
  if (s.nodes) return s.nodes->is_free(s.node_place_of(end, tolerance));
  const Place place = s.place_of(end, tolerance);
  return place && s.live->is_free(place);
}

NodePlace PathFinder::find_node_place(const Vec3d& position, double search_radius) {
  State& s = *state_;
  if (!s.nodes) return {};
  s.follow_edits_to_look_up();
  return s.nodes->find_place(position, search_radius);
}

std::optional<Vec3d> PathFinder::take_off(const Place& place) {
  State& s = *state_;
  if (!s.flight || !place) return {};
  s.follow_edits_to_look_up();
  return s.flight->take_off(place);
}

Place PathFinder::landing(const Vec3d& feet) {
  State& s = *state_;
  if (!s.flight) return {};
  s.follow_edits_to_look_up();
  return s.flight->landing(feet);
}

std::optional<Vec3d> PathFinder::random_point(uint64_t seed, uint64_t n) {
  State& s = *state_;
  if (s.flight) {
    s.follow_edits_to_look_up();
    return s.flight->random_point(seed, n);
  }
  if (s.nodes) {
    const NodePlace place = s.config.nodes.random_place(s.config.avatar_class, seed, n);
    return place ? std::optional(place.feet) : std::nullopt;
  }
  const Place place = s.world.random_place(s.config.avatar_class, seed, n);
  return place ? std::optional(place.position) : std::nullopt;
}

}  // namespace throng
