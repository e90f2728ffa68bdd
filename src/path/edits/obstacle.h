// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include "throng/world.h"
#include "world/ground.h"

/// What blocks a class.
namespace throng {

/// What stopped a straight walk on `level`.
Obstacle obstacle_beyond(const WorldGround& ground, const GroundLevel& level, const WalkStop& stop);

}  // namespace throng
