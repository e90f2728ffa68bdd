// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "throng/math.h"

/// The state of an avatar that a crowd reports, and the result of its self-check.
namespace throng {

/// Faults found by an independent check of the present positions. All must be 0.
struct CrowdCheck {
  uint64_t wall_entries = 0;      ///< Avatars on a cell where their class is not legal.
  uint64_t overlaps = 0;          ///< Pairs whose discs and heights both overlap.
  uint64_t obstacle_entries = 0;  ///< Pairs of an avatar and an obstacle that overlap.
};

/// The state of one avatar.
struct AvatarState {
  uint32_t id = 0;
  int32_t avatar_class = 0;
  Vec3d position;     ///< Y at the feet. [m]
  double radius = 0;  ///< Of the body. [m]
  /// Unit vector in the ground plane. For an avatar that leans: before the lean; leaned() of lean.h
  /// gives the direction of its walk.
  double heading_x = 0;
  double heading_z = 0;
  bool flies = false;   ///< It is in the air, or in a take-off or landing.
  bool climbs = false;  ///< It walks over nodes.
  /// Unit vector along the body from the feet; for climbers the surface's normal.
  Vec3d up{0, 1, 0};
};

}  // namespace throng
