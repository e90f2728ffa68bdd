// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

/// Colours as they are stored. The curve is a square root, not that of sRGB: a shader inverts it
/// with one product, and its bytes are the same everywhere; the two differ by less than 0.04.
namespace throng::impostor {

inline uint8_t encode_colour(double linear) {
  const double root = std::sqrt(std::clamp(linear, 0.0, 1.0));
  return static_cast<uint8_t>(root * 255 + 0.5);
}

inline double decode_colour(uint8_t stored) {
  const double root = stored / 255.0;
  return root * root;
}

}  // namespace throng::impostor
