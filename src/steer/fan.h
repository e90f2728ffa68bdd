// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>

#include "steer/sampled.h"

/// The directions and speeds of the trials.
namespace throng::steer {

/// Cosines and sines of multiples of 15 degrees.
struct Turns {
  std::array<float, kDirections> cosine, sine;
};

constexpr Turns turns() {
  // cos 0, 15, 30, ... 90 degrees; the rest follow by symmetry.
  constexpr std::array<double, 7> kCosines = {1,
                                              0.96592582628906828675,
                                              0.86602540378443864676,
                                              0.70710678118654752440,
                                              0.5,
                                              0.25881904510252076235,
                                              0};
  const auto cosine = [&](size_t k) {  // of k * 15 degrees
    k %= kDirections;
    if (k > 12) k = kDirections - k;
    return k <= 6 ? kCosines[k] : -kCosines[12 - k];
  };
  Turns t{};
  for (size_t k = 0; k < kDirections; ++k) {
    t.cosine[k] = static_cast<float>(cosine(k));
    t.sine[k] = static_cast<float>(cosine(k + 18));
  }
  return t;
}

/// The part of the fastest speed that the i-th trial of a direction has.
constexpr float part_of_speed(size_t i) { return static_cast<float>(i + 1) / kSpeeds; }

}  // namespace throng::steer
