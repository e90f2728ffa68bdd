// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <type_traits>

#include "world/walk.h"

/// Avatars as a step reads and writes them.
namespace throng::crowd {

/// Two to a cache line. A wanderer is handled alone, so its fields lie together; arrays of fields
/// would touch seven lines where this touches one.
struct Avatar {
  int32_t x = 0, z = 0;    // position in units of 1/2048 cell
  int32_t vx = 0, vz = 0;  // units a sub-step
  int32_t y = 0;           // feet [mm]
  uint32_t level = 0;      // of the world
  uint32_t id = 0;
  uint32_t reserved = 0;

  [[nodiscard]] world::GroundPoint point() const { return {x, z}; }
};
static_assert(sizeof(Avatar) == 32 && std::has_unique_object_representations_v<Avatar>);

}  // namespace throng::crowd
