// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "path/surface/node_search.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/access.h"
#include "world/zone_data.h"

// A* over the crossings of portals: Hart, Nilsson, Raphael. A formal basis for the heuristic
// determination of minimum cost paths. 1968. A path leads from the middle of one portal to the
// middle of the next, straight in the parameters of their block; a piece is measured over its
// middle, so it is never shorter than the straight line, and the straight line to the goal never
// overestimates: times the least cost of a metre, where that is less than 1. Time: n log n in the
// crossings that it reaches.
namespace throng::path {
namespace {

constexpr double kMaxStraightPiece = 1;  // Pieces up to here count as straight. [m]

// From 1, where no more is promised than the body takes, to 0, where it is the most that nodes can
// promise.
double shortage(double promised, double own, double most) {
  return most > own ? std::clamp((most - promised) / (most - own), 0.0, 1.0) : 0;
}

}  // namespace

std::vector<double> added_costs(const graph::NodeMesh& mesh, double narrow_cost, double low_cost) {
  std::vector<double> added;
  if (narrow_cost == 0 && low_cost == 0) return added;
  const Nodes& nodes = mesh.nodes();
  const NodeBins& bins = data_of(nodes)->summary.bins;
  const world::WorldData& world = *data_of(data_of(nodes)->world);
  const AvatarClass& avatar = world.summary.classes[static_cast<size_t>(mesh.avatar_class())];
  const double widest = bins.width.empty() ? 0 : bins.width.back();
  const double tallest = bins.height.empty() ? 0 : bins.height.back();
  added.reserve(mesh.blocks().size());
  uint32_t last = graph::kNoNode;
  for (const graph::NodeBlock& block : mesh.blocks()) {
    if (block.node == last) {  // Most blocks of a node follow each other.
      added.push_back(added.back());
      continue;
    }
    last = block.node;
    const NodeInfo info = nodes.node(block.node);
    const uint8_t height = avatar.climb_slope > 0 ? info.height : info.headroom;
    added.push_back(narrow_cost * shortage(bins.width_of(info.width), avatar.radius, widest) +
                    low_cost * shortage(bins.height_of(height), avatar.height, tallest));
  }
  return added;
}

PieceCost::PieceCost(const NodeView& view, double slope_cost, std::span<const double> added)
    : view_(&view), slope_cost_(slope_cost), added_(added) {
  const NodeBins& bins = data_of(view.mesh().nodes())->summary.bins;
  for (uint8_t code = 0; code < 16; ++code) {
    const double degrees = bins.inclination_of(code);
    // To 9 digits: the last bits of cos() differ between machines' libraries.
    const double cosine = std::round(std::cos(degrees * std::numbers::pi / 180) * 1e9) / 1e9;
    by_code_.push_back(1 + slope_cost * (1 - cosine));
  }
}

PieceCost::Piece PieceCost::operator()(uint32_t block, double s0, double t0, Vec3d from, double s1,
                                       double t1, Vec3d to) const {
  const graph::NodeSurface& surface = view_->surface(block);
  const double straight = length(to - from), factor = view_->factor(block);
  const double added = added_.empty() ? 0 : added_[view_->base_of(block)];
  if (surface.points == nullptr) {
    return {straight, straight * (by_code_[view_->block(block).inclination] + added) * factor};
  }
  const double s = (s0 + s1) / 2, t = (t0 + t1) / 2;
  double along = straight;
  if (straight > kMaxStraightPiece) {
    const Vec3d middle = surface.at(s, t);
    along = length(middle - from) + length(to - middle);
  }
  if (slope_cost_ == 0) return {along, along * (1 + added) * factor};
  return {along, along * (1 + slope_cost_ * (1 - surface.normal(s, t).y) + added) * factor};
}

void NodeSearch::push(double estimate, uint32_t state) { open_.push({estimate, state}); }

void NodeSearch::expand(const BlockPoint& from, Vec3d at, double cost, uint32_t parent) {
  for_each_arc_out(*view_, from.block, [&](const Crossing& crossing) {
    const uint32_t id = 2 * crossing.portal + (crossing.backward ? 1 : 0);
    if ((id ^ 1) == parent || id == parent) return;
    const graph::PortalSides sides = view_->sides(crossing.portal);
    const uint32_t into = crossing.backward ? sides.a : sides.b;
    if (within_.overlay_cell_of_block != nullptr &&
        within_.overlay_cell_of_block[view_->base_of(into)] != within_.overlay_cell) {
      return;
    }
    State& state = states_[id];
    if (states_.is_reached(state) && state.cost <= cost) return;
    const graph::NodePortal portal = view_->portal(crossing.portal);
    const auto [out, in] = ends_of(portal, crossing.backward);
    const Vec3d here = position(*view_, out);
    double next = cost + (*cost_)(out.block, from.s, from.t, at, out.s, out.t, here).cost;
    if (states_.is_reached(state) && state.cost <= next) return;
    const Vec3d there = position(*view_, in);
    next += view_->cost_through(crossing.portal, portal, here, there);
    if (states_.is_reached(state) && state.cost <= next) return;
    met_ += states_.is_reached(state) ? 0 : 1;
    state = {states_.search(), parent, next, there, false};
    push(next + length(goal_ - there) * min_factor_, id);
  });
}

PathEnd NodeSearch::find(const BlockPoint& from, const BlockPoint& to, const SearchBudget& budget,
                         std::vector<Crossing>& crossings, const SearchBounds& within,
                         double less_than) {
  begin(from, to, within, less_than);
  Slice all;
  return *advance(budget, all, crossings);
}

void NodeSearch::begin(const BlockPoint& from, const BlockPoint& to, const SearchBounds& within,
                       double less_than) {
  expanded_ = met_ = 0;
  best_cost_ = 0;
  within_ = within;
  states_.begin(2 * view_->portal_count());
  open_.clear();
  to_ = to;
  goal_ = position(*view_, to);
  min_factor_ = view_->min_factor();
  less_than_ = less_than;
  found_ = std::numeric_limits<double>::infinity();
  last_ = kStart;
  const Vec3d start = position(*view_, from);
  arrive(from, start, 0, kStart);
  expand(from, start, 0, kStart);
  nearest_ = length(goal_ - start);
  nearest_state_ = kStart;
}

std::optional<PathEnd> NodeSearch::advance(const SearchBudget& budget, Slice& slice,
                                           std::vector<Crossing>& crossings) {
  crossings.clear();
  const std::optional<PathEnd> end = search(budget, slice, crossings);
  if (end) give_back();
  return end;
}

uint64_t NodeSearch::used_bytes() const {
  return met_ * sizeof(State) + open_.used_bytes();  // as PathSearch::used_bytes
}

uint64_t NodeSearch::allocated_bytes() const {
  return states_.allocated_bytes() + open_.allocated_bytes();
}

void NodeSearch::give_back() {
  if (allocated_bytes() <= kKeptBytes) return;
  states_.give_back();
  open_.give_back();
}

void NodeSearch::arrive(const BlockPoint& in, Vec3d at, double cost, uint32_t parent) {
  if (in.block != to_.block) return;
  const double all = cost + (*cost_)(in.block, in.s, in.t, at, to_.s, to_.t, goal_).cost;
  if (all >= found_) return;
  found_ = all;
  last_ = parent;
  push(all, kGoal);
}

std::optional<PathEnd> NodeSearch::search(const SearchBudget& budget, Slice& slice,
                                          std::vector<Crossing>& crossings) {
  while (!open_.empty()) {
    if (slice.is_empty()) return {};
    const Open top = open_.pop();
    if (top.estimate >= less_than_) break;
    if (top.state == kGoal) {
      best_cost_ = found_;
      trace(last_, crossings);
      return PathEnd::kReached;
    }
    State& state = states_[top.state];
    if (state.closed) continue;
    state.closed = true;
    slice.take();
    if (budget.is_spent(++expanded_, used_bytes())) return PathEnd::kBudgetExhausted;
    const BlockPoint in = ends_of(*view_, {top.state / 2, (top.state & 1) != 0}).in;
    const Vec3d at = state.at;
    const double cost = state.cost;
    if (const double far = length(goal_ - at); far < nearest_) {
      nearest_ = far;
      nearest_state_ = top.state;
    }
    arrive(in, at, cost, top.state);
    expand(in, at, cost, top.state);
  }
  best_cost_ = nearest_state_ == kStart ? 0 : states_[nearest_state_].cost;
  trace(nearest_state_, crossings);
  return PathEnd::kUnreachable;
}

void NodeSearch::trace(uint32_t state, std::vector<Crossing>& crossings) {
  for (; state != UINT32_MAX; state = states_[state].parent) {
    crossings.push_back({state / 2, (state & 1) != 0});
  }
  std::reverse(crossings.begin(), crossings.end());
}

}  // namespace throng::path
