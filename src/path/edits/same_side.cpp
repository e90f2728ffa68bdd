// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <span>

#include "path/edits/ground_finder.h"
#include "path/edits/ground_finder_state.h"

// Can one path be moved onto another without crossing what is closed? Points along both are paired
// in order, one step on one of them at a time, and each pair must see each other (a discrete
// Frechet distance whose bound is sight), depth first. Time: linear in the points where they can,
// quadratic where not.
namespace throng::path {
namespace {

constexpr size_t kMaxPairs = 5000;  // that are tested; then it counts as moved
constexpr double kSameEnd = 1;      // [m] by which a path that goes on passes the end of another

// Points of a path on their levels: its corners, and middles of cells between them. (A rounded
// point beside a wall may be beyond it.) False: a segment is no legal move.
bool sample(GroundView& mesh, std::span<const ViewStop> path, std::vector<ViewStop>& points) {
  const world::WorldData& world = mesh.world();
  const auto number = static_cast<size_t>(mesh.avatar_class());
  const double spacing = 4 * world.summary.classes[number].radius / world.summary.cell;
  points.assign(1, path[0]);
  for (size_t i = 1; i < path.size(); ++i) {
    const ViewLevel* level = mesh.level(path[i - 1].level);
    const auto enter = [&](const ViewLevel* next, int32_t x, int32_t z, int32_t, int32_t) {
      const world::GroundPoint at = middle_of_cell(x, z);
      if (distance_of(points.back().at, at) >= spacing) {
        points.push_back({next->ground.world_level, 0, at});
      }
    };
    const world::WalkStop end =
        world::walk_far(mesh.ground(), level, path[i - 1].at, path[i].at, mesh.step(), enter);
    if (!end.arrived) return false;
    points.push_back(path[i]);
  }
  return true;
}

bool sees(GroundView& mesh, const ViewStop& from, const ViewStop& to) {
  const ViewLevel* level = mesh.level(from.level);
  return world::walk_far(mesh.ground(), level, from.at, to.at, mesh.step()).arrived &&
         level->ground.world_level == to.level;
}

}  // namespace

bool GroundFinder::is_same_side(std::span<const Place> path, std::span<const Place> other,
                                bool whole) {
  State& s = *state_;
  for (size_t k = 0; k < 2; ++k) {
    s.stops.clear();
    for (const Place& place : k == 0 ? path : other) {
      if (!s.locate(place, s.stops.emplace_back())) return false;
    }
    if (s.stops.empty() || !sample(s.mesh, s.stops, s.sampled[k])) return false;
  }
  // Pairs that are reached, the last first. The path that lags behind is tried first.
  const std::vector<ViewStop>&a = s.sampled[0], &b = s.sampled[1];
  const double near = kSameEnd / s.mesh.world().summary.cell;
  s.paired.assign(a.size() * b.size(), 0);
  s.pairs.assign(1, 0);
  const auto reach = [&](size_t i, size_t j) {
    if (i >= a.size() || j >= b.size()) return;
    uint8_t& was = s.paired[i * b.size() + j];
    if (was == 0) s.pairs.push_back(static_cast<uint32_t>(i * b.size() + j));
    was = 1;
  };
  for (size_t tested = 0; !s.pairs.empty(); ++tested) {
    if (tested == kMaxPairs) return true;
    const size_t i = s.pairs.back() / b.size(), j = s.pairs.back() % b.size();
    s.pairs.pop_back();
    if (!sees(s.mesh, a[i], b[j])) continue;
    const bool at_end = whole ? j + 1 == b.size() : distance_of(a[i].at, b[j].at) <= near;
    if (i + 1 == a.size() && at_end) return true;
    const bool lags = i * b.size() <= j * a.size();
    lags ? reach(i, j + 1) : reach(i + 1, j);
    lags ? reach(i + 1, j) : reach(i, j + 1);
  }
  return false;
}

}  // namespace throng::path
