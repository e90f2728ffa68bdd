// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "validate/statistics.h"

#include <algorithm>
#include <cmath>

// Shares of distributions in closed form; the Kolmogorov-Smirnov test with Stephens' correction
// for small samples [Stephens70], n log n.
namespace throng::validate {
namespace {

double share_of_whole(const Distribution& d, double x) {
  switch (d.kind) {
    case Distribution::Kind::kFixed:
      return x < d.a ? 0 : 1;
    case Distribution::Kind::kUniform:
      return d.a == d.b ? (x < d.a ? 0 : 1) : std::clamp((x - d.a) / (d.b - d.a), 0.0, 1.0);
    case Distribution::Kind::kNormal:
      if (d.b == 0) return x < d.a ? 0 : 1;
      return 0.5 * std::erfc(-(x - d.a) / (d.b * std::sqrt(2.0)));
    case Distribution::Kind::kExponential:
      return x <= 0 ? 0 : 1 - std::exp(-x / d.a);
  }
  return 0;
}

}  // namespace

// Numbers drawn outside the bounds are drawn again, so the shares within grow in proportion.
double share_below(const Distribution& d, double x) {
  const double low = std::isfinite(d.low) && d.low != d.high ? share_of_whole(d, d.low) : 0;
  const double high = std::isfinite(d.high) && d.low != d.high ? share_of_whole(d, d.high) : 1;
  if (!(high > low)) return share_of_whole(d, x);
  return std::clamp((share_of_whole(d, x) - low) / (high - low), 0.0, 1.0);
}

double ks_distance(std::vector<double> sample, const std::function<double(double)>& share) {
  std::sort(sample.begin(), sample.end());
  const auto n = static_cast<double>(sample.size());
  double distance = 0;
  for (size_t i = 0; i < sample.size(); ++i) {
    const double here = share(sample[i]);
    const auto before = static_cast<double>(i);
    distance = std::max({distance, here - before / n, (before + 1) / n - here});
  }
  return distance;
}

double ks_likelihood(double distance, size_t n) {
  const double root = std::sqrt(static_cast<double>(n));
  const double x = (root + 0.12 + 0.11 / root) * distance;
  if (x < 0.2) return 1;  // The series below does not converge there; the result is 1 to 12 digits.
  double sum = 0, sign = 1;
  for (int k = 1; k <= 100; ++k, sign = -sign) sum += sign * std::exp(-2 * k * k * x * x);
  return std::clamp(2 * sum, 0.0, 1.0);
}

double weidmann(double density) {
  return density >= 5.4 ? 0 : 1.34 * (1 - std::exp(-1.913 * (1 / density - 1 / 5.4)));
}

double flow_rate(std::span<const double> times) {
  if (times.size() < 20) return 0;
  const size_t first = times.size() / 10, last = times.size() - 1 - times.size() / 10;
  return static_cast<double>(last - first) / (times[last] - times[first]);
}

ProportionalFit fit_proportional(std::span<const double> x, std::span<const double> y) {
  double xy = 0, xx = 0, mean = 0;
  for (size_t i = 0; i < x.size(); ++i) {
    xy += x[i] * y[i];
    xx += x[i] * x[i];
    mean += y[i] / static_cast<double>(x.size());
  }
  const double slope = xy / xx;
  double off = 0, spread = 0;
  for (size_t i = 0; i < x.size(); ++i) {
    off += (y[i] - slope * x[i]) * (y[i] - slope * x[i]);
    spread += (y[i] - mean) * (y[i] - mean);
  }
  return {.slope = slope, .explained = 1 - off / spread};
}

}  // namespace throng::validate
