// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include "path/edits/solid.h"
#include "throng/path.h"

/// What blocks a path, and which change of the world does.
namespace throng::path {

struct FoundBlocker {
  Blocker blocker = Blocker::kNone;
  ChangeId change = 0;  ///< Of the finder: an obstacle or an area. 0: none does, or it is unknown.
};

/// Until PathFinder names the edit, a path has the change of its finder.
inline void set_blocker(const FoundBlocker& found, Path& path) {
  path.blocked_by = found.blocker;
  path.blocked_by_edit = found.change;
}

}  // namespace throng::path
