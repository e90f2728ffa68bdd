// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>

/// Sines and angles in turns, the same bytes on every machine (the C library's differ between
/// systems). A turn is 2 pi.
namespace throng {

/// Sine of 2 pi `turns`, to 1e-12. Any finite number of turns.
inline double sin_turns(double turns) {
  double t = turns - std::floor(turns + 0.5);  // [-0.5, 0.5)
  if (t > 0.25) t = 0.5 - t;
  if (t < -0.25) t = -0.5 - t;
  const double x = t * 6.283185307179586;
  const double s = x * x;
  // Taylor's series up to x^17: at a quarter turn its remainder is 4e-14.
  double sum = 1.0 / 355687428096000.0;
  sum = sum * s - 1.0 / 1307674368000.0;
  sum = sum * s + 1.0 / 6227020800.0;
  sum = sum * s - 1.0 / 39916800.0;
  sum = sum * s + 1.0 / 362880.0;
  sum = sum * s - 1.0 / 5040.0;
  sum = sum * s + 1.0 / 120.0;
  sum = sum * s - 1.0 / 6.0;
  return x + x * s * sum;
}

inline double cos_turns(double turns) { return sin_turns(turns + 0.25); }

/// Angle of (x, z) from +z towards +x, in turns, [0, 1], to 2e-6. Without branches, so that loops
/// over it become vector code. 0 for (0, 0).
inline float turns_of(float x, float z) {
  const float ax = std::fabs(x), az = std::fabs(z);
  const float high = ax > az ? ax : az, low = ax > az ? az : ax;
  const float q = low / (high > 1e-30F ? high : 1e-30F);
  const float s = q * q;
  // Minimax polynomial of the arc tangent on [0, 1]. Source: [AS64] 4.4.49, divided by 2 pi.
  float t = q * (0.15913362F +
                 s * (-0.05256880F + s * (0.02867033F + s * (-0.01354934F + s * 0.00331601F))));
  t = ax > az ? 0.25F - t : t;
  t = z < 0 ? 0.5F - t : t;
  return x < 0 ? 1.0F - t : t;
}

}  // namespace throng
