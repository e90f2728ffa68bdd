// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <map>

#include "throng/world.h"

/// All ground that a body can walk to: a flood over World::move, one cell at a time.
namespace throng {

struct Flood {
  double area = 0;  ///< Reached. [m^2]
  std::map<int32_t, double>
      area_at;          ///< Reached, by height of the feet in whole centimetres. [m^2]
  double steepest = 0;  ///< Largest change of height in one move. [m]

  /// Area reached with feet within 5 cm of `height`. [m^2]
  [[nodiscard]] double around(double height) const;
};

/// From the place nearest to `start` (vertical tolerance: a metre). Empty if there is none.
Flood flood_from(const World& world, int32_t avatar_class, Vec3d start);

}  // namespace throng
