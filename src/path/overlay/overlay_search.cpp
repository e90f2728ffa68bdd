// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "path/overlay/overlay_search.h"

#include <algorithm>
#include <limits>

// A* over entrances, then a search of each overlay cell crossed. Source: [BMS04], [DGPW11].
namespace throng::path {

void OverlaySearch::begin() {
  states_.begin(2 * overlay_->entrances().size());
  open_.clear();
}

void OverlaySearch::reach(uint32_t entry, uint32_t parent, double cost, uint8_t overlay_level,
                          Vec3d goal) {
  State& state = states_[entry];
  if (!(cost < kNoPath) || (states_.is_reached(state) && state.cost <= cost)) return;
  if (now_.is_closed(entry)) return;
  state = {states_.search(), parent, cost, overlay_level, false};
  open_.push({cost + length(goal - now_.at(entry)), entry});
}

bool OverlaySearch::next(Open& top) {
  while (!open_.empty()) {
    top = open_.pop();
    if (states_[top.entry].closed) continue;
    states_[top.entry].closed = true;
    return true;
  }
  return false;
}

PathEnd OverlaySearch::find(const BlockPoint& from, const BlockPoint& to,
                            const SearchBudget& budget, NodeSearch& blocks,
                            std::vector<Crossing>& crossings) {
  crossings.clear();
  expanded_ = 0;
  cost_ = 0;
  if (const PathEnd end = over_entrances(from, to, budget); end != PathEnd::kReached) return end;
  const std::vector<uint32_t>& of_block = overlay_->of_block();
  if (first_ == kNoEntry)
    return within(of_block[view_->base_of(from.block)], from, to, budget, blocks, crossings);
  for (size_t overlay_level = overlay_->overlay_levels().size(); --overlay_level > 0;) {
    finer_.clear();
    for (const Stretch& stretch : stretches_) {
      if (stretch.overlay_level < overlay_level) {
        finer_.push_back(stretch);
      } else if (!refine(stretch)) {
        return PathEnd::kUnreachable;  // Never: an overlay level is made from the one below.
      }
    }
    stretches_.swap(finer_);
  }
  BlockPoint at = from;
  joints_.clear();
  const auto go_to = [&](uint32_t entry) {
    const Crossing crossing = now_.crossing(entry);
    const auto [out, in] = ends_of(*view_, crossing);
    const PathEnd end =
        within(of_block[view_->base_of(at.block)], at, out, budget, blocks, crossings);
    if (end != PathEnd::kReached) return end;
    joints_.push_back(crossings.size());
    crossings.push_back(crossing);
    cost_ +=
        graph::portal_length(view_->portal(crossing.portal), position(*view_, out), now_.at(entry));
    at = in;
    return end;
  };
  PathEnd end = go_to(first_);
  for (size_t i = 0; i < stretches_.size() && end == PathEnd::kReached; ++i) {
    end = go_to(stretches_[i].to);
  }
  if (end == PathEnd::kReached)
    end = within(of_block[view_->base_of(to.block)], at, to, budget, blocks, crossings);
  if (end == PathEnd::kReached) straighten(from, to, budget, blocks, crossings);
  return end;
}

// From the middle of one overlay cell to the middle of the next, the path is searched for again,
// without having to pass the entrance between them.
void OverlaySearch::straighten(const BlockPoint& from, const BlockPoint& to,
                               const SearchBudget& budget, NodeSearch& blocks,
                               std::vector<Crossing>& crossings) {
  straightened_.clear();
  cost_ = 0;
  BlockPoint begin = from;
  size_t first = 0;  // of the stretch that is replaced
  for (size_t i = 0; i < joints_.size(); ++i) {
    const bool ends = i + 1 == joints_.size();
    const size_t last = ends ? crossings.size() : (joints_[i] + joints_[i + 1]) / 2;
    if (!ends && last == joints_[i]) continue;  // No middle: over both entrances at once.
    const BlockPoint end = ends ? to : ends_of(*view_, crossings[last]).out;
    const double known = cost_of(begin, end, crossings.data() + first, crossings.data() + last);
    constexpr double kGain = 1e-6;  // Anything less is rounding.
    SearchBudget left = budget;
    left.max_nodes = budget.max_nodes - std::min(budget.max_nodes, expanded_);
    const bool cheaper =
        blocks.find(begin, end, left, piece_, {}, known * (1 - kGain)) == PathEnd::kReached;
    expanded_ += blocks.expanded();
    if (cheaper) {
      straightened_.insert(straightened_.end(), piece_.begin(), piece_.end());
      cost_ += blocks.cost();
    } else {
      straightened_.insert(straightened_.end(), crossings.begin() + static_cast<ptrdiff_t>(first),
                           crossings.begin() + static_cast<ptrdiff_t>(last));
      cost_ += known;
    }
    if (ends) break;
    straightened_.push_back(crossings[last]);
    const auto [out, in] = ends_of(*view_, crossings[last]);
    cost_ += graph::portal_length(view_->portal(crossings[last].portal), position(*view_, out),
                                  position(*view_, in));
    begin = in;
    first = last + 1;
  }
  crossings.swap(straightened_);
}

double OverlaySearch::cost_of(const BlockPoint& from, const BlockPoint& to, const Crossing* first,
                              const Crossing* last) const {
  double cost = 0;
  BlockPoint at = from;
  Vec3d here = position(*view_, at);
  const auto go = [&](const BlockPoint& next) {
    const Vec3d there = position(*view_, next);
    cost += (*piece_cost_)(at.block, at.s, at.t, here, next.s, next.t, there).cost;
    here = there;
  };
  for (; first != last; ++first) {
    const auto [out, in] = ends_of(*view_, *first);
    go(out);
    const Vec3d beyond = position(*view_, in);
    cost += graph::portal_length(view_->portal(first->portal), here, beyond);
    at = in;
    here = beyond;
  }
  go(to);
  return cost;
}

// A* over entries. An overlay cell that does not hold the goal is crossed as one of the highest
// overlay level whose border the search crossed to enter it.
PathEnd OverlaySearch::over_entrances(const BlockPoint& from, const BlockPoint& to,
                                      const SearchBudget& budget) {
  const auto& overlay_levels = overlay_->overlay_levels();
  const std::vector<uint32_t>& of_block = overlay_->of_block();
  const uint32_t start_cell = of_block[view_->base_of(from.block)],
                 goal_cell = of_block[view_->base_of(to.block)];
  const Vec3d goal = position(*view_, to);
  stretches_.clear();
  // The remaining cost from the entries of the goal's overlay cell, and from the start if it is in
  // that cell too.
  graph_.set(now_.blocks_of(goal_cell), false);
  graph_.run_back(to);
  const auto goal_entries = overlay_levels.front().entries_of(goal_cell);
  rest_.clear();
  for (const uint32_t entry : goal_entries) {
    if (now_.is_closed(entry)) {
      rest_.push_back(kNoPath);
      continue;
    }
    const Crossing crossing = now_.crossing(entry);
    const bool closed = crossing.backward && view_->portal(crossing.portal).one_way;
    rest_.push_back(closed ? kNoPath : graph_.rest(ends_of(*view_, crossing).in));
  }
  double found = start_cell == goal_cell ? graph_.rest(from) : kNoPath;
  first_ = last_ = kNoEntry;
  expanded_ += graph_.expanded();
  graph_.set(now_.blocks_of(start_cell), false);
  const std::vector<double>& costs = graph_.run(from);
  expanded_ += graph_.expanded();
  if (budget.is_spent(expanded_)) return PathEnd::kBudgetExhausted;
  begin();
  for (const uint32_t entry : overlay_levels.front().entries_of(start_cell)) {
    const uint32_t out = entry ^ 1;
    if (now_.is_closed(out)) continue;
    const uint32_t arc = graph_.arc_of(now_.crossing(out));
    if (arc != graph::kNoNode) reach(out, kNoEntry, costs[arc], 0, goal);
  }
  // By overlay level: the cell of the goal.
  std::array<uint32_t, 32> holds_goal{};
  uint32_t overlay_cell = goal_cell;
  for (size_t k = 0; k < overlay_levels.size(); ++k) {
    holds_goal[k] = overlay_cell;
    if (k + 1 < overlay_levels.size()) overlay_cell = overlay_levels[k].above[overlay_cell];
  }
  for (Open top; next(top);) {
    if (top.estimate >= found) break;
    if (budget.is_spent(++expanded_, open_.used_bytes())) return PathEnd::kBudgetExhausted;
    const uint32_t entry = top.entry;
    const double cost = states_[entry].cost;
    if (overlay_levels.front().of_entry[entry] == goal_cell) {
      const double all = cost + rest_[overlay_levels.front().place[entry]];
      if (all < found) {
        found = all;
        last_ = entry;
      }
    }
    uint8_t overlay_level = overlay_->entrances()[entry / 2].overlay_level;
    const auto is_opened = [&] {
      const uint32_t through = overlay_levels[overlay_level].of_entry[entry];
      return through == holds_goal[overlay_level] || now_.is_stale(overlay_level, through);
    };
    while (overlay_level > 0 && is_opened()) --overlay_level;
    const bool is_stale =
        now_.is_stale(overlay_level, overlay_levels[overlay_level].of_entry[entry]);
    const auto through =
        is_stale ? now_.costs_from(entry) : overlay_levels[overlay_level].costs_from(entry);
    const auto others =
        overlay_levels[overlay_level].entries_of(overlay_levels[overlay_level].of_entry[entry]);
    for (size_t j = 0; j < others.size(); ++j) {
      reach(others[j] ^ 1, entry, cost + double{through[j]}, overlay_level, goal);
    }
  }
  if (!(found < kNoPath)) return PathEnd::kUnreachable;
  for (uint32_t entry = last_; entry != kNoEntry; entry = states_[entry].parent) {
    const State& state = states_[entry];
    first_ = entry;
    if (state.parent != kNoEntry) stretches_.push_back({state.parent, entry, state.overlay_level});
  }
  std::reverse(stretches_.begin(), stretches_.end());
  return PathEnd::kReached;
}

// Adds the same stretch to `finer_`, through overlay cells of the level below.
bool OverlaySearch::refine(const Stretch& stretch) {
  const Overlay::OverlayLevel& overlay_level = overlay_->overlay_levels()[stretch.overlay_level];
  const Overlay::OverlayLevel& below =
      overlay_->overlay_levels()[stretch.overlay_level - size_t{1}];
  const auto finer = static_cast<uint8_t>(stretch.overlay_level - 1);
  const uint32_t overlay_cell = overlay_level.of_entry[stretch.from];
  const Vec3d goal = now_.at(stretch.to);
  begin();
  reach(stretch.from, kNoEntry, 0, 0, goal);
  for (Open top; next(top);) {
    if (top.entry == stretch.to) break;
    ++expanded_;
    const double cost = states_[top.entry].cost;
    const auto through = below.costs_from(top.entry);
    const auto others = below.entries_of(below.of_entry[top.entry]);
    for (size_t j = 0; j < others.size(); ++j) {
      const uint32_t out = others[j] ^ 1;
      if (out != stretch.to && below.above[below.of_entry[out]] != overlay_cell) continue;
      reach(out, top.entry, cost + double{through[j]}, finer, goal);
    }
  }
  if (!states_.is_reached(states_[stretch.to])) return false;
  const size_t first = finer_.size();
  for (uint32_t entry = stretch.to; entry != stretch.from; entry = states_[entry].parent) {
    finer_.push_back({states_[entry].parent, entry, finer});
  }
  std::reverse(finer_.begin() + static_cast<ptrdiff_t>(first), finer_.end());
  return true;
}

PathEnd OverlaySearch::within(uint32_t overlay_cell, const BlockPoint& from, const BlockPoint& to,
                              const SearchBudget& budget, NodeSearch& blocks,
                              std::vector<Crossing>& crossings) {
  SearchBudget left = budget;
  left.max_nodes = budget.max_nodes > expanded_ ? budget.max_nodes - expanded_ : 0;
  const PathEnd end =
      blocks.find(from, to, left, piece_, {overlay_->of_block().data(), overlay_cell});
  expanded_ += blocks.expanded();
  if (end == PathEnd::kReached) {
    crossings.insert(crossings.end(), piece_.begin(), piece_.end());
    cost_ += blocks.cost();
  }
  return end;
}

}  // namespace throng::path
