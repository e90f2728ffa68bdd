// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>

/// Natural logarithm, the same bytes on every machine (the C library's differs between systems).
namespace throng {

/// To 1e-15, for positive finite numbers.
inline double log_of(double value) {
  int exponent = 0;
  double m = std::frexp(value, &exponent);  // exact; [1/2, 1)
  if (m < 0.70710678118654752) {
    m *= 2;
    --exponent;
  }
  // ln m = 2 artanh(s), s = (m - 1) / (m + 1), |s| < 0.1716: up to s^21 the rest is below 1e-18.
  const double s = (m - 1) / (m + 1), q = s * s;
  double sum = 0;
  for (int k = 21; k >= 1; k -= 2) sum = sum * q + 1.0 / k;
  return exponent * 0.69314718055994531 + 2 * s * sum;
}

}  // namespace throng
