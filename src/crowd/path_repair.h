// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "crowd/stride_ground.h"
#include "throng/live_ground.h"
#include "throng/path.h"
#include "world/zone_data.h"

/// Ways around obstacles.
namespace throng {

/// Memory for it: kept, so that nothing is allocated once it is warm.
struct RepairScratch {
  Path detour;
  std::vector<Place> points;
};

/// Makes a way over the baked ground one over the ground as it is now. Obstacles only take away, so
/// a way on which none lies stays, and is still the shortest. Where they lie on it, short detours
/// are put in, each no more than kMaxRepairDetour longer than what it replaces; if that does not
/// do, the whole way is searched on the live ground. [path: reached]
void lead_around(const WorldData& world, LiveGround& live, const StrideGround& ground,
                 const SearchBudget& budget, Path& path, RepairScratch& scratch);

inline constexpr double kMaxRepairDetour = 10;  // [m]

}  // namespace throng
