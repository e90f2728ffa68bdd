// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "scenario/door_queue.h"

#include <algorithm>
#include <bit>

#include "throng/base.h"

// Lindley's recursion for a queue with one server [Lindley52]: free(i) = max(free(i - 1),
// arrival(i)) + service. Compositions of such steps again have the form max(x + a, b), so a tree
// over the ticks stores them, and a change or query costs a path from a leaf to the root.
namespace throng::scenario {

uint32_t DoorQueue::tick(double time) {
  constexpr double kLast = 4e9;
  return static_cast<uint32_t>(std::clamp(time / kTick, 0.0, kLast));
}

uint32_t DoorQueue::add(uint32_t tick) {
  constexpr auto kMaxAhead = static_cast<uint32_t>(6 * 3600 / kTick);
  tick = std::min(tick, forgotten_ + kMaxAhead);
  change(tick, 1);
  return tick;
}

DoorQueue::TickRange DoorQueue::combine(const TickRange& first, const TickRange& then) const {
  const double served = first.free + static_cast<double>(then.count) * service_;
  return {first.count + then.count, std::max(served, then.free)};
}

// Moves the leaves to begin at the first tick not forgotten and makes room for `tick`. Avatars
// expected before that are only counted.
void DoorQueue::grow(uint32_t tick) {
  const size_t leaves = tree_.size() / 2;
  const size_t dropped = std::min<size_t>(leaves, forgotten_ - first_);
  for (size_t n = 0; n < dropped; ++n) late_ += tree_[leaves + n].count;
  first_ = forgotten_;
  const size_t wanted =
      std::bit_ceil(std::max<size_t>({256, tick - first_ + size_t{1}, leaves - dropped}));
  std::vector<TickRange> moved(2 * wanted);
  std::copy_n(tree_.begin() + static_cast<int64_t>(leaves + dropped), leaves - dropped,
              moved.begin() + static_cast<int64_t>(wanted));
  for (size_t n = wanted; n-- > 1;) moved[n] = combine(moved[2 * n], moved[2 * n + 1]);
  tree_ = std::move(moved);
}

void DoorQueue::change(uint32_t tick, int64_t count) {
  if (tick >= first_ + tree_.size() / 2 && tick >= forgotten_) grow(tick);
  if (tick < first_ || tick >= first_ + tree_.size() / 2) {
    late_ += count;
    THRONG_ASSERT(late_ >= 0);
    return;
  }
  size_t n = tree_.size() / 2 + (tick - first_);
  TickRange& leaf = tree_[n];
  leaf.count += count;
  THRONG_ASSERT(leaf.count >= 0);
  leaf.free =
      leaf.count > 0 ? tick * kTick + static_cast<double>(leaf.count) * service_ : TickRange{}.free;
  while ((n /= 2) > 0) tree_[n] = combine(tree_[2 * n], tree_[2 * n + 1]);
}

// The ticks from `first` to before `last`.
DoorQueue::TickRange DoorQueue::combine_range(size_t first, size_t last) const {
  const size_t leaves = tree_.size() / 2;
  const auto leaf = [&](size_t tick) {
    return leaves + std::min(leaves, tick - std::min<size_t>(tick, first_));
  };
  TickRange left, right;
  first = leaf(first);
  last = leaf(last);
  for (; first < last; first /= 2, last /= 2) {
    if (first % 2 == 1) left = combine(left, tree_[first++]);
    if (last % 2 == 1) right = combine(tree_[--last], right);
  }
  return combine(left, right);
}

double DoorQueue::pass_time(uint32_t tick, uint32_t now) const {
  THRONG_ASSERT(now >= forgotten_);
  tick = std::max(tick, now);
  const auto here = static_cast<double>(late_ + combine_range(0, now).count);
  const TickRange later = combine_range(now, size_t{tick} + 1);
  const double free = combine({0, now * kTick + here * service_}, later).free;
  return std::max(free, tick * kTick) + service_;
}

}  // namespace throng::scenario
