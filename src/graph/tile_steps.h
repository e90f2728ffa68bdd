// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "throng/avatar.h"
#include "world/level_view.h"

/// Where the floor of level tiles rises by a step, and not by a slope.
namespace throng::graph {

/// What is a step, and how steep a slope may be.
struct StepLimits {
  int32_t step = 0;   ///< Of the class that steps least. [mm]
  int32_t slope = 0;  ///< Of the class that walks on the steepest ground. [mm per cell]
};
[[nodiscard]] StepLimits step_limits(std::span<const AvatarClass> classes, double cell);

/// Is there a step between a cell of one level and the next to the east or south, of the same or
/// another level? What the floor rises by from the middle of one to the middle of the other is a
/// slope as far as it continues for three cells, of which these may be any. Where that is not
/// known, because the floor or the tile ends, a slope that some class walks on is assumed to be
/// one.
[[nodiscard]] bool is_step(const world::LevelView& a, int32_t x, int32_t z,
                           const world::LevelView& b, int32_t nx, int32_t nz,
                           const StepLimits& limits);

/// Bit x of `across` row z: a step between (x, z) and (x + 1, z), of `along` between (x, z) and
/// (x, z + 1).
struct TileSteps {
  world::CellRows across{}, along{};
};
/// All steps of a level, or none if it has none. [view.samples, if it has a floor in blocks]
[[nodiscard]] std::optional<TileSteps> tile_steps(const world::LevelView& view,
                                                  const StepLimits& limits);

}  // namespace throng::graph
