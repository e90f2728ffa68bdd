// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

/// What the engines of all modes report of a step.
namespace throng::crowd {

/// What a step did, summed over all bodies.
struct EngineCounts {
  uint64_t contested = 0;  // those that could touch another
  uint64_t stood = 0;
  uint64_t low_detail = 0;  // those in low detail
  uint64_t skipped = 0;     // of these, those that took no step
  int64_t progress = 0;     // speeds towards local targets over desired speeds, millionths

  void add(const EngineCounts& other) {
    contested += other.contested;
    stood += other.stood;
    progress += other.progress;
    low_detail += other.low_detail;
    skipped += other.skipped;
  }
};

struct EngineTimes {
  double plan = 0, sort = 0, steer = 0, resolve = 0, settle = 0;  // [s]
};

}  // namespace throng::crowd
