// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "path/overlay/overlay_search.h"

#include <algorithm>
#include <limits>

// A* over entrances, then a search of each overlay cell crossed. Source: [BMS04], [DGPW11]. Time: n
// log n in the entrances that it reaches, then in the blocks of the overlay cells crossed.
namespace throng::path {

void OverlaySearch::begin_states() {
  states_.begin(2 * overlay_->entrances().size());
  open_.clear();
}

void OverlaySearch::reach(uint32_t entry, uint32_t parent, double cost, uint8_t overlay_level,
                          Vec3d goal) {
  State& state = states_[entry];
  if (!(cost < kNoPath) || (states_.is_reached(state) && state.cost <= cost)) return;
  if (now_.is_closed(entry)) return;
  state = {states_.search(), parent, cost, overlay_level, false};
  open_.push({cost + length(goal - now_.at(entry)) * view_->min_factor(), entry});
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
  begin(from, to);
  Slice all;
  return *advance(budget, all, blocks, crossings);
}

void OverlaySearch::begin(const BlockPoint& from, const BlockPoint& to) {
  const std::vector<uint32_t>& of_block = overlay_->of_block();
  from_ = from;
  to_ = to;
  goal_ = position(*view_, to);
  start_cell_ = of_block[view_->base_of(from.block)];
  goal_cell_ = of_block[view_->base_of(to.block)];
  expanded_ = 0;
  cost_ = 0;
  stretches_.clear();
  first_ = last_ = kNoEntry;
  step_ = Step::kBack;
  graph_.set(now_.blocks_of(goal_cell_), false);
  graph_.begin_back(to);
}

std::optional<PathEnd> OverlaySearch::advance(const SearchBudget& budget, Slice& slice,
                                              NodeSearch& blocks,
                                              std::vector<Crossing>& crossings) {
  if (step_ < Step::kRefine) {
    crossings.clear();
    const auto end = over_entrances(budget, slice);
    if (end != PathEnd::kReached) return end;
    overlay_level_ = overlay_->overlay_levels().size() - 1;
    index_ = 0;
    is_begun_ = false;
    finer_.clear();
    step_ = Step::kRefine;
  }
  if (step_ == Step::kRefine) {
    const auto end = refine_all(slice);
    if (end != PathEnd::kReached) return end;
    index_ = 0;
    is_begun_ = false;
    at_ = from_;
    joints_.clear();
    step_ = Step::kJoin;
  }
  if (step_ == Step::kJoin) {
    const auto end = join(budget, slice, blocks, crossings);
    if (end != PathEnd::kReached || first_ == kNoEntry) return end;
    straightened_.clear();
    cost_ = 0;
    index_ = first_crossing_ = 0;
    is_begun_ = false;
    at_ = from_;
    step_ = Step::kStraighten;
  }
  if (!straighten(budget, slice, blocks, crossings)) return {};
  return PathEnd::kReached;
}

// To the start of each entrance of the path, over it, and at last to the goal.
std::optional<PathEnd> OverlaySearch::join(const SearchBudget& budget, Slice& slice,
                                           NodeSearch& blocks, std::vector<Crossing>& crossings) {
  const size_t entries = first_ == kNoEntry ? 0 : stretches_.size() + 1;
  for (; index_ < entries; ++index_) {
    const uint32_t entry = index_ == 0 ? first_ : stretches_[index_ - 1].to;
    const Crossing crossing = now_.crossing(entry);
    const auto [out, in] = ends_of(*view_, crossing);
    const auto end = within(out, budget, slice, blocks, crossings);
    if (end != PathEnd::kReached) return end;
    joints_.push_back(crossings.size());
    crossings.push_back(crossing);
    cost_ += view_->cost_through(crossing.portal, view_->portal(crossing.portal),
                                 position(*view_, out), now_.at(entry));
    at_ = in;
  }
  return within(to_, budget, slice, blocks, crossings);
}

// From the middle of one overlay cell to the middle of the next, the path is searched for again,
// without having to pass the entrance between them. False: the slice is spent.
bool OverlaySearch::straighten(const SearchBudget& budget, Slice& slice, NodeSearch& blocks,
                               std::vector<Crossing>& crossings) {
  for (; index_ < joints_.size(); ++index_) {
    const bool ends = index_ + 1 == joints_.size();
    const size_t last = ends ? crossings.size() : (joints_[index_] + joints_[index_ + 1]) / 2;
    if (!ends && last == joints_[index_]) continue;  // No middle: over both entrances at once.
    const BlockPoint end = ends ? to_ : ends_of(*view_, crossings[last]).out;
    const size_t first = first_crossing_;
    const double known = cost_of(at_, end, crossings.data() + first, crossings.data() + last);
    constexpr double kGain = 1e-6;  // Anything less is rounding.
    const auto found = find_piece(at_, end, {}, known * (1 - kGain), budget, slice, blocks);
    if (!found) return false;
    if (found == PathEnd::kReached) {
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
    cost_ += view_->cost_through(crossings[last].portal, view_->portal(crossings[last].portal),
                                 position(*view_, out), position(*view_, in));
    at_ = in;
    first_crossing_ = last + 1;
  }
  crossings.swap(straightened_);
  return true;
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
    cost += view_->cost_through(first->portal, view_->portal(first->portal), here, beyond);
    at = in;
    here = beyond;
  }
  go(to);
  return cost;
}

// An overlay cell that does not hold the goal is crossed as one of the highest overlay level whose
// border the search crossed to enter it.
std::optional<PathEnd> OverlaySearch::over_entrances(const SearchBudget& budget, Slice& slice) {
  if (step_ == Step::kBack) {
    if (!graph_.advance_back(slice)) return {};
    note_rest();
    expanded_ += graph_.expanded();
    graph_.set(now_.blocks_of(start_cell_), false);
    graph_.begin(from_);
    step_ = Step::kOut;
  }
  if (step_ == Step::kOut) {
    if (!graph_.advance(slice)) return {};
    expanded_ += graph_.expanded();
    if (budget.is_spent(expanded_)) return PathEnd::kBudgetExhausted;
    begin_entrances();
    step_ = Step::kEntrances;
  }
  while (!open_.empty()) {
    if (slice.is_empty()) return {};
    Open top;
    if (!next(top) || top.estimate >= found_) break;
    slice.take();
    if (budget.is_spent(++expanded_, open_.used_bytes())) return PathEnd::kBudgetExhausted;
    expand(top.entry);
  }
  if (!(found_ < kNoPath)) return PathEnd::kUnreachable;
  for (uint32_t entry = last_; entry != kNoEntry; entry = states_[entry].parent) {
    const State& state = states_[entry];
    first_ = entry;
    if (state.parent != kNoEntry) stretches_.push_back({state.parent, entry, state.overlay_level});
  }
  std::reverse(stretches_.begin(), stretches_.end());
  return PathEnd::kReached;
}

// The remaining cost from the entries of the goal's overlay cell, and from the start if it is in
// that cell too.
void OverlaySearch::note_rest() {
  rest_.clear();
  for (const uint32_t entry : overlay_->overlay_levels().front().entries_of(goal_cell_)) {
    if (now_.is_closed(entry)) {
      rest_.push_back(kNoPath);
      continue;
    }
    const Crossing crossing = now_.crossing(entry);
    const bool closed = crossing.backward && view_->portal(crossing.portal).one_way;
    rest_.push_back(closed ? kNoPath : graph_.rest(ends_of(*view_, crossing).in));
  }
  found_ = start_cell_ == goal_cell_ ? graph_.rest(from_) : kNoPath;
}

void OverlaySearch::begin_entrances() {
  const auto& overlay_levels = overlay_->overlay_levels();
  const std::vector<double>& costs = graph_.costs();
  begin_states();
  for (const uint32_t entry : overlay_levels.front().entries_of(start_cell_)) {
    const uint32_t out = entry ^ 1;
    if (now_.is_closed(out)) continue;
    const uint32_t arc = graph_.arc_of(now_.crossing(out));
    if (arc != graph::kNoNode) reach(out, kNoEntry, costs[arc], 0, goal_);
  }
  uint32_t overlay_cell = goal_cell_;
  for (size_t k = 0; k < overlay_levels.size(); ++k) {
    holds_goal_[k] = overlay_cell;
    if (k + 1 < overlay_levels.size()) overlay_cell = overlay_levels[k].above[overlay_cell];
  }
}

void OverlaySearch::expand(uint32_t entry) {
  const auto& overlay_levels = overlay_->overlay_levels();
  const double cost = states_[entry].cost;
  if (overlay_levels.front().of_entry[entry] == goal_cell_) {
    const double all = cost + rest_[overlay_levels.front().place[entry]];
    if (all < found_) {
      found_ = all;
      last_ = entry;
    }
  }
  uint8_t overlay_level = overlay_->entrances()[entry / 2].overlay_level;
  const auto is_opened = [&] {
    const uint32_t through = overlay_levels[overlay_level].of_entry[entry];
    return through == holds_goal_[overlay_level] || now_.is_stale(overlay_level, through);
  };
  while (overlay_level > 0 && is_opened()) --overlay_level;
  const bool is_stale = now_.is_stale(overlay_level, overlay_levels[overlay_level].of_entry[entry]);
  const auto through =
      is_stale ? now_.costs_from(entry) : overlay_levels[overlay_level].costs_from(entry);
  const auto others =
      overlay_levels[overlay_level].entries_of(overlay_levels[overlay_level].of_entry[entry]);
  for (size_t j = 0; j < others.size(); ++j) {
    reach(others[j] ^ 1, entry, cost + double{through[j]}, overlay_level, goal_);
  }
}

// Stretches over overlay levels, from the highest down to the lowest.
std::optional<PathEnd> OverlaySearch::refine_all(Slice& slice) {
  for (; overlay_level_ > 0; --overlay_level_) {
    for (; index_ < stretches_.size(); ++index_) {
      const Stretch& stretch = stretches_[index_];
      if (stretch.overlay_level < overlay_level_) {
        finer_.push_back(stretch);
        continue;
      }
      const std::optional<bool> found = refine(stretch, slice);
      if (!found) return {};
      // Never false: an overlay level is made from the one below.
      if (!*found) return PathEnd::kUnreachable;
    }
    stretches_.swap(finer_);
    finer_.clear();
    index_ = 0;
  }
  return PathEnd::kReached;
}

// Adds the same stretch to `finer_`, through overlay cells of the level below.
std::optional<bool> OverlaySearch::refine(const Stretch& stretch, Slice& slice) {
  const Overlay::OverlayLevel& overlay_level = overlay_->overlay_levels()[stretch.overlay_level];
  const Overlay::OverlayLevel& below =
      overlay_->overlay_levels()[stretch.overlay_level - size_t{1}];
  const auto finer = static_cast<uint8_t>(stretch.overlay_level - 1);
  const uint32_t overlay_cell = overlay_level.of_entry[stretch.from];
  const Vec3d goal = now_.at(stretch.to);
  if (!is_begun_) {
    begin_states();
    reach(stretch.from, kNoEntry, 0, 0, goal);
    is_begun_ = true;
  }
  while (!open_.empty()) {
    if (slice.is_empty()) return {};
    Open top;
    if (!next(top) || top.entry == stretch.to) break;
    slice.take();
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
  is_begun_ = false;
  if (!states_.is_reached(states_[stretch.to])) return false;
  const size_t first = finer_.size();
  for (uint32_t entry = stretch.to; entry != stretch.from; entry = states_[entry].parent) {
    finer_.push_back({states_[entry].parent, entry, finer});
  }
  std::reverse(finer_.begin() + static_cast<ptrdiff_t>(first), finer_.end());
  return true;
}

// From where the crossings lead to so far, within its overlay cell.
std::optional<PathEnd> OverlaySearch::within(const BlockPoint& to, const SearchBudget& budget,
                                             Slice& slice, NodeSearch& blocks,
                                             std::vector<Crossing>& crossings) {
  const std::vector<uint32_t>& of_block = overlay_->of_block();
  const auto end = find_piece(at_, to, {of_block.data(), of_block[view_->base_of(at_.block)]},
                              kNoPath, budget, slice, blocks);
  if (end != PathEnd::kReached) return end;
  crossings.insert(crossings.end(), piece_.begin(), piece_.end());
  cost_ += blocks.cost();
  return end;
}

std::optional<PathEnd> OverlaySearch::find_piece(const BlockPoint& from, const BlockPoint& to,
                                                 const SearchBounds& within, double less_than,
                                                 const SearchBudget& budget, Slice& slice,
                                                 NodeSearch& blocks) {
  if (!is_begun_) blocks.begin(from, to, within, less_than);
  is_begun_ = true;
  const auto end = blocks.advance(budget.after(expanded_), slice, piece_);
  if (!end) return {};
  is_begun_ = false;
  expanded_ += blocks.expanded();
  return end;
}

}  // namespace throng::path
