// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include "crowd/climb/climb.h"
#include "throng/path.h"
#include "throng/surface.h"

/// The path of a climber, as its row holds it.
namespace throng::crowd {

/// As much of a path as fits: it ends on the ground.
void take_path(Climb& climb, const Path& path);
/// Where the rest of a path leads that does not fit: without its end, which is the goal.
void set_stations(Climb& climb, const Path& path);
/// The body stays where it is.
void clear_path(Climb& climb);
/// One segment over one node, or only its start if there is no end.
void set_segment(Path& path, const NodePlace& from, const NodePlace& to);

}  // namespace throng::crowd
