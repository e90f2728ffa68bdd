// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <chrono>
#include <cmath>
#include <optional>
#include <string>

#include "path/hub_labels.h"
#include "path/legs.h"
#include "path/mesh.h"
#include "path/search.h"
#include "throng/path.h"
#include "world/ground.h"
#include "world/place.h"

namespace throng {

struct PathFinder::Shared {
  World world;
  PathMesh mesh;
  std::optional<HubLabels> labels;
  PathSummary summary;
};

struct PathFinder::Scratch {
  PathSearch search;
  LabelSearch look_up;
  std::vector<uint32_t> corners;
  std::vector<Stop> stops;
};

PathFinder::PathFinder(std::shared_ptr<const Shared> shared)
    : shared_(std::move(shared)), scratch_(std::make_unique<Scratch>()) {}
PathFinder::PathFinder(const PathFinder& other) : PathFinder(other.shared_) {}
PathFinder& PathFinder::operator=(const PathFinder& other) {
  shared_ = other.shared_;
  return *this;
}
PathFinder::PathFinder(PathFinder&&) noexcept = default;
PathFinder& PathFinder::operator=(PathFinder&&) noexcept = default;
PathFinder::~PathFinder() = default;

Result<PathFinder> PathFinder::make(const World& world, const PathConfig& config,
                                    Context& context) {
  if (world.data() == nullptr) return Error{Errc::kBadInput, "path: the world is empty"};
  const auto classes = static_cast<int32_t>(world.data()->summary.classes.size());
  if (config.avatar_class < 0 || config.avatar_class >= classes) {
    return Error{Errc::kBadConfig, "path: there is no class " +
                                       std::to_string(config.avatar_class) + ", the world has " +
                                       std::to_string(classes)};
  }
  if (config.workers < 0) return Error{Errc::kBadConfig, "path: workers must be 0 or more"};
  const auto start = std::chrono::steady_clock::now();
  auto mesh = build_mesh(*world.data(), config.avatar_class, config.workers, context);
  if (!mesh) return mesh.error();
  auto shared = std::make_shared<Shared>();
  shared->world = world;
  shared->mesh = std::move(*mesh);
  PathSummary& summary = shared->summary;
  summary = {shared->mesh.rects.size() - 1, shared->mesh.portals.size(),
             shared->mesh.corner_count(),   0,
             shared->mesh.bytes(),          0};
  if (config.labels) {
    auto labels = build_labels(shared->mesh, config.workers, context);
    if (!labels) return labels.error();
    shared->labels = std::move(*labels);
    summary.labels = shared->labels->labels.size();
    summary.bytes += shared->labels->bytes();
  }
  summary.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return PathFinder(std::move(shared));
}

PathSummary PathFinder::summary() const { return shared_->summary; }

void PathFinder::find(const Place& from, const Place& to, Path& path, uint64_t max_nodes) {
  const WorldData& world = *shared_->world.data();
  const PathMesh& mesh = shared_->mesh;
  path.end = PathEnd::kNoPlace;
  path.points.clear();
  path.length = 0;
  path.nodes = 0;
  const auto locate = [&](const Place& place, GroundPoint& at, SearchEnd& end) {
    if (!place || place.level1 > world.level_count ||
        !std::isfinite(place.position.x + place.position.z))
      return false;
    at = to_ground(world, place.position.x, place.position.z);
    if (!in_grid(world, at)) return false;
    end.rect = mesh.rect_at(place.level1 - 1, at.cell_x(), at.cell_z());
    end.point = {static_cast<double>(at.x) / kUnitsPerCell,
                 static_cast<double>(at.z) / kUnitsPerCell};
    return end.rect != kNoRect;
  };
  GroundPoint start, goal;
  SearchEnd start_end, goal_end;
  if (!locate(from, start, start_end) || !locate(to, goal, goal_end)) return;

  if (mesh.rects[start_end.rect].component != mesh.rects[goal_end.rect].component) {
    path.end = PathEnd::kUnreachable;
    return;
  }
  double length = 0;
  SearchResult result = SearchResult::kNone;
  if (shared_->labels) {
    if (scratch_->look_up.find(mesh, *shared_->labels, {start, start_end.rect},
                               {goal, goal_end.rect}, scratch_->corners, length)) {
      result = SearchResult::kFound;
    }
  } else {
    result = scratch_->search.find(mesh, start_end, goal_end, max_nodes, scratch_->corners, length);
    path.nodes = scratch_->search.expanded();
  }
  path.end = result == SearchResult::kNone ? PathEnd::kUnreachable : PathEnd::kGaveUp;
  if (result != SearchResult::kFound) return;
  LegWalker walker(world, mesh);
  const bool walked =
      walker.walk({start, start_end.rect}, scratch_->corners, goal, scratch_->stops);
  if (!walked || scratch_->stops.back().rect != goal_end.rect) {
    path.end = PathEnd::kUnreachable;
    return;
  }
  path.end = PathEnd::kReached;
  path.length = length * world.summary.cell;
  const double unit = world.summary.cell / kUnitsPerCell;
  for (const Stop& stop : scratch_->stops) {
    const uint32_t on = mesh.rects[stop.rect].level;
    const GroundLevel level = ground_level(world, on, mesh.avatar_class);
    const int32_t feet = level.view.feet(stop.at.cell_x() & 63, stop.at.cell_z() & 63,
                                         static_cast<int32_t>(stop.at.x & (kUnitsPerCell - 1)),
                                         static_cast<int32_t>(stop.at.z & (kUnitsPerCell - 1)));
    path.points.push_back(
        {{world.summary.origin.x + (static_cast<double>(stop.at.x) + 0.5) * unit, feet * 1e-3,
          world.summary.origin.z + (static_cast<double>(stop.at.z) + 0.5) * unit},
         on + 1});
  }
}

}  // namespace throng
