// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "path/air/flight_finder.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iterator>
#include <string>
#include <utility>

#include "core/access.h"
#include "core/check_class.h"
#include "core/random.h"
#include "path/air/flight_finder_state.h"
#include "path/ground/reset_path.h"

// Joins the parts of a flight: walks, take-offs, flight search, landings and string pulling. Time:
// mostly of the flight search, n log n in the air boxes that it expands; an end that must walk to a
// take-off adds a flood over kMaxFloodCells cells at most. Where obstacles block a path all of it
// is tried again, kMaxTries times at most.
namespace throng::path {
namespace {

constexpr int32_t kLargestBox = 32;  // voxels: larger ones hide good paths

}  // namespace

bool FlightFinder::Scratch::find_link(const Shared& shared, const AirView& air_now, End& end,
                                      uint32_t component, bool& budget_exhausted) {
  if (!end.ground) return end.air.has_value();
  const FlightEndpoints ends = shared.ends(air_now);
  end.ground_air_link = end.ground;
  end.air = ends.take_off(end.ground_air_link);
  if (end.air &&
      (component == kNoBox || air_now.component(air_now.box_at(*end.air)) == component)) {
    return true;
  }
  end.air.reset();
  const uint32_t ground_part = shared.ground_of(end.ground);
  const bool leads = component == kNoBox
                         ? !shared.ground_air_links.air_over(ground_part).empty()
                         : shared.ground_air_links.joins(ground_part, air_now.baked(component));
  if (!leads) return false;
  const FlightLog::Entry& nearest = nearest_take_off(ends, end.ground, component);
  is_flood_cut = is_flood_cut || nearest.budget_exhausted;
  budget_exhausted = budget_exhausted || nearest.budget_exhausted;
  end.ground_air_link = nearest.place;
  end.air = ends.take_off(end.ground_air_link);
  return end.air.has_value();
}

const FlightLog::Entry& FlightFinder::Scratch::nearest_take_off(const FlightEndpoints& ends,
                                                                const Place& from,
                                                                uint32_t component) {
  FlightLog::Entry& entry = log.next();
  if (entry.is_done) return entry;
  if (!entry.is_begun) entry.nodes = 0;
  entry.is_begun = true;
  Slice& slice = log.slice();
  const uint64_t cells = kFloodCells * std::min(slice.left, kMaxFloodCells);
  FlightEndpoints::FloodPart part{.visited = entry.nodes, .left = cells};
  const auto nearest = ends.nearest_take_off(from, kMaxFloodCells, component, flood, part);
  slice.take((cells - part.left) / kFloodCells);
  entry.nodes = part.visited;
  entry.is_done = part.is_done;
  entry.place = part.is_done ? nearest.place : Place{};
  entry.budget_exhausted = part.is_done && nearest.budget_exhausted;
  if (!part.is_done) log.set_pending();
  return entry;
}

uint32_t FlightFinder::Scratch::common_air(const Shared& shared, const AirView& air_now,
                                           const End& a, const End& b, const SearchBudget& budget,
                                           bool& budget_exhausted) {
  const FlightEndpoints ends = shared.ends(air_now);
  const auto over_a = shared.ground_air_links.air_over(shared.ground_of(a.ground));
  const auto over_b = shared.ground_air_links.air_over(shared.ground_of(b.ground));
  common.clear();
  std::set_intersection(over_a.begin(), over_a.end(), over_b.begin(), over_b.end(),
                        std::back_inserter(common));
  if (common.empty()) return kNoBox;
  if (common.size() < 2 && !is_changed()) return common[0];
  if (is_cancelled(budget)) {
    budget_exhausted = true;
    return kNoBox;
  }
  const std::vector<uint32_t>& over_from = components_over(ends, a.ground);
  const std::vector<uint32_t>& over_to = components_over(ends, b.ground);
  size_t least = SIZE_MAX;
  uint32_t best = common[0];
  for (size_t i = 0; i < over_from.size(); ++i) {
    const auto found = std::find(over_to.begin(), over_to.end(), over_from[i]);
    const size_t rank = i + static_cast<size_t>(found - over_to.begin());
    if (found == over_to.end() || rank >= least) continue;
    least = rank;
    best = over_from[i];
  }
  return best;
}

FlightFinder::FlightFinder(std::shared_ptr<const Shared> shared)
    : state_(std::move(shared)), scratch_(std::make_unique<Scratch>(*state_)) {}
FlightFinder::FlightFinder(const FlightFinder& other) : FlightFinder(other.state_) {
  scratch_->changes = other.scratch_->changes;
}
FlightFinder& FlightFinder::operator=(const FlightFinder& other) {
  if (this != &other) *this = FlightFinder(other);
  return *this;
}
FlightFinder::FlightFinder(FlightFinder&&) noexcept = default;
FlightFinder& FlightFinder::operator=(FlightFinder&&) noexcept = default;
FlightFinder::~FlightFinder() = default;

Result<FlightFinder> FlightFinder::create(const World& world, const PathConfig& config,
                                          Context& context) {
  if (data_of(world) == nullptr) return Error{Errc::kBadInput, "flight: the world is empty"};
  const world::WorldData& data = *data_of(world);
  if (auto ok = world::check_air_index(data); !ok) return ok.error();
  if (data.air == nullptr) {
    return Error{Errc::kNotFound,
                 "flight: the world was baked without air; bake it with --air or with a class that "
                 "flies"};
  }
  if (auto ok = check_class(data.summary.classes, config.avatar_class, "flight"); !ok)
    return ok.error();
  if (config.workers < 0) return Error{Errc::kBadConfig, "flight: workers must be 0 or more"};
  if (auto ok = refuse_settings(config, "flight", false); !ok) return ok.error();
  const AvatarClass& avatar = data.summary.classes[static_cast<size_t>(config.avatar_class)];
  if (!avatar.flies) {
    return Error{Errc::kBadConfig, "flight: class " + avatar.name +
                                       " does not fly; say `flies = true` in the classes' file"};
  }
  const auto start = std::chrono::steady_clock::now();
  if (auto ok = world.check_all(); !ok) return ok.error();
  auto shared = std::make_shared<Shared>();
  shared->body = world::air_body(avatar, data.air->shape);
  auto space = build_flight_space(*data.air, shared->body, kLargestBox, config.workers, context);
  if (!space) return space.error();
  shared->world = world;
  shared->avatar_class = config.avatar_class;
  shared->space = std::move(*space);
  shared->cells_before.reserve(shared->space.boxes.size() + 1);
  shared->cells_before.push_back(0);
  for (const world::AirCube& box : shared->space.boxes) {
    const auto side = static_cast<uint64_t>(box.side);
    shared->cells_before.push_back(shared->cells_before.back() + side * side * side);
  }
  if (data.level_count > 0) {
    auto walker = MeshFinder::create(
        world, {.avatar_class = config.avatar_class, .workers = config.workers}, context);
    if (!walker) return walker.error();
    shared->walker = std::move(*walker);
    shared->ground_air_links =
        GroundAirLinks(data, shared->walker->mesh(), shared->space, config.workers);
  }
  if (AirLinks::exist(world)) {
    const auto nodes = Nodes::open(world);
    if (!nodes) return nodes.error();
    auto links = AirLinks::open(*nodes);
    if (!links) return links.error();
    if (auto ok = links->check_all(); !ok) return ok.error();
    shared->links = *std::move(links);
  }
  shared->summary.boxes = shared->space.boxes.size();
  shared->summary.bytes = shared->space.bytes() + shared->cells_before.size() * sizeof(uint64_t) +
                          shared->ground_air_links.bytes() +
                          (shared->walker ? shared->walker->summary().bytes : 0);
  shared->summary.seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return FlightFinder(std::move(shared));
}

PathSummary FlightFinder::summary() const { return state_->summary; }
const FlightSpace& FlightFinder::space() const { return state_->space; }

ChangeId FlightFinder::add_obstacle(Solid solid) {
  return scratch_->add(*state_, std::move(solid));
}

bool FlightFinder::set_active(ChangeId change, bool active) {
  Scratch& scratch = *scratch_;
  if (!scratch.changes || !scratch.changes->set_active(change, active)) return false;
  if (scratch.live) scratch.live->set_active(scratch.live_ids[change - 1], active);
  return true;
}

bool FlightFinder::remove(ChangeId change) {
  Scratch& scratch = *scratch_;
  if (!scratch.changes || !scratch.changes->remove(change)) return false;
  if (scratch.live) scratch.live->remove(scratch.live_ids[change - 1]);
  return true;
}

uint64_t FlightFinder::version() const {
  const Scratch& scratch = *scratch_;
  return (scratch.changes ? scratch.changes->version() : 0) +
         (scratch.live ? scratch.live->version() - scratch.live_began : 0);
}

bool FlightFinder::is_end(Vec3d at, double vertical_tolerance) const {
  End end;
  return locate(at, vertical_tolerance, end);
}

bool FlightFinder::is_legal(Vec3d feet) const {
  return state_->ends(scratch_->air(*state_)).in_air(feet).has_value();
}

bool FlightFinder::is_cut_off(Vec3d from, Vec3d to) const {
  const AirView air = scratch_->air(*state_);
  const FlightEndpoints ends = state_->ends(air);
  const auto a = ends.in_air(from), b = ends.in_air(to);
  return a && b && !air.same_component(*a, *b);
}

std::optional<Vec3d> FlightFinder::random_point(uint64_t seed, uint64_t n) const {
  const std::vector<uint64_t>& before = state_->cells_before;
  if (before.back() == 0) return {};
  const AirView air = scratch_->air(*state_);
  const FlightEndpoints ends = state_->ends(air);
  const auto draw = [&](const world::AirCube& cube, uint64_t first) {
    const auto part = [&](uint64_t i) {
      return kAirSkin + random_unit(seed, n, first + i) * (cube.side - 2 * kAirSkin);
    };
    return AirPoint{cube.x + part(1), cube.y + part(2), cube.z + part(3)};
  };
  // What obstacles have blocked is drawn again. Where hardly anything is left, it is searched.
  constexpr uint64_t kDraws = 256;
  size_t box = 0;
  for (uint64_t i = 0; i < kDraws; ++i) {
    const uint64_t pick = random_below(seed, n, 4 * i, before.back());
    box = static_cast<size_t>(std::upper_bound(before.begin(), before.end(), pick) -
                              before.begin() - 1);
    const AirPoint p = draw(state_->space.boxes[box], 4 * i);
    if (air.changes() == nullptr || air.box_at(p) != kNoBox) return ends.to_metres(p);
  }
  std::optional<AirPoint> found;
  for (size_t i = 0; i < state_->space.boxes.size() && !found; ++i) {
    air.for_pieces(static_cast<uint32_t>((box + i) % state_->space.boxes.size()),
                   [&](uint32_t piece) {
                     if (!found) found = draw(air.cube(piece), 4 * kDraws);
                   });
  }
  if (!found) return {};
  return ends.to_metres(*found);
}

std::optional<Vec3d> FlightFinder::take_off(const Place& place) const {
  const FlightEndpoints ends = state_->ends(scratch_->air(*state_));
  const auto up = ends.take_off(place);
  if (!up) return {};
  return ends.to_metres(*up);
}

Place FlightFinder::landing(Vec3d feet) const {
  const AirView air = scratch_->air(*state_);
  const FlightEndpoints ends = state_->ends(air);
  const auto point = ends.in_air(feet);
  if (!point) return {};
  if (const Place linked = state_->linked_from(air, *point)) return linked;
  return ends.best_landing(ends.lowest_box(*point));
}

void FlightFinder::find(const FlightQuery& query, Path& path) {
  begin(query);
  Slice all;
  advance(all, path);
}

void FlightFinder::begin(const FlightQuery& query) {
  scratch_->begun = query;
  scratch_->taken = 0;
  scratch_->log.begin();
}

bool FlightFinder::advance(Slice& slice, Path& path) {
  Scratch& scratch = *scratch_;
  const FlightQuery& query = scratch.begun;
  const uint64_t before = slice.left;
  scratch.log.begin_part(slice);
  scratch.spent = SpentBudget::kNodes;
  scratch.expanded = 0;
  scratch.is_flood_cut = false;
  reset(path);
  if (!is_cancelled(query)) find_flight(query, path);
  // A flood on foot that was cut short says nothing about paths that land in between.
  const bool is_cut =
      scratch.is_flood_cut && !scratch.log.is_pending() && path.end == PathEnd::kBudgetExhausted;
  if (query.by_turns && (is_cut || path.end == PathEnd::kUnreachable)) find_by_turns(query, path);
  if (is_cut && path.end == PathEnd::kUnreachable) path.end = PathEnd::kBudgetExhausted;
  if (query.nearest && path.end == PathEnd::kUnreachable) find_nearest(query, path);
  scratch.taken += before - slice.left;
  // What was not found may exist all the same.
  const bool is_stopped = is_cancelled(query) && path.end != PathEnd::kReached;
  if (is_stopped || scratch.log.is_pending()) {
    reset(path);
    path.nodes = scratch.taken;
    path.end = PathEnd::kBudgetExhausted;
    path.spent = is_stopped ? SpentBudget::kCancelled : SpentBudget::kNodes;
    if (is_stopped) scratch.search.give_back();
    return is_stopped;
  }
  if (path.end == PathEnd::kBudgetExhausted) path.spent = scratch.spent;
  path.nodes = scratch.expanded;
  path.cost = path.length;
  scratch.search.give_back();
  return true;
}

bool FlightFinder::is_cancelled(const FlightQuery& query) {
  return query.budget.cancel != nullptr && *query.budget.cancel;
}

bool FlightFinder::locate(Vec3d at, double vertical_tolerance, End& end) const {
  const FlightEndpoints ends = state_->ends(scratch_->air(*state_));
  end.air = ends.in_air(at);
  if (end.air) return true;
  end.ground = state_->world.find_place(state_->avatar_class, at, vertical_tolerance);
  return end.ground && ends.may_stand(end.ground);
}

const Path& FlightFinder::walk(const FlightQuery& query, const Place& from, const Place& to) {
  Scratch& scratch = *scratch_;
  FlightLog::Entry& entry = scratch.log.next();
  Path& path = entry.walk;
  const SearchBudget left = query.budget.after(scratch.expanded);
  const bool is_changed = scratch.is_changed();
  if (!entry.is_begun) {
    entry.is_begun = true;
    reset(path);
    if (is_cancelled(query)) {
      path.end = PathEnd::kBudgetExhausted;
      path.spent = SpentBudget::kCancelled;
      entry.is_done = true;
    } else if (!is_changed) {
      scratch.walker->begin(from, to);
    } else if (state_->ground_of(from) != state_->ground_of(to)) {
      path.end = PathEnd::kUnreachable;
      entry.is_done = true;
    } else {
      scratch.ground(*state_).begin(from, to);
    }
  }
  if (!entry.is_done) {
    Slice& slice = scratch.log.slice();
    entry.is_done = is_changed ? scratch.ground(*state_).advance(left, slice, path)
                               : scratch.walker->advance(left, slice, path);
    if (!entry.is_done) scratch.log.set_pending();
  }
  if (path.end == PathEnd::kBudgetExhausted) scratch.spent = path.spent;
  // A search counts the node that was too many.
  scratch.expanded += std::min(path.nodes, left.max_nodes);
  return path;
}

const FlightLog::Entry& FlightFinder::Scratch::fly(const AirView& air_now, const FlightQuery& query,
                                                   AirPoint from, AirPoint to, AirPoint towards) {
  FlightLog::Entry& entry = log.next();
  const SearchBudget left = query.budget.after(expanded);
  if (!entry.is_begun) search.begin(air_now, from, to);
  entry.is_begun = true;
  if (!entry.is_done) {
    const auto result = search.advance(left, log.slice(), entry.flight);
    entry.is_done = result.has_value();
    if (!result) log.set_pending();
    entry.result = result.value_or(SearchResult::kBudget);
    entry.nodes = search.expanded();
    entry.point.reset();
    if (result == SearchResult::kNone) entry.point = search.nearest_reached(towards);
    if (result == SearchResult::kFound) pull.pull(air_now, entry.flight);
  }
  if (entry.result == SearchResult::kBudget) spent = left.spent(entry.nodes + 1);
  expanded += entry.nodes;
  return entry;
}

// One flight, or a walk.
void FlightFinder::find_flight(const FlightQuery& query, Path& path) {
  Scratch& scratch = *scratch_;
  const AirView air = scratch.air(*state_);
  const FlightEndpoints ends = state_->ends(air);
  clear(path);
  scratch.reached.reset();
  bool budget_exhausted = false;  // somewhere: then what was not found may exist all the same
  const auto component_of = [&](AirPoint p) { return air.component(air.box_at(p)); };
  const auto to_link = [&](End& end, uint32_t component) {
    return scratch.find_link(*state_, air, end, component, budget_exhausted);
  };
  // The nearest take-offs may lead into islands of the air, a room or a yard under a net: then the
  // path takes off farther away, into air that leads to the other end.
  const auto to_links = [&](End& a, End& b) {
    if (!a.ground && !b.ground) return true;
    if (!a.ground) return to_link(b, component_of(*a.air));
    if (!b.ground) return to_link(a, component_of(*b.air));
    if (!to_link(a, kNoBox) || !to_link(b, kNoBox)) return false;
    if (air.same_component(*a.air, *b.air)) return true;
    const uint32_t common = scratch.common_air(*state_, air, a, b, query.budget, budget_exhausted);
    return common != kNoBox && to_link(a, common) && to_link(b, common);
  };
  const auto find_on_foot = [&](const Place& a, const Place& b) {
    const Path& ground = walk(query, a, b);
    budget_exhausted = budget_exhausted || ground.end == PathEnd::kBudgetExhausted;
    return &ground;
  };
  End from, to;
  if (!locate(query.from, query.vertical_tolerance, from) ||
      !locate(query.to, query.vertical_tolerance, to))
    return;

  double on_foot = INFINITY;
  const Path* all = nullptr;
  if (from.ground && to.ground && scratch.walker) {
    all = find_on_foot(from.ground, to.ground);
    if (all->end == PathEnd::kReached) on_foot = length_of(*all);
  }
  SearchResult result = SearchResult::kNone;
  const std::vector<AirPoint>* flight = nullptr;
  if (!scratch.log.is_pending() && to_links(from, to) && air.same_component(*from.air, *to.air)) {
    const FlightLog::Entry& found =
        scratch.fly(air, query, *from.air, *to.air, ends.to_air(query.to));
    flight = &found.flight;
    result = found.result;
    budget_exhausted = budget_exhausted || result == SearchResult::kBudget;
    scratch.reached = found.point;
  }
  if (result == SearchResult::kFound) {
    bool walked = true;
    if (from.ground) {
      if (from.ground_air_link.position.x != from.ground.position.x ||
          from.ground_air_link.position.z != from.ground.position.z) {
        const Path* there = find_on_foot(from.ground, from.ground_air_link);
        walked = there->end == PathEnd::kReached;
        add_walk(*there, 0, path);
      } else {
        add(from.ground_air_link.position, SegmentKind::kWalk, path);
      }
    }
    for (size_t i = 0; i < flight->size(); ++i) {
      add(ends.to_metres((*flight)[i]), i == 0 ? SegmentKind::kTakeOff : SegmentKind::kFly, path);
    }
    if (to.ground) {
      add(to.ground_air_link.position, SegmentKind::kLand, path);
      if (!scratch.log.is_pending() && (to.ground_air_link.position.x != to.ground.position.x ||
                                        to.ground_air_link.position.z != to.ground.position.z)) {
        const Path* on = find_on_foot(to.ground_air_link, to.ground);
        walked = walked && on->end == PathEnd::kReached;
        add_walk(*on, 1, path);
      }
    }
    if (walked && path.length <= on_foot) {
      path.end = PathEnd::kReached;
      return;
    }
  }
  clear(path);
  const bool open = budget_exhausted || scratch.log.is_pending();
  path.end = open ? PathEnd::kBudgetExhausted : PathEnd::kUnreachable;
  if (on_foot == INFINITY) return;
  add_walk(*all, 0, path);
  path.end = PathEnd::kReached;
}

// To the point of all reachable air that is nearest to the goal; if no avatar can take off from the
// ground, of the ground: there, of each rectangle, the cell that is nearest in the plane.
void FlightFinder::find_nearest(const FlightQuery& query, Path& path) {
  Scratch& scratch = *scratch_;
  const AirView air = scratch.air(*state_);
  const FlightEndpoints ends = state_->ends(air);
  const std::optional<AirPoint> reached = scratch.reached;
  const bool is_changed = scratch.is_changed();
  End from;
  if (!locate(query.from, query.vertical_tolerance, from)) return;
  const GroundAirLinks::Part start = state_->part_of(from);
  state_->ground_air_links.search(start, {kNoBox, true}, {}, scratch.parts);
  std::vector<uint32_t>& airs = scratch.common;
  airs.clear();
  for (const auto& step : scratch.parts.steps) {
    if (step.part.is_air) airs.push_back(step.part.component);
  }
  // Obstacles may have cut off its air from what the ground leads to otherwise.
  if (is_changed && from.air) {
    airs.push_back(air.component(air.box_at(*from.air)));
  } else if (is_changed) {
    const std::vector<uint32_t>& over = scratch.components_over(ends, from.ground);
    airs.insert(airs.end(), over.begin(), over.end());
  }
  std::sort(airs.begin(), airs.end());
  airs.erase(std::unique(airs.begin(), airs.end()), airs.end());
  const AirPoint goal = ends.to_air(query.to);
  std::optional<AirPoint> nearest;
  for (int32_t tries = 0; tries < kMaxTries; ++tries) {
    const auto look = [&](FlightLog::Entry& entry) {
      entry.point = air.nearest_in(airs, goal, scratch.zone_order);
    };
    if (is_cancelled(query)) return;
    nearest = reached && tries == 0 ? reached : scratch.log.next(look).point;
    if (!nearest) break;
    const AirPoint at = off_faces(*nearest);
    FlightQuery nearer = query;
    nearer.to = ends.to_metres(at);
    find_flight(nearer, path);
    if (path.end == PathEnd::kUnreachable) find_by_turns(nearer, path);
    if (path.end != PathEnd::kUnreachable || !is_changed) break;
    const uint32_t component = air.component(air.box_at(at));
    std::erase(airs, component);
  }
  if (!nearest || (is_changed && path.end == PathEnd::kUnreachable && from.ground)) {
    find_nearest_on_foot(query, from.ground, path);
    return;
  }
  const PathEnd ended = path.end;
  if (ended != PathEnd::kReached) clear(path);
  path.end = ended == PathEnd::kBudgetExhausted ? ended : PathEnd::kUnreachable;
  if (path.end == PathEnd::kBudgetExhausted) return;
  path.blocked_by = Blocker::kNone;
  if (path.points.empty()) return;
  set_blocker(
      air_blocker(*data_of(state_->world)->air, state_->body, air, off_faces(*nearest), goal),
      path);
  // Air that begins right there and leads nowhere else: only a corner is between.
  if (path.blocked_by == Blocker::kNone) path.blocked_by = Blocker::kNarrow;
}

// Over the ground, where no avatar can take off.
void FlightFinder::find_nearest_on_foot(const FlightQuery& query, const Place& from, Path& path) {
  Scratch& scratch = *scratch_;
  clear(path);
  path.end = PathEnd::kUnreachable;
  const uint32_t ground = state_->ground_of(from);
  const auto look = [&](FlightLog::Entry& entry) {
    entry.place = {};
    if (scratch.is_changed()) {
      entry.place = state_->ends(scratch.air(*state_))
                        .nearest_place(from, kMaxFloodCells, query.to, scratch.flood);
    }
    if (!entry.place) entry.place = state_->nearest_ground(ground, query.to);
  };
  const Place nearest = scratch.log.next(look).place;
  if (!nearest) return;
  const Path& on_foot = walk(query, from, nearest);
  const PathEnd end = on_foot.end;
  if (end == PathEnd::kBudgetExhausted) path.end = end;
  // To what comes nearest, if the finder of paths on foot knows it.
  if (end != PathEnd::kReached && !(scratch.is_changed() && end == PathEnd::kUnreachable)) return;
  add_walk(on_foot, 0, path);
  path.blocked_by =
      state_->ground_air_links.air_over(ground).empty() ? Blocker::kLow : Blocker::kNarrow;
}

}  // namespace throng::path
