// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "throng/prism.h"

/// Obstacles that are put up in a crowd while it runs: crates, barriers, doors, carts.
namespace throng {

/// Names an obstacle of a crowd; zero names none. An id is never given twice.
struct ObstacleId {
  uint32_t slot1 = 0;  ///< Slot plus one.
  uint32_t generation = 0;
  explicit operator bool() const { return slot1 != 0; }
  friend bool operator==(ObstacleId, ObstacleId) = default;
};

/// How an obstacle affects paths. Avatars avoid both kinds as walls.
enum class ObstacleKind : uint8_t {
  kStatic,  ///< Paths lead around it: a crate, a door.
  /// Paths ignore it: a cart, which is elsewhere by the time that an avatar comes there.
  kKinematic,
};

/// What happens when an obstacle is requested where avatars stand.
enum class ObstaclePolicy : uint8_t {
  /// It closes: from the request on no avatar enters its volume, paths lead around it, and avatars
  /// inside walk out: along their paths if these lead out soon, else by the shortest path. It comes
  /// up as soon as no body is inside.
  kRefuseEntry,
  /// It waits until no body is inside; until then avatars walk in and out.
  kWait,
};

/// The present state of an obstacle.
struct ObstacleState {
  Prism prism;         ///< Where it is, or will be.
  bool is_up = false;  ///< It blocks avatars.
  bool waits = false;  ///< It was requested to come up or to move, and waits for avatars to leave.
  ObstacleKind kind = ObstacleKind::kStatic;
  ObstaclePolicy policy = ObstaclePolicy::kRefuseEntry;
  /// When it was last requested, in the crowd's time (steps times dt). Below 0: never, or switched
  /// off since. [s]
  double asked_at = -1;
  double up_at = -1;  ///< When it came up; below 0: it is not up. [s]
  /// Avatars inside, counted at the request and at the beginning of each step.
  uint32_t occupants = 0;
};

}  // namespace throng
