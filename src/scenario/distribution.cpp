// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "core/math/logarithm.h"
#include "core/math/trig.h"
#include "core/random.h"
#include "throng/scenario.h"

// Random numbers of the distributions in scenarios: by inversion, and normal ones after [BM58].
// Each is a function of seed, stream and index. Draws outside the limits are repeated, 64 times at
// most.
namespace throng {
namespace {

constexpr uint64_t kMaxTries = 64;

double draw_once(const Distribution& d, uint64_t seed, uint64_t stream, uint64_t n) {
  const double u = random_unit(seed, stream, n);
  switch (d.kind) {
    case Distribution::Kind::kFixed:
      return d.a;
    case Distribution::Kind::kUniform:
      return d.a + (d.b - d.a) * u;
    case Distribution::Kind::kExponential:
      return -d.a * log_of(1 - u);
    case Distribution::Kind::kNormal:
      break;
  }
  // [BM58]
  const double angle = random_unit(seed ^ 0x6e6f726d616cULL, stream, n);
  return d.a + d.b * std::sqrt(-2 * log_of(1 - u)) * cos_turns(angle);
}

}  // namespace

double draw(const Distribution& distribution, uint64_t seed, uint64_t stream, uint64_t n) {
  double value = distribution.a;
  for (uint64_t k = 0; k < kMaxTries; ++k) {
    value = draw_once(distribution, seed, stream, n * kMaxTries + k);
    if (value >= distribution.low && value <= distribution.high) return value;
  }
  return std::clamp(value, distribution.low, distribution.high);
}

}  // namespace throng
