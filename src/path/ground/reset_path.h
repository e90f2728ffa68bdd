// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include "throng/path.h"

/// What every finder does to a path before it fills it.
namespace throng::path {

/// Nothing found, from no place; the memory stays.
inline void reset(Path& path) {
  path.end = PathEnd::kNoPlace;
  path.points.clear();
  path.node_places.clear();
  path.segments.clear();
  path.links.clear();
  path.corridor.clear();
  path.length = path.cost = path.searched_cost = 0;
  path.blocked_by = Blocker::kNone;
  path.nodes = 0;
  path.spent = SpentBudget::kNone;
}

}  // namespace throng::path
