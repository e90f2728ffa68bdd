// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "crowd/ground/avatars.h"
#include "crowd/ground/crowd_ground.h"
#include "crowd/walk/collision_map.h"

/// The first places of a crowd.
namespace throng::crowd {

/// Places `count` avatars on legal cells, clear of each other in `map`: at random, uniform over the
/// ground, and when random points no longer fit, cell by cell. Returns fewer if no more fit.
/// [body_height: mm]
std::vector<Avatar> place_avatars(const CrowdGround& ground, int32_t body_height, uint32_t count,
                                  uint64_t seed, CollisionMap& map);

}  // namespace throng::crowd
