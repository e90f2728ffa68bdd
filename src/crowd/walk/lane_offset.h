// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include "crowd/ground/body.h"
#include "crowd/ground/stride_ground.h"
#include "crowd/walk/routes.h"

/// Where in an opening an avatar walks, so that not all crowd at the corner that shortest paths
/// touch.
namespace throng::crowd {

/// The place beside the next corner of a body's path: its distance from the corner, relative to the
/// width of the opening there, is the body's distance from the wall on the inner side, relative to
/// the width where it walks. It is the corner itself if the path hardly bends, if fewer than three
/// bodies fit abreast, or if the place is not visible from here or from the next corner. For
/// bodies that queue, corners within a metre are one: the opening counts where it is narrowest.
PathPoint lane_offset(const Body& body, const Route& route, const StrideGround& ground,
                      Following how);

}  // namespace throng::crowd
