// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "throng/scene.h"

/// Tiny hand-made scenes that tests and benchmarks of every stage share. Metres, Y up, floors begin
/// at (0, 0, 0) and extend towards +x and +z. They are the same on every machine.
namespace throng::worlds {

/// One square floor at height 0.
Scene flat(double side);

/// A floor of 10 x 6 at height 0 and a deck over x in [5, 10] at height 3 (underside 2.8), joined
/// by a flight of 18 solid risers along the z = 0 side, open to the deck at the top.
Scene two_floors();

/// A floor (x in [0, 3]), `count` solid risers towards +x, and a landing of 3 m. All 3 m wide.
Scene steps(double rise, double run, int32_t count);

/// A floor (x in [0, 3]), a slope towards +x of horizontal length `length`, a landing of 3 m. All 3
/// m wide.
Scene ramp(double slope_degrees, double length);

/// A floor of 8 x 6, cut by a wall (0.2 thick, 3 high) at x = 4 with an opening `width` wide whose
/// middle is at z = 3. The opening has no lintel.
Scene doorway(double width);

/// A floor of 10 x 4 and a slab (0.2 thick) over x in [4, 6] whose underside is at `height`.
Scene low_ceiling(double height);

/// `triangles` triangles in a cube of side `extent`: slivers, specks, long ones, level and upright
/// ones. Corners lie on whole millimetres.
Scene random_soup(uint64_t seed, uint32_t triangles, double extent);

/// [ML06] figures 4 to 6: floors at 1 and 4, and a block from 5.95 to 9 over parts of both. An
/// avatar of 4.5 at resolution 0.1 gives 32 slices taken, 2 kept (13.6 and 5.9).
Scene worked_example();

/// Thin roofs at 8, 7 and 6, side by side over a floor at 0. An avatar of 4.5 at resolution 0.1
/// gives 4 slices taken, 2 kept (12.6 and 5.9): each later slice replaces the one before.
Scene roofs_8_7_6();

}  // namespace throng::worlds
