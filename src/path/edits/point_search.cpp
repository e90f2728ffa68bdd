// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "path/edits/point_search.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "path/edits/corridor.h"
#include "path/ground/pull_string.h"
#include "world/tile_grid.h"

// A* (Hart, Nilsson, Raphael. 1968) over points of portals at area costs, then string pulling by
// doubling, halving and moving stops. Time: n log n in the points that it reaches; to pull, a
// number of segments for each stop that is logarithmic in the stops, each linear in the cells that
// it crosses.
namespace throng::path {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();

size_t slot_of(const ViewStop& stop, size_t mask) {
  const auto x = static_cast<uint64_t>(stop.at.x), z = static_cast<uint64_t>(stop.at.z);
  uint64_t hash = (x * 0x9e3779b97f4a7c15 ^ z) * 0xbf58476d1ce4e5b9 + stop.level;
  hash = (hash ^ hash >> 29) * 0x94d049bb133111eb;
  return static_cast<size_t>(hash >> 20) & mask;
}

bool same(const ViewStop& a, const ViewStop& b) {
  return a.level == b.level && a.at.x == b.at.x && a.at.z == b.at.z;
}

// Cost of a metre on the ground of a cell.
double factor_at(const GroundView& mesh, const ViewLevel& level, int32_t x, int32_t z) {
  return mesh.factor(mesh.rect_at(level, x, z));
}

}  // namespace

void ReachedPoints::clear() {
  if (table_.empty()) table_.resize(1 << 12);
  if (nodes.size() * 16 < table_.size()) {
    for (size_t n = 0; n < nodes.size(); ++n) {
      for (size_t s = slot_of(nodes[n].stop, table_.size() - 1); table_[s] != 0;
           s = (s + 1) & (table_.size() - 1)) {
        table_[s] = 0;
      }
    }
  } else {
    std::fill(table_.begin(), table_.end(), 0);
  }
  nodes.clear();
}

void ReachedPoints::give_back() {
  nodes.clear();
  nodes.shrink(0);
  std::vector<uint32_t>().swap(table_);
}

// Beside itself a node takes up to eight places of the table, and two of the old one as it grows.
uint64_t ReachedPoints::used_bytes() const {
  return nodes.size() * (sizeof(ReachedPoint) + 10 * sizeof(uint32_t));
}

uint64_t ReachedPoints::allocated_bytes() const {
  return nodes.allocated_bytes() + table_.capacity() * sizeof(uint32_t);
}

std::pair<uint32_t, bool> ReachedPoints::node_of(const ViewStop& stop) {
  size_t slot = slot_of(stop, table_.size() - 1);
  for (; table_[slot] != 0; slot = (slot + 1) & (table_.size() - 1)) {
    if (same(nodes[table_[slot] - 1].stop, stop)) return {table_[slot] - 1, false};
  }
  const auto index = static_cast<uint32_t>(nodes.size());
  nodes.push_back({});
  nodes[index].stop = stop;
  table_[slot] = index + 1;
  if (nodes.size() * 2 > table_.size()) grow();
  return {index, true};
}

void ReachedPoints::grow() {
  table_.assign(table_.size() * 4, 0);
  for (uint32_t n = 0; n < nodes.size(); ++n) {
    size_t slot = slot_of(nodes[n].stop, table_.size() - 1);
    while (table_[slot] != 0) slot = (slot + 1) & (table_.size() - 1);
    table_[slot] = n + 1;
  }
}

double segment_cost(GroundView& mesh, const ViewStop& from, const ViewStop& to) {
  const ViewLevel* level = mesh.level(from.level);
  const double length = distance_of(from.at, to.at);
  const GroundDelays* delays = mesh.delays();
  const GroundDelays::Heading heading =
      delays == nullptr ? GroundDelays::Heading{} : GroundDelays::heading(from.at, to.at);
  const bool is_even = mesh.is_plain() && delays == nullptr;  // a metre costs 1 everywhere
  const auto factor_of = [&](const ViewLevel& of, int32_t x, int32_t z) {
    const double by_kind = mesh.is_plain() ? 1 : factor_at(mesh, of, x, z);
    if (delays == nullptr) return by_kind;
    return by_kind *
           delays->factor(of.ground.world_level, world::in_tile(x), world::in_tile(z), heading);
  };
  double cost = 0, t = 0;
  double factor = is_even ? 1 : factor_of(*level, from.at.cell_x(), from.at.cell_z());
  const auto dx = static_cast<double>(to.at.x - from.at.x);
  const auto dz = static_cast<double>(to.at.z - from.at.z);
  const auto enter = [&](const ViewLevel* next, int32_t x, int32_t z, int32_t before_x,
                         int32_t before_z) {
    if (is_even) return;
    double at = t;
    if (x != before_x) {
      const int64_t line = int64_t{std::max(x, before_x)} << world::kUnitBits;
      at = static_cast<double>(line - from.at.x) / dx;
    } else if (z != before_z) {
      const int64_t line = int64_t{std::max(z, before_z)} << world::kUnitBits;
      at = static_cast<double>(line - from.at.z) / dz;
    }
    cost += (at - t) * length * factor;
    t = at;
    factor = factor_of(*next, x, z);
  };
  const world::WalkStop stop =
      world::walk_far(mesh.ground(), level, from.at, to.at, mesh.step(), enter);
  if (!stop.arrived || level->ground.world_level != to.level) return kNever;
  if (is_even) return length;
  cost += (1 - t) * length * factor;
  return std::isfinite(cost) ? cost : kNever;
}

void CostString::leave_out(std::vector<ViewStop>& walk) {
  constexpr double kRoundingFactor = 1 + 1e-9;
  if (walk.size() < 3) return;
  before_.assign(walk.size(), 0);
  for (size_t i = 1; i < walk.size(); ++i)
    before_[i] = before_[i - 1] + segment_cost(*mesh_, walk[i - 1], walk[i]);
  path::leave_out<LeaveOut::kDoubling>(walk, [&](const ViewStop& from, size_t at, size_t to) {
    return segment_cost(*mesh_, from, walk[to]) <= (before_[to] - before_[at]) * kRoundingFactor;
  });
}

bool CostString::move(std::vector<ViewStop>& walk, int) {
  for (size_t i = 1; i + 1 < walk.size(); ++i) move_stop(walk, i);
  return true;
}

// Towards the straight line between its neighbours as far as the ground permits.
void CostString::move_stop(std::vector<ViewStop>& walk, size_t i) {
  constexpr int kHalvings = 6;
  GroundView& mesh = *mesh_;
  const ViewStop a = walk[i - 1], b = walk[i + 1];
  double best = segment_cost(mesh, a, walk[i]) + segment_cost(mesh, walk[i], b);
  const auto ux = static_cast<double>(b.at.x - a.at.x);
  const auto uz = static_cast<double>(b.at.z - a.at.z);
  const double size = ux * ux + uz * uz;
  if (!(size > 0)) return;
  const world::GroundPoint from = walk[i].at;
  const double along = std::clamp(
      (static_cast<double>(from.x - a.at.x) * ux + static_cast<double>(from.z - a.at.z) * uz) /
          size,
      0.0, 1.0);
  const double foot_x = static_cast<double>(a.at.x) + along * ux;
  const double foot_z = static_cast<double>(a.at.z) + along * uz;
  double low = 0, step = 1;
  for (int h = 0; h < kHalvings; ++h, step /= 2) {
    const double t = low + step;
    if (t > 1) continue;
    const world::GroundPoint at{from.x + std::llround(t * (foot_x - static_cast<double>(from.x))),
                                from.z + std::llround(t * (foot_z - static_cast<double>(from.z)))};
    // On whichever level the segment there leads to.
    const ViewLevel* level = mesh.level(a.level);
    if (!world::walk_far(mesh.ground(), level, a.at, at, mesh.step()).arrived) continue;
    const uint32_t rect = mesh.rect_at(*level, at.cell_x(), at.cell_z());
    const ViewStop moved{level->ground.world_level, static_cast<uint16_t>(rect - level->first_rect),
                         at};
    const double cost = segment_cost(mesh, a, moved) + segment_cost(mesh, moved, b);
    if (cost >= best) continue;
    best = cost;
    walk[i] = moved;
    low = t;
  }
}

void CostString::pull(GroundView& mesh, std::vector<ViewStop>& stops) {
  mesh_ = &mesh;
  if (std::none_of(stops.begin(), stops.end(),
                   [](const ViewStop& stop) { return stop.off_mesh_link > 0; }))
    return pull_string(*this, stops);
  whole_.clear();
  walk_.clear();
  const auto end_walk = [&] {
    pull_string(*this, walk_);
    whole_.insert(whole_.end(), walk_.begin(), walk_.end());
    walk_.clear();
  };
  for (const ViewStop& stop : stops) {
    if (stop.off_mesh_link > 0) end_walk();
    walk_.push_back(stop);
  }
  end_walk();
  stops.swap(whole_);
}

void PointSearch::begin(GroundView& mesh, const ViewStop& from, const ViewStop& to, double max_cost,
                        const Corridor* corridor) {
  to_ = to;
  corridor_ = corridor;
  max_cost_ = max_cost;
  nodes_.clear();
  open_.clear();
  expanded_ = 0;
  goal_ = UINT32_MAX;
  nearest_ = 0;
  nearest_distance_ = kNever;
  push(mesh, from, UINT32_MAX, 0);
}

ReachedPoint* PointSearch::push(GroundView& mesh, const ViewStop& stop, uint32_t parent,
                                double cost) {
  if (corridor_ != nullptr &&
      !corridor_->holds(stop.level, mesh.rect(*mesh.level(stop.level), stop.rect))) {
    return nullptr;
  }
  const auto [index, is_new] = nodes_.node_of(stop);
  ReachedPoint& node = nodes_.nodes[index];
  if (!is_new && (node.done || node.cost <= cost)) return nullptr;
  node.stop = stop;  // by an off-mesh link, or not
  node.cost = cost;
  node.parent = parent;
  const double left = distance_of(stop.at, to_.at);
  open_.push({cost + left * mesh.min_factor(), index});
  return &node;
}

// Of the node's rectangle, the point nearest to the goal; heights count, so a point below the goal
// is not at it.
void PointSearch::note_nearest(GroundView& mesh, uint32_t index) {
  const ViewStop& stop = nodes_.nodes[index].stop;
  const ViewLevel& level = *mesh.level(stop.level);
  const MeshRect& rect = mesh.rect(level, stop.rect);
  const auto clamped = [](int64_t at, int32_t first, int32_t cells) {
    return std::clamp(at, int64_t{first} << world::kUnitBits,
                      (int64_t{first + cells} << world::kUnitBits) - 1);
  };
  const world::GroundPoint at{clamped(to_.at.x, rect.x, rect.width),
                              clamped(to_.at.z, rect.z, rect.depth)};
  const auto feet = [](const ViewLevel& of, world::GroundPoint p) {
    return of.ground.view.sample(world::in_tile(p.cell_x()), world::in_tile(p.cell_z()));
  };
  const double rise =
      (feet(level, at) - feet(*mesh.level(to_.level), to_.at)) * 1e-3 / mesh.world().summary.cell;
  const double away = distance_of(at, to_.at);
  const double distance = std::sqrt(away * away + rise * rise);
  if (distance >= nearest_distance_) return;
  nearest_distance_ = distance;
  nearest_ = index;
  nearest_stop_ = {stop.level, stop.rect, at};
}

void PointSearch::push_links(GroundView& mesh, const ReachedPoint& node, uint32_t index,
                             double factor) {
  for (const GroundView::OffMeshLinkEnd& off_mesh_link : mesh.links_from(node.stop.level)) {
    ViewStop from{node.stop.level, 0, off_mesh_link.from},
        to{off_mesh_link.to_level, 0, off_mesh_link.to, off_mesh_link.cost};
    if (!mesh.stand(from.level, from.at, from.rect) || from.rect != node.stop.rect) continue;
    if (!mesh.stand(to.level, to.at, to.rect)) continue;
    const double cost =
        node.cost + distance_of(node.stop.at, from.at) * factor + off_mesh_link.cost;
    if (ReachedPoint* there = push(mesh, to, index, cost)) there->link_from = from.at;
  }
}

uint64_t PointSearch::allocated_bytes() const {
  return nodes_.allocated_bytes() + open_.allocated_bytes();
}

void PointSearch::give_back() {
  if (allocated_bytes() <= kKeptBytes) return;
  nodes_.give_back();
  open_.give_back();
}

PointSearch::State PointSearch::advance(GroundView& mesh, uint64_t max_nodes, uint64_t max_bytes) {
  for (uint64_t n = 0; n < max_nodes;) {
    if (open_.empty()) return State::kNone;
    if (mesh.counted_bytes() + nodes_.used_bytes() + open_.used_bytes() > max_bytes) {
      return State::kFull;
    }
    const Open next = open_.pop();
    if (next.bound > max_cost_) return State::kNone;  // All others cost as much or more.
    const uint32_t index = next.node;
    if (nodes_.nodes[index].done) continue;
    ++n;
    ++expanded_;
    nodes_.nodes[index].done = true;
    const ReachedPoint node = nodes_.nodes[index];
    if (same(node.stop, to_)) {
      goal_ = index;
      return State::kFound;
    }
    const ViewLevel& level = *mesh.level(node.stop.level);
    note_nearest(mesh, index);
    const double factor = mesh.factor(level, node.stop.rect);
    if (node.stop.level == to_.level && node.stop.rect == to_.rect) {
      const double away = mesh.length_now(node.stop.level, node.stop.at, to_.at);
      push(mesh, to_, index, node.cost + away * factor);
    }
    // No delay is known of links.
    if (mesh.delays() == nullptr) push_links(mesh, node, index, factor);
    for_portal_points(mesh, node.stop, [&](world::GroundPoint side, const ViewStop& beyond) {
      const double beyond_factor = mesh.factor(*mesh.level(beyond.level), beyond.rect);
      if (!std::isfinite(beyond_factor)) return;
      const double cost = node.cost +
                          mesh.length_now(node.stop.level, node.stop.at, side) * factor +
                          beyond_factor / world::kUnitsPerCell;
      push(mesh, beyond, index, cost);
    });
  }
  return State::kSearching;
}

void PointSearch::trace(GroundView& mesh, std::vector<ViewStop>& stops) const {
  stops.clear();
  uint32_t index = goal_ != UINT32_MAX ? goal_ : nearest_;
  if (goal_ == UINT32_MAX) stops.push_back(nearest_stop_);
  for (; index != UINT32_MAX; index = nodes_.nodes[index].parent) {
    const ReachedPoint& node = nodes_.nodes[index];
    stops.push_back(node.stop);
    if (node.parent == UINT32_MAX) break;
    // A stop beyond a portal was reached straight across from its other side.
    const ViewStop& before = nodes_.nodes[node.parent].stop;
    if (node.stop.off_mesh_link > 0) {
      stops.push_back({before.level, before.rect, node.link_from});
      continue;
    }
    if (before.level == node.stop.level && before.rect == node.stop.rect) continue;
    for_portal_points(mesh, before, [&](world::GroundPoint side, const ViewStop& beyond) {
      if (same(beyond, node.stop)) stops.push_back({before.level, before.rect, side});
    });
  }
  std::reverse(stops.begin(), stops.end());
}

}  // namespace throng::path
