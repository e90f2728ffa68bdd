// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "crowd/ground/stride_ground.h"
#include "path/edits/ground_finder.h"
#include "throng/path.h"
#include "world/zone_data.h"

/// Repair of paths that obstacles cut.
namespace throng::crowd {

/// Scratch memory: reused, so that nothing is allocated after warm-up.
struct RepairScratch {
  Path detour;
  std::vector<Place> points;
};

/// Changes a path over the baked ground into one over the current ground. Obstacles only block
/// cells, so a path that none cuts stays, and is still the shortest. Where some cut it, short
/// detours are put in, each at most kMaxRepairDetour longer than what it replaces; if that fails,
/// the whole path is searched on the live ground. [path: reached]
void lead_around(const world::WorldData& world, path::GroundFinder& live,
                 const StrideGround& ground, const SearchBudget& budget, Path& path,
                 RepairScratch& scratch);

inline constexpr double kMaxRepairDetour = 10;  // [m]

}  // namespace throng::crowd
