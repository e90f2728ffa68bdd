// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "throng/prism.h"

/// What is put up in a crowd while it runs: crates, barriers, doors, carts.
namespace throng {

/// Names an obstacle of a crowd; zero names none. An id is never given twice.
struct ObstacleId {
  uint32_t slot1 = 0;  ///< Slot plus one.
  uint32_t generation = 0;
  explicit operator bool() const { return slot1 != 0; }
  friend bool operator==(ObstacleId, ObstacleId) = default;
};

/// What an obstacle is to those who look for their ways. A wall it is to everybody.
enum class ObstacleKind : uint8_t {
  kStatic,     ///< Ways lead around it: a crate, a door.
  kKinematic,  ///< Ways do not know it: a cart, which is elsewhere by the time that one is there.
};

/// What an obstacle does that is to come up where avatars are.
enum class ObstaclePolicy : uint8_t {
  /// It closes: from the request on no avatar enters its volume, paths lead around it, and avatars
  /// in it get out: on along their paths if these lead out soon, else the nearest way. It is up as
  /// soon as no body is in it.
  kRefuseEntry,
  /// It waits until its volume happens to be free; until then avatars go in and out.
  kWait,
};

/// An obstacle as it is now.
struct ObstacleState {
  Prism prism;         ///< Where it is, or would be.
  bool is_up = false;  ///< It is in the way of those who walk.
  bool waits =
      false;  ///< It is not yet where, or what, it was asked to be: avatars are in its way.
  ObstacleKind kind = ObstacleKind::kStatic;
  ObstaclePolicy policy = ObstaclePolicy::kRefuseEntry;
  /// When it was last asked to be up, in the crowd's time: steps times dt; below 0: never, or it
  /// was asked to be down since. [s]
  double asked_at = -1;
  double up_at = -1;  ///< When it came up; below 0: it is not up. [s]
  /// In its way when this was last looked at: when it was asked for, and as each step begins.
  uint32_t occupants = 0;
};

}  // namespace throng
