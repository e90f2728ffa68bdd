// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "crowd/avatars.h"
#include "crowd/collision_map.h"
#include "crowd/crowd_ground.h"

/// Where a crowd begins.
namespace throng {

/// Places `count` avatars on legal cells, clear of each other in `map`: at random, uniform over the
/// ground, and when chance finds no more room, cell by cell. Returns fewer if no more fit.
std::vector<Avatar> place_avatars(const CrowdGround& ground, uint32_t count, uint64_t seed,
                                  CollisionMap& map);

}  // namespace throng
