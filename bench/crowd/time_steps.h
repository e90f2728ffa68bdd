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
  uint64_t check_every = 50;       ///< Steps between checks of all avatars, which are not timed.
};

/// Steps a crowd, calls `give` for avatars that arrived, and returns the time of an avatar's step,
/// total (median) and by phases (mean) [ns], and the faults that the checks found.
nlohmann::ordered_json time_steps(Crowd& crowd, const StepTiming& timing,
                                  const std::function<void(std::span<const AvatarId>)>& give);

}  // namespace throng::bench
