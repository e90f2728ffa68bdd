// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include "crowd/body.h"
#include "crowd/routes.h"
#include "crowd/stride_ground.h"

/// Where in an opening one goes, instead of all going for the corner that the shortest ways touch.
namespace throng {

/// The place at the next corner of a way that a body is bound for: as far from the corner, by the
/// width of the opening there, as the body is from the wall on the inner side of the bend, by the
/// width of where it walks. The corner itself where the way hardly bends, fewer than three find
/// room abreast, or the place could not be seen from here or would not see the next corner.
/// `metre`: [units]
Spot lane_offset(const Body& body, const Route& route, const StrideGround& ground, float metre);

}  // namespace throng
