// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include "world/air_data.h"
#include "world/air_rows.h"

/// Clearance of free air boxes: width and height.
namespace throng::bake {

/// Writes the clearance of every free air box of a tree that was built from `source`, whose rows
/// reach `apron` cells beyond the zone on all sides: no width is promised beyond what they show.
/// The highest layer of the rows is free. A height is that over the box grown by its width. Time:
/// the cells, and 15 layers over each cube.
void measure_clearance(const world::AirTreeSource& source, int32_t apron, int32_t workers,
                       world::AirTreeData& tree);

}  // namespace throng::bake
