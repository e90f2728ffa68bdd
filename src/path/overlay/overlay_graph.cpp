// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "path/overlay/overlay_graph.h"

#include <algorithm>
#include <limits>

// Dijkstra's algorithm over the arcs of one overlay cell, forward or backward. O(n log n) in the
// arcs.
namespace throng::path {
namespace {}  // namespace

uint32_t OverlayGraph::place_of(uint32_t block) const {
  const auto at = std::lower_bound(blocks_.begin(), blocks_.end(), block);
  if (at == blocks_.end() || *at != block) return graph::kNoNode;
  return static_cast<uint32_t>(at - blocks_.begin());
}

uint32_t OverlayGraph::arc_of(const Crossing& crossing) const {
  const uint32_t from = place_of(ends_of(*view_, crossing).out.block);
  if (from == graph::kNoNode) return graph::kNoNode;
  for (uint32_t w = first_arc_[from]; w < first_arc_[from + 1]; ++w) {
    if (arcs_[w].crossing == crossing) return w;
  }
  return graph::kNoNode;
}

void OverlayGraph::set(std::span<const uint32_t> blocks, bool keep) {
  blocks_ = blocks;
  expanded_ = 0;
  first_arc_.assign(1, 0);
  arcs_.clear();
  for (const uint32_t block : blocks_) {
    for_each_arc_out(*view_, block, [&](const Crossing& crossing) {
      const graph::NodePortal portal = view_->portal(crossing.portal);
      const auto [out, in] = ends_of(portal, crossing.backward);
      Arc arc{crossing, out, in, position(*view_, out), position(*view_, in)};
      arc.through = view_->cost_through(crossing.portal, portal, arc.out_at, arc.in_at);
      arc.into = place_of(in.block);
      arcs_.push_back(arc);
    });
    first_arc_.push_back(static_cast<uint32_t>(arcs_.size()));
  }
  first_in_.assign(blocks_.size() + 1, 0);
  for (const Arc& arc : arcs_) {
    if (arc.into != graph::kNoNode) ++first_in_[arc.into + 1];
  }
  for (size_t b = 0; b < blocks_.size(); ++b) first_in_[b + 1] += first_in_[b];
  in_of_.resize(first_in_.back());
  for (size_t w = arcs_.size(); w-- > 0;) {
    const uint32_t into = arcs_[w].into;
    if (into == graph::kNoNode) continue;
    // Filled from the end of each block's own: what is left of them is counted in `first_in_`.
    in_of_[--first_in_[into + 1]] = static_cast<uint32_t>(w);
  }
  // Each count now stands one place late.
  first_in_.erase(first_in_.begin());
  first_in_.push_back(static_cast<uint32_t>(in_of_.size()));
  first_kept_.clear();
  kept_.clear();
  if (!keep) return;
  for (const Arc& arc : arcs_) {
    first_kept_.push_back(kept_.size());
    if (arc.into == graph::kNoNode) continue;
    for (uint32_t w = first_arc_[arc.into]; w < first_arc_[arc.into + 1]; ++w) {
      kept_.push_back(piece(arc.in, arc.in_at, arcs_[w].out, arcs_[w].out_at));
    }
  }
}

void OverlayGraph::reach(uint32_t arc, double cost) {
  if (cost >= cost_[arc]) return;
  cost_[arc] = cost;
  open_.push({cost, arc});
}

// False if nothing is left, of the slice or to expand.
bool OverlayGraph::next(Open& top, Slice& slice) {
  while (!open_.empty() && !slice.is_empty()) {
    top = open_.pop();
    if (top.cost > cost_[top.arc]) continue;
    slice.take();
    ++expanded_;
    return true;
  }
  return false;
}

const std::vector<double>& OverlayGraph::run(const BlockPoint& from) {
  begin(from);
  Slice all;
  advance(all);
  return cost_;
}

const std::vector<double>& OverlayGraph::run_back(const BlockPoint& to) {
  begin_back(to);
  Slice all;
  advance_back(all);
  return cost_;
}

void OverlayGraph::begin(const BlockPoint& from) {
  cost_.assign(arcs_.size(), kNoPath);
  open_.clear();
  const uint32_t start = place_of(from.block);
  const Vec3d at = position(*view_, from);
  for (uint32_t w = first_arc_[start]; w < first_arc_[start + 1]; ++w) {
    reach(w, piece(from, at, arcs_[w].out, arcs_[w].out_at) + arcs_[w].through);
  }
}

bool OverlayGraph::advance(Slice& slice) {
  for (Open top; next(top, slice);) {
    const Arc& arc = arcs_[top.arc];
    if (arc.into == graph::kNoNode) continue;
    const uint32_t first = first_arc_[arc.into], last = first_arc_[arc.into + 1];
    for (uint32_t w = first; w < last; ++w) {
      if (cost_[w] <= top.cost) continue;
      const double along = kept_.empty() ? piece(arc.in, arc.in_at, arcs_[w].out, arcs_[w].out_at)
                                         : kept_[first_kept_[top.arc] + w - first];
      reach(w, top.cost + along + arcs_[w].through);
    }
  }
  return open_.empty();
}

void OverlayGraph::begin_back(const BlockPoint& to) {
  cost_.assign(arcs_.size(), kNoPath);
  open_.clear();
  goal_ = to;
  goal_at_ = position(*view_, to);
  const uint32_t goal = place_of(to.block);
  for (uint32_t k = first_in_[goal]; k < first_in_[goal + 1]; ++k) {
    const Arc& arc = arcs_[in_of_[k]];
    reach(in_of_[k], piece(arc.in, arc.in_at, goal_, goal_at_));
  }
}

bool OverlayGraph::advance_back(Slice& slice) {
  for (Open top; next(top, slice);) {
    const Arc& arc = arcs_[top.arc];
    const uint32_t from = place_of(arc.out.block);
    for (uint32_t k = first_in_[from]; k < first_in_[from + 1]; ++k) {
      const Arc& before = arcs_[in_of_[k]];
      if (cost_[in_of_[k]] <= top.cost) continue;
      reach(in_of_[k],
            piece(before.in, before.in_at, arc.out, arc.out_at) + arc.through + top.cost);
    }
  }
  return open_.empty();
}

double OverlayGraph::rest(const BlockPoint& from) const {
  const Vec3d at = position(*view_, from);
  double least = from.block == goal_.block ? piece(from, at, goal_, goal_at_) : kNoPath;
  const uint32_t start = place_of(from.block);
  for (uint32_t w = first_arc_[start]; w < first_arc_[start + 1]; ++w) {
    const Arc& arc = arcs_[w];
    if (arc.into == graph::kNoNode || cost_[w] >= least) continue;
    least = std::min(least, piece(from, at, arc.out, arc.out_at) + arc.through + cost_[w]);
  }
  return least;
}

}  // namespace throng::path
