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
  constexpr double kLast = 4e9;
  return static_cast<uint32_t>(std::clamp(time / kTick, 0.0, kLast));
}

uint32_t DoorQueue::add(uint32_t tick) {
  constexpr auto kFar = static_cast<uint32_t>(6 * 3600 / kTick);
  tick = std::min(tick, forgotten_ + kFar);
  change(tick, 1);
  return tick;
}

DoorQueue::Stretch DoorQueue::joined(const Stretch& first, const Stretch& then) const {
  const double served = first.free + static_cast<double>(then.people) * service_;
  return {first.people + then.people, std::max(served, then.free)};
}

// Leaves move down to what may still be asked; those who should have come before are only counted.
void DoorQueue::make_room(uint32_t tick) {
  const size_t leaves = tree_.size() / 2;
  const size_t gone = std::min<size_t>(leaves, forgotten_ - first_);
  for (size_t n = 0; n < gone; ++n) late_ += tree_[leaves + n].people;
  first_ = forgotten_;
  const size_t wanted =
      std::bit_ceil(std::max<size_t>({256, tick - first_ + size_t{1}, leaves - gone}));
  std::vector<Stretch> moved(2 * wanted);
  std::copy_n(tree_.begin() + static_cast<int64_t>(leaves + gone), leaves - gone,
              moved.begin() + static_cast<int64_t>(wanted));
  for (size_t n = wanted; n-- > 1;) moved[n] = joined(moved[2 * n], moved[2 * n + 1]);
  tree_ = std::move(moved);
}

void DoorQueue::change(uint32_t tick, int64_t people) {
  if (tick >= first_ + tree_.size() / 2 && tick >= forgotten_) make_room(tick);
  if (tick < first_ || tick >= first_ + tree_.size() / 2) {
    late_ += people;
    THRONG_ASSERT(late_ >= 0);
    return;
  }
  size_t n = tree_.size() / 2 + (tick - first_);
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
  const auto leaf = [&](size_t tick) {
    return leaves + std::min(leaves, tick - std::min<size_t>(tick, first_));
  };
  Stretch left, right;
  first = leaf(first);
  last = leaf(last);
  for (; first < last; first /= 2, last /= 2) {
    if (first % 2 == 1) left = joined(left, tree_[first++]);
    if (last % 2 == 1) right = joined(tree_[--last], right);
  }
  return joined(left, right);
}

double DoorQueue::passes(uint32_t tick, uint32_t now) const {
  THRONG_ASSERT(now >= forgotten_);
  tick = std::max(tick, now);
  const auto here = static_cast<double>(late_ + between(0, now).people);
  const Stretch later = between(now, size_t{tick} + 1);
  const double free = joined({0, now * kTick + here * service_}, later).free;
  return std::max(free, tick * kTick) + service_;
}

}  // namespace throng
