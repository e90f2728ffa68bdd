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

/// An obstacle as it is now.
struct ObstacleState {
  Prism prism;         ///< Where it is, or would be.
  bool is_up = false;  ///< It is in the way of those who walk.
  bool waits =
      false;  ///< It is not yet where, or what, it was asked to be: somebody is in its way.
  ObstacleKind kind = ObstacleKind::kStatic;
};

}  // namespace throng
