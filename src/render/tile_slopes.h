// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>

#include "world/ground.h"

/// The slope of the ground of level tiles. It is measured, because a node promises only the limit
/// of some class: flat floor on which only the class with the steepest limit fits promises that
/// limit.
namespace throng::render {

/// Keeps the level tile that was read last.
class TileSlopes {
 public:
  explicit TileSlopes(const world::WorldData& world) : world_(&world) {}

  /// Inclination of the floor in a cell, as feet follow it (world/surface.h): 0 on stairs. Beside a
  /// cell without floor the slope is that of the cells on the other side. [degrees]
  double at(uint32_t level, int32_t x, int32_t z);

 private:
  const world::WorldData* world_;
  uint32_t level_ = UINT32_MAX;
  world::GroundLevel ground_;
  std::array<uint16_t, 4096> samples_{};
};

}  // namespace throng::render
