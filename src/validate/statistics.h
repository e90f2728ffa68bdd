// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "throng/scenario.h"

/// Statistics of samples: distributions, the Kolmogorov-Smirnov test, flow.
namespace throng::validate {

/// Share of the numbers drawn from a distribution that lie at or below x.
double share_below(const Distribution& distribution, double x);

/// Kolmogorov's distance: the largest difference between the share of a sample below x and that of
/// a distribution, over all x. [sample: not empty]
double ks_distance(std::vector<double> sample, const std::function<double(double)>& share);
/// Probability that n numbers drawn from the distribution differ at least so much [Stephens70].
double ks_likelihood(double distance, size_t n);

/// Speed at a density, in one direction [Weidmann93]. [1/m2, > 0; m/s]
double weidmann(double density);

/// Flow over a line without the first and the last tenth of the people: their number by the time
/// between them [SS10]. 0: fewer than 20 people. [times: ascending, s] [p/s]
double flow_rate(std::span<const double> times);

/// The line through the origin that is nearest to some points, by least squares.
struct ProportionalFit {
  double slope = 0;
  double explained = 0;  ///< Share of the variance of y that the line explains. [<= 1]
};
/// [x and y: equally many, not all x 0; NaN for `explained` if all y are equal and on the line]
ProportionalFit fit_proportional(std::span<const double> x, std::span<const double> y);

}  // namespace throng::validate
