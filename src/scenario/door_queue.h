// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

/// When somebody gets through a door, by those who come to it before him: they go through one after
/// the other, in order of coming, and nobody before he has come. Times are whole ticks.
namespace throng {

class DoorQueue {
 public:
  static constexpr double kTick = 0.125;  // [s]

  /// `flow`: of the door. [people/s, > 0]
  explicit DoorQueue(double flow) : service_(1 / flow) {}

  /// The tick in which a time lies; what is beyond ten days counts as ten days.
  [[nodiscard]] static uint32_t tick(double time);

  void clear() { tree_.clear(); }
  /// Somebody comes in a tick. Time: logarithm of the latest tick.
  void add(uint32_t tick) { change(tick, 1); }
  /// He does not come. [somebody was added there]
  void remove(uint32_t tick) { change(tick, -1); }
  /// When whoever comes in a tick is through, after all who come before him or with him; those who
  /// should have come by `now` and are still here stand at the door. Time: as `add`. [s]
  [[nodiscard]] double passes(uint32_t tick, uint32_t now) const;

 private:
  // What a stretch of ticks does to a door that is free from some time on: it is free from then
  // plus `people` services, or from `free`, whichever is later.
  struct Stretch {
    int64_t people = 0;
    double free = -1e300;
  };
  [[nodiscard]] Stretch joined(const Stretch& first, const Stretch& then) const;
  void change(uint32_t tick, int64_t people);
  [[nodiscard]] Stretch between(size_t first, size_t last) const;

  double service_;             // [s]
  std::vector<Stretch> tree_;  // of n leaves: 1 is the root, n + tick a leaf
};

}  // namespace throng
