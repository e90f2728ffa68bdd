// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "path/overlay/mesh_finder.h"

#include <algorithm>
#include <chrono>
#include <optional>
#include <string>

#include "core/access.h"
#include "core/check_class.h"
#include "path/edits/ground_finder.h"
#include "path/ground/baked_cells.h"
#include "path/ground/hub_labels.h"
#include "path/ground/label_search.h"
#include "path/ground/mesh.h"
#include "path/ground/reset_path.h"
#include "path/ground/search.h"
#include "path/ground/segments.h"
#include "path/overlay/zone_search.h"
#include "world/place.h"
#include "world/tile_grid.h"

// Chooses between labels, zones and search, and turns corners into places. Time of a query: with
// labels, linear in those of the corners that the two ends see; else n log n in the intervals or
// entrances that the search expands. The shared part is made in one pass over all zones.
namespace throng::path {
namespace {

// Feet mostly wait for the ground's bytes: all are prefetched before any is read.
void add_places(const world::WorldData& world, const PathMesh& mesh, const std::vector<Stop>& stops,
                std::vector<world::LevelView>& views, Path& path) {
  views.clear();
  for (const Stop& stop : stops) {
    const uint32_t level = mesh.rects[stop.rect].level;
    const size_t slot = world.slot_of_level(level);
    const world::Zone* zone = world.zone(slot);
    views.push_back(zone == nullptr ? world::LevelView{}
                                    : zone->view(level - world.slots[slot]->first_level));
    views.back().ask_for_heads(world::in_tile(stop.at.cell_x()), world::in_tile(stop.at.cell_z()));
  }
  for (size_t i = 0; i < stops.size(); ++i) {
    views[i].ask_for_cells(world::in_tile(stops[i].at.cell_x()),
                           world::in_tile(stops[i].at.cell_z()));
  }
  for (size_t i = 0; i < stops.size(); ++i) {
    path.points.push_back(
        world::place_at(world, mesh.rects[stops[i].rect].level, views[i], stops[i].at));
  }
}

}  // namespace

struct MeshFinder::Shared {
  World world;
  PathMesh mesh;
  std::optional<HubLabels> labels;
  std::optional<ZoneGraph> zones;
  PathSummary summary;
};

struct MeshFinder::Scratch {
  PathSearch search;
  LabelSearch label_search;
  ZoneSearch over_zones;
  std::optional<GroundFinder> over_points;  // made when a path cannot be drawn over corners
  std::vector<uint32_t> corners;
  std::vector<Stop> stops;
  std::vector<world::LevelView> views;  // of the stops

  // Of a search in parts.
  enum class Step : uint8_t { kNoPlace, kApart, kCorners, kPoints };
  Step step = Step::kNoPlace;
  Place from, to;
  Stop start, goal;
  uint64_t nodes = 0;  // expanded over corners
};

MeshFinder::MeshFinder(std::shared_ptr<const Shared> shared)
    : state_(std::move(shared)), scratch_(std::make_unique<Scratch>()) {}
MeshFinder::MeshFinder(const MeshFinder& other) : MeshFinder(other.state_) {}
MeshFinder& MeshFinder::operator=(const MeshFinder& other) {
  state_ = other.state_;
  if (scratch_ == nullptr) scratch_ = std::make_unique<Scratch>();  // it was moved from
  return *this;
}
MeshFinder::MeshFinder(MeshFinder&&) noexcept = default;
MeshFinder& MeshFinder::operator=(MeshFinder&&) noexcept = default;
MeshFinder::~MeshFinder() = default;

Result<MeshFinder> MeshFinder::create(const World& world, const PathConfig& config,
                                      Context& context) {
  if (data_of(world) == nullptr) return Error{Errc::kBadInput, "path: the world is empty"};
  if (auto ok = check_class(data_of(world)->summary.classes, config.avatar_class, "path"); !ok)
    return ok.error();
  if (config.workers < 0) return Error{Errc::kBadConfig, "path: workers must be 0 or more"};
  if (config.slope_cost != 0) {
    return Error{Errc::kBadConfig, "path: labels and zones know no slope_cost"};
  }
  const auto start = std::chrono::steady_clock::now();
  if (auto ok = world.check_ground(); !ok) return ok.error();
  auto mesh = build_mesh(*data_of(world), config.avatar_class, config.workers, context);
  if (!mesh) return mesh.error();
  auto shared = std::make_shared<Shared>();
  shared->world = world;
  shared->mesh = std::move(*mesh);
  PathSummary& summary = shared->summary;
  summary.rectangles = shared->mesh.rects.size() - 1;
  summary.portals = shared->mesh.portals.size();
  summary.corners = shared->mesh.corner_count();
  summary.bytes = shared->mesh.bytes();
  if (config.speedup == PathSpeedup::kLabels) {
    auto labels = build_labels(shared->mesh, config.workers, context);
    if (!labels) return labels.error();
    shared->labels = std::move(*labels);
    summary.labels = shared->labels->labels.size();
    summary.bytes += shared->labels->bytes();
  }
  if (config.speedup == PathSpeedup::kZones) {
    auto zones = build_zone_graph(*data_of(world), shared->mesh, config.workers, context);
    if (!zones) return zones.error();
    shared->zones = std::move(*zones);
    summary.entrances = shared->zones->entrances.size();
    summary.labels = shared->zones->label_count();
    summary.bytes += shared->zones->bytes();
  }
  summary.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return MeshFinder(std::move(shared));
}

PathSummary MeshFinder::summary() const { return state_->summary; }
const PathMesh& MeshFinder::mesh() const { return state_->mesh; }

void MeshFinder::find(const Place& from, const Place& to, Path& path, const SearchBudget& budget) {
  begin(from, to);
  Slice all;
  advance(budget, all, path);
}

std::optional<Stop> MeshFinder::stop(const Place& place) const {
  const auto at = world::ground_point(*data_of(state_->world), place);
  if (!at) return {};
  const uint32_t rect = state_->mesh.rect_at(place.level1 - 1, at->cell_x(), at->cell_z());
  return rect == kNoRect ? std::nullopt : std::optional<Stop>({*at, rect});
}

uint32_t MeshFinder::component(const Place& place) const {
  const auto at = stop(place);
  return at ? state_->mesh.rects[at->rect].component : kNoRect;
}

void MeshFinder::begin(const Place& from, const Place& to) {
  const PathMesh& mesh = state_->mesh;
  Scratch& s = *scratch_;
  s.from = from;
  s.to = to;
  s.nodes = 0;
  s.step = Scratch::Step::kNoPlace;
  const auto start = stop(from), goal = stop(to);
  if (!start || !goal) return;
  s.start = *start;
  s.goal = *goal;
  s.step = Scratch::Step::kApart;
  if (mesh.rects[s.start.rect].component != mesh.rects[s.goal.rect].component) return;
  s.step = Scratch::Step::kCorners;
  if (!state_->labels && !state_->zones) s.search.begin(mesh, s.start, s.goal);
}

bool MeshFinder::advance(const SearchBudget& budget, Slice& slice, Path& path) {
  const world::WorldData& world = *data_of(state_->world);
  const PathMesh& mesh = state_->mesh;
  Scratch& s = *scratch_;
  reset(path);
  if (s.step == Scratch::Step::kPoints) return advance_over_points(budget, slice, path);
  if (s.step == Scratch::Step::kApart) path.end = PathEnd::kUnreachable;
  if (s.step != Scratch::Step::kCorners) return true;
  double length = 0;
  SearchResult result = SearchResult::kNone;
  if (state_->labels) {
    if (s.label_search.find(mesh, *state_->labels, s.start, s.goal, s.corners, length)) {
      result = SearchResult::kFound;
    }
  } else if (state_->zones) {
    ZoneSearch& search = s.over_zones;
    result = search.find(world, mesh, *state_->zones, s.start, s.goal, budget, s.corners, length);
    s.nodes = search.expanded();
  } else {
    // The search counts the node that was too many; with a larger budget it is expanded.
    SearchBudget part = budget;
    part.max_nodes =
        std::min(budget.max_nodes, s.nodes + std::min(slice.left, UINT64_MAX - s.nodes));
    result = s.search.advance(part, s.corners, length);
    const uint64_t expanded = std::min(s.search.expanded(), part.max_nodes);
    slice.take(expanded - s.nodes);
    s.nodes = expanded;
    if (result == SearchResult::kBudget && part.spent(s.search.expanded()) == SpentBudget::kNodes &&
        expanded < budget.max_nodes) {
      path.nodes = expanded;
      path.end = PathEnd::kBudgetExhausted;
      path.spent = SpentBudget::kNodes;
      return false;
    }
    s.nodes = s.search.expanded();
    s.search.give_back();
  }
  path.nodes = s.nodes;
  // Both are of one component: a path exists, even if none can be drawn over corners.
  const auto is_drawn = [&] {
    const BakedCells cells(world, mesh);
    SegmentWalker walker(cells, mesh);
    return walker.walk(s.start, s.corners, s.goal.at, s.stops) &&
           s.stops.back().rect == s.goal.rect;
  };
  if (result == SearchResult::kBudget) {
    path.spent = budget.spent(path.nodes);
    path.end = PathEnd::kBudgetExhausted;
    return true;
  }
  if (result == SearchResult::kNone || !is_drawn()) {
    begin_over_points();
    return advance_over_points(budget, slice, path);
  }
  path.end = PathEnd::kReached;
  path.length = path.cost = length * world.summary.cell;
  add_places(world, mesh, s.stops, s.views, path);
  path.segments.assign(path.points.size() - 1, SegmentKind::kWalk);
  return true;
}

void MeshFinder::begin_over_points() {
  Scratch& s = *scratch_;
  s.step = Scratch::Step::kPoints;
  if (!s.over_points) {
    auto made = GroundFinder::create(state_->world, {.avatar_class = state_->mesh.avatar_class});
    THRONG_ASSERT(made);  // The class was checked.
    s.over_points = *std::move(made);
  }
  s.over_points->begin_over_points(s.from, s.to);
}

bool MeshFinder::advance_over_points(const SearchBudget& budget, Slice& slice, Path& path) {
  const uint64_t nodes_before = scratch_->nodes;
  const bool ended = scratch_->over_points->advance(budget.after(nodes_before), slice, path);
  path.nodes += nodes_before;
  return ended;
}

}  // namespace throng::path
