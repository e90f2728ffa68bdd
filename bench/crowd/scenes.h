// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "steer_bench.h"

/// Scenes for crowds that need no file.
namespace throng::bench {

using test::Play;
using test::Walker;

/// A corridor 4 m wide; `side` walkers at each end, one per `area` m2, change ends.
Play corridor(uint32_t side, double area, uint64_t seed);

/// Two corridors 10 m wide that cross; `arm` walkers in each of the four arms, one per `area` m2,
/// walk to the opposite arm.
Play crossing(uint32_t arm, double area, uint64_t seed);

}  // namespace throng::bench
