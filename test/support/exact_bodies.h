// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "throng/scene.h"
#include "throng/world.h"

/// Grounds and boxes made of triangles, and the exact body test of `verify` on every legal cell.
namespace throng::test {

using Height = std::function<double(double x, double z)>;

/// A square of ground from triangles over a lattice, each cell split along a random diagonal. [m]
Scene ground(double side, double spacing, uint64_t seed, const Height& height);

/// Kerbs, walls and posts: a box with a foot in the ground, turned about its first corner. [m, rad]
void add_box(Scene& scene, Vec3d at, Vec3d size, double turn = 0);

/// Calls visit with the middle and the side of every cell that the class may stand on.
void for_legal_cells(const World& world, int32_t avatar_class,
                     const std::function<void(Vec3d middle, double cell)>& visit);

/// Expects that a body at nine points of each legal cell, corners included, enters no triangle.
/// Returns the number of cells.
int64_t expect_no_body_enters(const World& world, const Scene& scene, int32_t avatar_class,
                              const std::string& what);

}  // namespace throng::test
