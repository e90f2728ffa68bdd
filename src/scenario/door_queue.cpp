// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "scenario/door_queue.h"

#include <algorithm>
#include <bit>

#include "throng/base.h"

// Lindley's recursion for a queue with one counter [Lindley52]: free(i) = max(free(i - 1),
// comes(i))
// + service. Such steps, one after the other, are again of the form max(x + a, b), so a tree over
// the ticks holds them, and a change costs one path from a leaf to the root.
namespace throng {

uint32_t DoorQueue::tick(double time) {
  constexpr double kLast = 10 * 86400 / kTick;
  return static_cast<uint32_t>(std::clamp(time / kTick, 0.0, kLast));
}

DoorQueue::Stretch DoorQueue::joined(const Stretch& first, const Stretch& then) const {
  const double served = first.free + static_cast<double>(then.people) * service_;
  return {first.people + then.people, std::max(served, then.free)};
}

void DoorQueue::change(uint32_t tick, int64_t people) {
  size_t leaves = tree_.size() / 2;
  if (tick >= leaves) {  // The old leaves are the first of the new ones.
    const size_t wanted = std::bit_ceil(std::max<size_t>(256, size_t{tick} + 1));
    std::vector<Stretch> larger(2 * wanted);
    std::copy_n(tree_.begin() + static_cast<int64_t>(leaves), leaves,
                larger.begin() + static_cast<int64_t>(wanted));
    for (size_t n = wanted; n-- > 1;) larger[n] = joined(larger[2 * n], larger[2 * n + 1]);
    tree_ = std::move(larger);
    leaves = wanted;
  }
  size_t n = leaves + tick;
  Stretch& leaf = tree_[n];
  leaf.people += people;
  THRONG_ASSERT(leaf.people >= 0);
  leaf.free =
      leaf.people > 0 ? tick * kTick + static_cast<double>(leaf.people) * service_ : Stretch{}.free;
  while ((n /= 2) > 0) tree_[n] = joined(tree_[2 * n], tree_[2 * n + 1]);
}

// The ticks from `first` to before `last`.
DoorQueue::Stretch DoorQueue::between(size_t first, size_t last) const {
  const size_t leaves = tree_.size() / 2;
  Stretch left, right;
  first = leaves + std::min(first, leaves);
  last = leaves + std::min(last, leaves);
  for (; first < last; first /= 2, last /= 2) {
    if (first % 2 == 1) left = joined(left, tree_[first++]);
    if (last % 2 == 1) right = joined(tree_[--last], right);
  }
  return joined(left, right);
}

double DoorQueue::passes(uint32_t tick, uint32_t now) const {
  tick = std::max(tick, now);
  const double here = static_cast<double>(between(0, now).people);
  const Stretch later = between(now, size_t{tick} + 1);
  const double free = joined({0, now * kTick + here * service_}, later).free;
  return std::max(free, tick * kTick) + service_;
}

}  // namespace throng
