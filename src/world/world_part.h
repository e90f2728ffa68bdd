// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include "throng/base.h"
#include "world/air_data.h"
#include "world/zone_data.h"

/// A district of a large world as a world of its own.
namespace throng::world {

/// Takes out all zones that do not touch a box, seen from above, before any was opened; levels are
/// numbered again, and WorldData::part is set. Fails with kBadConfig if none is left. Time: linear
/// in zones.
Result<void> keep_part(WorldData& world, const Box3d& part);
/// The same of its air. What is outside cannot be flown in.
void keep_part(AirData& air, const ZoneRect& part);

}  // namespace throng::world
