// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include "throng/world.h"
#include "world/ground.h"

/// What blocks a class.
namespace throng::path {

/// What stopped a straight walk on `level`.
Blocker blocker_beyond(const world::WorldGround& ground, const world::GroundLevel& level,
                       const world::WalkStop& stop);

/// What a straight line over the baked ground from one place to another meets first.
Blocker blocker_towards(const world::WorldGround& ground, const Place& from, const Place& to);

}  // namespace throng::path
