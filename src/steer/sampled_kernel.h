// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include "steer/lanes.h"
#include "steer/sampled.h"

/// steer/sampled.h and the hot part of steer/lanes.h, vectorised over trials or neighbours. The
/// same bits.
namespace throng::steer {

Plane following_fast(const SampledSettings& settings, const Situation& situation);
bool preferred_is_open_fast(const SampledSettings& settings, const Situation& situation);
bool is_opposed_fast(const LaneSettings& settings, const Situation& situation);
/// The cheapest trial, which take_best_fast gives first; computes only a part of the costs.
Plane best_fast(const SampledSettings& settings, const Situation& situation);
/// Costs of trials_of(situation), which it writes to `trials`.
void costs_of_fast(const SampledSettings& settings, const Situation& situation, Trials& trials,
                   Costs& costs);
/// Returns the cheapest trial and removes it: the next call returns the next one.
Plane take_best_fast(const Trials& trials, Costs& costs);

}  // namespace throng::steer
