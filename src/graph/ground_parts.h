// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "graph/flood.h"
#include "world/ground.h"

/// Ground of one class as rows of bits.
namespace throng::graph {

/// Where the class may stand on a level.
world::CellRows legal_rows(const world::GroundLevel& level);

/// Steps between neighbouring legal cells that are too high for the class; none where the bake has
/// proved that there are none. Unpacks the floor, unless the level's view has samples. [mm]
std::optional<StepCuts> step_cuts(const world::GroundLevel& level, const world::CellRows& legal,
                                  int32_t step);

}  // namespace throng::graph
