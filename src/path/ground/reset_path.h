// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "throng/path.h"

/// What finders have in common: what they do to a path before they fill it, and what they refuse.
namespace throng::path {

/// Refuses a speedup, which only the ground has, and a slope cost where there is none. [kBadConfig]
inline Result<void> refuse_settings(const PathConfig& config, const std::string& finder,
                                    bool has_slope_cost) {
  if (config.speedup != PathSpeedup::kNone) {
    return Error{Errc::kBadConfig, finder + ": a speedup is only for paths on the ground"};
  }
  if (!has_slope_cost && config.slope_cost != 0) {
    return Error{Errc::kBadConfig, finder + ": there is no slope_cost in the air"};
  }
  return {};
}

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
  path.blocked_by_edit = 0;
  path.nodes = 0;
  path.spent = SpentBudget::kNone;
}

}  // namespace throng::path
