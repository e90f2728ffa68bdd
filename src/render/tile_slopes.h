// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>

#include "world/ground.h"

/// How steep the ground of level tiles is: what their nodes promise is a limit of some class, for
/// the bake asks no more, and flat floor on which only the steepest walkers have room promises
/// theirs.
namespace throng {

/// Reads the tile that was asked for last once.
class TileSlopes {
 public:
  explicit TileSlopes(const WorldData& world) : world_(&world) {}

  /// Inclination of the floor in a cell, as feet follow it (world/surface.h): 0 on stairs. Beside a
  /// cell without floor the slope is that of the cells on the other side. [degrees]
  double at(uint32_t level, int32_t x, int32_t z);

 private:
  const WorldData* world_;
  uint32_t level_ = UINT32_MAX;
  GroundLevel ground_;
  std::array<uint16_t, 4096> samples_{};
};

}  // namespace throng
