// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include "throng/base.h"
#include "world/air_data.h"
#include "world/zone_data.h"

/// A district of a large world as a world of its own.
namespace throng::world {

/// The zones of a grid that touch a box, seen from above. `origin` is of the grid, `side` of a
/// zone. Fails with kBadConfig if the box has no lower and upper corner. [m]
Result<ZoneRect> zones_in(const Box3d& box, const Vec3d& origin, double side, int32_t zones_x,
                          int32_t zones_z);
/// Takes out all zones that do not touch a box, seen from above, before any was opened; levels are
/// numbered again, and WorldData::part is set. Fails with kBadConfig if none is left. Time: linear
/// in zones.
Result<void> keep_part(WorldData& world, const Box3d& part);
/// The same of its air. What is outside cannot be flown in.
void keep_part(AirData& air, const ZoneRect& part);

}  // namespace throng::world
