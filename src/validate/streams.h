// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>

/// How two streams of people sort themselves.
namespace throng::validate {

/// Somebody in a corridor: how far across it, and whether he walks up it or down.
struct Passer {
  double across = 0;  ///< [m]
  bool up = false;
};

/// Order of lanes [NS12]: the corridor in rows along it, `row` wide; the square of the surplus of
/// one way in each row, over all people, set to 0 for those mixed by chance, 1 for rows of one way.
/// Below 0 for those more even than chance. 0: too few to say. [row: m, > 0]
double lane_order(std::span<const Passer> people, double row);

/// Shape of a crowd before a door: mean distance to the side by mean distance to the front. 1 for
/// a half circle, less for a column, more for a line along the wall.
struct Before {
  double aside = 0, front = 0;  ///< Of a place, from the middle of the door. [m]
};
double arch_shape(std::span<const Before> people);

}  // namespace throng::validate
