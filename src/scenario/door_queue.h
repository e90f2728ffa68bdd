// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

/// The time at which an avatar passes a door, from the arrival times of all that head there: they
/// pass one after the other, in order of arrival, none before it arrives. Times are whole ticks.
/// Memory: the ticks from the last forgotten one to the latest arrival.
namespace throng::scenario {

class DoorQueue {
 public:
  static constexpr double kTick = 0.125;  // [s]

  /// `flow`: of the door. [avatars/s, > 0]
  explicit DoorQueue(double flow) : service_(1 / flow) {}

  /// The tick in which a time lies. [s, 0 to 16 years]
  [[nodiscard]] static uint32_t tick(double time);

  /// No query concerns a time before `now` any more: avatars expected by then that were not removed
  /// count as standing at the door.
  void forget_before(uint32_t now) { forgotten_ = std::max(forgotten_, now); }
  /// Adds an arrival. Returns the tick under which it is stored: at most six hours after the last
  /// forgotten one. Time: logarithmic in the stored ticks.
  uint32_t add(uint32_t tick);
  /// Removes an arrival. [tick: as `add` returned it]
  void remove(uint32_t tick) { change(tick, -1); }
  /// When an avatar that arrives in `tick` has passed, after all that arrive before it or with it.
  /// Those expected by `now` and not removed stand at the door. Time: as `add`. [s; now: not
  /// forgotten]
  [[nodiscard]] double pass_time(uint32_t tick, uint32_t now) const;
  /// The number of stored ticks.
  [[nodiscard]] size_t kept() const { return tree_.size() / 2; }

 private:
  // The effect of a range of ticks on a door that is free from a time t on: afterwards it is free
  // from max(t + count * service, free) on.
  struct TickRange {
    int64_t count = 0;
    double free = -1e300;
  };
  [[nodiscard]] TickRange combine(const TickRange& first, const TickRange& then) const;
  void change(uint32_t tick, int64_t count);
  void grow(uint32_t tick);
  [[nodiscard]] TickRange combine_range(size_t first, size_t last) const;

  double service_;               // [s]
  uint32_t forgotten_ = 0;       // all before this tick
  uint32_t first_ = 0;           // tick of the first leaf
  int64_t late_ = 0;             // avatars expected before that
  std::vector<TickRange> tree_;  // of n leaves: 1 is the root, n + tick - first a leaf
};

}  // namespace throng::scenario
