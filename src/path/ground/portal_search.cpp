// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "path/ground/portal_search.h"

#include <algorithm>
#include <cmath>

#include "path/ground/border.h"
#include "path/ground/mesh_ray.h"

// A* over the ends and middles of portals, then string pulling over the stops.
namespace throng::path {
namespace {

double between(world::GroundPoint a, world::GroundPoint b) {
  return distance(in_cells(a), in_cells(b));
}

}  // namespace

SearchResult PortalSearch::find(const PathMesh& mesh, const Stop& from, const Stop& to,
                                const SearchBudget& budget, std::vector<Stop>& stops,
                                double& length) {
  if (mesh_ != &mesh) {
    mesh_ = &mesh;
    reached_.clear();
    reached_.resize(mesh.portals.size() * kPoints);
    search_ = 0;
  }
  if (++search_ == 0) {
    reached_.clear();
    search_ = 1;
  }
  const SearchResult result = search(from, to, budget, stops, length);
  give_back();
  return result;
}

uint64_t PortalSearch::used_bytes() const {
  return met_ * sizeof(Reached) + open_.used_bytes();  // as PathSearch::used_bytes
}

uint64_t PortalSearch::allocated_bytes() const {
  return reached_.allocated_bytes() + open_.allocated_bytes() + all_.capacity() * sizeof(Stop);
}

void PortalSearch::give_back() {
  if (allocated_bytes() <= kKeptBytes) return;
  reached_.clear();
  open_.give_back();
  std::vector<Stop>().swap(all_);
}

SearchResult PortalSearch::search(const Stop& from, const Stop& to, const SearchBudget& budget,
                                  std::vector<Stop>& stops, double& length) {
  goal_ = to.at;
  met_ = 0;
  expanded_ = 0;
  open_.clear();
  uint32_t last = kStart;
  double best = INFINITY;
  if (from.rect == to.rect) {
    best = between(from.at, to.at);
  } else {
    expand(from, 0, kStart);
  }
  while (!open_.empty() && open_.first().estimate < best) {
    const Open next = open_.pop();
    const auto [search, before, rect, cost] = reached_[next.point];
    const Stop at{crossing(rect, next.point).beyond, mesh_->portals[next.point / kPoints].rect};
    if (next.estimate > cost + between(at.at, goal_)) continue;  // It was reached at a lower cost.
    if (budget.is_spent(++expanded_, used_bytes())) return SearchResult::kBudget;
    if (at.rect == to.rect) {
      best = cost + between(at.at, to.at);
      last = next.point;
      continue;
    }
    expand(at, cost, next.point);
  }
  if (best == INFINITY) return SearchResult::kNone;
  draw(last, from, to, stops);
  length = 0;
  for (size_t i = 1; i < stops.size(); ++i) length += between(stops[i - 1].at, stops[i].at);
  return SearchResult::kFound;
}

// Portals of a rectangle go around it; a border's units belong to the cells after it.
PortalSearch::Crossing PortalSearch::crossing(uint32_t rect, uint32_t point) const {
  const MeshRect& r = mesh_->rects[rect];
  const MeshPortal& portal = mesh_->portals[point / kPoints];
  const auto units = [](int64_t cells) { return cells << world::kUnitBits; };
  const int64_t first = units(portal.from) + 1, last = units(portal.to) - 2;
  const int64_t along = point % kPoints == 0   ? first
                        : point % kPoints == 1 ? (first + last) / 2
                                               : last;
  const int64_t west = units(r.x), east = units(r.x + r.width);
  const int64_t south = units(r.z), north = units(r.z + r.depth);
  if (portal.from < r.width) return {{west + along, south}, {west + along, south - 1}};
  if (portal.from < r.width + r.depth) {
    const int64_t z = south + along - units(r.width);
    return {{east - 1, z}, {east, z}};
  }
  if (portal.from < 2 * r.width + r.depth) {
    const int64_t x = east - 1 - (along - units(r.width + r.depth));
    return {{x, north - 1}, {x, north}};
  }
  const int64_t z = north - 1 - (along - units(2 * r.width + r.depth));
  return {{west, z}, {west - 1, z}};
}

// To all points beyond the rectangle's portals: a rectangle is crossed in a straight line.
void PortalSearch::expand(const Stop& at, double cost, uint32_t before) {
  const uint32_t end = mesh_->rects[at.rect + size_t{1}].first_portal * kPoints;
  for (uint32_t p = mesh_->rects[at.rect].first_portal * kPoints; p < end; ++p) {
    const world::GroundPoint to = crossing(at.rect, p).beyond;
    const double whole = cost + between(at.at, to);
    Reached& reached = reached_[p];
    if (reached.search == search_ && reached.cost <= whole) continue;
    met_ += reached.search == search_ ? 0 : 1;
    reached = {search_, before, at.rect, whole};
    open_.push({whole + between(to, goal_), p});
  }
}

// The path backwards from its last portal, both sides of each; then without stops that are
// needless.
void PortalSearch::draw(uint32_t last, const Stop& from, const Stop& to, std::vector<Stop>& stops) {
  all_.clear();
  all_.push_back(to);
  for (uint32_t p = last; p != kStart; p = reached_[p].before) {
    const Crossing over = crossing(reached_[p].rect, p);
    all_.push_back({over.beyond, mesh_->portals[p / kPoints].rect});
    all_.push_back({over.inside, reached_[p].rect});
  }
  all_.push_back(from);
  std::reverse(all_.begin(), all_.end());
  // Repeated until no stop is left out: each removal may allow the next.
  for (size_t before = 0; before != all_.size();) {
    before = all_.size();
    stops.assign(1, all_.front());
    for (size_t i = 1; i + 1 < all_.size(); ++i) {
      const Stop& kept = stops.back();
      const Stop& next = all_[i + 1];
      if (mesh_ray(*mesh_, kept.rect, kept.at, next.at) != next.rect) stops.push_back(all_[i]);
    }
    stops.push_back(all_.back());
    all_ = stops;
  }
}

}  // namespace throng::path
