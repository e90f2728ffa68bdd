// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "throng/base.h"
#include "throng/context.h"
#include "throng/result.h"
#include "throng/scene.h"
#include "throng/world.h"

/// The walkable surface of a class, as triangles or as polygons seen from above, for other
/// programs.
namespace throng {

/// Makes triangles of the floor under all legal cells of a class, where its feet are: flat cells
/// and planes are merged into rectangles, within 2 mm at the middle of each cell. One part per
/// storey, material "floor". Borders of the triangles are borders of cells: where the middle of a
/// body may be. Reads every zone. Fails with kBadConfig (no such class), kBadFile (a zone cannot be
/// used), kCancelled.
[[nodiscard]] THRONG_API Result<Scene> walkable_surface(const World& world, int32_t avatar_class,
                                                        Context& context);

/// A piece of the walkable surface seen from above: cells connected by their sides.
struct WalkablePiece {
  Polygon polygon;  ///< Counter-clockwise, its holes clockwise, in (x, z). Rings may touch.
  double area = 0;  ///< [m^2]
};

/// Makes polygons of the legal cells of a class whose floors lie from `lowest` to `highest`, all
/// levels projected onto the plane, largest piece first. Reads every zone. Fails as
/// walkable_surface does, and with kLimit if the world has more than 2^32 cells.
[[nodiscard]] THRONG_API Result<std::vector<WalkablePiece>> walkable_pieces(
    const World& world, int32_t avatar_class, double lowest, double highest, Context& context);

/// A polygon as well-known text: POLYGON((x z, ...), (hole)), to the millimetre.
[[nodiscard]] THRONG_API std::string to_wkt(const Polygon& polygon);

}  // namespace throng
