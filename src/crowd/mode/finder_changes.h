// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "crowd/obstacles/obstacle_set.h"
#include "path/edits/solid.h"

/// What the path finders of a class, one a worker, know of an obstacle.
namespace throng::crowd {

/// A new one is added, else it is switched. All copies give the same id.
template <class Finder>
void sync_change(std::vector<Finder>& finders, const CrowdObstacle& obstacle, bool is_new,
                 path::ChangeId& change) {
  const path::ChangeId old = change;
  for (Finder& finder : finders) {
    if (!is_new) {
      finder.set_active(old, obstacle.has_cells);
      continue;
    }
    finder.remove(old);
    change = finder.add_obstacle({obstacle.place});
  }
}

template <class Finder>
void remove_change(std::vector<Finder>& finders, path::ChangeId change) {
  for (Finder& finder : finders) finder.remove(change);
}

}  // namespace throng::crowd
