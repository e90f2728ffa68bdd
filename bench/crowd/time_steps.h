// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <nlohmann/json.hpp>
#include <span>

#include "throng/crowd.h"

namespace throng::bench {

struct StepTiming {
  uint64_t warm = 50, steps = 50;  ///< Only the latter are timed.
  uint64_t check_every = 50;       ///< Steps after which all are looked at, outside the time.
};

/// Steps a crowd, giving others goals to who has arrived, and says what an avatar's step takes, as
/// a whole (median) and by phases (mean), and what was found wrong. [ns]
nlohmann::ordered_json time_steps(Crowd& crowd, const StepTiming& timing,
                                  const std::function<void(std::span<const AvatarId>)>& give);

}  // namespace throng::bench
