// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "crowd/mode/orientation.h"

#include "throng/avatar.h"

// A body's direction is turned as its axis is: without that, its angle before the lean would jump
// where a climber passes from a wall to a ceiling.
namespace throng::crowd {

Orientation transported(Orientation orientation, const Vec3d& from, const Vec3d& to) {
  if (from == to || !orientation.exists()) return orientation;
  const Vec3d ahead = leaned({orientation.x(), 0, orientation.z()}, from);
  // The rotation as two reflections: at the plane normal to `from`, then normal to from + to.
  const Vec3d half = from + to;
  const double size = dot(half, half);
  if (!(size > 1e-9)) return orientation;  // Half a turn: around any axis.
  const Vec3d across = ahead - from * (2 * dot(ahead, from));
  const Vec3d own = unleaned(across - half * (2 * dot(across, half) / size), to);
  return Orientation::along({static_cast<float>(own.x), static_cast<float>(own.z)});
}

}  // namespace throng::crowd
