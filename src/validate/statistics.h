// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "throng/scenario.h"

/// What is made of many numbers.
namespace throng::validate {

/// Share of the numbers that `draw` gives which lie at or below x.
double share_below(const Distribution& distribution, double x);

/// Kolmogorov's distance: the most that the share of a sample below any x is off a distribution's.
/// [sample: not empty]
double ks_distance(std::vector<double> sample, const std::function<double(double)>& share);
/// How likely a sample of n numbers of the distribution itself is at least so far off [Stephens70].
double ks_likelihood(double distance, size_t n);

/// Speed at a density, one way [Weidmann93]. [1/m2, > 0; m/s]
double weidmann(double density);

/// People a second through a line, from the 10 % first to the 10 % last, by the time between them
/// [SS10]. 0: fewer than 20 came through. [times: ascending, s]
double flow_rate(std::span<const double> times);

}  // namespace throng::validate
