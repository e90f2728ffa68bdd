// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

/// When somebody gets through a door, by those who come to it before him: they go through one after
/// the other, in order of coming, and nobody before he has come. Times are whole ticks. Memory: the
/// ticks from the last one that was forgotten to the latest in which somebody comes.
namespace throng {

class DoorQueue {
 public:
  static constexpr double kTick = 0.125;  // [s]

  /// `flow`: of the door. [people/s, > 0]
  explicit DoorQueue(double flow) : service_(1 / flow) {}

  /// The tick in which a time lies. [s, 0 to 16 years]
  [[nodiscard]] static uint32_t tick(double time);

  /// Nobody asks any more what was before `now`: whoever should have come by then stands at the
  /// door, if he is still here.
  void forget_before(uint32_t now) { forgotten_ = std::max(forgotten_, now); }
  /// Somebody comes in a tick. Returns that under which he is kept: beyond six hours from what was
  /// forgotten last all is alike. Time: logarithm of the ticks that are kept.
  uint32_t add(uint32_t tick);
  /// He does not come. [tick: as `add` returned it]
  void remove(uint32_t tick) { change(tick, -1); }
  /// When whoever comes in a tick is through, after all who come before him or with him; those who
  /// should have come by `now` and are still here stand at the door. Time: as `add`. [now: not
  /// forgotten; s]
  [[nodiscard]] double passes(uint32_t tick, uint32_t now) const;
  /// So many ticks are kept.
  [[nodiscard]] size_t kept() const { return tree_.size() / 2; }

 private:
  // What a stretch of ticks does to a door that is free from some time on: it is free from then
  // plus `people` services, or from `free`, whichever is later.
  struct Stretch {
    int64_t people = 0;
    double free = -1e300;
  };
  [[nodiscard]] Stretch joined(const Stretch& first, const Stretch& then) const;
  void change(uint32_t tick, int64_t people);
  void make_room(uint32_t tick);
  [[nodiscard]] Stretch between(size_t first, size_t last) const;

  double service_;             // [s]
  uint32_t forgotten_ = 0;     // all before this tick
  uint32_t first_ = 0;         // tick of the first leaf
  int64_t late_ = 0;           // people who should have come before that
  std::vector<Stretch> tree_;  // of n leaves: 1 is the root, n + tick - first a leaf
};

}  // namespace throng
