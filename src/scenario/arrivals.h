// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "throng/scenario.h"

/// When people come out of a source.
namespace throng {

/// A Poisson process whose rate changes from time to time, or an even one.
class Arrivals {
 public:
  /// `stream`: of random numbers, this source's own.
  Arrivals(const Source& source, uint64_t seed, uint64_t stream);

  /// The next group that is due at `time`: how many people; 0: none is. Call until it says 0.
  uint64_t next_due(double time);
  [[nodiscard]] bool is_over() const { return next_ >= source_->end || come_ >= source_->count; }

 private:
  void find_next();

  const Source* source_;
  uint64_t seed_, stream_;
  uint64_t events_ = 0, come_ = 0;
  double next_ = 0;  // [s]
};

}  // namespace throng
