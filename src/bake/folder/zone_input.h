// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>

#include "bake/folder/zone_bake.h"

/// What a zone's bytes depend on, as one number: zones whose number is the same need no new bake.
namespace throng::bake {

/// Of the program. Raise it with every change of what a bake makes of the same triangles: a golden
/// hash of bake_test.cpp that changes says so.
inline constexpr uint32_t kBakeVersion = 3;

/// XXH3 of all that bake_zone reads: the triangles in their order, where they lie on the grid and
/// what they are to the classes, the bodies, the grid and the tiles around the zone that exist.
/// `triangles` as for bake_zone. Linear in them.
uint64_t zone_input(const BakePlan& plan, int32_t zone_x, int32_t zone_z,
                    std::span<const uint32_t> triangles);

}  // namespace throng::bake
