// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "path/ground/string_puller.h"

#include <algorithm>
#include <cmath>

#include "core/arrays/prefetch.h"
#include "path/ground/border.h"
#include "path/ground/mesh_ray.h"

// Removes waypoint after waypoint that is not a taut turn, replacing it by the convex chain of
// corners in its triangle. Time: a ray for each waypoint removed; if that is blocked, a cast into
// the triangle for each corner of the chain.
namespace throng::path {
namespace {

// Towards the missing cell, seen from a corner on a line along (dx, dz): positive if to the left.
double missing_side(const MeshCorner& corner, double dx, double dz) {
  return dx * -corner.away_z - dz * -corner.away_x;
}

// True if the path over `at` goes around what is missing there, or straight on.
bool holds(const PathMesh& mesh, CellPoint before, const Waypoint& at, CellPoint after) {
  if (at.corner == kNoCorner) return false;
  const double turn = cross(before, at.at, after);
  const double in_x = at.at.x - before.x, in_z = at.at.z - before.z;
  const double out_x = after.x - at.at.x, out_z = after.z - at.at.z;
  if (std::fabs(turn) <= kSame) return in_x * out_x + in_z * out_z >= 0;
  const MeshCorner& corner = mesh.corners[at.corner];
  if (!is_taut(corner, in_x, in_z) || !is_taut(corner, out_x, out_z)) return false;
  return missing_side(corner, in_x, in_z) * turn > 0;
}

// Where a ray may begin or end: the point of a rectangle, or the one beside a corner.
Stop stop_of(const PathMesh& mesh, const Waypoint& p) {
  const auto inside = [&](uint32_t rect, world::GroundPoint at) {
    const MeshRect& r = mesh.rects[rect];
    return Stop{{std::clamp(at.x, int64_t{r.x} << world::kUnitBits,
                            (int64_t{r.x + r.width} << world::kUnitBits) - 1),
                 std::clamp(at.z, int64_t{r.z} << world::kUnitBits,
                            (int64_t{r.z + r.depth} << world::kUnitBits) - 1)},
                rect};
  };
  if (p.corner == kNoCorner) {
    return inside(p.rect, {static_cast<int64_t>(std::floor(p.at.x * world::kUnitsPerCell)),
                           static_cast<int64_t>(std::floor(p.at.z * world::kUnitsPerCell))});
  }
  const MeshCorner& corner = mesh.corners[p.corner];
  const world::GroundPoint at = beside(corner);
  for (uint32_t i = corner.first_rect; i < mesh.corners[p.corner + 1].first_rect; ++i) {
    const Stop stop = inside(mesh.corner_rects[i], at);
    if (stop.at.x == at.x && stop.at.z == at.z) return stop;
  }
  return {};
}

// Does a line along (dx, dz) that begins or ends there keep out of the cell missing there, if any?
bool keeps_out(const PathMesh& mesh, const Waypoint& p, double dx, double dz) {
  return p.corner == kNoCorner || is_taut(mesh.corners[p.corner], dx, dz);
}

// Rays go from and to points beside corners. Where the line between the corners themselves runs
// into a cell that is missing at one of them the ray may still pass by, and proves nothing.
bool see_each_other(const PathMesh& mesh, const Waypoint& a, const Waypoint& b) {
  const double dx = b.at.x - a.at.x, dz = b.at.z - a.at.z;
  if (!keeps_out(mesh, a, dx, dz) || !keeps_out(mesh, b, dx, dz)) return false;
  const Stop from = stop_of(mesh, a), to = stop_of(mesh, b);
  return from.rect != kNoRect && to.rect != kNoRect &&
         mesh_ray(mesh, from.rect, from.at, to.at) == to.rect;
}

}  // namespace

// Most points at which the path need not turn are pulled away from, between the points beside them:
// what lies there is prefetched before any of it is read.
void StringPuller::prefetch_waypoints(const PathMesh& mesh, const std::vector<Waypoint>& path) {
  prefetched_.clear();
  for (size_t i = 1; i + 1 < path.size(); ++i) {
    if (path[i].corner != kNoCorner) continue;
    for (const Waypoint& beside : {path[i - 1], path[i + 1]}) {
      if (beside.corner == kNoCorner) continue;
      prefetched_.push_back(beside.corner);
      prefetch(mesh.corner_rects.data() + mesh.corners[beside.corner].first_rect);
    }
  }
  const auto each_rect = [&](auto visit) {
    for (const uint32_t corner : prefetched_) {
      const uint32_t end = mesh.corners[corner + 1].first_rect;
      for (uint32_t i = mesh.corners[corner].first_rect; i < end; ++i) visit(mesh.corner_rects[i]);
    }
  };
  each_rect([&](uint32_t rect) { prefetch(&mesh.rects[rect]); });
  each_rect([&](uint32_t rect) { prefetch(mesh.portals.data() + mesh.rects[rect].first_portal); });
}

// The obstacles in the triangle of `from`, `over`, `to`, whose first two sides are free: the convex
// chain of corners that catches a string over these two sides when it is pulled.
void StringPuller::wrap(const PathMesh& mesh, const Waypoint& from, const Waypoint& over,
                        const Waypoint& to) {
  chain_.clear();
  // A ray costs less than casting into the triangle, and usually nothing stands there.
  if (see_each_other(mesh, from, to)) return;
  const double turn = cross(from.at, over.at, to.at);
  if (std::fabs(turn) <= kSame) return;
  const double side = turn > 0 ? 1 : -1;  // of `to`, seen along the first side
  Waypoint at = from;
  constexpr size_t kMax = 1000;  // corners: rounding must not wrap for ever
  while (chain_.size() < kMax) {
    const CellPoint right = side > 0 ? over.at : to.at, left = side > 0 ? to.at : over.at;
    sight_.cast_into(mesh, at.corner, at.rect, at.at, right, left);
    // The first one that a line from `at` meets as it swings from `over` to `to`.
    const SeenCorner* first = nullptr;
    for (const SeenCorner& seen : sight_.corners()) {
      const MeshCorner& corner = mesh.corners[seen.corner];
      const CellPoint p{double(corner.x), double(corner.z)};
      if (seen.corner == over.corner || seen.corner == to.corner || seen.distance <= kSame)
        continue;
      const double dx = p.x - at.at.x, dz = p.z - at.at.z;
      if (missing_side(corner, dx, dz) * side <= 0) continue;
      // Of what the second side touches, only what is within.
      const double beyond = cross(over.at, to.at, p) * side;
      if (beyond <= kSame &&
          missing_side(corner, to.at.x - over.at.x, to.at.z - over.at.z) * side <= 0)
        continue;
      if (first != nullptr) {
        const MeshCorner& best = mesh.corners[first->corner];
        const double swing = cross(at.at, {double(best.x), double(best.z)}, p) * side;
        if (swing > kSame || (swing > -kSame && seen.distance >= first->distance)) continue;
      }
      first = &seen;
    }
    if (first == nullptr) return;
    at = waypoint(mesh, first->corner);
    chain_.push_back(at);
    if (cross(at.at, over.at, to.at) * side <= kSame) return;
  }
}

bool StringPuller::pull(const PathMesh& mesh, const std::vector<Waypoint>& path,
                        std::vector<uint32_t>& corners, double& length) {
  prefetch_waypoints(mesh, path);
  corners.clear();
  taut_.assign(1, path.front());
  ahead_.assign(path.rbegin(), path.rend() - 1);
  // Each turn makes the path shorter; the count ends what rounding could continue for ever.
  size_t turns = 1000 + 100 * path.size();
  while (!ahead_.empty()) {
    if (turns-- == 0) return false;
    const Waypoint next = ahead_.back();
    ahead_.pop_back();
    if (taut_.size() == 1 || holds(mesh, taut_[taut_.size() - 2].at, taut_.back(), next.at)) {
      taut_.push_back(next);
      continue;
    }
    const Waypoint over = taut_.back();
    taut_.pop_back();
    wrap(mesh, taut_.back(), over, next);
    ahead_.push_back(next);
    ahead_.insert(ahead_.end(), chain_.rbegin(), chain_.rend());
  }
  length = 0;
  for (size_t i = 1; i < taut_.size(); ++i) {
    length += distance(taut_[i - 1].at, taut_[i].at);
    if (i + 1 < taut_.size()) corners.push_back(taut_[i].corner);
  }
  return true;
}

}  // namespace throng::path
