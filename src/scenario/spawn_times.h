// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "throng/scenario.h"

/// When avatars enter from a source.
namespace throng::scenario {

/// A Poisson process with piecewise constant rate, or evenly spaced times.
class SpawnTimes {
 public:
  /// `stream`: the source's own stream of random numbers.
  SpawnTimes(const Source& source, uint64_t seed, uint64_t stream);

  /// The size of the next group due at `time`; 0: none is. Call until it returns 0.
  uint64_t next_due(double time);
  [[nodiscard]] bool is_over() const { return next_ >= source_->end || spawned_ >= source_->count; }

 private:
  void find_next();

  const Source* source_;
  uint64_t seed_, stream_;
  uint64_t events_ = 0, spawned_ = 0;
  double next_ = 0;  // [s]
};

}  // namespace throng::scenario
