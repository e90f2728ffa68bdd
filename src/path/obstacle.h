// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include "throng/ground_query.h"
#include "world/ground.h"

/// Why a class cannot go on.
namespace throng {

/// What keeps the ground's class from cell (x, z) of the grid, coming from a level with feet at
/// `feet` [mm].
Obstacle obstacle_at(const WorldGround& ground, int32_t x, int32_t z, int32_t feet);

/// What stopped a straight walk on `level`.
Obstacle obstacle_beyond(const WorldGround& ground, const GroundLevel& level, const WalkStop& stop);

}  // namespace throng
