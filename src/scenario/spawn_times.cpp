// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "scenario/spawn_times.h"

#include <algorithm>
#include <cmath>

// When a source spawns avatars, and how many at once: all at the beginning, or as its rates say.
namespace throng::scenario {
namespace {

constexpr uint64_t kIntervals = 1, kSizes = 2;  // offsets of a source's two streams

}  // namespace

SpawnTimes::SpawnTimes(const Source& source, uint64_t seed, uint64_t stream)
    : source_(&source), seed_(seed), stream_(stream * 4), next_(source.begin) {
  if (!source.rates.empty()) find_next();
}

// A Poisson process by inversion of its cumulative rate: the next time is where the integral of the
// rate since the last one reaches an exponential number (1 if even). Time: linear in the rates.
void SpawnTimes::find_next() {
  const Distribution exponential{Distribution::Kind::kExponential, 1, 0, 0, HUGE_VAL};
  double interval = source_->pattern == SpawnPattern::kEven
                        ? 1
                        : draw(exponential, seed_, stream_ + kIntervals, events_);
  ++events_;
  const auto& rates = source_->rates;
  double from = std::max(next_, rates.front().first);
  for (size_t r = 0; r < rates.size(); ++r) {
    const double until = r + 1 < rates.size() ? rates[r + 1].first : HUGE_VAL;
    if (until <= from) continue;
    const double rate = rates[r].second;
    if (rate > 0 && from + interval / rate <= until) {
      next_ = from + interval / rate;
      return;
    }
    if (rate > 0) interval -= rate * (until - from);
    from = until;
  }
  next_ = HUGE_VAL;
}

uint64_t SpawnTimes::next_due(double time) {
  if (is_over() || next_ > time) return 0;
  const double size = draw(source_->group, seed_, stream_ + kSizes, spawned_);
  const auto members = std::min<uint64_t>(static_cast<uint64_t>(std::max(1.0, std::round(size))),
                                          source_->count - spawned_);
  spawned_ += members;
  if (!source_->rates.empty()) find_next();
  return members;
}

}  // namespace throng::scenario
