// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "path/node_search.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

// Hart, Nilsson, Raphael. A formal basis for the heuristic determination of minimum cost paths.
// 1968. A way goes from the middle of one portal to the middle of the next, straight by the
// parameters of their block; a piece is measured over its middle, so it is never shorter than the
// straight line, and the straight line to the goal never says too much. Nor do landmarks; but what
// they say is rounded, so a state may be found a better way to after it was left.
namespace throng {
namespace {

constexpr double kShort = 1;  // Pieces up to here are taken for straight. [m]

}  // namespace

PieceCost::PieceCost(const NodeMesh& mesh, double slope_cost)
    : mesh_(&mesh), slope_cost_(slope_cost) {
  const NodeBins& bins = mesh.nodes().data()->summary.bins;
  for (uint8_t code = 0; code < 16; ++code) {
    const double degrees = bins.inclination_of(code);
    // To 9 digits: the last bits of cos() differ between machines' libraries.
    const double cosine = std::round(std::cos(degrees * std::numbers::pi / 180) * 1e9) / 1e9;
    by_code_.push_back(1 + slope_cost * (1 - cosine));
  }
}

PieceCost::Piece PieceCost::operator()(uint32_t block, double s0, double t0, Vec3d from, double s1,
                                       double t1, Vec3d to) const {
  const NodeSurface& surface = mesh_->surface(block);
  const double straight = length(to - from);
  if (surface.points == nullptr) {
    return {straight, straight * by_code_[mesh_->blocks()[block].inclination]};
  }
  const double s = (s0 + s1) / 2, t = (t0 + t1) / 2;
  double along = straight;
  if (straight > kShort) {
    const Vec3d middle = surface.at(s, t);
    along = length(middle - from) + length(to - middle);
  }
  if (slope_cost_ == 0) return {along, along};
  return {along, along * (1 + slope_cost_ * (1 - surface.normal(s, t).y))};
}

void NodeSearch::push(double estimate, uint32_t state) {
  open_.push_back({estimate, state});
  std::push_heap(open_.begin(), open_.end(), [](const Open& a, const Open& b) {
    return a.estimate != b.estimate ? a.estimate > b.estimate : a.state > b.state;
  });
}

double NodeSearch::left(uint32_t portal, Vec3d at) const {
  return std::max(length(goal_ - at), landmarks_->least(portal, goal_far_));
}

void NodeSearch::expand(uint32_t block, double s, double t, Vec3d at, double cost,
                        uint32_t parent) {
  for (const uint32_t p : mesh_->portals_of(block)) {
    const NodePortal& portal = mesh_->portals()[p];
    const bool backward = portal.a != block;
    const uint32_t id = 2 * p + (backward ? 1 : 0);
    if ((backward && portal.one_way) || (id ^ 1) == parent || id == parent) continue;
    State& state = states_[id];
    if (state.query == query_ && state.cost <= cost) continue;
    const auto& on = backward ? portal.on_b : portal.on_a;
    const auto& beyond = backward ? portal.on_a : portal.on_b;
    const double s1 = (on[0] + on[2]) / 2, t1 = (on[1] + on[3]) / 2;
    const Vec3d here = mesh_->surface(block).at(s1, t1);
    double next = cost + (*cost_)(block, s, t, at, s1, t1, here).cost;
    if (state.query == query_ && state.cost <= next) continue;
    const uint32_t into = backward ? portal.a : portal.b;
    const Vec3d there =
        mesh_->surface(into).at((beyond[0] + beyond[2]) / 2, (beyond[1] + beyond[3]) / 2);
    next += portal_length(portal, here, there);
    if (state.query == query_ && state.cost <= next) continue;
    state = {query_, parent, next, there, false};
    push(next + left(p, there), id);
  }
}

PathEnd NodeSearch::find(const BlockPoint& from, const BlockPoint& to, const SearchBudget& budget,
                         std::vector<Crossing>& way) {
  way.clear();
  looked_at_ = 0;
  states_.resize(2 * mesh_->portals().size());
  if (++query_ == 0) {  // After 2^32 queries the marks begin anew.
    std::fill(states_.begin(), states_.end(), State{});
    query_ = 1;
  }
  open_.clear();
  goal_ = mesh_->surface(to.block).at(to.s, to.t);
  goal_far_ = landmarks_->of(*mesh_, to.block, goal_);
  const Vec3d start = mesh_->surface(from.block).at(from.s, from.t);
  constexpr uint32_t kGoal = UINT32_MAX - 1, kStart = UINT32_MAX;
  double found = std::numeric_limits<double>::infinity();
  uint32_t last = kStart;
  const auto arrive = [&](uint32_t block, double s, double t, Vec3d at, double cost,
                          uint32_t parent) {
    if (block != to.block) return;
    const double all = cost + (*cost_)(block, s, t, at, to.s, to.t, goal_).cost;
    if (all >= found) return;
    found = all;
    last = parent;
    push(all, kGoal);
  };
  arrive(from.block, from.s, from.t, start, 0, kStart);
  expand(from.block, from.s, from.t, start, 0, kStart);
  double nearest = length(goal_ - start);
  uint32_t nearest_state = kStart;
  while (!open_.empty()) {
    std::pop_heap(open_.begin(), open_.end(), [](const Open& a, const Open& b) {
      return a.estimate != b.estimate ? a.estimate > b.estimate : a.state > b.state;
    });
    const Open top = open_.back();
    open_.pop_back();
    if (top.state == kGoal) {
      best_cost_ = found;
      trace(last, way);
      return PathEnd::kReached;
    }
    State& state = states_[top.state];
    if (state.closed) continue;
    state.closed = true;
    if (budget.is_spent(++looked_at_)) return PathEnd::kGaveUp;
    const NodePortal& portal = mesh_->portals()[top.state / 2];
    const bool backward = (top.state & 1) != 0;
    const uint32_t block = backward ? portal.a : portal.b;
    const auto& in = backward ? portal.on_a : portal.on_b;
    const double s = (in[0] + in[2]) / 2, t = (in[1] + in[3]) / 2;
    const Vec3d at = state.at;
    const double cost = state.cost;
    if (const double far = length(goal_ - at); far < nearest) {
      nearest = far;
      nearest_state = top.state;
    }
    arrive(block, s, t, at, cost, top.state);
    expand(block, s, t, at, cost, top.state);
  }
  best_cost_ = nearest_state == kStart ? 0 : states_[nearest_state].cost;
  trace(nearest_state, way);
  return PathEnd::kUnreachable;
}

void NodeSearch::trace(uint32_t state, std::vector<Crossing>& way) const {
  for (; state != UINT32_MAX; state = states_[state].parent) {
    way.push_back({state / 2, (state & 1) != 0});
  }
  std::reverse(way.begin(), way.end());
}

}  // namespace throng
