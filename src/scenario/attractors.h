// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include "throng/scenario.h"

/// What is asked of attractors, and of the obstacles that they may be fixed to.
namespace throng::scenario {

/// Fail with kBadInput and the name.
[[nodiscard]] Result<void> check_line(const ScenarioObstacle& obstacle);
[[nodiscard]] Result<void> check_attractor(const Attractor& attractor, const Scenario& scenario);

/// The prism of an obstacle that has moved so far along its line, and back. [m]
[[nodiscard]] Prism prism_after(const ScenarioObstacle& obstacle, double distance);

}  // namespace throng::scenario
