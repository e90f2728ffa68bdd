// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include "path/air/flight_endpoints.h"
#include "throng/surface.h"

/// Where the links that a bake has stored between the air and the ground lead.
namespace throng::path {

/// The place on the ground to which the leaf under a point of the air is linked for the class:
/// straight down to the lowest box, and of its lowest voxel there the leaf of the octree. Nowhere
/// if the leaf has no link for the class, or the link cannot be used now: the body may not stand
/// there, or what it rises into is not connected with the point. `links` may be empty.
[[nodiscard]] Place linked_landing(const AirLinks& links, const FlightEndpoints& ends,
                                   const AirView& air, int32_t avatar_class, AirPoint at);

}  // namespace throng::path
