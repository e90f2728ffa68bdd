// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include "steer/lanes.h"
#include "steer/sampled.h"

/// steer/sampled.h and what is asked often of steer/lanes.h, for machines: many trials, or many
/// neighbours, at a time. The same bits.
namespace throng::steer {

Plane following_fast(const SampledSettings& settings, const Situation& situation);
bool preferred_is_open_fast(const SampledSettings& settings, const Situation& situation);
bool is_opposed_fast(const LaneSettings& settings, const Situation& situation);
/// The cheapest trial: what take_best_fast gives first. Most trials need not be looked at for that.
Plane best_fast(const SampledSettings& settings, const Situation& situation);
/// Costs of trials_of(situation), which it leaves in `trials`.
void costs_of_fast(const SampledSettings& settings, const Situation& situation, Trials& trials,
                   Costs& costs);
/// The cheapest trial, and takes it out: the next call gives the next.
Plane take_best_fast(const Trials& trials, Costs& costs);

}  // namespace throng::steer
