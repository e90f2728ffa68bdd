// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>

/// Measures of self-organisation: lanes of a counter-flow, the arch of a crowd before a door.
namespace throng::validate {

/// A person in a corridor: the position across it, and the direction along it.
struct Passer {
  double across = 0;  ///< [m]
  bool up = false;
};

/// Order of lanes [NS12]: the corridor is cut into rows along it, `row` wide. Each row contributes
/// the square of the surplus of one direction by its people; the sum is scaled to 0 for random
/// mixing and 1 if every row has one direction. Below 0: more even than random. 0: too few people.
/// [row: m, > 0]
double lane_order(std::span<const Passer> people, double row);

/// Shape of a crowd before a door: mean distance to the side by mean distance to the front. 1 for
/// a half circle, less for a column, more for a line along the wall.
struct DoorOffset {
  double aside = 0, front = 0;  ///< Offset from the middle of the door. [m]
};
double arch_shape(std::span<const DoorOffset> people);

}  // namespace throng::validate
