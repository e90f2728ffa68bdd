// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstdint>
#include <utility>

#include "core/random.h"

/// Random directions in the plane, the same on every machine.
namespace throng {

/// A unit vector, uniform over the circle, without trigonometry: a point of the disc, put on its
/// rim.
inline std::pair<double, double> random_direction(uint64_t seed, uint64_t id) {
  for (uint64_t i = 0;; i += 2) {
    const double x = random_unit(seed, id, i) * 2 - 1, z = random_unit(seed, id, i + 1) * 2 - 1;
    const double square = x * x + z * z;
    if (square > 1 || square < 1e-4) continue;
    const double size = std::sqrt(square);
    return {x / size, z / size};
  }
}

}  // namespace throng
