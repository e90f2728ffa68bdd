// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "throng/math.h"

/// What crowds show of their avatars, and what a check of them finds.
namespace throng {

/// What an independent look at the present positions found. All zero, always.
struct CrowdCheck {
  uint64_t wall_entries = 0;      ///< Avatars on a cell that their class may not stand on.
  uint64_t overlaps = 0;          ///< Pairs whose discs and heights both overlap.
  uint64_t obstacle_entries = 0;  ///< Pairs of an avatar and an obstacle that its body is in.
};

/// Read-back of one avatar.
struct AvatarState {
  uint32_t id = 0;
  int32_t avatar_class = 0;
  Vec3d position;     ///< Y at the feet. [m]
  double radius = 0;  ///< Of the body. [m]
  /// Unit vector of the walk; of who leans, before he leans: lean.h turns it to where he goes.
  double heading_x = 0;
  double heading_z = 0;
  bool flies = false;   ///< It is in the air, or on its way up or down.
  bool climbs = false;  ///< It goes over nodes.
  Vec3d up{0, 1, 0};    ///< Along the body, from its feet; of who climbs the surface's normal.
};

}  // namespace throng
