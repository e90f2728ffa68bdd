// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>

#include "steer/air.h"

/// Steering on a surface of any slope by trying velocities along it: the model of steer/air.h with
/// directions of a climber. docs/design/013-climbers.md.
namespace throng::steer {

inline constexpr size_t kSurfaceChoices = 8;

/// The velocities of the smallest costs, the best first. `up`: the surface normal. [unit length]
using SurfaceChoices = std::array<Space, kSurfaceChoices>;
SurfaceChoices best_along(const AirSettings& settings, const AirSituation& situation, Space up);

}  // namespace throng::steer
