// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "scenario/arrivals.h"

#include <algorithm>
#include <cmath>

namespace throng {
namespace {

constexpr uint64_t kGaps = 1, kSizes = 2;  // streams beside each other

}  // namespace

Arrivals::Arrivals(const Source& source, uint64_t seed, uint64_t stream)
    : source_(&source), seed_(seed), stream_(stream * 4), next_(source.begin) {
  if (!source.rates.empty()) find_next();
}

// The time at which the expected number of arrivals since the last one reaches the next gap.
void Arrivals::find_next() {
  const Distribution exponential{Distribution::Kind::kExponential, 1, 0, 0, HUGE_VAL};
  double gap = source_->even ? 1 : draw(exponential, seed_, stream_ + kGaps, events_);
  ++events_;
  const auto& rates = source_->rates;
  double from = std::max(next_, rates.front().first);
  for (size_t r = 0; r < rates.size(); ++r) {
    const double until = r + 1 < rates.size() ? rates[r + 1].first : HUGE_VAL;
    if (until <= from) continue;
    const double rate = rates[r].second;
    if (rate > 0 && from + gap / rate <= until) {
      next_ = from + gap / rate;
      return;
    }
    if (rate > 0) gap -= rate * (until - from);
    from = until;
  }
  next_ = HUGE_VAL;
}

uint64_t Arrivals::next_due(double time) {
  if (is_over() || next_ > time) return 0;
  const double size = draw(source_->group, seed_, stream_ + kSizes, come_);
  const auto people = std::min<uint64_t>(static_cast<uint64_t>(std::max(1.0, std::round(size))),
                                         source_->count - come_);
  come_ += people;
  if (!source_->rates.empty()) find_next();
  return people;
}

}  // namespace throng
