// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>

/// Powers of e, the same bytes on every machine (the C library's differ between systems).
namespace throng {

/// To 1e-15 of the result; 0 below e^-700, and no more than e^700.
inline double exp_of(double value) {
  constexpr double kMax = 700;
  if (!(value >= -kMax)) return 0;
  value = std::min(value, kMax);
  const double twos = std::floor(value * 1.4426950408889634 + 0.5);
  // ln 2 in two parts: what is left is exact to the last bit.
  const double r = value - twos * 0.693147180369123816490 - twos * 1.90821492927058770002e-10;
  // Taylor's series, |r| <= 0.35: up to r^14 the rest is below 1e-18.
  double sum = 1;
  for (int k = 14; k >= 1; --k) sum = 1 + sum * r / k;
  return std::ldexp(sum, static_cast<int>(twos));
}

}  // namespace throng
